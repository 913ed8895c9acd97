#!/usr/bin/env python3
"""Times libviso2 in turn with `quadedge bench` on KITTI 06 and MH_01 and makes its figures in doc/results/peers.json.

    scripts/peers.py VISO2 --data DIR [--rounds N] [--frames N] [--kernels TEXT] [--quadedge FILE] [--out FILE]

VISO2 is a program that you have built: libviso2 is GPL and no part of this repository. It is called as
    VISO2 LEFT_FOLDER RIGHT_FOLDER F CU CV BASELINE
with folders of rectified images and their camera in pixels and metres, and prints "median X ms". libviso2 uses one
thread, QuadEdge as many as the machine has. MH_01 is rectified for libviso2 with OpenCV's Python package (without it,
KITTI 06 alone is timed). Then scripts/result_tables.py writes the tables.
Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import importlib.util
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import result_tables
from evidence import Recording, camera_of
from measurements import RECORDED, REPOSITORY
from stamped import stamped, write


def median_of_viso2(program, images, camera):
    command = [program, images / "image_0", images / "image_1", *map(str, camera)]
    printed = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    found = re.search(r"median ([\d.]+) ms", printed)
    if not found:
        raise ValueError(f'{program}: expected "median X ms", found "{printed.strip()}"')
    return float(found[1])


def median_of_quadedge(program, sequence, preset, options, folder):
    file = Path(folder) / "bench.json"
    subprocess.run([program, "bench", sequence, "--preset", preset, "--frames", str(options.frames), "--warm-up", "2",
                    "--quiet", "--force", "--json", file], stdout=subprocess.DEVNULL, check=True)
    return json.loads(file.read_text(encoding="utf-8"))["latency_ms"]["median"]


def add(peers, title, kernels, times):
    """Enters the times [ms] of the rounds."""
    own, other = statistics.median(times["quadedge_ms"]), statistics.median(times["libviso2_ms"])
    named = f"{title}, {kernels}" if kernels else title
    peers["libviso2"]["in_turn"][named] = stamped(times | {"threads": os.cpu_count()})
    for row in peers["rows"]:
        if row[0] == "libviso2" and named == "KITTI 06":
            row[1] = f"{other:.0f} ms (QuadEdge in alternating runs: {own:.0f} ms)"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("viso2", type=Path)
    parser.add_argument("--data", type=Path, default=os.environ.get("QUADEDGE_DATA"), required=False)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=30)
    parser.add_argument("--kernels", help="what is special about the kernels, for the row's name")
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge")
    parser.add_argument("--out", type=Path, default=result_tables.RESULTS / "peers.json")
    options = parser.parse_args()
    if not options.data:
        parser.error("the folder of recorded data is missing: --data or QUADEDGE_DATA")
    peers = json.loads(options.out.read_text(encoding="utf-8"))
    street, flight = (options.data / RECORDED[name] for name in ("kitti06", "flight"))
    try:
        with tempfile.TemporaryDirectory() as folder:
            timed = [("KITTI 06", street, street, camera_of(street / "calib.txt"))]
            if flight.exists() and importlib.util.find_spec("cv2"):
                recording = Recording("mh_01", flight, Path(folder))
                recording.rectify()
                timed.append(("EuRoC MH_01", flight, recording.pairs, camera_of(recording.pairs / "calib.txt")))
            for title, sequence, images, camera in timed:
                times = {"quadedge_ms": [], "fast_ms": [], "libviso2_ms": []}
                for _ in range(options.rounds):
                    times["libviso2_ms"].append(median_of_viso2(options.viso2.resolve(), images, camera))
                    for name, preset in (("quadedge_ms", "default"), ("fast_ms", "fast")):
                        times[name].append(median_of_quadedge(options.quadedge, sequence, preset, options, folder))
                    print(f"{title}: " + ", ".join(f"{name} {values[-1]:.1f}" for name, values in times.items()),
                          file=sys.stderr, flush=True)
                add(peers, title, options.kernels, times)
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        print(f"peers: {error}", file=sys.stderr)
        return 1
    write(peers, options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
