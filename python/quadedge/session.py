"""Tracks frames as they come, for the programs that track live: prints warnings, and keeps results."""

import argparse
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy

from .errors import UsageError

_RESULTS = ("frames.csv", "poses.csv", "trajectory.txt", "report.json", "config.toml")


def add_session_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options that a Session takes."""
    parser.add_argument("-o", "--output", metavar="OUT", help="results folder, with the files of `quadedge run`")
    parser.add_argument("--force", action="store_true", help="replace results in OUT")
    parser.add_argument("--device", default="auto", help="auto, cpu, gpu, reference, an index, or a part of a name")
    parser.add_argument("--threads", type=int, metavar="N",
                        help="threads to compute with at most, here and in OpenCL on CPUs; default: all")
    parser.add_argument("--preset", default="default", help="fast, default or dense")
    parser.add_argument("--config", metavar="FILE", help="a configuration file (TOML)")
    parser.add_argument("--loops", action="store_true", help="recognise places and close loops")


@contextmanager
def stopped_by_signals() -> Iterator[list[int]]:
    """A list that gets the number of SIGINT or SIGTERM when it comes, which then does nothing else."""
    came: list[int] = []
    before = {number: signal.signal(number, lambda found, _: came.append(found))
              for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def check_session_options(options: argparse.Namespace) -> None:
    """Limits the threads. Raises UsageError, DataError or DeviceError for options that a Session would refuse."""
    from . import Device, configuration, limit_threads

    if options.threads is not None:
        limit_threads(options.threads)
    configuration(options.preset, options.config)
    Device(options.device)
    if not options.output:
        return
    if Path(options.output).is_file():
        raise UsageError(f"{options.output}: found a file, expected a folder for results")
    found = [name for name in _RESULTS if (Path(options.output) / name).exists()]
    if found and not options.force:
        raise UsageError(f"{options.output}: the folder holds results ({found[0]}); choose another folder with -o, or "
                         "replace them with --force")


class Session:
    """An Odometry and its results. say: called with a sentence for the user. Raises what Odometry raises."""

    def __init__(self, rig, options: argparse.Namespace, say):
        from . import Odometry

        self.rig = rig
        self.odometry = Odometry(rig, options.device, options.preset, options.config, loops=options.loops)
        self._files, self._output, self._options, self._say = None, "", options, say
        self._last, self.frames = None, 0

    def begin_files(self, output: str, name: str) -> None:
        """Keeps results from here on. Raises UsageError or DataError for a folder that has some or is not writable."""
        from . import ResultFiles
        self._files, self._output = ResultFiles(output, self.odometry, name, " ".join(sys.argv),
                                                self._options.force), output

    def track(self, stamp_ns: int, left: numpy.ndarray, right: numpy.ndarray):
        """The FrameResult of a pair, kept. Raises what Odometry.track() and keep() raise."""
        result = self.odometry.track(stamp_ns, left, right)
        self.keep(result)
        return result

    def keep(self, result) -> None:
        """Writes the result of the next frame and prints its warnings. Raises DataError if it cannot be written."""
        last, self._last = self._last, result
        for warning in result.warnings:
            self._say(f"warning: frame {self.frames}: {warning.text}")
        if not result.is_tracked and (last is None or last.status != result.status):
            self._say(f"warning: frame {self.frames}: lost: {result.message}")
        if result.ambiguous_motion and not (last is not None and last.ambiguous_motion):
            self._say(f"warning: frame {self.frames}: {result.message}")
        elif last is not None and last.segment != result.segment and not result.warnings:
            self._say(f"warning: frame {self.frames}: {result.message}")
        self.frames += 1
        if self._files:
            self._files.add(result)

    def end_files(self) -> None:
        """Keeps no more results. Those of the frames so far stay as they are, without a report."""
        self._files = None

    def close(self) -> None:
        """Finishes the results; releases the device in any case. Raises DataError if results cannot be written."""
        try:
            if self._files:
                self._files.finish()
                if self._options.loops and self.frames:
                    self.odometry.map_trajectory().write_tum(Path(self._output) / "trajectory_map.txt")
                self._say(f"results of {self.frames} frames are in {self._output}")
        finally:
            self.odometry.close()


def say_on_stderr(program: str):
    """A function that prints a sentence as this program's."""
    return lambda text: print(f"{program}: {text}", file=sys.stderr, flush=True)
