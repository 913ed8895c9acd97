"""``python -m quadedge.matching``: recall, precision and ambiguity after every filter, on the terminal and as files."""

import argparse
import json
import os
import shlex
import sys
from contextlib import suppress
from pathlib import Path

from .. import configuration, open_dataset, synthetic
from ..errors import DataError, UsageError
from ..report.matching_page import matching_page
from ..report.matching_tables import summary_tables
from ..report.page import to_html, write_atomically, write_tables
from ..report.table import to_text
from ..session import say_on_stderr
from ..shell import exit_code
from .counts import Tolerance
from .document import document, summary
from .observer import observe
from .sources import RecordedSource, RenderedSource

NAME = "python -m quadedge.matching"
SCENES, RENDERED_FRAMES = ("room", "cables", "facade", "yard"), 10
_say = say_on_stderr(NAME)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog=NAME, allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Compares the candidates that remain after each filter of the matching with ground truth.",
        epilog="Constants of the method are set as for `quadedge run`, for example --stereo.ncc_min 0.8.\n\nExamples:\n"
               f"  {NAME} two_view_training/terrace_2s --html terrace.html\n"
               f"  {NAME} room --frames 5 --stereo.ncc_min 0.8")
    parser.add_argument("paths", nargs="+", metavar="PATH",
                        help="stereo pairs with disparities, sequences with depths (`quadedge synth`), "
                             f"or a built-in scene: {', '.join(SCENES)}")
    parser.add_argument("--frames", type=int, default=0,
                        help=f"evaluate only the first N frames; 0: all, {RENDERED_FRAMES} of a built-in scene")
    parser.add_argument("--path", default="ellipse", help="camera path in a built-in scene")
    parser.add_argument("--size", metavar="WxH", default="", help="image size of built-in scenes [px]")
    parser.add_argument("--scene-seed", type=int, default=7, help="seed of the built-in scenes")
    parser.add_argument("--tolerance", type=float, default=1.0,
                        help="largest distance of a veridical match from the true position [px]")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write the tables as JSON")
    parser.add_argument("--csv", type=Path, metavar="DIR", help="also write every table as CSV")
    parser.add_argument("--html", type=Path, metavar="FILE", help="also make a page with tables and plots")
    parser.add_argument("--device", default=os.environ.get("QUADEDGE_DEVICE", "auto"),
                        help="as for `quadedge run`; also QUADEDGE_DEVICE")
    parser.add_argument("--preset", default="default", help="fast, default, dense, or paper: the paper's own method")
    parser.add_argument("--config", metavar="FILE", help="a configuration file (TOML)")
    parser.add_argument("--force", action="store_true", help="replace existing files")
    parser.add_argument("--quiet", action="store_true", help="hide progress")
    return parser


def _value(text: str):
    """A number, true or false, where the text is one; else the text."""
    with suppress(ValueError):
        return json.loads(text)
    return text


def configured(preset: str, file: str | None, words: list[str]) -> dict:
    """All constants: those of a preset, a file over it, and options such as --stereo.ncc_min 0.8 over both.
    Raises UsageError."""
    values, chosen = configuration(preset, file), {}
    words = [part for word in words for part in (word.split("=", 1) if word.startswith("--") else [word])]
    for option, text in zip(words[::2], [*words[1::2], None]):
        key = option.removeprefix("--")
        if not option.startswith("--") or text is None:
            raise UsageError(f"{option}: expected --CONSTANT VALUE, for example --stereo.ncc_min 0.8")
        if key == "variant":
            chosen.setdefault(key, list(values.get(key, []))).append(text)
        else:
            chosen[key] = _value(text)
    return configuration(preset, values | chosen)


def _scene(name: str, options: argparse.Namespace):
    size = {}
    if options.size:
        try:
            size = dict(zip(("width", "height"), map(int, options.size.split("x")), strict=True))
        except ValueError:
            raise UsageError(f"--size {options.size}: expected WIDTHxHEIGHT, for example 640x332") from None
    return RenderedSource(synthetic(name, options.path, options.frames or RENDERED_FRAMES, seed=options.scene_seed,
                                    **size))


def _check(options: argparse.Namespace) -> None:
    """Raises UsageError for options that contradict each other or the disk."""
    if options.frames < 0:
        raise UsageError(f"--frames {options.frames}: expected 0 or more")
    if not 0 < options.tolerance <= 100:
        raise UsageError("--tolerance: expected more than 0 and at most 100 px")
    for file in (options.json, options.html):
        if file and file.exists() and not options.force:
            raise UsageError(f"{file} exists; use --force to replace it")


def _progress(name: str, quiet: bool):
    if quiet or not sys.stderr.isatty():
        return lambda done, total: None
    return lambda done, total: print(f"\r{name}: {done} of {total} frames", end="\n" if done == total else "",
                                     file=sys.stderr, flush=True)


def _print(title: str, content: dict, frames: int) -> None:
    print(f"\n=== {title}: {frames} stereo frame{'s' if frames != 1 else ''} ===")
    classes = ", ".join(f"{number} {kind}" for kind, number in content["stereo_edges"].items())
    print(f"final stereo edges: {classes}")
    for table in summary_tables(content):
        print(f"\n{to_text(table)}", end="")


def _evaluate(options: argparse.Namespace, words: list[str]) -> None:
    _check(options)
    config, sources = configured(options.preset, options.config, words), []
    for path in options.paths:
        is_scene = path in SCENES and not os.path.exists(path)
        sources.append(_scene(path, options) if is_scene else RecordedSource(open_dataset(path)))
    tolerance, results = Tolerance(options.tolerance), []
    for source in sources:
        result, device = observe(source, options.device, options.preset, config, options.frames, tolerance,
                                 _progress(source.name, options.quiet))
        results.append(result)
        for number, frame in enumerate(result.frames):
            if frame.result.message:
                _say(f"warning: {source.name}, frame {number}: {frame.result.message}")
    if len(results) > 1:
        for result in results:
            _print(result.name, summary([result]), len(result.frames))
    _print("all" if len(results) > 1 else results[0].name, summary(results), sum(len(one.frames) for one in results))
    command = shlex.join([*NAME.split(), *sys.argv[1:]])
    content = document(results, device, config, options.paths, tolerance, command)
    page = matching_page(content)
    try:
        if options.json:
            write_atomically(options.json, json.dumps(content, indent=2) + "\n")
        if options.html:
            write_atomically(options.html, to_html(page))
        if options.csv:
            write_tables(page, options.csv)
    except OSError as problem:
        raise DataError(f"{problem.filename or ''}: {problem.strerror}; expected a writable location") from problem


def main() -> int:
    options, words = _parser().parse_known_args()
    return exit_code(NAME, lambda: _evaluate(options, words))


if __name__ == "__main__":
    sys.exit(main())
