"""What a measurement says of itself: the commit of the sources and the date (doc/results/*.json)."""

import datetime
import json
import subprocess
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent


def commit():
    """Of the sources, with a "+" where they have changed since; the documentation does not count."""

    def git(*arguments):
        return subprocess.run(
            ["git", "-C", REPOSITORY, *arguments], stdout=subprocess.PIPE, text=True, check=True
        ).stdout.strip()

    return git("rev-parse", "--short=7", "HEAD") + (
        "+" if git("status", "--porcelain", "--", ".", ":!doc", ":!README.md") else ""
    )


def stamped(result, measured=None):
    """`result` with commit and date in front; `measured` is the commit where it was asked for before the work began."""
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    return {"commit": measured or commit(), "date": today, **result}


def write(result, file):
    """As JSON, `file` a path."""
    file.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
