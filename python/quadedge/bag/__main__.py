"""``python -m quadedge.bag``: tracks a recording of ROS from the shell."""

import argparse
import sys
from pathlib import Path

from .. import Odometry, UsageError
from ..shell import exit_code
from . import Recording, open_bag, write_mcap, write_tum
from .recording import TOLERANCE_NS


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m quadedge.bag",
        description="Tracks a stereo recording of ROS 1 (.bag), ROS 2 (a folder) or MCAP: writes OUT/trajectory.txt "
                    "(TUM) and OUT/odometry (MCAP of nav_msgs/Odometry with covariance).")
    parser.add_argument("bag", nargs="+", help="the recording; several .bag files that belong together")
    parser.add_argument("-o", "--output", metavar="OUT", help="folder for the results; without it nothing is tracked, "
                                                              "only what the recording holds is said")
    parser.add_argument("--left", default="", metavar="TOPIC",
                        help="images of the left camera; found by name otherwise")
    parser.add_argument("--right", default="", metavar="TOPIC", help="images of the right camera")
    parser.add_argument("--calibration", metavar="FILE", help="instead of camera_info: a file, or two with a comma "
                                                              "between them, left and right")
    parser.add_argument("--tolerance", type=float, default=TOLERANCE_NS / 1e6, metavar="MS",
                        help="how far the stamps of a pair may lie apart [ms]; default: %(default)g")
    parser.add_argument("--device", default="auto", help="auto, cpu, gpu, reference, a number, or a part of a name")
    parser.add_argument("--preset", default="default", help="fast, default or accurate")
    parser.add_argument("--config", metavar="FILE", help="a configuration (TOML)")
    return parser


def _track(recording: Recording, options: argparse.Namespace) -> list:
    odometry = Odometry(recording.rig, options.device, options.preset, options.config)
    results = []
    for frame in recording:
        result = odometry.track(frame.stamp_ns, frame.left, frame.right)
        if result.warning or (result.message and not result.is_tracked):
            print(f"frame {len(results)}: {result.warning or result.message}", file=sys.stderr)
        results.append(result)
    return results


def _run(options: argparse.Namespace) -> None:
    recording = open_bag(options.bag, left=options.left, right=options.right, calibration=options.calibration,
                         tolerance_ns=round(options.tolerance * 1e6))
    print(f"recording  {recording.name}\nleft       {recording.topics.left}\nright      {recording.topics.right}\n"
          f"frames     {recording.pairing}")
    if options.output is None:
        return
    output = Path(options.output)
    if output.exists() and any(output.iterdir()):
        raise UsageError(f"{output}: found files in it, expected a new or an empty folder")
    results = _track(recording, options)
    output.mkdir(parents=True, exist_ok=True)
    write_tum(output / "trajectory.txt", results)
    write_mcap(output / "odometry", results)
    print(f"tracked    {sum(result.is_tracked for result in results)} of {len(results)}\nresults    {output}")


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code of the ``quadedge`` command."""
    return exit_code("quadedge.bag", lambda: _run(_parser().parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
