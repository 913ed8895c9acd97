#!/usr/bin/env python3
"""Runs clang-tidy over host/, one translation unit of the build at a time.

    lint_tidy.py REPOSITORY BUILD [--fix] [--jobs N] [FOLDER...]

BUILD holds compile_commands.json, best of a build with QUADEDGE_UNITY: most of the time goes into included files.
FOLDER is, for example, host/motion; without one, all of host/ is checked. clang-tidy is the one next to the running
Python (tests/requirements.txt): newer than Debian's, it skips system headers and takes a quarter of the time.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def flags_of(command: str) -> list[str]:
    """The flags of a compiler call that affect its meaning."""
    words = shlex.split(command)
    kept = [word for word in words if word.startswith(("-D", "-I", "-std"))]
    for i, word in enumerate(words):
        if word == "-isystem":
            kept += [word, words[i + 1]]
    return kept


def sources_of(unit: Path) -> list[Path]:
    """The sources that a translation unit compiles: those that it includes, or itself."""
    together = re.findall(r'^#include "(.*)"$', unit.read_text(encoding="utf-8"), re.MULTILINE)
    return [Path(name) for name in together] if unit.match("Unity/unity_*_cxx.cxx") else [unit]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", type=lambda text: Path(text).resolve())
    parser.add_argument("build", type=lambda text: Path(text).resolve())
    parser.add_argument("folders", nargs="*", default=["host"])
    parser.add_argument("--fix", action="store_true", help="let clang-tidy change the files")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    folders = [options.repository / folder for folder in options.folders]
    tasks = {}
    for row in json.loads((options.build / "compile_commands.json").read_text(encoding="utf-8")):
        sources = sources_of(Path(row["file"])) if Path(row["file"]).is_file() else []
        if any(source.is_relative_to(folder) for source in sources for folder in folders):
            call = [str(Path(sys.executable).with_name("clang-tidy")), "--quiet",
                    f"--config-file={options.repository / '.clang-tidy'}", row["file"]]
            tasks[row["file"]] = len(sources), call + ["--fix"] * options.fix + ["--"] + flags_of(row["command"])
    checked = sum(count for count, _ in tasks.values())
    assert checked > 100 or options.folders != ["host"], f"found {checked} sources of host/, expected all"

    def run(name: str) -> tuple[str, subprocess.CompletedProcess]:
        return name, subprocess.run(tasks[name][1], capture_output=True, text=True, check=False)

    failed = False
    with ThreadPoolExecutor(1 if options.fix else options.jobs) as pool:
        for name, result in pool.map(run, sorted(tasks)):
            found = result.returncode != 0
            print(f"{Path(name).name} ({tasks[name][0]} files): {'findings' if found else 'fine'}", flush=True)
            if found:
                failed = True
                print(result.stdout, flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
