#!/usr/bin/env python3
"""Runs a small sweep with scripts/disturbance_sweep.py.

    test_disturbance_sweep.py SCRIPT QUADEDGE
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

script, quadedge = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    out = Path(folder) / "sweep"
    small = ("--quadedge", quadedge, "--frames", "3", "--size", "320x200")
    subprocess.run([sys.executable, script, out, *small, "--scenes", "room", "--kinds", "noise"],
                   check=True, stdout=subprocess.DEVNULL)
    rows = json.loads((out / "disturbances.json").read_text())
    assert [row["value"] for row in rows] == [0, 1.5, 3, 5, 8], rows
    assert all(row["right"] + row["wrong"] + row["lost"] == 2 for row in rows), rows
    assert rows[0]["tracked"] == 3 and rows[0]["rpe_translation_m"] < rows[-1]["rpe_translation_m"], rows
    with open(out / "disturbances.csv", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    assert [float(row["rpe_rotation_deg"]) for row in table] == [row["rpe_rotation_deg"] for row in rows], table
    assert "<svg" in (out / "disturbances.svg").read_text()

    # Given values and seeds; blur that cannot be rendered ends the sweep with the program's message.
    subprocess.run([sys.executable, script, out, *small, "--scenes", "facade", "--kinds", "blur", "--values", "2",
                    "--scene-seed", "11"], check=True, stdout=subprocess.DEVNULL)
    (row,) = json.loads((out / "disturbances.json").read_text())
    assert (row["scene"], row["kind"], row["value"], row["frames"]) == ("facade", "blur", 2, 3), row
    failed = subprocess.run([sys.executable, script, out, *small, "--scenes", "room", "--kinds", "blur", "--values",
                             "40"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    assert failed.returncode == 1 and "blur = 40, allowed: 0 to " in failed.stderr, failed
