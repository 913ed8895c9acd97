#!/usr/bin/env python3
"""Tracks a short rendered sequence with scripts/drift.py and compares its errors with `quadedge evaluate trajectory`.

test_drift.py DRIFT QUADEDGE
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

drift, quadedge = sys.argv[1:]
with tempfile.TemporaryDirectory() as folder:
    out, file = Path(folder) / "out", Path(folder) / "drift.json"
    call = [sys.executable, drift, out, "--scenes", "cables", "--seeds", "4", "--frames", "4", "--size", "240x150",
            "--quadedge", quadedge, "--before", out, "-o", file]
    done = subprocess.run(call, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    result = json.loads(file.read_text())
    assert json.loads(done.stdout) == result and result["commit"] and len(result["date"]) == 10, result
    (row,) = result["rows"]
    (run,) = row["runs"]
    assert row["scene"] == "cables" and run["frames"] == 4, row
    assert row["before"]["runs"] == row["runs"], row  # the same folder serves as the other program's

    work = out / "cables_4"
    judged = [quadedge, "evaluate", "trajectory", work / "trajectory.txt", work / "groundtruth.txt", "--json",
              work / "judged.json"]
    subprocess.run(judged, check=True, stdout=subprocess.DEVNULL)
    errors = json.loads((work / "judged.json").read_text())["accuracy"]["origin_aligned"]["ape_translation_m"]
    assert abs(run["rms_mm"] - 1e3 * errors["rmse"]) < 1e-6, (run, errors)
    parts = sum(part * part for part in run["end_parts_mm"]) ** 0.5
    assert abs(run["end_mm"] - parts) < 1e-9 and run["end_mm"] <= 1e3 * errors["max"] + 1e-6, (run, errors)
    assert abs(row["end_percent"] - run["end_mm"] / run["path_m"] / 10) < 1e-9, row

    # A complete run is reused; a failing program is reported.
    before = (work / "trajectory.txt").stat().st_mtime_ns
    assert subprocess.run(call, capture_output=True, check=False).returncode == 0
    assert (work / "trajectory.txt").stat().st_mtime_ns == before
    failed = subprocess.run([*call[:3], "--scenes", "attic", "--quadedge", quadedge], capture_output=True, text=True,
                            check=False)
    assert failed.returncode == 1 and "attic" in failed.stderr, failed
print("fine")
