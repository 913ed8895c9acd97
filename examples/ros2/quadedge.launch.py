"""Starts quadedge.ros2 beside a camera's driver: ros2 launch ./quadedge.launch.py python:=/opt/quadedge/bin/python

python: of the virtual environment with the wheel and its extra ros2; options: those of python -m quadedge.ros2.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("python", default_value="/opt/quadedge/bin/python"),
        DeclareLaunchArgument("options", default_value="--preset fast"),
        # SIGINT ends it within seconds. A usage error (2) or a missing device (4) would only repeat: no respawn.
        ExecuteProcess(cmd=[LaunchConfiguration("python"), "-m", "quadedge.ros2", LaunchConfiguration("options")],
                       shell=True, output="screen", respawn=False, sigterm_timeout="10"),
    ])
