"""Reads stereo recordings of ROS 1, ROS 2 and MCAP. Needs rosbags (the extra ``bag``).

    recording = quadedge.bag.open_bag("flight.bag")
    odometry = quadedge.Odometry(recording.rig)
    results = [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in recording]
    quadedge.bag.write_mcap("flight_odometry", results)

``python -m quadedge.bag flight.bag -o results`` does the same on the command line and also writes all results of
``quadedge run``. ROS itself is not needed.
"""

from .images import grey_image
from .pairing import Pairing, pair_stamps
from .recording import BagFrame, Recording, open_bag
from .writing import write_mcap

__all__ = ["BagFrame", "Pairing", "Recording", "grey_image", "open_bag", "pair_stamps", "write_mcap"]
