"""Tracks two folders of images from your own cameras.

    python 01_own_images.py LEFT RIGHT CALIBRATION [TRAJECTORY.txt]

Images are paired in the order of their names. Names that are timestamps in nanoseconds are used as such; otherwise the
folders need a times.txt or data.csv. CALIBRATION: a file of Kalibr, OpenCV, ROS or EuRoC, or two separated by a comma.
"""

import sys

import numpy

import quadedge

left, right, calibration = sys.argv[1:4]
output = sys.argv[4] if len(sys.argv) > 4 else "trajectory.txt"

images = quadedge.open_stereo_source(left=left, right=right, calibration=calibration)
tracked = []
with quadedge.Odometry(images) as odometry:
    for frame in images:
        result = odometry.track(frame.stamp_ns, frame.left, frame.right)
        position = numpy.round(result.world_from_left[:3, 3], 3) if result.is_tracked else []
        print(frame.stamp_ns, "ambiguous" if result.ambiguous_motion else result.status, *position, result.message)
        if result.is_tracked:
            tracked.append(result)

stamps = numpy.array([result.stamp_ns for result in tracked])
poses = numpy.array([result.world_from_left for result in tracked])
quadedge.Trajectory(stamps, poses).write_tum(output)
