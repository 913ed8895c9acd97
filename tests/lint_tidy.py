#!/usr/bin/env python3
"""Runs clang-tidy over what changed in host/ since the last release, one translation unit of the build at a time.

    lint_tidy.py REPOSITORY BUILD [--all] [--fix] [--jobs N] [FOLDER...]

BUILD holds compile_commands.json, best of a build with QUADEDGE_UNITY: most of the time goes into included files.
FOLDER is, for example, host/tracker/motion; without one, it is host/. A header that changed is checked with a source
that includes it. --all, a change of .clang-tidy and a history without the release check every source. clang-tidy is the
one next to the running Python (tests/requirements.txt): newer than Debian's, it skips system headers and takes a
quarter of the time.
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

from changed_files import changed_since_release, included_by


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


def sources_to_check(repository: Path, sources: list[Path]) -> set[Path]:
    """The sources that changed, and for each other file that changed the first source that includes it."""
    changed = changed_since_release(repository)
    if changed is None or repository / ".clang-tidy" in changed:
        return set(sources)
    checked = {source for source in sources if source in changed}
    covered = set().union(*(included_by(source, repository) for source in checked))
    for source in sources:
        missed = (included_by(source, repository) & changed) - covered
        if missed:
            checked.add(source)
            covered |= missed
    return checked


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", type=lambda text: Path(text).resolve())
    parser.add_argument("build", type=lambda text: Path(text).resolve())
    parser.add_argument("folders", nargs="*", default=["host"])
    parser.add_argument("--all", action="store_true", help="check what has not changed, too")
    parser.add_argument("--fix", action="store_true", help="let clang-tidy change the files")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    folders = [options.repository / folder for folder in options.folders]
    units = {}
    for row in json.loads((options.build / "compile_commands.json").read_text(encoding="utf-8")):
        sources = sources_of(Path(row["file"])) if Path(row["file"]).is_file() else []
        if any(source.is_relative_to(folder) for source in sources for folder in folders):
            units[Path(row["file"])] = sources, flags_of(row["command"])
    known = [source for unit in sorted(units) for source in units[unit][0]]
    assert len(known) > 100 or options.folders != ["host"], f"found {len(known)} sources of host/, expected all"
    wanted = set(known) if options.all else sources_to_check(options.repository, known)
    tasks = {}
    for unit, (sources, flags) in units.items():
        kept = [source for source in sources if source in wanted]
        if not kept:
            continue
        if kept != sources:
            unit = options.build / "tidy" / unit.name
            unit.parent.mkdir(exist_ok=True)
            unit.write_text("".join(f'#include "{source}"\n' for source in kept), encoding="utf-8")
        call = [str(Path(sys.executable).with_name("clang-tidy")), "--quiet",
                f"--config-file={options.repository / '.clang-tidy'}", str(unit)]
        tasks[str(unit)] = len(kept), call + ["--fix"] * options.fix + ["--"] + flags

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
