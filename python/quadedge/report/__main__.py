"""``python -m quadedge.report``: makes a page of results. Started by `quadedge report`."""

import argparse
import sys

from ..errors import DataError
from ..shell import exit_code
from . import make_page


def _make(options: dict) -> None:
    quiet = options.pop("quiet")
    try:
        file = make_page(**options)
    except OSError as problem:
        raise DataError(f"{problem.filename or ''}: {problem.strerror}; expected a writable location") from problem
    if not quiet:
        print(file)


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m quadedge.report", description="Makes an HTML page of results.")
    parser.add_argument("results", help="folder of a run or a batch")
    parser.add_argument("-o", "--output", help="path of the page")
    parser.add_argument("--markdown", metavar="FILE", help="also write the tables of the first section as Markdown")
    parser.add_argument("--csv", metavar="DIR", help="also write every table as CSV")
    parser.add_argument("--quiet", action="store_true", help="do not print the name of the page")
    return exit_code("quadedge", lambda: _make(vars(parser.parse_args())))


if __name__ == "__main__":
    sys.exit(main())
