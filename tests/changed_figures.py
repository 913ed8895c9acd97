#!/usr/bin/env python3
"""The record of a release: each figure of doc/results beside that of an earlier commit; rises over 5 % last.

    changed_figures.py COMMIT [PART...]      PART: evidence, accuracy, speed ...; without one, all
"""

import json
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
NAMES = ("recording", "title", "scene", "system", "preset", "method", "kind", "extension", "length_m", "frames")


def figures(value, place=""):
    """Numbers by their place; an entry of a list is named by what it is about, or by its index."""
    if isinstance(value, dict):
        for key, inside in value.items():
            if key not in ("least", "most"):  # over the seeds
                yield from figures(inside, f"{place}/{key}")
    elif isinstance(value, list):
        for index, inside in enumerate(value):
            words = [str(inside[name]) for name in NAMES if name in inside] if isinstance(inside, dict) else []
            yield from figures(inside, f"{place}/{', '.join(words) or index}")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield place, value


commit, parts = sys.argv[1], sys.argv[2:] or sorted(file.stem for file in (REPOSITORY / "doc/results").glob("*.json"))
rows = []
for part in parts:
    name = f"doc/results/{part}.json"
    command = ["git", "-C", REPOSITORY, "show", f"{commit}:{name}"]
    old = subprocess.run(command, capture_output=True, text=True, check=False)
    before = dict(figures(json.loads(old.stdout))) if old.returncode == 0 else {}
    now = dict(figures(json.loads((REPOSITORY / name).read_text(encoding="utf-8"))))
    rows += [(value / before[of], part + of, before[of], value) for of, value in now.items()
             if before.get(of) and value != before[of]]
print("| figure | before | now | ratio |\n| --- | --- | --- | --- |")
for ratio, of, was, value in sorted(rows):
    print(f"| {of} | {was:.4g} | {value:.4g} | {ratio:.3f}{' **rise**' if ratio > 1.05 else ''} |")
