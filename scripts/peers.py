#!/usr/bin/env python3
"""Times libviso2 in turn with `quadedge bench` on KITTI 06 and makes its figures in doc/results/peers.json.

    scripts/peers.py VISO2 --data DIR [--rounds N] [--frames N] [--quadedge FILE] [--out FILE]

VISO2 is a program that you have built: libviso2 is GPL and no part of this repository. It is called as
    VISO2 LEFT_FOLDER RIGHT_FOLDER F CU CV BASELINE
with folders of rectified images and their camera in pixels and metres, and prints "median X ms". Both programs use as
many threads as the machine has. Then scripts/result_tables.py writes the tables.
Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import result_tables
from measurements import RECORDED, REPOSITORY
from stamped import stamped, write

TITLE = "KITTI 06"


def camera_of(calibration):
    """Focal length, principal point and baseline of KITTI's calib.txt."""
    rows = {name: [float(value) for value in values.split()] for name, values in
            (line.split(":", 1) for line in calibration.read_text(encoding="utf-8").splitlines() if ":" in line)}
    return rows["P0"][0], rows["P0"][2], rows["P0"][6], -rows["P1"][3] / rows["P1"][0]


def median_of_viso2(program, sequence):
    command = [program, sequence / "image_0", sequence / "image_1", *map(str, camera_of(sequence / "calib.txt"))]
    printed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    found = re.search(r"median ([\d.]+) ms", printed)
    if not found:
        raise ValueError(f'{program}: expected "median X ms", found "{printed.strip()}"')
    return float(found[1])


def median_of_quadedge(program, sequence, frames, folder):
    file = Path(folder) / "bench.json"
    subprocess.run([program, "bench", sequence, "--frames", str(frames), "--warm-up", "2", "--quiet", "--force",
                    "--json", file], stdout=subprocess.DEVNULL, check=True)
    return json.loads(file.read_text(encoding="utf-8"))["latency_ms"]["median"]


def add(peers, ours, theirs):
    """Enters the times [ms] of the rounds."""
    own, other = statistics.median(ours), statistics.median(theirs)
    peers["libviso2"]["in_turn"][TITLE] = stamped({"quadedge_ms": ours, "libviso2_ms": theirs,
                                                   "threads": os.cpu_count()})
    for row in peers["rows"]:
        if row[0] == "libviso2":
            row[1] = f"{other:.0f} ms (QuadEdge in turn with it: {own:.0f} ms)"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("viso2", type=Path)
    parser.add_argument("--data", type=Path, default=os.environ.get("QUADEDGE_DATA"), required=False)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge")
    parser.add_argument("--out", type=Path, default=result_tables.RESULTS / "peers.json")
    options = parser.parse_args()
    if not options.data:
        parser.error("the folder of recorded data is missing: --data or QUADEDGE_DATA")
    sequence = options.data / RECORDED["kitti06"]
    ours, theirs = [], []
    try:
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(options.rounds):
                theirs.append(median_of_viso2(options.viso2.resolve(), sequence))
                ours.append(median_of_quadedge(options.quadedge, sequence, options.frames, folder))
                print(f"libviso2 {theirs[-1]:.1f} ms, QuadEdge {ours[-1]:.1f} ms", file=sys.stderr, flush=True)
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"peers: {error}", file=sys.stderr)
        return 1
    peers = json.loads(options.out.read_text(encoding="utf-8"))
    add(peers, ours, theirs)
    write(peers, options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
