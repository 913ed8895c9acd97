#!/usr/bin/env python3
"""Measures the drift over long rendered sequences with several textures, and the part that all textures share.

    drift.py OUT                                     room and cables, seeds 1 to 3, 480 frames of 480x249
    drift.py OUT --scenes room --seeds 11 12 -o FILE other scenes and seeds, with the results as JSON in FILE
    drift.py OUT --before OLD ...                    together with results of another program in OLD, in the same layout

Each run has a folder OUT/SCENE_SEED; complete runs are not repeated. Errors are those of the camera position,
origin-aligned: at the end, and the root mean square along the path. Needs the program build/quadedge.
Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

from stamped import stamped, write

REPOSITORY = Path(__file__).resolve().parent.parent


def rows(file):
    return [[float(value) for value in line.split()] for line in file.read_text().splitlines() if line[0] != "#"]


def errors(folder):
    """End error and RMS error of the positions [mm], components of the end error [mm], path length [m]."""
    truth = {round(row[0], 6): row[1:4] for row in rows(folder / "groundtruth.txt")}
    found = [(truth[round(row[0], 6)], row[1:4]) for row in rows(folder / "trajectory.txt")]
    parts = [[1e3 * (b - a) for a, b in zip(true, estimate)] for true, estimate in found]
    squares = [sum(part * part for part in position) for position in parts]
    path = sum(
        sum((b - a) ** 2 for a, b in zip(one, other)) ** 0.5 for (one, _), (other, _) in zip(found, found[1:])
    )
    return {"end_mm": squares[-1] ** 0.5, "rms_mm": (sum(squares) / len(squares)) ** 0.5, "end_parts_mm": parts[-1],
            "path_m": path, "frames": len(found)}


def track(scene, seed, options):
    folder = options.out / f"{scene}_{seed}"
    if not (folder / "trajectory.txt").exists():
        command = [options.quadedge, "demo", "--scene", scene, "--scene-seed", seed, "--frames", options.frames,
                   "--size", options.size, "-o", folder, "--quiet", "--force"]
        result = subprocess.run([str(part) for part in command], stderr=subprocess.PIPE, stdout=subprocess.PIPE,
                                text=True, check=False)
        if result.returncode not in (0, 5):
            sys.exit(f"drift: {scene}, seed {seed}: {result.stderr.strip()}")
    return errors(folder)


def summary(scene, runs):
    count = len(runs)
    return {"scene": scene, "end_mm": sum(run["end_mm"] for run in runs) / count,
            "rms_mm": sum(run["rms_mm"] for run in runs) / count,
            "end_percent": sum(run["end_mm"] / run["path_m"] for run in runs) / count / 10,
            "mean_end_parts_mm": [sum(run["end_parts_mm"][k] for run in runs) / count for k in range(3)], "runs": runs}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path)
    parser.add_argument("--scenes", nargs="+", default=["room", "cables"])
    parser.add_argument("--seeds", nargs="+", type=int, default=[1, 2, 3])
    parser.add_argument("--frames", type=int, default=480)
    parser.add_argument("--size", default="480x249")
    parser.add_argument("--before", type=Path, metavar="OLD")
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE")
    options = parser.parse_args()
    result = stamped({"size": options.size, "seeds": options.seeds, "rows": []})
    for scene in options.scenes:
        row = summary(scene, [track(scene, seed, options) for seed in options.seeds])
        if options.before:
            row["before"] = summary(scene, [errors(options.before / f"{scene}_{seed}") for seed in options.seeds])
        result["rows"].append(row)
    print(json.dumps(result, indent=1))
    if options.output:
        write(result, options.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
