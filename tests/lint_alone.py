#!/usr/bin/env python3
"""Reads sources of host/ by themselves, as a build without QUADEDGE_UNITY does, which no other test is: those that
changed since the last release, or include what has; with --all, or a history without the release, every source.

    lint_alone.py REPOSITORY BUILD [--all]

BUILD/alone is configured for it. clang reads each file as if it were to be included elsewhere, after the target's
precompiled header: what a file uses has to be declared, but templates of Eigen are not instantiated, which would take
most of the time. Prints the first error of each file; exit code 1 if there is any.
"""

import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from changed_files import changed_since_release, included_by
from lint_tidy import flags_of


def precompile(unit: dict, result: str) -> subprocess.CompletedProcess:
    """Lets clang precompile a source of a compile database, or a target's header: then result is '', beside it."""
    command = shlex.split(unit["command"])
    source, front = Path(unit["file"]), []
    if "-include" in command:
        header = Path(command[command.index("-include") + 1])
        if result:
            front = ["-include-pch", f"{header}.pch"]
        else:
            source, result = header, f"{header}.pch"
    call = ["clang++", *flags_of(unit["command"]), *front, "-w", "-x", "c++-header", str(source), "-o", result]
    return subprocess.run(call, cwd=unit["directory"], capture_output=True, text=True, check=False)


def error(unit: dict) -> str:
    """The first error of a translation unit; empty: it can be read."""
    result = precompile(unit, os.devnull)
    lines = [line for line in result.stderr.split("\n") if "error" in line]
    return (lines or [f"{unit['file']}: {result.stderr.strip()}"])[0] if result.returncode else ""


def main() -> int:
    repository, build = Path(sys.argv[1]).resolve(), Path(sys.argv[2]) / "alone"
    subprocess.run(["cmake", "-S", repository, "-B", build, "-G", "Ninja", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"],
                   check=True, stdout=subprocess.DEVNULL)
    rows = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    for row in rows:
        if Path(row["file"]).name == "cmake_pch.hxx.cxx":
            precompile(row, "").check_returncode()
    units = [row for row in rows if Path(row["file"]).is_relative_to(repository / "host")]
    assert len(units) > 100, f"found {len(units)} sources of host/, expected all"
    changed = None if "--all" in sys.argv else changed_since_release(repository)
    if changed is not None:
        units = [row for row in units if included_by(Path(row["file"]), repository) & changed]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(error, units) if text]
    print("\n".join(found) or f"{len(units)} files: fine")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
