#!/usr/bin/env python3
"""Makes a small measurement with scripts/measure.py and checks that the documentation matches doc/results.

test_measure.py SCRIPTS QUADEDGE
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

scripts, quadedge = Path(sys.argv[1]), sys.argv[2]
sys.path.insert(0, str(scripts))
import recordings  # noqa: E402
import result_tables  # noqa: E402


def run(script, *options):
    command = [sys.executable, scripts / script, *map(str, options)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


# Every generated block of the documentation and the pages of doc/results match the JSON files.
stale = [str(file) for file, _ in result_tables.differing()]
assert not stale, stale

with tempfile.TemporaryDirectory() as folder:
    # A measurement holds the programs' figures in full precision, with commit and command.
    out, work = Path(folder) / "results", Path(folder) / "work"
    small = ("--quadedge", quadedge, "--out", out, "--work", work, "--frames", "3", "--sequences", "cables",
             "--systems", "default", "--seeds", "2")
    done = run("measure.py", *small, "--only", "accuracy")
    assert done.returncode == 0, done.stderr
    result = json.loads((out / "accuracy.json").read_text())
    (row,) = result["rows"]
    reports = [json.loads((work / f"{seed}/cables/report.json").read_text()) for seed in ("default", "default_2")]
    assert row["tracked"] == row["frames"] == 3 and row["seeds"] == 2, row
    for name in ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m"):
        of_seeds = sorted(report["accuracy"]["origin_aligned"][name]["mean"] for report in reports)
        for shown, value in zip((row["least"][name], row["most"][name]), of_seeds):
            assert abs(shown - value) < 1e-6, (name, row)
    assert row["steps"] == {"right": 2, "wrong": 0, "lost": 0}, row
    command = "quadedge demo --scene cables --frames 3 --seed 1 -o OUT/default/cables"
    assert row["commands"][0] == command, row["commands"]
    assert result["commit"] and len(result["date"]) == 10, result
    shown = result_tables.render("compared", {"accuracy": result})
    assert "| rendered cables, 3 frames | QuadEdge | 3 / 3 |" in shown and result["commit"] in shown, shown

    failed = run("measure.py", *small[2:], "--quadedge", "/bin/false", "--only", "accuracy", "--sequences",
                 "room")
    assert failed.returncode == 1 and "/bin/false" in failed.stderr, failed

    # Complete runs are reused.
    stamp = (work / "default/cables/report.json").stat().st_mtime_ns
    assert run("measure.py", *small, "--only", "accuracy", "--keep").returncode == 0
    assert (work / "default/cables/report.json").stat().st_mtime_ns == stamp

    # Blocks of a document: filled, refilled, and a note for a table without a measurement.
    results = {"accuracy": result}
    end = "<!-- end of table -->\n"
    text = f"before\n<!-- table: compared -->\nold\n{end}after\n<!-- table: matching -->\n{end}"
    filled = result_tables.filled(text, results)
    assert "old" not in filled and "| rendered cables, 3 frames | QuadEdge | 3 / 3 |" in filled, filled
    assert "Not measured yet" in filled, filled
    assert filled.startswith("before\n") and "<!-- end of table -->\nafter\n" in filled, filled

    # Titles name the evaluated frames; a figure of several seeds has its range.
    later = {**row, "title": "KITTI 06, from frame 2", "from_frame": 2}
    flight = {**row, "title": "EuRoC MH_01, flight", "sequence": "flight", "rpe_translation_m": 0.002}
    flight.update({name: {**row[name], "rpe_translation_m": of} for name, of in (("least", 0.001), ("most", 0.0025))})
    shown = result_tables.render("compared", {"accuracy": {**result, "rows": [later, flight]}})
    assert "| KITTI 06, 1 frame from frame 2 |" in shown and "| EuRoC MH_01, 3 frames |" in shown, shown
    assert "| 2 (1 to 2.5) |" in shown and "Medians of 2 seeds" in shown, shown

    # Whole recordings: a peer that fails is named, and the other rows keep what was measured before.
    folder_of_street = Path(folder) / "recordings/street"
    subprocess.run([quadedge, "synth", folder_of_street, "--frames", "4", "--size", "320x200", "--quiet"], check=True)
    (folder_of_street / "times.txt").write_text("".join(f"{0.05 * i}\n" for i in range(4)))
    (folder_of_street / "groundtruth.txt").rename(folder_of_street / "truth.txt")
    whole = ("--quadedge", quadedge, "--out", out, "--work", work, "--recordings", Path(folder) / "recordings",
             "--seeds", "1", "--only", "evidence")
    done = run("measure.py", *whole, "--viso2", "/bin/false", "--baseline", "/absent")
    assert done.returncode == 0, done.stderr
    rows = json.loads((out / "evidence.json").read_text())["rows"]
    assert [row["system"] for row in rows] == ["QuadEdge", "QuadEdge, --calibrate", "QuadEdge, --loops",
                                                "QuadEdge, fast", "viso2"], rows
    assert rows[0]["runs"][0]["poses"] == 4 and rows[0]["runs"][0]["ate_rmse_m"] < 0.01, rows[0]
    assert rows[4]["left_out"].startswith("failed: "), rows[4]

    names = ("length_m", "sub_paths", "t_rel_percent", "t_rel_sd_percent", "r_rel_deg_per_m", "r_rel_sd_deg_per_m")
    (both,) = recordings.pooled({"sub_paths": {"by_length": [dict(zip(names, (5, 1, of, 0, of, 0)))]}} for of in (1, 3))
    assert (both["sub_paths"], both["t_rel_percent"], both["t_rel_sd_percent"]) == (2, 2, 1), both
    # A failing program is reported with its message; figures of a few frames do not get into the documentation.
    failed = run("measure.py", "--quadedge", quadedge, "--out", out, "--work", work, "--only", "accuracy", "--frames",
                 "3", "--sequences", "rest", "--systems", "default", "--data", Path(folder) / "absent")
    assert failed.returncode == 1 and "absent" in failed.stderr, failed
    assert run("measure.py", "--frames", "3").returncode == 2
    assert run("measure.py", "--sequences", "mars").returncode == 2
