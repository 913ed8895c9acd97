#!/usr/bin/env python3
"""Checks that two runs of the same frames agree: every frame has the same status and the same counts of edges, stereo
edges, temporal matches, quads and inliers; no quaternion component differs by more than 1e-9, and no position by more
than 1e-9 of its distance from the first frame, or 1e-9 m within the first metre.

    compare_poses.py ONE OTHER        output folders of `quadedge run` or `quadedge demo`
"""

import csv
import math
import sys
from pathlib import Path

TOLERANCE = 1e-9
COUNTS = "frame status key_rig edges_left edges_right stereo_edges temporal_left temporal_right quads inliers".split()
POSITION, ROTATION = "x y z".split(), "qx qy qz qw".split()


def rows(folder: str, name: str, columns: list[str]) -> list[list[str]]:
    with open(Path(folder) / name, newline="") as file:
        return [[row[column] for column in columns] for row in csv.DictReader(file)]


def numbers(row: list[str]) -> list[float]:
    return [float(value) for value in row]


def main() -> int:
    one, other = sys.argv[1:]
    for a, b in zip(rows(one, "frames.csv", COUNTS), rows(other, "frames.csv", COUNTS), strict=True):
        if a != b:
            print("frames.csv differs:", *(f"{name} {x} | {y}" for name, x, y in zip(COUNTS, a, b)), sep="\n  ")
            return 1
    positions, rotations = (
        [
            (numbers(a), numbers(b))
            for a, b in zip(rows(one, "poses.csv", part), rows(other, "poses.csv", part), strict=True)
        ]
        for part in (POSITION, ROTATION)
    )
    apart = max(math.dist(a, b) for a, b in positions)
    position = max(math.dist(a, b) / max(1, math.hypot(*a)) for a, b in positions)
    rotation = max(abs(x - y) for a, b in rotations for x, y in zip(a, b))
    agree = max(position, rotation) <= TOLERANCE
    print(
        f"{len(positions)} frames with the same counts; positions within {apart:.1e} m, {position:.1e} of the distance,"
        f" quaternions within {rotation:.1e}" + ("" if agree else f": more than {TOLERANCE}")
    )
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
