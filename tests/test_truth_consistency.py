#!/usr/bin/env python3
"""Gives scripts/truth_consistency.py a ground truth with known errors, which it must find, and one without any.

test_truth_consistency.py SCRIPT
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

script = sys.argv[1]
START = 1_500_000_000_000_000_000  # ns
LATE, ARM, SCALE = 0.006, np.array([0.02, -0.01, 0.03]), 0.002  # s, m in the body, 1


def poses(time):
    """A smooth flight: positions, and quaternions x, y, z, w of rotations about a moving axis."""
    position = np.stack([np.sin(1.1 * time), 0.7 * np.cos(1.7 * time), 0.3 * np.sin(2.3 * time)], 1)
    turn = 0.4 * np.stack([np.sin(1.3 * time), np.cos(0.9 * time), np.sin(2.1 * time + 1)], 1)
    angle = np.linalg.norm(turn, axis=1, keepdims=True)
    return position, np.concatenate([turn / angle * np.sin(angle / 2), np.cos(angle / 2)], 1)


def matrices(quaternion):
    x, y, z, w = quaternion.T
    return np.moveaxis(np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]), 2, 0)


def examine(folder, late, arm, scale):
    """Writes a ground truth with positions that are `late`, of a point `arm` off the body, and too long by `scale`."""
    truth, results = folder / "mav0" / "state_groundtruth_estimate0", folder / "results"
    for made in (truth, folder / "mav0" / "cam0", results):
        made.mkdir(parents=True, exist_ok=True)
    (folder / "mav0" / "cam0" / "sensor.yaml").write_text(
        "T_BS:\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n")
    time = np.arange(-0.1, 6.2, 0.005)
    quaternion = poses(time)[1]
    position, turned = poses(time - late)
    position = (position + np.einsum("nij,j->ni", matrices(turned), arm)) * (1 + scale)
    (truth / "data.csv").write_text("#timestamp\n" + "".join(
        ",".join([str(START + round(t * 1e9)), *(f"{value:.12f}" for value in (*p, q[3], q[0], q[1], q[2]))]) + "\n"
        for t, p, q in zip(time, position, quaternion)))
    frames = np.arange(0, 6, 0.05)
    (results / "trajectory.txt").write_text("# stamp x y z qx qy qz qw\n" + "".join(
        f"{(START + round(t * 1e9)) // 10**9}.{(START + round(t * 1e9)) % 10**9:09d} "
        + " ".join(f"{value:.12f}" for value in (*p, *q)) + "\n" for t, p, q in zip(frames, *poses(frames))))
    promised = [{"frames": steps, "promised_m": 0.001 * steps} for steps in (1, 2, 5, 10, 20, 40, 50, 100)]
    (results / "report.json").write_text(json.dumps({"accuracy": {"consistency": promised}}))
    done = subprocess.run([sys.executable, script, folder, results, "-o", folder / "truth.json"], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "truth.json").read_text())


with tempfile.TemporaryDirectory() as folder:
    right = examine(Path(folder) / "right", 0.0, np.zeros(3), 0.0)
    assert all(row["as_it_is_mm"] < 0.1 for row in right["rows"]), right
    assert all(abs(value) < 1e-3 for value in right["constants"].values()), right
    assert [row["promised_mm"] for row in right["rows"]] == [row["frames"] for row in right["rows"]], right

    faulty = examine(Path(folder) / "faulty", LATE, ARM, SCALE)
    assert abs(faulty["rotation_offset_ms"]) < 0.2, faulty  # the orientations' timestamps are those of the images
    found = faulty["constants"]
    # Positions are late by the constant; scale and arm are negative, from the ground truth to the estimate.
    assert abs(found["position time"] - LATE) < 5e-4, found
    assert abs(found["scale"] + SCALE) < 5e-4, found
    for axis, part in zip("xyz", ARM):
        assert abs(found[f"arm {axis}"] + part) < 2e-3, found
    assert max(abs(found[f"turn {axis}"]) for axis in "xyz") < 1e-3, found
    for row in faulty["rows"]:
        if row["frames"] >= 5:
            assert row["constants_removed_mm"] < 0.2 * row["as_it_is_mm"], row
            assert row["of_other_half_mm"] < 0.3 * row["as_it_is_mm"], row
print("fine")
