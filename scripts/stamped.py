"""Files of doc/results: measurements with their origin (commit of the sources and date)."""

import datetime
import json
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent


def commit():
    """Of the sources, followed by "+" if they have uncommitted changes outside the documentation."""

    def git(*arguments):
        command = ["git", "-C", REPOSITORY, *arguments]
        return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()

    changed = git("status", "--porcelain", "--", ".", ":!doc", ":!README.md")
    return git("rev-parse", "--short=7", "HEAD") + ("+" if changed else "")


def stamped(result, measured=None):
    """`result` with commit and date in front. `measured`: the commit, if determined before a long measurement."""
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    return {"commit": measured or commit(), "date": today, **result}


def write(result, file):
    """Writes `result` as JSON to the path `file`."""
    file.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
