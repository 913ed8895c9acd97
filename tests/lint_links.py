#!/usr/bin/env python3
"""Checks that links of the Markdown pages in a folder, such as the installed documentation, lead to existing files and
headings.

    lint_links.py FOLDER
"""

import sys
from pathlib import Path

from lint_structure import broken_links


def main() -> int:
    folder = Path(sys.argv[1])
    pages = sorted(folder.rglob("*.md"))
    findings = [] if pages else [f"{folder}: no page"]
    for page in pages:
        findings += broken_links(folder, str(page.relative_to(folder)), page.read_text(encoding="utf-8"))
    print("\n".join(findings) or f"{len(pages)} pages: fine")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
