#!/usr/bin/env python3
"""Writes the tables of doc/results/*.json into the documentation.

    scripts/result_tables.py            writes the marked blocks of README.md and the pages in doc/
    scripts/result_tables.py --check    changes nothing; exit code 1 if a table differs from the JSON

A block is enclosed by <!-- table: NAME --> and <!-- end of table -->. scripts/measure.py writes the JSON files.
"""

import json
import re
import sys

from harness import REPOSITORY
from tables import TABLES

RESULTS = REPOSITORY / "doc" / "results"
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end of table -->)", re.DOTALL)


def render(name, results):
    """A table, or a note that it is missing."""
    part, function = TABLES[name]
    return function(results) if part in results else f"*Not measured yet: `scripts/measure.py --only {part}`.*\n"


def filled(text, results):
    """A page with its tables."""
    return BLOCK.sub(lambda block: block[1] + render(block[2], results) + block[3], text)


def differing():
    """Pages whose tables differ from the JSON, with their expected text."""
    results = {file.stem: json.loads(file.read_text(encoding="utf-8")) for file in sorted(RESULTS.glob("*.json"))}
    for file in (REPOSITORY / "README.md", *sorted((REPOSITORY / "doc").glob("**/*.md"))):
        text = file.read_text(encoding="utf-8")
        if filled(text, results) != text:
            yield file, filled(text, results)


def main(words):
    for file, text in differing():
        if "--check" in words:
            print(f"result_tables: {file} differs from its JSON; run scripts/result_tables.py", file=sys.stderr)
            return 1
        file.write_text(text, encoding="utf-8")
        print(f"wrote {file.relative_to(REPOSITORY)}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
