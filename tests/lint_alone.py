#!/usr/bin/env python3
"""Compiles every source of host/ by itself, as a build without QUADEDGE_UNITY does, which no other test is.

    lint_alone.py REPOSITORY BUILD

BUILD/alone is configured for it; nothing is linked or kept. Prints the first error of each file; exit code 1 if there
is any.
"""

import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def error(unit: dict) -> str:
    """The first error of a translation unit; empty: it compiles."""
    command = shlex.split(unit["command"])
    output = command.index("-o")
    check = [*command[:output], *command[output + 2:], "-O0", "-fsyntax-only"]
    result = subprocess.run(check, cwd=unit["directory"], capture_output=True, text=True, check=False)
    lines = [line for line in result.stderr.split("\n") if "error" in line]
    return (lines or [f"{unit['file']}: {result.stderr.strip()}"])[0] if result.returncode else ""


def main() -> int:
    repository, build = Path(sys.argv[1]), Path(sys.argv[2]) / "alone"
    subprocess.run(["cmake", "-S", repository, "-B", build, "-G", "Ninja", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"],
                   check=True, stdout=subprocess.DEVNULL)
    units = [unit for unit in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
             if Path(unit["file"]).is_relative_to(repository / "host")]
    assert len(units) > 100, f"found {len(units)} sources of host/, expected all"
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(error, units) if text]
    print("\n".join(found) or f"{len(units)} files: fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
