#!/usr/bin/env python3
"""Checks that the library formats and reads numbers independently of the locale of the process.

    lint_locale.py REPOSITORY

Numbers with a point are formatted by printed() (common/printed.hpp) or std::to_chars, and read by std::from_chars.
The commands run in the locale "C" and may print with printf.
"""

import re
import subprocess
import sys
from pathlib import Path

EXEMPT = ("host/tracker/common/printed.cpp", "host/workbench/cli/")
PRINTF = re.compile(r"\b(v?s?n?printf|[fs]?scanf)\((?P<call>[^;]*);", re.DOTALL)
FLOATING = re.compile(r"%[-+ #0]*(\d+|\*)?(\.(\d+|\*))?[lL]?[aefgAEFG]")
READERS = re.compile(r"\b(atof|strto(d|f|ld)|std::sto(d|f|ld))\(")
STREAM = re.compile(r"\b(std::)?[io]?stringstream (?P<name>\w+)[^;]*;(?P<rest>[^}]{0,200})", re.DOTALL)


def findings(text: str) -> list[tuple[int, str]]:
    """Offsets and sentences of what depends on the locale."""
    found = []
    for call in PRINTF.finditer(text):
        if FLOATING.search(call["call"]) or '"' not in call["call"]:
            found.append((call.start(), f"{call[1]} of a number with a point, expected printed() or std::from_chars"))
    found += [(call.start(), f"{call[1]}, expected std::from_chars") for call in READERS.finditer(text)]
    for stream in STREAM.finditer(text):
        is_read_by_lines = f"getline({stream['name']}" in stream["rest"] or "istringstream" in stream[0]
        if not is_read_by_lines and f"{stream['name']}.imbue(std::locale::classic())" not in stream["rest"]:
            found.append((stream.start(), f"the stream {stream['name']} has the locale of the process, expected "
                                          "imbue(std::locale::classic()), or printed()"))
    return found


def main() -> int:
    root = Path(sys.argv[1])
    listed = subprocess.run(["git", "-C", root, "ls-files", "host/*.?pp", "python/*.?pp"], check=True, text=True,
                            capture_output=True).stdout.split()
    status = 0
    for name in listed:
        if name.startswith(EXEMPT):
            continue
        text = (root / name).read_text()
        for offset, sentence in findings(text):
            print(f"{name}:{text.count(chr(10), 0, offset) + 1}: {sentence}")
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
