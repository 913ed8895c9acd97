#!/usr/bin/env python3
"""Checks that the lints judge only files that git tracks.

    test_lints.py REPOSITORY
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from lint_structure import Tree, check_lines

BAD = "int  main( ){\treturn 0;}  \n" + "// " + 130 * "x" + "\n"


def main() -> None:
    repository = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        shutil.copy(repository / ".clang-format", root)
        subprocess.run(["git", "init", "-q", root], check=True)
        (root / "good.cpp").write_text("int main() { return 0; }\n")
        subprocess.run(["git", "-C", root, "add", "good.cpp"], check=True)
        (root / "results").mkdir()
        (root / "results/bad.cpp").write_text(BAD)

        def lints() -> tuple[list[str], bool]:
            formatted = subprocess.run([repository / "tests/lint_format.sh", root], capture_output=True)
            return check_lines(Tree(root)), formatted.returncode == 0

        assert lints() == ([], True), lints()
        subprocess.run(["git", "-C", root, "add", "results"], check=True)
        findings, formatted = lints()
        assert len(findings) == 2 and not formatted, (findings, formatted)


if __name__ == "__main__":
    main()
