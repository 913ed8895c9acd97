"""``python -m quadedge.report``: makes a page of results. Started by `quadedge report`."""

import argparse
import sys

from . import DamagedResults, make_page

DATA_ERROR = 3  # an exit code of the program


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m quadedge.report", description="Makes an HTML page of results.")
    parser.add_argument("results", help="folder of a run or a batch, or a file of `quadedge evaluate matching --json`")
    parser.add_argument("-o", "--output", help="path of the page")
    parser.add_argument("--comparison", help="file that `quadedge report --baseline --peer` writes about a batch")
    parser.add_argument("--markdown", metavar="FILE", help="also write the tables of the first section as Markdown")
    parser.add_argument("--csv", metavar="DIR", help="also write every table as CSV")
    parser.add_argument("--latex", metavar="DIR", help="also write every table as LaTeX")
    parser.add_argument("--figures", metavar="DIR", help="also write every figure as SVG and PDF")
    parser.add_argument("--quiet", action="store_true", help="do not print the name of the page")
    options = vars(parser.parse_args())
    quiet = options.pop("quiet")
    try:
        file = make_page(**options)
    except DamagedResults as problem:
        print(f"quadedge: {problem}", file=sys.stderr)
        return DATA_ERROR
    except OSError as problem:
        print(f"quadedge: {problem.filename or ''}: {problem.strerror}; expected a writable location",
              file=sys.stderr)
        return DATA_ERROR
    if not quiet:
        print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
