#!/usr/bin/env python3
"""changed_figures.py COMMIT [PART...]: each figure of doc/results beside that of COMMIT, rises over 5 % marked."""

import json
import subprocess
import sys
from pathlib import Path

RESULTS = Path(__file__).resolve().parent.parent / "doc/results"
NAMES = ("recording title scene sequence system preset method kind extension length_m frames value threshold height "
         "rate_hz").split()  # of what an entry of a list is about


def figures(value, place):
    """Numbers by their place, in a list by names or index."""
    if isinstance(value, list):
        words = [[str(of[name]) for name in NAMES if isinstance(of, dict) and name in of] for of in value]
        value = {", ".join(words[index]) or index: inside for index, inside in enumerate(value)}
    if isinstance(value, dict):
        for key in value.keys() - {"least", "most"}:  # of the seeds
            yield from figures(value[key], f"{place}/{key}")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield place, value


rows = []
print("| figure | before | now | ratio |\n| --- | --- | --- | --- |")
for part in sys.argv[2:] or [file.stem for file in RESULTS.glob("*.json")]:
    old = subprocess.run(["git", "show", f"{sys.argv[1]}:./{part}.json"], cwd=RESULTS, capture_output=True, check=False)
    before = dict(figures(json.loads(old.stdout or "{}"), part))
    now = figures(json.loads((RESULTS / f"{part}.json").read_text()), part)
    rows += [(new / before[of], of, before[of], new) for of, new in now if before.get(of, new) not in (0, new)]
for ratio, of, was, value in sorted(rows):
    print(f"| {of} | {was:.4g} | {value:.4g} | {ratio:.3f}{' **rise**' if ratio > 1.05 else ''} |")
