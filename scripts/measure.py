#!/usr/bin/env python3
"""Measures the figures of README and doc/, and writes them to doc/results.

    scripts/measure.py                         all parts, over an hour; recorded data from --data or QUADEDGE_DATA
    scripts/measure.py --only speed            one part; the others remain unchanged
    scripts/measure.py --keep                  resumes after an interruption: complete runs are reused
    scripts/measure.py --frames 6 --out try    a quick test in another folder

Each part is written to OUT/PART.json with commit, date and the command behind each figure; scripts/result_tables.py
then writes the tables and the marked blocks of the documentation. The programs are those of build/, which is brought up
to date first; the OpenCV baseline needs -DQUADEDGE_BENCHMARKS=ON. Run it with build/venv/bin/python, which has the
package: matching and paper measure with it.

The part "evidence" is about whole recordings, the folders street, karlsruhe and mh_01 of --recordings
(scripts/recordings.py says where they come from), and other systems:
  --viso2   libviso2 (GPL, no part of this repository): a program of yours that is called as
            VISO2 LEFT_FOLDER RIGHT_FOLDER F CU CV BASELINE POSES, writes one row of KITTI's format per pair to POSES
            and prints "median X ms, p99 Y ms"
  --peers   a Python with pyorbslam3, opencv-python-headless and NumPy (scripts/evidence_peers.py)
The part "ros2" sends EuRoC's flight and rendered pairs over the loopback; three minutes on a machine that does nothing
else. Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import json
import os
import sys
from pathlib import Path

import result_tables
from harness import REPOSITORY, Problem, Programs, commit, write
from measurements import PARTS, RECORDED, SCENES, SYSTEMS


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="parts to measure")
    parser.add_argument("--data", type=Path, default=os.environ.get("QUADEDGE_DATA"),
                        help="folder with the recorded sequences; without it, only rendered sequences are measured")
    parser.add_argument("--recordings", type=Path, metavar="DIR", help="folder with the whole recordings")
    parser.add_argument("--sequences", nargs="+", choices=(*RECORDED, *SCENES), default=None)
    parser.add_argument("--systems", nargs="+", choices=SYSTEMS, default=list(SYSTEMS))
    parser.add_argument("--viso2", type=Path, metavar="FILE")
    parser.add_argument("--peers", type=Path, metavar="PYTHON")
    parser.add_argument("--seeds", type=int, default=5, metavar="N", help="runs of QuadEdge per sequence")
    parser.add_argument("--frames", type=int, default=0, help="limit on the frames of each sequence; requires --out")
    parser.add_argument("--keep", action="store_true", help="reuse the complete runs in WORK")
    parser.add_argument("--out", type=Path, default=result_tables.RESULTS)
    parser.add_argument("--work", type=Path, default=REPOSITORY / "build" / "measure", help="folder of the runs")
    parser.add_argument("--quadedge", type=Path, help="program to use instead of the one in build/")
    parser.add_argument("--baseline", type=Path, help="OpenCV baseline to use instead of the one in build/")
    options = parser.parse_args()
    if options.frames and options.out == result_tables.RESULTS:
        parser.error("--frames needs --out: the documentation covers whole sequences")
    if options.sequences is None:
        options.sequences = [*(RECORDED if options.data else ()), *SCENES]
    elif not options.data and any(name in RECORDED for name in options.sequences):
        parser.error("recorded sequences need --data or QUADEDGE_DATA")
    options.work = options.work.resolve()
    return options


def main():
    options = parse()
    options.out.mkdir(parents=True, exist_ok=True)
    options.work.mkdir(parents=True, exist_ok=True)
    programs = Programs(options)
    try:
        needed = {"quadedge_program": options.quadedge}
        if "accuracy" in options.only and "opencv" in options.systems:
            needed["opencv_baseline"] = options.baseline
        missing = [target for target, given in needed.items() if not given]
        if missing:
            programs.call(["cmake", "--build", REPOSITORY / "build", "--target", *missing])
        options.quadedge = options.quadedge or REPOSITORY / "build" / "quadedge"
        options.baseline = options.baseline or REPOSITORY / "build" / "bench" / "opencv_baseline"
        measured = commit()  # of the programs, independent of commits made while they run
        for part in options.only:
            if not {"evidence": options.recordings, "ros2": options.data}.get(part, True):
                continue
            found = PARTS[part](programs)
            content = found if isinstance(found, dict) else {"seeds": options.seeds, "rows": found}
            write(content, measured, options.out / f"{part}.json")
    except Problem as problem:
        print(f"measure: {problem}", file=sys.stderr)
        return 1
    return result_tables.main([]) if options.out == result_tables.RESULTS else 0


if __name__ == "__main__":
    sys.exit(main())
