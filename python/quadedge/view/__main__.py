"""``python -m quadedge.view``: results in rerun's viewer, from the shell."""

import argparse
import sys
import time
from pathlib import Path

from ..errors import DataError, UsageError
from ..shell import exit_code
from . import Viewer, show_results


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m quadedge.view",
        description="Shows the results of `quadedge run` on a time line: path, key rigs, edges in space, both images "
                    "with edges and quads, counts and times.")
    parser.add_argument("results", metavar="RESULTS", help="folder that `quadedge run` has left")
    target = parser.add_mutually_exclusive_group()
    target.add_argument("--save", metavar="F.rrd", help="write a file for `rerun F.rrd` instead of opening a window")
    target.add_argument("--web", action="store_true", help="serve the viewer to a browser until Ctrl-C")
    parser.add_argument("--no-images", action="store_true", help="only what the files of RESULTS say: seconds")
    parser.add_argument("--data", metavar="PATH", help="the recording, when it does not lie where it was")
    parser.add_argument("--device", default="auto", help="tracks the recording once more for its edges")
    parser.add_argument("--force", action="store_true", help="replace F.rrd")
    return parser


def _show(options: argparse.Namespace) -> None:
    if options.save and Path(options.save).exists() and not options.force:
        raise UsageError(f"{options.save}: the file exists; choose another name, or --force to replace it")
    if not (Path(options.results) / "frames.csv").is_file():
        raise DataError(f"{options.results}: found no frames.csv, expected the results of `quadedge run`")
    viewer = Viewer(Path(options.results).resolve().name, save=options.save, web=options.web)
    try:
        frames = show_results(options.results, viewer, images=not options.no_images, data=options.data,
                              device=options.device)
        print(f"frames     {frames}" + (f"\nwritten    {options.save}" if options.save else ""))
        if viewer.address:
            print(f"open       {viewer.address}", flush=True)
        while options.web:
            time.sleep(1)
    except KeyboardInterrupt:
        pass
    finally:
        viewer.close()


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code of the ``quadedge`` command."""
    return exit_code("quadedge.view", lambda: _show(_parser().parse_args(arguments)))


if __name__ == "__main__":
    sys.exit(main())
