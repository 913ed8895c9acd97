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
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import result_tables
from measurements import RECORDED, REPOSITORY
from stamped import stamped, write

try:
    import cv2
    import yaml
except ImportError:
    cv2 = None


def camera_of(calibration):
    """Focal length, principal point and baseline of KITTI's calib.txt."""
    rows = {name: [float(value) for value in values.split()] for name, values in
            (line.split(":", 1) for line in calibration.read_text(encoding="utf-8").splitlines() if ":" in line)}
    return rows["P0"][0], rows["P0"][2], rows["P0"][6], -rows["P1"][3] / rows["P1"][0]


def rectified(flight, folder):
    """Writes the images of a EuRoC sequence, rectified, to image_0 and image_1 of a folder. Returns their camera."""
    rows = [[(flight / "mav0" / name / "sensor.yaml"), flight / "mav0" / name / "data"] for name in ("cam0", "cam1")]
    sensors = [yaml.safe_load(file.read_text(encoding="utf-8")) for file, _ in rows]
    body = [numpy.reshape(sensor["T_BS"]["data"], (4, 4)) for sensor in sensors]
    right_from_left = numpy.linalg.inv(body[1]) @ body[0]
    lenses = [(numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]), numpy.array(sensor["distortion_coefficients"]))
              for sensor in sensors for fx, fy, cx, cy in [sensor["intrinsics"]]]
    size = tuple(sensors[0]["resolution"])
    turn_0, turn_1, made_0, made_1, *_ = cv2.stereoRectify(*lenses[0], *lenses[1], size, right_from_left[:3, :3],
                                                           right_from_left[:3, 3:], alpha=0)
    for camera, (matrix, lens), turn, made, (_, images) in zip("01", lenses, (turn_0, turn_1), (made_0, made_1), rows):
        maps = cv2.initUndistortRectifyMap(matrix, lens, turn, made, size, cv2.CV_32FC1)
        (folder / f"image_{camera}").mkdir()
        for image in sorted(images.glob("*.png")):
            pixels = cv2.imread(str(image), cv2.IMREAD_GRAYSCALE)
            cv2.imwrite(str(folder / f"image_{camera}" / image.name), cv2.remap(pixels, *maps, cv2.INTER_LINEAR))
    return made_0[0, 0], made_0[0, 2], made_0[1, 2], -made_1[0, 3] / made_1[0, 0]


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
            if cv2:
                timed.append(("EuRoC MH_01", flight, Path(folder), rectified(flight, Path(folder))))
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
