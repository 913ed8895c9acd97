#!/usr/bin/env python3
"""Runs a small batch and loads it with scripts/load_batch.py.

    test_load_batch.py LOAD_SCRIPT QUADEDGE
"""

import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

script, quadedge = sys.argv[1:]
specification = importlib.util.spec_from_file_location("load_batch", script)
load_batch = importlib.util.module_from_spec(specification)
specification.loader.exec_module(load_batch)


def close(a, b):
    return abs(a - b) < 1e-9 * max(1, abs(b))


with tempfile.TemporaryDirectory() as folder:
    data, out, picture = Path(folder) / "data", Path(folder) / "out", Path(folder) / "plot.png"
    for name, frames in (("long", "5"), ("short", "3")):
        subprocess.run([quadedge, "synth", data / name, "--frames", frames, "--size", "240x150", "--quiet"], check=True)
    shutil.copytree(data / "short", data / "broken")
    (data / "broken" / "rgb.txt").write_text("no time stamps\n")
    code = subprocess.run([quadedge, "batch", data, "-o", out, "--quiet"], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode
    assert code == 3, code

    summary = load_batch.load_summary(out)
    assert list(summary.index) == ["broken", "long", "short"], summary
    broken = summary.loc["broken"]
    assert broken["status"] == "failed" and "rgb.txt" in broken["message"], broken
    frames = load_batch.load_frames(out)
    assert frames.groupby("sequence").size().to_dict() == {"long": 5, "short": 3}, frames
    errors = load_batch.load_errors(out)
    reported = json.loads((out / "summary.json").read_text())["all"]["pooled"]["origin_aligned"]
    for column in ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m"):
        assert close(errors[column].mean(), reported[column]["mean"]), column
        assert close(errors[column].std(ddof=0), reported[column]["std"]), column
    for sequence in ("long", "short"):
        of_sequence = errors[errors["sequence"] == sequence]["ape_translation_m"]
        assert close(of_sequence.mean(), summary.loc[sequence, "origin_aligned_ape_translation_m_mean"])
    estimate, truth = (load_batch.load_trajectory(out, "long", name) for name in ("trajectory.txt", "groundtruth.txt"))
    assert len(estimate) == len(truth) == 5 and (estimate.loc[0, ["tx", "ty", "tz"]] == 0).all(), estimate

    printed = subprocess.run([sys.executable, script, out, picture], check=True, capture_output=True, text=True).stdout
    assert "broken" in printed and "long" in printed, printed
    assert picture.read_bytes()[:4] == b"\x89PNG" and picture.stat().st_size > 10000
print("the tables of the batch agree with its summary")
