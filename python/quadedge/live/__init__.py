"""Frames of stereo cameras as they come, through the vendors' own packages.

    camera = quadedge.live.open_camera("realsense")                  # or "oak", "v4l2"
    odometry = quadedge.Odometry(camera.rig)
    for stamp_ns, left, right in camera:
        result = odometry.track(stamp_ns, left, right)

``python -m quadedge.live KIND`` does this on the command line, with a viewer and the results of ``quadedge run``.
"""

import importlib

from ..errors import UsageError

KINDS = ("realsense", "oak", "v4l2")


def open_camera(kind: str, **options):
    """Opens a camera of one of KINDS: iterating yields (stamp [ns], left, right) of the newest pair.

    It has a ``rig``, a ``name`` and close(). options: those of the class Camera in quadedge.live.KIND. Raises
    ImportError without the vendor's package, DataError where no camera is found or its calibration cannot be used.
    """
    if kind not in KINDS:
        raise UsageError(f"camera: found '{kind}', expected one of {', '.join(KINDS)}")
    return importlib.import_module(f".{kind}", __name__).Camera(**options)
