#!/usr/bin/env python3
"""Runs two builds of the program on the same sequences and compares their results byte by byte.

  scripts/compare_results.py OLD NEW [--data DIR] [--quick] [--work DIR]

OLD and NEW are `quadedge` programs. DIR contains recorded data (default: QUADEDGE_DATA); without it, only the
built-in scenes that both programs can render are run. Both trajectory files and the edges of one image are compared
byte by byte, and every column of frames.csv that both write except the times; of a message, only its presence is
compared.
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

RECORDED = {
    "kitti_06": ["kitti_odometry", "--sequence", "06"],
    "kitti_01": ["kitti_odometry", "--sequence", "01"],
    "euroc_at_rest": ["euroc_v1_01_easy_at_rest"],
    "euroc_keyframes": ["euroc_v1_01_easy_keyframes"],
    "euroc_flight": ["euroc_mh_01_easy"],
}
SCENES = ("room", "cables", "facade")
IMAGE = "kitti_odometry/sequences/06/image_0/000000.png"


def scenes_of(program):
    """The built-in scenes that a program can render."""
    help_text = subprocess.run([program, "demo", "--help"], stdout=subprocess.PIPE, text=True, check=True).stdout
    return {scene for scene in SCENES if scene in help_text}


def jobs(data, quick, scenes):
    """Name and arguments of every run; each writes a folder, or a CSV file of edges."""
    frames = ["--frames", "0:6"] if quick else []
    if data:
        for name, (folder, *options) in RECORDED.items():
            yield name, ["run", str(data / folder), *options, *frames, "--quiet", "--force", "--output"]
        yield "edges.csv", ["edges", str(data / IMAGE), "--force", "--csv"]
    for scene in scenes:
        yield scene, ["demo", "--scene", scene, "--frames", "4" if quick else "60", "--quiet", "--force", "--output"]


def run(program, name, arguments, folder):
    """Exit codes 0 and 5 (few frames tracked) are results; any other code ends the comparison."""
    done = subprocess.run([program, *arguments, str(folder / name)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          text=True)
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
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("QUADEDGE_DATA"))
    parser.add_argument("--quick", action="store_true", help="a few frames of each sequence")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("compare_results"))
    options = parser.parse_args()
    data = pathlib.Path(options.data) if options.data else None
    kind = "quick" if options.quick else "whole"
    old, new = options.work / f"old_{kind}", options.work / f"new_{kind}"
    old.mkdir(parents=True, exist_ok=True)
    new.mkdir(parents=True, exist_ok=True)
    different = 0
    scenes = sorted(scenes_of(options.old) & scenes_of(options.new))
    for name, arguments in jobs(data, options.quick, scenes):
        if not (old / name).exists():
            run(options.old, name, arguments, old)
        run(options.new, name, arguments, new)
        found = differences(old / name, new / name)
        different += bool(found)
        print(f"{name:16} {'different: ' + ', '.join(found) if found else 'identical'}", flush=True)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
