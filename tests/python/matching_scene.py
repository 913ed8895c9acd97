"""A rectified rig in front of a plane, to calculate by hand: a left point (x, y) is at (x - 10, y) on the right."""

from types import SimpleNamespace

import numpy
import quadedge
from quadedge.matching.surfaces import FrameTruth, right_from_left

STEEP = 1.5  # rad, nearly vertical


def floats(values):
    return numpy.array(values, numpy.float32)


def small_rig():
    camera = quadedge.PinholeCamera(100, 100, 49.5, 29.5, 100, 60)
    pose = numpy.eye(4)
    pose[0, 3] = -0.1
    return quadedge.Rig(camera, camera, pose)


def plane_truth(x=None):
    """Every pixel of the left view has disparity 10, except from column 80 on, where it is unknown. With x: a plane 1 m
    away, seen from x m farther right."""
    left = numpy.full((60, 100), 10, numpy.float32)
    left[:, 80:] = numpy.nan
    right = right_from_left(left, 100)
    if x is None:
        return FrameTruth(left, right, right_is_measured=False)
    pose = numpy.eye(4)
    pose[0, 3] = x
    return FrameTruth(left, right, depth_scale=10, world_from_left=pose)  # focal length 100 px, baseline 0.1 m


def edges(*rows):
    """Edges of one image: x, y and, unless it is STEEP, direction."""
    x, y, direction = zip(*((*row, STEEP)[:3] for row in rows))
    return SimpleNamespace(x=floats(x), y=floats(y), direction=floats(direction))


def stereo_edges(*rows, right_direction=STEEP):
    """Stereo edges: left x, y, right x. Their points are those of the plane's depth at a focal length of 100 px."""
    left_x, y, right_x = (floats(values) for values in zip(*rows))
    count = numpy.arange(len(rows), dtype=numpy.int32)
    depth = 10 / (left_x - right_x)
    points = numpy.stack([(left_x - 49.5) / 100 * depth, (y - 29.5) / 100 * depth, depth], axis=1).astype(float)
    tangents = numpy.tile([numpy.cos(STEEP), numpy.sin(STEEP), 0], (len(rows), 1))
    return SimpleNamespace(left_index=count, right_index=count, left=numpy.stack([left_x, y], axis=1),
                           right=numpy.stack([right_x, y], axis=1), left_direction=floats([STEEP] * len(rows)),
                           right_direction=floats([right_direction] * len(rows)), xyz=points, direction=tangents)


def images_of(stereo):
    """The edges that stereo edges consist of."""
    return [SimpleNamespace(x=xy[:, 0], y=xy[:, 1], direction=direction)
            for xy, direction in ((stereo.left, stereo.left_direction), (stereo.right, stereo.right_direction))]


def candidates(*rows, x=(), y=(), cue=()):
    """Lists of the targets of every row."""
    first = numpy.cumsum([0, *map(len, rows)]).astype(numpy.int32)
    return SimpleNamespace(first=first, target=numpy.array([one for row in rows for one in row], numpy.int32),
                           x=floats(x), y=floats(y), cue=floats(cue))


def result(search=-1, reference_frame=0, x=0.0, status="tracked"):
    """What the pipeline says of a frame, at x m to the right."""
    pose = numpy.eye(4)
    pose[0, 3] = x
    return SimpleNamespace(status=status, message="", pose_or_prediction=pose, reference_frame=reference_frame,
                           diagnostics=SimpleNamespace(search=search))
