#!/usr/bin/env python3
"""Checks that memory and processor time per frame of `quadedge run` stay constant over 1100 rendered frames.

    long_run.py FOLDER                               240x150, handheld camera
    long_run.py FOLDER --frames 2100 -- --device gpu more frames, with options for `quadedge run`

FOLDER/sequence is rendered unless it exists; FOLDER/out is replaced. Prints one line per hundred frames: resident
memory after the last of them, processor time of all threads and median latency per frame. Processor time is the cost
of the frames; latency also depends on what else runs on the machine.
Needs Linux (/proc) and the program build/quadedge.
Exit code: 0 constant, 1 more than 5 MB of growth after frame 100 or more than 10 % more time per frame, 2 wrong usage.
"""

import argparse
import csv
import os
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
BLOCK = 100  # frames per line; the first block is not judged, because buffers still grow
GROWTH_MB, SLOWER = 5, 1.1  # at most
TICKS = os.sysconf("SC_CLK_TCK")


def memory_and_time(process):
    """Resident memory [MB] and processor time of all threads [s]; nothing once the process has ended."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
        times = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return None
    resident = [line for line in status.splitlines() if line.startswith("VmRSS:")]
    if not resident:
        return None
    return int(resident[0].split()[1]) / 1024, (int(times[11]) + int(times[12])) / TICKS


def watch(program, frames_csv):
    """(frames done, memory, time) after each frame, until the program ends."""
    samples, size, lines = [], 0, 0
    while program.poll() is None:
        time.sleep(0.005)
        if not frames_csv.exists() or frames_csv.stat().st_size == size:
            continue
        with open(frames_csv, "rb") as file:
            file.seek(size)
            text = file.read()
        size += len(text)
        lines += text.count(b"\n")
        if sample := memory_and_time(program.pid):
            samples.append((lines - 1, *sample))  # without the heading
    return samples


def at_frame(samples, frame):
    """The first sample with at least `frame` frames done."""
    return next(sample for sample in samples if sample[0] >= frame)


def report(samples, latencies):
    """Prints the table. Returns whether memory and time stayed constant."""
    print(f"{'frames':>12} {'memory':>10} {'cpu/frame':>10} {'latency':>10}")
    blocks = []
    for first in range(0, len(latencies) - BLOCK + 1, BLOCK):
        last = min(first + BLOCK, samples[-1][0])
        begin, end = at_frame(samples, max(first, 1)), at_frame(samples, last)
        cost = 1e3 * (end[2] - begin[2]) / max(1, end[0] - begin[0])
        blocks.append((end[1], cost))
        latency = statistics.median(latencies[first : first + BLOCK])
        print(f"{first:5d} - {last:4d} {end[1]:7.1f} MB {cost:7.1f} ms {latency:7.1f} ms")
    if len(blocks) < 3:
        sys.exit(f"long_run: {len(latencies)} frames; expected at least {3 * BLOCK}")
    growth = max(memory for memory, _ in blocks[1:]) - blocks[0][0]
    half = len(blocks[1:]) // 2
    early, late = (statistics.median(cost for _, cost in part) for part in (blocks[1 : 1 + half], blocks[-half:]))
    print(f"after the first {BLOCK} frames: memory {growth:+.1f} MB (at most +{GROWTH_MB}), "
          f"time per frame {100 * (late / early - 1):+.1f} % (second half to first, at most "
          f"+{100 * (SLOWER - 1):.0f} %)")
    return growth <= GROWTH_MB and late <= SLOWER * early


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="FOLDER")
    parser.add_argument("--frames", type=int, default=1100, help="number of frames to render (%(default)s)")
    parser.add_argument("--size", default="240x150", help="image size [px] (%(default)s)")
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge", help="the program")
    parser.add_argument("options", nargs="*", metavar="-- OPTION", help="options for `quadedge run`")
    options = parser.parse_args()
    sequence, out = options.folder / "sequence", options.folder / "out"
    if not sequence.is_dir():
        spare = options.folder / "sequence.part"
        shutil.rmtree(spare, ignore_errors=True)
        subprocess.run([options.quadedge, "synth", spare, "--path", "handheld", "--frames", str(options.frames),
                        "--size", options.size, "--quiet"], stdout=subprocess.DEVNULL, check=True)
        spare.rename(sequence)
    shutil.rmtree(out, ignore_errors=True)
    with subprocess.Popen([options.quadedge, "run", sequence, "-o", out, "--quiet", *options.options],
                          stdout=subprocess.DEVNULL) as program:
        samples = watch(program, out / "frames.csv")
    if program.returncode != 0:
        sys.exit(f"long_run: quadedge run ended with code {program.returncode}")
    with open(out / "frames.csv", newline="", encoding="utf-8") as file:
        latencies = [float(row["latency_ms"]) for row in csv.DictReader(file)]
    return 0 if report(samples, latencies) else 1


if __name__ == "__main__":
    sys.exit(main())
