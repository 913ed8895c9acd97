#!/usr/bin/env python3
"""Determines how much of the error on a recorded EuRoC sequence is explained by its ground truth.

    truth_consistency.py SEQUENCE RESULTS [-o FILE]

SEQUENCE contains mav0, RESULTS the output of `quadedge run` (trajectory.txt, report.json). Prints, and writes to FILE
as JSON:

- the time offset between ground truth and images that best aligns the rotation angles between frames;
- the errors of motions over 1 to 100 frames, and the same errors after fitting eight constants of the ground truth over
  all step lengths together: the scale of its positions, a rotation between positions and orientations, a time offset of
  the positions, and the lever arm from the tracked prism to the origin of the body. A prism, a tracker with a separate
  clock and a hand-eye calibration can cause such errors; odometry cannot, because its errors grow with the path length;
- the same with the constants fitted on one half of the sequence and evaluated on the other, in both directions;
- the errors predicted by the covariances (report.json).

Needs numpy. Exit code: 0 done, 2 wrong usage.
"""

import argparse
import json
import re
import sys
from pathlib import Path

import numpy as np

from stamped import stamped, write

STEPS = (1, 2, 5, 10, 20, 40, 50, 100)  # frames
NAMES = ("scale", "turn x", "turn y", "turn z", "position time", "arm x", "arm y", "arm z")
LARGEST_OFFSET, OFFSET_STEP = 0.02, 0.0005  # s
SPEED_WINDOW = 0.02  # s to either side


def rotations(quaternions):
    """Matrices of unit quaternions x, y, z, w."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def angles(matrices):
    """Rotation angles [rad], accurate for small angles."""
    axis = [matrices[:, 2, 1] - matrices[:, 1, 2], matrices[:, 0, 2] - matrices[:, 2, 0],
            matrices[:, 1, 0] - matrices[:, 0, 1]]
    return np.arctan2(np.linalg.norm(axis, axis=0), np.trace(matrices, axis1=1, axis2=2) - 1)


class Truth:
    """Poses of the left camera at any time: positions and quaternions interpolated between rows 5 ms apart."""

    def __init__(self, sequence, start):
        folder = sequence / "mav0"
        file = folder / "state_groundtruth_estimate0" / "data.csv"
        stamps = [int(line.split(",")[0]) for line in file.read_text().splitlines() if line and line[0].isdigit()]
        rows = np.loadtxt(file, delimiter=",", comments="#")
        self.time = (np.array(stamps) - start) * 1e-9
        self.position, quaternion = rows[:, 1:4], rows[:, [5, 6, 7, 4]]
        flips = np.cumprod(np.where((quaternion[1:] * quaternion[:-1]).sum(1) < 0, -1, 1))
        self.quaternion = quaternion * np.concatenate([[1], flips])[:, None]
        text = (folder / "cam0" / "sensor.yaml").read_text()
        data = re.search(r"T_BS:.*?data:\s*\[(.*?)\]", text, re.S)[1]
        self.body_from_left = np.array([float(value) for value in data.split(",")]).reshape(4, 4)

    def at(self, time):
        def interpolate(values):
            return np.stack([np.interp(time, self.time, column) for column in values.T], 1)

        body = rotations(interpolate(self.quaternion))
        return body @ self.body_from_left[:3, :3], interpolate(self.position) + body @ self.body_from_left[:3, 3]


def motions(rotation, position, steps):
    """Rotations and translations over `steps` frames, in the earlier camera's frame."""
    back = rotation[:-steps].transpose(0, 2, 1)
    return back @ rotation[steps:], np.einsum("nij,nj->ni", back, position[steps:] - position[:-steps])


def rotation_offset(truth, time, rotation):
    """Delay of the ground truth's orientations [s], and the RMS difference of the rotation angles [deg]."""
    found = angles(motions(rotation, np.zeros((len(time), 3)), 1)[0])
    offsets = np.arange(-LARGEST_OFFSET, LARGEST_OFFSET + OFFSET_STEP / 2, OFFSET_STEP)
    squares = []
    for offset in offsets:
        turned, position = truth.at(time + offset)
        squares.append(np.mean((angles(motions(turned, position, 1)[0]) - found) ** 2))
    best = int(np.clip(np.argmin(squares), 4, len(offsets) - 5))
    curve = np.polyfit(offsets[best - 4 : best + 5], squares[best - 4 : best + 5], 2)
    return -curve[1] / (2 * curve[0]), np.degrees(np.sqrt(min(squares)))


def errors_and_causes(truth, time, rotation, position, steps):
    """Errors of the translations over `steps` frames [m], (n, 3), their derivatives by each constant, (n, 3, 8), and
    the lengths of the true translations [m], (n)."""
    true_rotation, true_position = truth.at(time)
    turned, moved = motions(true_rotation, true_position, steps)
    _, found = motions(rotation, position, steps)
    speed = (truth.at(time + SPEED_WINDOW)[1] - truth.at(time - SPEED_WINDOW)[1]) / (2 * SPEED_WINDOW)
    change = np.einsum("nji,nj->ni", true_rotation[:-steps], speed[steps:] - speed[:-steps])
    turns = np.stack([np.cross(axis, moved) for axis in np.eye(3)], 2)
    causes = np.concatenate([moved[:, :, None], turns, change[:, :, None], turned - np.eye(3)], 2)
    return found - moved, causes, np.linalg.norm(moved, axis=1)


def fit(steps, rows):
    """The eight constants, by least squares over all step lengths with equal weights."""
    scaled = [(error[rows(error)] / np.sqrt((error**2).mean()), cause[rows(error)] / np.sqrt((error**2).mean()))
              for error, cause, _ in steps.values()]
    causes = np.concatenate([cause.reshape(-1, len(NAMES)) for _, cause in scaled])
    return np.linalg.lstsq(causes, np.concatenate([error.ravel() for error, _ in scaled]), rcond=None)[0]


def rms(errors):
    return float(np.sqrt((errors**2).sum(1).mean()))


def examine(sequence, results):
    lines = [line.split() for line in (results / "trajectory.txt").read_text().splitlines() if line[0] != "#"]
    stamps = np.array([int(row[0].replace(".", "")) for row in lines])
    values = np.array([[float(value) for value in row[1:]] for row in lines])
    truth = Truth(sequence, stamps[0])
    time, position, rotation = (stamps - stamps[0]) * 1e-9, values[:, :3], rotations(values[:, 3:])
    offset, difference = rotation_offset(truth, time, rotation)
    steps = {n: errors_and_causes(truth, time, rotation, position, n) for n in STEPS if n < len(time) - 10}
    constants = fit(steps, lambda error: slice(None))
    halves = [fit(steps, lambda error: slice(None, len(error) // 2)),
              fit(steps, lambda error: slice(len(error) // 2, None))]
    report = json.loads((results / "report.json").read_text())
    promised = {step["frames"]: 1e3 * step["promised_m"] for step in report["accuracy"]["consistency"]}
    rows = []
    for n, (error, causes, ways) in steps.items():
        middle = len(error) // 2
        crossed = np.concatenate([error[middle:] - causes[middle:] @ halves[0],
                                  error[:middle] - causes[:middle] @ halves[1]])
        rows.append({"frames": n, "way_mm": 1e3 * float(ways.mean()), "as_it_is_mm": 1e3 * rms(error),
                     "constants_removed_mm": 1e3 * rms(error - causes @ constants),
                     "of_other_half_mm": 1e3 * rms(crossed), "promised_mm": promised[n]})
    return {"sequence": sequence.name, "rotation_offset_ms": 1e3 * offset, "rotation_rms_deg": float(difference),
            "constants": dict(zip(NAMES, (float(value) for value in constants))), "rows": rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("-o", "--output", type=Path, metavar="FILE")
    options = parser.parse_args()
    result = stamped(examine(options.sequence, options.results))
    print(json.dumps(result, indent=1))
    if options.output:
        write(result, options.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
