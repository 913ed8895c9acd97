"""Takes images from topics of ROS 2 and publishes odometry, without ROS: ``python -m quadedge.ros2``.

Needs cyclonedds and rosbags (the extra ``ros2``).
"""
