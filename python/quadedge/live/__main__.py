"""``python -m quadedge.live KIND``: tracks a camera live."""

import argparse
import signal
import sys
from contextlib import ExitStack, suppress

from ..session import Session, add_session_options, check_session_options, say_on_stderr
from ..shell import exit_code
from . import KINDS, open_camera

_OPTIONS = ("width", "height", "fps", "serial", "source", "calibration")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m quadedge.live",
        description="Tracks a stereo camera until Ctrl-C and prints a line per frame: status, position [m], latency "
                    "[ms]. Calibration and timestamps come from the camera (realsense, oak).")
    kinds = parser.add_subparsers(dest="kind", required=True, metavar="KIND")
    for kind, what in zip(KINDS, ("infrared pair of a RealSense, with pyrealsense2",
                                  "mono cameras of an OAK, with depthai",
                                  "both views side by side in one image, with ffmpeg")):
        one = kinds.add_parser(kind, help=what, description=f"Tracks the {what}." if kind != "v4l2" else
                               "Tracks a camera that delivers both views side by side, with ffmpeg.")
        for name in ("width", "height", "fps"):
            one.add_argument(f"--{name}", type=int, help="of the images [px]" if name != "fps" else "frames per second")
        if kind == "v4l2":
            one.add_argument("source", nargs="?", help="device or address; default: /dev/video0")
            one.add_argument("--calibration", metavar="FILE", help="calibration of both cameras", required=True)
        else:
            one.add_argument("--serial", help="which camera, if there are several")
        viewer = one.add_mutually_exclusive_group()
        viewer.add_argument("--view", action="store_true", help="show edges and path in rerun's viewer")
        viewer.add_argument("--web", action="store_true", help="the same in a browser")
        viewer.add_argument("--save", metavar="F.rrd", help="write a file for rerun")
        add_session_options(one)
    return parser


def _line(result) -> str:
    x, y, z = result.pose_or_prediction[:3, 3]
    status = "ambiguous" if result.ambiguous_motion else result.status
    return f"{status:20} {x:8.3f} {y:8.3f} {z:8.3f} m  {result.timing.latency_ms:6.1f} ms  {result.message}"


def _run(options: argparse.Namespace) -> None:
    say, given = say_on_stderr("quadedge.live"), vars(options)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    check_session_options(options)
    camera = open_camera(options.kind, **{name: given[name] for name in _OPTIONS if given.get(name)})
    with suppress(KeyboardInterrupt), ExitStack() as closing:
        closing.callback(camera.close)
        session = Session(camera.rig, options, say)
        closing.callback(session.close)  # whatever becomes of the others
        if options.output:
            session.begin_files(options.output, camera.name)
        viewer = None
        if options.view or options.web or options.save:
            from ..view import Viewer

            viewer = Viewer(camera.name, save=options.save, web=options.web)
            closing.callback(viewer.close)
            if viewer.address:
                say(f"open {viewer.address}")
        size = f"{camera.rig.left.width} x {camera.rig.left.height} px"
        say("; ".join([f"{camera.name}, {size}", *camera.notes]))
        for stamp_ns, left, right in camera:
            result = session.track(stamp_ns, left, right)
            print(_line(result), flush=True)
            if viewer:
                viewer.log(session.odometry, result, left, right)
        say("the camera delivers no more images")


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code, as documented for the ``quadedge`` command."""
    return exit_code("quadedge.live", lambda: _run(_parser().parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
