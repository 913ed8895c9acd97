"""``python -m quadedge.view``: shows results in rerun's viewer."""

import argparse
import sys
import time
from pathlib import Path

from ..errors import DataError, UsageError
from ..shell import exit_code
from . import Viewer
from .results import Run


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m quadedge.view",
        description="Shows the results of `quadedge run` along a time line: path, keyframes, edges in space, both "
                    "images with edges and quads, counts and times.")
    parser.add_argument("results", metavar="RESULTS", help="results folder of `quadedge run`")
    target = parser.add_mutually_exclusive_group()
    target.add_argument("--save", metavar="F.rrd", help="write a file for `rerun F.rrd` instead of opening a window")
    target.add_argument("--web", action="store_true", help="serve the viewer to a browser until Ctrl-C")
    parser.add_argument("--no-images", action="store_true",
                        help="show only what the files in RESULTS contain, without tracking the recording again")
    parser.add_argument("--data", metavar="PATH", help="the recording, if it has moved since the run")
    parser.add_argument("--device", default="auto", help="device on which the recording is tracked again for its edges")
    parser.add_argument("--force", action="store_true", help="replace F.rrd")
    return parser


def _show(options: argparse.Namespace) -> None:
    if options.save and Path(options.save).exists() and not options.force:
        raise UsageError(f"{options.save}: the file exists; choose another name, or --force to replace it")
    if not (Path(options.results) / "frames.csv").is_file():
        raise DataError(f"{options.results}: found no frames.csv, expected a results folder of `quadedge run`")
    run = Run(options.results)
    recording = None if options.no_images else run.open_recording(options.data)
    if recording is None and not options.no_images:
        print(f"quadedge.view: images and edges are not shown: {run.why_no_recording}", file=sys.stderr)
    unfinished = f"{options.save}.part" if options.save else None
    viewer = Viewer(Path(options.results).resolve().name, save=unfinished, web=options.web)
    try:
        run.show(viewer, recording, options.device)
        if options.save:
            viewer.close()
            Path(unfinished).replace(options.save)
        print(f"frames     {len(run.frames)}" + (f"\nwritten    {options.save}" if options.save else ""))
        if viewer.address:
            print(f"open       {viewer.address}", flush=True)
        while options.web:
            time.sleep(1)
    except KeyboardInterrupt:
        if not options.web:
            print("quadedge.view: interrupted", file=sys.stderr)
    finally:
        viewer.close()
        if unfinished:
            Path(unfinished).unlink(missing_ok=True)


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code, as documented for the ``quadedge`` command."""
    return exit_code("quadedge.view", lambda: _show(_parser().parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
