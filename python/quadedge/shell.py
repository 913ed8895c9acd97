"""What the package's command-line programs share."""

import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from .errors import Error, UsageError


def exit_code(name: str, work: Callable[[], int | None]) -> int:
    """Runs ``work`` and returns its exit code, 0 for None. Prints errors in one line, as ``quadedge`` does."""
    try:
        return work() or 0
    except Error as error:
        print(visible(f"{name}: {error}"), file=sys.stderr)
        return error.exit_code
    except ImportError as error:  # of an optional dependency; the message says how to install it
        print(visible(f"{name}: {error}"), file=sys.stderr)
        return UsageError.exit_code


def visible(text: str) -> str:
    """The text with control characters other than line feeds written as \\xNN, as ``quadedge`` prints it."""
    return re.sub(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]", lambda found: f"\\x{ord(found[0]):02x}", text)


def program() -> list[str]:
    """The beginning of a command line of ``quadedge``. Raises UsageError if the program is not installed."""
    if (Path(__file__).parent / "bin" / "quadedge").is_file():
        return [sys.executable, "-m", "quadedge"]
    if found := shutil.which("quadedge"):
        return [found]
    raise UsageError("found no program quadedge, neither in the package nor on PATH; install it from a wheel or add "
                     "the folder of the one that you built to PATH")
