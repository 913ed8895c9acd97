"""``quadedge`` and ``python -m quadedge``: the compiled program, which makes its pages with this Python."""

import os
import sys
from pathlib import Path

from . import opencl_runtime
from .errors import UsageError


def main() -> int:
    """Becomes the program. Returns an exit code only where the package was built without it."""
    program = Path(__file__).parent / "bin" / "quadedge"
    if not program.is_file():
        print(f"quadedge: {program} is missing; this installation of the package has no program", file=sys.stderr)
        return UsageError.exit_code
    os.environ.setdefault("QUADEDGE_PYTHON", sys.executable)
    opencl_runtime.announce()
    os.execv(program, ["quadedge", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
