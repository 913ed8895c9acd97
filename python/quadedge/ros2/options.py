"""The options of ``python -m quadedge.ros2``, judged before cameras come."""

import argparse
from pathlib import Path

from ..bag.calibration import given_rig
from ..errors import DataError, UsageError
from ..session import check_session_options
from .mount import levelled, mount_of


def _remaps(remaps: list[str]) -> dict[str, str]:
    """Topics by the names that they replace."""
    for remap in remaps:
        if remap.count(":=") != 1 or not all(part.startswith("/") for part in remap.split(":=")):
            raise UsageError(f"--remap: found '{remap}', expected two topics, as /quadedge/odometry:=/odom")
    return dict(remap.split(":=") for remap in remaps)


def check_options(options: argparse.Namespace) -> None:
    """Raises UsageError, DataError or DeviceError for what would fail when the first pair comes."""
    options.remaps = _remaps(options.remap)
    if options.left and options.left == options.right:
        raise UsageError(f"--left, --right: found {options.left} twice, expected the topics of two cameras")
    if options.left_mask and options.left_mask == options.right_mask:
        raise UsageError(f"--left-mask, --right-mask: found {options.left_mask} twice, expected two topics")
    for mask in {options.left_mask, options.right_mask} & {options.left, options.right} - {""}:
        raise UsageError(f"--left-mask, --right-mask: found {mask}, the topic of a camera, expected one of masks")
    frames = (options.base_frame, options.odom_frame, options.map_frame)
    if len(set(frames)) < 3 or not all(frames):
        raise UsageError(f"--base-frame, --odom-frame, --map-frame: found {', '.join(frames)}, expected three names")
    if options.base_from_camera:
        mount_of(options.base_from_camera)
    if options.gravity:
        levelled(options.gravity)
    if options.calibration:
        given_rig(options.calibration)
    if options.map and options.loops:
        raise UsageError("--map, --loops: found both, expected one: either says where odom is in the map")
    if options.save_map and not options.loops:
        raise UsageError("--save-map: found no --loops, expected it: maps are kept with it")
    if options.map and not Path(options.map).is_file():
        raise DataError(f"{options.map}: found no such file, expected one of --save-map or `quadedge run --save-map`")
    check_session_options(options)
