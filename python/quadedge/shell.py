"""What the package's programs for the shell share."""

import sys
from collections.abc import Callable

from .errors import Error, UsageError


def exit_code(program: str, work: Callable[[], None]) -> int:
    """Does the work and ends as the ``quadedge`` command does: its exit codes, complaints in one line."""
    try:
        work()
    except Error as error:
        print(f"{program}: {error}", file=sys.stderr)
        return error.exit_code
    except ImportError as error:  # an extra of the package that is not installed, named with how to get it
        print(f"{program}: {error}", file=sys.stderr)
        return UsageError.exit_code
    return 0
