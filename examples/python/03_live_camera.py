"""Tracks a stereo camera live: 03_live_camera.py KIND [SOURCE CALIBRATION], KIND: realsense, oak or v4l2."""

import sys

import quadedge.live

kind, *more = sys.argv[1:]
camera = quadedge.live.open_camera(kind, **dict(zip(("source", "calibration"), more)))
with quadedge.Odometry(camera.rig, preset="fast") as odometry:
    for stamp_ns, left, right in camera:
        result = odometry.track(stamp_ns, left, right)
        status = "ambiguous" if result.ambiguous_motion else result.status
        print(f"{status:20} {result.pose_or_prediction[:3, 3].round(3)} m  {result.message}")
