#!/usr/bin/env python3
"""Makes a small accuracy table with scripts/accuracy_table.py.

    test_accuracy_table.py SCRIPT QUADEDGE
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

script, quadedge = sys.argv[1:]


def make(out, *options):
    return subprocess.run([sys.executable, script, out, "--quadedge", quadedge, *options], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE,
                          text=True, check=False)


with tempfile.TemporaryDirectory() as folder:
    out = Path(folder) / "table"
    done = make(out, "--sequences", "cables", "--systems", "default", "--frames", "3")
    assert done.returncode == 0, done.stderr
    table = (out / "accuracy.md").read_text()
    assert table == done.stdout, done.stdout
    (entry,) = json.loads((out / "accuracy.json").read_text())
    report = json.loads((out / "default/cables/report.json").read_text())
    assert entry["tracked"] == entry["frames"] == 3, entry
    for name, value in entry["errors"].items():
        assert abs(value - report["accuracy"]["origin_aligned"][name]["mean"]) < 1e-6, (name, entry, report["accuracy"])
    assert entry["steps"] == {"right": 2, "wrong": 0, "lost": 0}, entry
    row = table.splitlines()[2]
    assert row.startswith("| rendered cables | QuadEdge | 3 / 3 |"), row
    assert f"{entry['errors']['rpe_translation_m']:.3g}" in row, row
    assert "<svg" in (out / "cables.svg").read_text()

    # A program that fails is said, with its complaint.
    failed = make(Path(folder) / "none", "--sequences", "rest", "--systems", "default", "--data",
                  Path(folder) / "absent")
    assert failed.returncode == 1 and "absent" in failed.stderr, failed
    assert make(Path(folder) / "none", "--sequences", "mars").returncode == 2
