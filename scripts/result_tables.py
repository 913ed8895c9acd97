#!/usr/bin/env python3
"""Writes the tables of doc/results/*.json into the documentation.

    scripts/result_tables.py            writes doc/results/PART.md and the marked blocks of README.md and doc/*.md
    scripts/result_tables.py --check    changes nothing; exit code 1 if a table differs from the JSON

A block is enclosed by <!-- table: NAME --> and <!-- end of table -->. scripts/measure.py writes the JSON files, except
doc/results/peers.json, which is written by hand and names the source of its figures.
"""

import argparse
import json
import re
import sys
from pathlib import Path

from tables import TABLES

REPOSITORY = Path(__file__).resolve().parent.parent
RESULTS = REPOSITORY / "doc" / "results"
BLOCK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end of table -->)", re.DOTALL)
# Part -> (title, introduction, tables and headings)
PAGES = {
    "accuracy": ("Accuracy", "Errors are origin-aligned means: absolute (APE) and from frame to frame (RPE)."
                 " [accuracy.md](../accuracy.md) explains them.", ("systems", "steps", "paths")),
    "evidence": ("Whole recordings", "t_rel and r_rel are errors over sub-paths"
                 " ([definition](../reference.md#trajectory-errors)); figures over less than 100 m are not those of"
                 " KITTI's leaderboard. Several seeds: median (range). ORB-SLAM3 runs without loop closing. PAIRS: the"
                 " images rectified by OpenCV. Processor times include decoding and starting.", (
                     "evidence", "## Consistency of the covariances", "evidence-nees")),
    "matching": ("Matching", "Recall and precision after the last filter, for left edges whose counterpart exists"
                 " (paired) and for all left edges (all). [matching.md](../matching.md) defines the terms.",
                 ("matching",)),
    "speed": ("Speed", "Time from the images in host memory to the pose on the host. S and N are times of OpenCV"
              " functions in the same run: [performance.md](../performance.md).", ("speed",)),
    "nvidia": ("NVIDIA GPUs", "Figures of two device kits; room and flight are rendered, kitti06 is recorded."
               " [performance.md](../performance.md#measure-a-gpu) says how to measure another GPU.", (
                   "## Time of a frame\n\nHost's part: while the device waits, measured with profiling.", "gpu-latency",
                   "## Poses\n\nAgainst those of PoCL on a CPU.", "gpu-poses",
                   "## Kernel variants\n\nMedian, and its ratio to that of the default.", "gpu-variants")),
    "disturbances": ("Disturbances", "Mean error of a step in mm, with the numbers of wrong and lost steps if there are"
                     " any, in images of 640 x 332 pixels. [disturbances.md](../disturbances.md) sums up.",
                     ("disturbances",)),
    "light": ("Low light and low contrast", "Contrast scales the final image, including its noise: 0.05 in 8 bits"
              " leaves about ten grey levels. Light applies to all frames, with camera noise of 8 grey levels, gamma to"
              " both cameras. The fixed edge threshold is 2 grey levels per pixel."
              " [disturbances.md](../disturbances.md) sums up.", ("light",)),
    "paper": ("The paper's method", "[paper.md](../paper.md) explains the tables.", (
        "## Table 1: stereo\n\nRecall / precision [%] / ambiguity. Precision is the mean over edges with candidates,"
        " ambiguity the paper's: candidates per edge of the pool less 1.", "paper-stereo",
        "## Table 2: in time, left images\n\nThe right ones differ little.", "paper-temporal",
        "## Table 3: pairs of quads\n\nRecall / precision [%].", "paper-constraints",
        "## Trajectories", "paper-trajectories",
        "## Extensions\n\nErrors from frame to frame of the default without an extension, and of the paper's method"
        " with one alone, where it has the step.", "paper-extensions")),
}


def render(name, results):
    """A table, or a note that it is missing."""
    part, function = TABLES[name]
    return function(results) if part in results else f"*Not measured yet: `scripts/measure.py --only {part}`.*\n"


def page(part, results):
    title, about, names = PAGES[part]
    if part not in results:
        return f"# {title}\n\n{render(part, results)}"
    made_by = {"nvidia": "scripts/device_kit.sh"}.get(part, f"scripts/measure.py --only {part}")
    listed = {"commands", "command"} & results[part].get("rows", [{}])[0].keys()
    commands = f" by the commands in [{part}.json]({part}.json)" if listed else ""
    return "\n".join([f"# {title}\n", f"Made by `{made_by}`{commands}. {about}\n",
                      *(f"{name}\n" if name.startswith("#") else render(name, results) for name in names)])


def judged(rows):
    """Without the sequences that are also evaluated from a later frame, as their ground truth is wrong before it."""
    later = {row["title"].split(", from frame")[0] for row in rows if row["from_frame"]}
    return [row for row in rows if row["title"] not in later]


def wanted_texts(folder):
    """Path -> expected text, for every file with tables."""
    results = {file.stem: json.loads(file.read_text(encoding="utf-8")) for file in sorted(folder.glob("*.json"))}
    if "accuracy" in results:
        results["accuracy"]["rows"] = judged(results["accuracy"]["rows"])
    texts = {folder / f"{part}.md": page(part, results) for part in PAGES if part in results or folder == RESULTS}
    if folder == RESULTS:
        for file in (REPOSITORY / "README.md", *sorted((REPOSITORY / "doc").glob("*.md"))):
            text = file.read_text(encoding="utf-8")
            texts[file] = BLOCK.sub(lambda block: block[1] + render(block[2], results) + block[3], text)
    return texts


def differing(folder):
    return [(file, text) for file, text in wanted_texts(folder).items()
            if not file.exists() or file.read_text(encoding="utf-8") != text]


def write(folder=RESULTS):
    for file, text in differing(folder):
        file.write_text(text, encoding="utf-8")
        print(f"wrote {file.relative_to(REPOSITORY) if file.is_relative_to(REPOSITORY) else file}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--results", type=Path, default=RESULTS, metavar="DIR")
    options = parser.parse_args()
    if not options.check:
        write(options.results)
        return 0
    stale = [file for file, _ in differing(options.results)]
    for file in stale:
        print(f"result_tables: {file} differs from its JSON; run scripts/result_tables.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
