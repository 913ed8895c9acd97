"""``python -m quadedge.ros2``: odometry from the topics of a stereo camera."""

import argparse
import sys
from pathlib import Path

from ..bag.topics import add_topic_options, milliseconds
from ..errors import DataError, UsageError
from ..session import add_session_options, check_session_options, say_on_stderr, stopped_by_signals
from ..shell import exit_code

_HELP = """\
Tracks the images of two topics of ROS 2 (sensor_msgs/Image or CompressedImage, and CameraInfo) and publishes:

  /quadedge/odometry  nav_msgs/Odometry of every tracked pair
  /tf                 odom to base_link; with --loops or --map map to odom
  /diagnostics        status, reason of a loss, latency and dropped pairs, once a second
  /quadedge/edges     with --cloud, sensor_msgs/PointCloud2
  /quadedge/map_pose  with --map, geometry_msgs/PoseWithCovarianceStamped of every located pair

A std_msgs/Empty on /quadedge/reset starts again at the origin, as does the service of this name. The services
/quadedge/save_map and /quadedge/load_map write and read maps; all are std_srvs/srv/Trigger. The domain is that of
ROS_DOMAIN_ID. Ctrl-C ends it."""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m quadedge.ros2", description=_HELP,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add_topic_options(parser)
    for side in ("left", "right"):
        parser.add_argument(f"--{side}-mask", default="", metavar="TOPIC",
                            help=f"masks of the {side} images, with their stamps: sensor_msgs/Image, mono8, 0 where "
                                 "nothing is tracked")
    parser.add_argument("--mask-wait", type=milliseconds, default=100.0, metavar="MS",
                        help="how long a pair waits for its masks at most [ms], before it is tracked without; default: "
                             "%(default)g")
    parser.add_argument("--reliable", action="store_true",
                        help="request lost images again (reliable QoS); default: best effort, as for sensors")
    parser.add_argument("--remap", action="append", default=[], metavar="FROM:=TO", help="publish under another name")
    parser.add_argument("--base-from-camera", metavar="X,Y,Z,ROLL,PITCH,YAW",
                        help="pose of the left camera in the base frame [m, rad]; default: that of the images' frame "
                             "in /tf_static")
    parser.add_argument("--gravity", metavar="X,Y,Z",
                        help="direction of gravity in the axes of the base in the first pair, such as 0.1,0,-9.8: "
                             "levels odom, as REP 105 asks; default: odom has the axes of the base in the first pair")
    parser.add_argument("--use-sim-time", action="store_true", help="stamp diagnostics with the time of /clock")
    for name, frame in (("base", "base_link"), ("odom", "odom"), ("map", "map")):
        parser.add_argument(f"--{name}-frame", default=frame, metavar="FRAME", help="default: %(default)s")
    parser.add_argument("--no-tf", action="store_true", help="do not publish /tf, for use with a filter that does")
    parser.add_argument("--withhold-ambiguous", action="store_true",
                        help="publish nothing for pairs with an ambiguous motion; default: variances of 1e6")
    parser.add_argument("--map", metavar="FILE", help="locate pairs in a saved map, and publish map to odom")
    parser.add_argument("--save-map", metavar="FILE", help="file that the service /quadedge/save_map writes (--loops)")
    parser.add_argument("--cloud", action="store_true", help="publish the edges of every tracked pair as points")
    add_session_options(parser)
    return parser


def _remaps(remaps: list[str]) -> dict[str, str]:
    """Topics by the names that they replace."""
    for remap in remaps:
        if remap.count(":=") != 1 or not all(part.startswith("/") for part in remap.split(":=")):
            raise UsageError(f"--remap: found '{remap}', expected two topics, as /quadedge/odometry:=/odom")
    return dict(remap.split(":=") for remap in remaps)


def _check(options: argparse.Namespace) -> None:
    """Raises UsageError, DataError or DeviceError for what would fail when the first pair comes."""
    from ..bag.calibration import given_rig
    from .mount import levelled, mount_of

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


def _run(options: argparse.Namespace) -> None:
    from .domain import Domain
    from .node import Node
    from .watch import awaited_topics

    _check(options)
    say, domain = say_on_stderr("quadedge.ros2"), Domain()
    with stopped_by_signals() as stopped:
        found = awaited_topics(domain, options, say, stopped)
        if found:
            topics, kinds = found
            say(f"left {topics.left}, right {topics.right}")
            Node(domain, topics, kinds, options, say).run(stopped)


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code, as documented for the ``quadedge`` command."""
    return exit_code("quadedge.ros2", lambda: _run(_parser().parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
