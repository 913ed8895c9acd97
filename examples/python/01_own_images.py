"""Tracks two folders of images of one's own.

    python 01_own_images.py LEFT RIGHT CALIBRATION [TRAJECTORY.txt]

Images belong together by their order; names that are numbers are stamps in nanoseconds, others count as 20 frames per
second. CALIBRATION: a file of Kalibr, OpenCV, ROS or EuRoC, or two with a comma between them.
"""

import sys
from pathlib import Path

import numpy

import quadedge

left, right, calibration = sys.argv[1:4]
output = sys.argv[4] if len(sys.argv) > 4 else "trajectory.txt"

odometry = quadedge.Odometry(quadedge.Rig.from_file(calibration))
tracked = []
for number, files in enumerate(zip(sorted(Path(left).iterdir()), sorted(Path(right).iterdir()))):
    stamp_ns = int(files[0].stem) if files[0].stem.isdigit() else number * 50_000_000
    images = [quadedge.read_grey_image(file) for file in files]
    result = odometry.track(stamp_ns, *images)
    print(stamp_ns, result.status, *numpy.round(result.world_from_left[:3, 3], 3), result.message)
    if result.is_tracked:
        tracked.append(result)

stamps = numpy.array([result.stamp_ns for result in tracked])
poses = numpy.array([result.world_from_left for result in tracked])
quadedge.Trajectory(stamps, poses).write_tum(output)
