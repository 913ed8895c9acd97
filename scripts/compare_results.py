#!/usr/bin/env python3
"""Runs two builds of the program on the same sequences and compares their results byte by byte.

  scripts/compare_results.py OLD NEW [--data DIR] [--quick] [--work DIR]

OLD and NEW are `quadedge` programs. DIR contains recorded data (default: QUADEDGE_DATA); without it, only the built-in
scenes are run. Both trajectory files and the edges of one image are compared byte by byte, and every column of
frames.csv that both write except the times; of a message, only its presence is compared.
The results of OLD are kept in the work folder and reused.
Exit code: 0 identical, 1 some differ, 2 a run failed.
"""
import argparse
import csv
import filecmp
import os
import pathlib
import subprocess
import sys

# Name of the results, a folder or a CSV file of edges -> arguments; those of recorded data have its folder first.
RECORDED = {
    "kitti_06": ["run", "kitti_odometry", "--sequence", "06"],
    "kitti_01": ["run", "kitti_odometry", "--sequence", "01"],
    "euroc_at_rest": ["run", "euroc_v1_01_easy_at_rest"],
    "euroc_keyframes": ["run", "euroc_v1_01_easy_keyframes"],
    "euroc_flight": ["run", "euroc_mh_01_easy"],
    "edges.csv": ["edges", "kitti_odometry/sequences/06/image_0/000000.png"],
}
SCENES = ("cables", "facade", "room")


def jobs(data, quick):
    """Name and arguments of every run, but for the place of its results."""
    for name, (command, place, *options) in RECORDED.items() if data else ():
        frames = ["--frames", "0:6"] if quick and command == "run" else []
        yield name, [command, str(pathlib.Path(data) / place), *options, *frames, "--force"]
    for scene in SCENES:
        yield scene, ["demo", "--scene", scene, "--frames", "4" if quick else "60", "--force"]


def run(program, name, arguments, folder):
    """Exit codes 0 and 5 (few frames tracked) are results; any other code ends the comparison."""
    output = ["--csv"] if name.endswith(".csv") else ["--quiet", "--output"]
    done = subprocess.run([program, *arguments, *output, str(folder / name)], stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, 5):
        print(f"{name}: {program} ended with code {done.returncode}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)


def untimed_columns(path):
    """Columns of frames.csv except those in milliseconds; messages are replaced by whether there is one."""
    with open(path, newline="") as file:
        header, *rows = list(csv.reader(file))
    columns = {name: [row[i] for row in rows] for i, name in enumerate(header) if not name.endswith("_ms")}
    return columns | {"message": [bool(text) for text in columns["message"]]}


def differences(old, new):
    if old.suffix == ".csv":
        return [] if filecmp.cmp(old, new, shallow=False) else [old.name]
    found = [name for name in ("trajectory.txt", "trajectory_kitti.txt")
             if not filecmp.cmp(old / name, new / name, shallow=False)]
    before, after = (untimed_columns(folder / "frames.csv") for folder in (old, new))
    if any(before[name] != after[name] for name in before.keys() & after.keys()):
        found.append("frames.csv")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--data", default=os.environ.get("QUADEDGE_DATA"))
    parser.add_argument("--quick", action="store_true", help="a few frames of each sequence")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("compare_results"))
    options = parser.parse_args()
    old, new = (options.work / f"{which}_{'quick' if options.quick else 'whole'}" for which in ("old", "new"))
    for folder in (old, new):
        folder.mkdir(parents=True, exist_ok=True)
    different = 0
    for name, arguments in jobs(options.data, options.quick):
        if not (old / name).exists():
            run(options.old, name, arguments, old)
        run(options.new, name, arguments, new)
        found = differences(old / name, new / name)
        different += bool(found)
        print(f"{name:16} {'different: ' + ', '.join(found) if found else 'identical'}", flush=True)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
