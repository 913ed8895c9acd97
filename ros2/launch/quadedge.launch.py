"""ros2 launch quadedge_ros2 quadedge.launch.py params_file:=FILE"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    package = "quadedge_ros2"
    defaults = PathJoinSubstitution([FindPackageShare(package), "config", "quadedge.yaml"])
    return LaunchDescription([
        DeclareLaunchArgument("params_file", default_value=defaults),
        # SIGINT ends it within seconds. A usage error (2) or a missing device (4) would only repeat: no respawn.
        Node(package=package, executable="quadedge", parameters=[LaunchConfiguration("params_file")], output="screen",
             respawn=False, sigterm_timeout="10"),
    ])
