"""Which sources of host/ a lint looks at: those that changed since the last release, or all."""

import re
import subprocess
from pathlib import Path

# Every file was checked at this commit (`--all`). It moves with each release.
CHECKED = "e84ad81d"


def changed_since_release(repository: Path) -> set[Path] | None:
    """The files that differ from CHECKED, but for moved ones; None where the history lacks it, as a source archive."""
    calls = [["diff", "--name-status", "-M100%", CHECKED, "--"], ["ls-files", "--others", "--exclude-standard"]]
    results = [subprocess.run(["git", "-C", repository, *call], capture_output=True, text=True, check=False)
               for call in calls]
    if any(result.returncode for result in results):
        return None
    return {repository / line.split("\t")[-1] for result in results for line in result.stdout.splitlines()
            if not line.startswith("R100")}


def included_by(source: Path, repository: Path) -> set[Path]:
    """A source and the repository's files that it includes, directly or through others."""
    found, open_files = set(), [source]
    while open_files:
        file = open_files.pop()
        if file in found or not file.is_file():
            continue
        found.add(file)
        names = re.findall(r'^#include "(.*)"', file.read_text(encoding="utf-8"), re.MULTILINE)
        open_files += [place / name for place in (*repository.glob("host/*"), repository / "include") for name in names]
    return found
