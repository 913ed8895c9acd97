"""``python -m quadedge.bag``: tracks a ROS recording."""

import argparse
import shutil
import signal
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path

import numpy

from ..errors import UsageError
from ..run_frames import read_frames
from ..shell import exit_code, program
from . import Recording, open_bag, write_mcap
from .topics import add_topic_options

_TOO_FEW_TRACKED = 5  # exit code of a finished run


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m quadedge.bag",
        description="Tracks a stereo recording of ROS 1 (.bag), ROS 2 (a folder) or MCAP. Writes the results of "
                    "`quadedge run` to OUT, and OUT/odometry, an MCAP of nav_msgs/Odometry with covariances.",
        epilog="Options after -- are passed to `quadedge run`: python -m quadedge.bag f.bag -o out -- --points m.ply")
    parser.add_argument("bag", nargs="+", help="the recording; a ROS 1 recording may consist of several .bag files")
    parser.add_argument("-o", "--output", metavar="OUT",
                        help="results folder; without it the recording is described but not tracked")
    add_topic_options(parser)
    parser.add_argument("--sort-stamps", action="store_true",
                        help="take the images in the order of their stamps; by default one that goes back is refused")
    parser.add_argument("--restarts", action="store_true",
                        help="start a new segment of the trajectory where a stamp goes back: a clock was set, or a "
                             "simulation restarted")
    parser.add_argument("--withhold-ambiguous", action="store_true",
                        help="write no odometry of frames with an ambiguous motion; by default with variances of 1e6")
    parser.add_argument("--device", help="auto, cpu, gpu, reference, an index, or a part of a name")
    parser.add_argument("--preset", help="fast, default, dense or paper")
    parser.add_argument("--config", metavar="FILE", help="a configuration file (TOML)")
    return parser


def _pgm(image: numpy.ndarray) -> bytes:
    height, width = image.shape
    maximum = numpy.iinfo(image.dtype).max
    return b"P5\n%d %d\n%d\n" % (width, height, maximum) + image.astype(image.dtype.newbyteorder(">")).tobytes()


def _run_program(recording: Recording, options: argparse.Namespace, more: list[str]) -> int:
    """Tracks the recording with `quadedge run` and returns its exit code."""
    with tempfile.TemporaryDirectory() as folder:
        times = Path(folder) / "times.txt"
        times.write_text("".join(f"{ns // 10**9}.{ns % 10**9:09d}\n" for ns in recording.stamps_ns))
        command = [*program(), "run", "-", "--output", options.output, "--name", recording.name, "--times", str(times),
                   "--calibration", recording.write_calibration(Path(folder)), *more]
        command += ["--restarts"] * bool(recording.pairing.restarts) + ["--rectified"] * recording.calibration_states_p
        for name in ("device", "preset", "config"):
            if value := getattr(options, name):
                command += [f"--{name}", value]
        process = subprocess.Popen(command, stdin=subprocess.PIPE)
        try:
            for frame in recording:
                process.stdin.write(_pgm(frame.left) + _pgm(frame.right))
        except (BrokenPipeError, KeyboardInterrupt):  # it has ended; Ctrl-C reaches it, too, and it keeps its results
            pass
        except Exception:
            process.send_signal(signal.SIGINT)
            raise
        finally:
            with suppress(BrokenPipeError):
                process.stdin.close()
            process.wait()
        code = process.returncode
        return code if code >= 0 else 128 - code  # of a signal, as shells report it


def _run(options: argparse.Namespace, more: list[str]) -> int:
    recording = open_bag(options.bag, left=options.left, right=options.right, left_info=options.left_info,
                         right_info=options.right_info, calibration=options.calibration,
                         tolerance_ns=round(options.tolerance * 1e6), sort_stamps=options.sort_stamps,
                         restarts=options.restarts, rectified=options.rectified)
    print(f"recording  {recording.name}\nleft       {recording.topics.left}\nright      {recording.topics.right}\n"
          f"frames     {recording.pairing}", flush=True)
    if recording.has_recorded_stamps:
        print("quadedge.bag: warning: the stamps of all images are 0: the times of recording replace them, which vary "
              "with the load of the recorder", file=sys.stderr)
    if options.output is None:
        next(iter(recording))  # images and camera_info that a run would refuse are refused here, too
        if recording.has_calibration:
            recording.rig  # noqa: B018
        return 0
    recording.rig  # noqa: B018  before the program starts: its messages would name a temporary file
    folder = Path(options.output) / "odometry"
    if folder.exists() and not ("--force" in more and (folder / "metadata.yaml").exists()):
        raise UsageError(f"{folder}: the folder exists; choose another one with -o, or replace its recording with -- "
                         "--force")
    code = _run_program(recording, options, more)
    if code in (0, _TOO_FEW_TRACKED):
        shutil.rmtree(folder, ignore_errors=True)
        file = write_mcap(folder, read_frames(options.output), withhold_ambiguous=options.withhold_ambiguous)
        print(f"odometry   {file}")
    return code


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code, as documented for the ``quadedge`` command."""
    given = sys.argv[1:] if arguments is None else arguments
    end = given.index("--") if "--" in given else len(given)
    options = _parser().parse_args(given[:end])
    return exit_code("quadedge.bag", lambda: _run(options, given[end + 1:]))


if __name__ == "__main__":
    sys.exit(main())
