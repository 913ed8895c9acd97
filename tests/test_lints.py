#!/usr/bin/env python3
"""Checks that the lints judge only files that git tracks, and what they find about folders and pages.

    test_lints.py REPOSITORY
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from lint_structure import Tree, check_lines, check_phrases, check_sizes

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

        (root / "doc").mkdir()
        (root / "host/small").mkdir(parents=True)
        page = "<!-- sizes -->\n| folder | lines |\n|---|---|\n| `host/small/` | {} |\n<!-- end of sizes -->\n"
        (root / "doc/design.md").write_text(page.format(2))
        (root / "host" / "small" / "two.cpp").write_text("\n\n")
        subprocess.run(["git", "-C", root, "add", "doc", "host"], check=True)
        assert check_sizes(Tree(root)) == [] and check_phrases(Tree(root)) == []
        (root / "doc/design.md").write_text(page.format(1) + "A figure stands once.\n")
        (root / "host" / "outside.cpp").write_text("\n")
        subprocess.run(["git", "-C", root, "add", "doc", "host"], check=True)
        assert len(check_sizes(Tree(root))) == 2 and len(check_phrases(Tree(root))) == 1


if __name__ == "__main__":
    main()
