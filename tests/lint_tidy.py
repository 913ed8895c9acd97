#!/usr/bin/env python3
"""Runs clang-tidy over the code, one translation unit per folder, since most of the time goes into included files.

    lint_tidy.py REPOSITORY BUILD [--fix] [--jobs N] [--syntax] [FOLDER...]

BUILD holds compile_commands.json. FOLDER is, for example, host/motion; without one, all of host/ is checked. Files of a
folder that define the same local name go into different translation units, as few as possible. clang-tidy is the one
next to the running Python (tests/requirements.txt): newer than Debian's, it skips system headers and takes a quarter
of the time.
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

FOLDERS = ("common", "geometry", "device", "reference", "paper", "edges", "rig", "motion", "places", "scenes", "data",
           "data/calibrations", "output", "benchmark", "cli")


def own_names(text: str) -> set[str]:
    """Local names of a formatted source: those in unnamed namespaces, and macros."""
    names = set(re.findall(r"^#define (\w+)", text, re.MULTILINE))
    for body in re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text, re.MULTILINE | re.DOTALL):
        names |= set(re.findall(r"\b(k[A-Z]\w*)(?:\[\w*\])*\s*(?:=|\{)", body))
        for line in body.split("\n"):
            type_name = re.match(r"(?:class|struct|enum class|enum|using) (\w+)(?: :| \{| =|;)", line)
            if type_name:
                names.add(type_name[1])
            elif re.match(r"(?!template|class|struct|enum|using)[A-Za-z\[]", line):
                found = re.search(r"([A-Za-z_]\w*)(?:\[\w*\])*\s*(?:\(|=|\{|;|$)", re.sub(r"^\[\[.*?\]\]", "", line))
                if found:
                    names.add(found[1])
    return names


def shared_names(folder: Path) -> set[str]:
    """Types and constants in a folder's headers."""
    return {name for header in folder.glob("*.hpp")
            for name in re.findall(r"^(?:class|struct|enum class|(?:inline )?constexpr [\w:<>]+) (\w+)",
                                   header.read_text(), re.MULTILINE)}


def units(files: list[Path], taken: set[str]) -> list[list[Path]]:
    """Distributes files over translation units in which no name is defined twice."""
    result: list[tuple[set[str], list[Path]]] = []
    for file in files:
        names = own_names(file.read_text())
        if names & taken:
            result.append((names | {"alone"}, [file]))
            continue
        unit = next((unit for unit in result if not unit[0] & names and "alone" not in unit[0]), None)
        if unit is None:
            result.append((names, [file]))
        else:
            unit[0].update(names)
            unit[1].append(file)
    return [files for _, files in result]


def flags_of(file: Path, commands: dict[str, str]) -> list[str]:
    """The flags of a file's compiler call that affect its meaning."""
    words = shlex.split(commands[str(file)])
    kept = [word for word in words if word.startswith(("-D", "-I", "-std"))]
    for i, word in enumerate(words):
        if word == "-isystem":
            kept += [word, words[i + 1]]
    return kept


def compiler_calls(build: Path) -> dict[str, str]:
    """Source -> its compiler call; for sources compiled together, their common call."""
    commands = {}
    for row in json.loads((build / "compile_commands.json").read_text()):
        commands[row["file"]] = row["command"]
        if Path(row["file"]).match("Unity/unity_*_cxx.cxx"):
            together = re.findall(r'^#include "(.*)"$', Path(row["file"]).read_text(), re.MULTILINE)
            commands.update(dict.fromkeys(together, row["command"]))
    return commands


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", type=lambda text: Path(text).resolve())
    parser.add_argument("build", type=lambda text: Path(text).resolve())
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--fix", action="store_true", help="let clang-tidy change the files")
    parser.add_argument("--syntax", action="store_true", help="only let clang read the translation units")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    commands = compiler_calls(options.build)
    work = options.build / "lint"
    work.mkdir(exist_ok=True)
    tasks = []
    for folder in options.folders or [f"host/{name}" for name in FOLDERS]:
        files = [file for file in sorted((options.repository / folder).glob("*.cpp")) if str(file) in commands]
        for number, unit in enumerate(units(files, shared_names(options.repository / folder))):
            source = work / f"{folder.replace('/', '_')}_{number}.cpp"
            source.write_text("".join(f'#include "{file}"  // NOLINT\n' for file in unit))
            if options.syntax:
                call = ["clang++", "-fsyntax-only", str(source)]
            else:
                call = [str(Path(sys.executable).with_name("clang-tidy")), "--quiet",
                        f"--config-file={options.repository / '.clang-tidy'}", str(source)]
                call += ["--fix"] if options.fix else []
                call += ["--"]
            tasks.append((f"{folder} ({len(unit)} files)", call + flags_of(unit[0], commands)))

    def run(task):
        return task[0], subprocess.run(task[1], capture_output=True, text=True)

    failed = False
    with ThreadPoolExecutor(1 if options.fix else options.jobs) as pool:
        for name, result in pool.map(run, sorted(tasks, key=lambda task: len(task[0]))):
            findings = result.stdout + (result.stderr if options.syntax else "")
            print(f"{name}: {'fine' if result.returncode == 0 else 'findings'}", flush=True)
            if result.returncode != 0:
                failed = True
                print(findings, flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
