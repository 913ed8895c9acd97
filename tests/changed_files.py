"""Which sources of host/ a lint looks at: those that changed since the last release, or all."""

import re
import subprocess
from pathlib import Path

# Every file was checked at this commit (`--all`). It moves with each release.
CHECKED = "31341f0a"


def changed_since_release(repository: Path) -> set[Path] | None:
    """The files that differ from CHECKED; None where the history does not reach it, as in a source archive."""
    calls = [["diff", "--name-only", CHECKED, "--"], ["ls-files", "--others", "--exclude-standard"]]
    results = [subprocess.run(["git", "-C", repository, *call], capture_output=True, text=True, check=False)
               for call in calls]
    if any(result.returncode for result in results):
        return None
    return {repository / name for result in results for name in result.stdout.splitlines()}


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
