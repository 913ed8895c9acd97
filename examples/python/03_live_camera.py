"""Tracks a live stereo camera whose images, captured with OpenCV, show the left and right view side by side.

    python 03_live_camera.py CAMERA CALIBRATION      CAMERA: device index of OpenCV; stop with Ctrl-C
    python 03_live_camera.py stand-in                a rendered room instead of a camera

A camera needs OpenCV for Python (`pip install opencv-python-headless`); the stand-in does not.
"""

import sys
import time

import numpy

import quadedge


class StandIn:
    """A replacement for cv2.VideoCapture that renders a room."""

    def __init__(self):
        self.room = quadedge.synthetic(frames=10, width=320, height=200)
        self.frames = iter(self.room)

    def read(self):
        frame = next(self.frames, None)
        if frame is None:
            return False, None
        grey = numpy.hstack([frame.left, frame.right])
        return True, numpy.repeat(grey[:, :, None], 3, axis=2)


if sys.argv[1:] == ["stand-in"]:
    camera = StandIn()
    rig = camera.room
else:
    import cv2

    camera = cv2.VideoCapture(int(sys.argv[1]))
    rig = quadedge.Rig.from_file(sys.argv[2])

with quadedge.Odometry(rig, preset="fast") as odometry:
    while True:
        found, picture = camera.read()
        if not found:
            break
        green = picture[:, :, 1]  # a view of one channel; images may be strided
        middle = green.shape[1] // 2
        result = odometry.track(time.monotonic_ns(), green[:, :middle], green[:, middle:])
        x, y, z = result.pose_or_prediction[:3, 3]
        time_ms = result.timing.latency_ms
        print(f"{result.status:20} {x:8.3f} {y:8.3f} {z:8.3f} m  {time_ms:6.1f} ms  {result.message}")
