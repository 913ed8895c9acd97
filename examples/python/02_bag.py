"""Tracks a recording of ROS 1, ROS 2 or MCAP and writes its odometry as another recording.

    python 02_bag.py RECORDING OUT [CALIBRATION]

Needs rosbags (the extra `bag`). Without CALIBRATION, the recorded camera_info is used.
"""

import sys

import quadedge
import quadedge.bag

recording = quadedge.bag.open_bag(sys.argv[1], calibration=sys.argv[3] if len(sys.argv) > 3 else None)
print(recording.topics.left, recording.topics.right, recording.pairing)

odometry = quadedge.Odometry(recording.rig)
results = [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in recording]
print(sum(result.is_tracked for result in results), "of", len(results), "tracked,",
      sum(result.ambiguous_motion for result in results), "of them ambiguous: they may follow what moves")
print(quadedge.bag.write_mcap(sys.argv[2], results))
