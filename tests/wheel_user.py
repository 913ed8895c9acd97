"""The README's five lines on rendered images.   wheel_user.py DEVICE"""

import sys

import quadedge

frames = quadedge.synthetic(frames=3, width=160, height=100)
odometry = quadedge.Odometry(frames.rig, device=sys.argv[1])
for frame in frames:
    result = odometry.track(frame.stamp_ns, frame.left, frame.right)
points = odometry.edges().xyz
assert points.shape[1] == 3 and len(points) > 100, points.shape
print(result.status, result.world_from_left.shape, len(points))
