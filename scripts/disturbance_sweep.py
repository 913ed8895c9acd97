#!/usr/bin/env python3
"""Sweeps disturbances of the camera over rendered sequences and plots the error as a function of each.

    disturbance_sweep.py OUT                                 all scenes and disturbances
    disturbance_sweep.py OUT --scenes room --kinds blur noise --frames 10 --size 640x332
    disturbance_sweep.py OUT --kinds mover --values 0.3 --scene-seed 11

The disturbances are the light of every second frame (factor 0.5 to 2), the right camera's exposure (factor 0.5 to 2),
motion blur (up to 5 px, with a handheld camera, because on the ellipse the image moves less than that per frame),
camera noise (up to 8 grey levels) and the fraction of the image covered by an independently moving board (up to 40 %).
On request (--kinds): image contrast (down to 0.05 with 8 bits, to 0.01 with 16 bits), the light of all frames (down to
0.15, with noise of 8 grey levels) and the camera's gamma.
OUT/disturbances.csv and .json have one row per run, OUT/disturbances.svg the plots. A step is wrong if it is reported
as tracked and its error exceeds 5 mm + 10 % of the motion or 0.25 degrees (`quadedge evaluate trajectory --steps`).
Needs matplotlib and the program `quadedge`.
Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import csv
import json
import statistics
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
SCENES = ("room", "cables", "facade")
# Option of `quadedge demo` -> (label, values, further options)
KINDS = {
    "gain": ("light of every second frame, factor", (0.5, 0.7, 1, 1.4, 2), ()),
    "right-gain": ("exposure of the right camera, factor", (0.5, 0.7, 1, 1.4, 2), ()),
    "blur": ("motion blur, handheld camera [px]", (0, 1, 2, 3, 4, 5), ("--path", "handheld")),
    "noise": ("camera noise [grey levels]", (0, 1.5, 3, 5, 8), ()),
    "mover": ("ratio of the image covered by a moving board", (0, 0.1, 0.2, 0.3, 0.4), ()),
}
# Low light and low contrast; scripts/measure.py --only light
LIGHT = {
    "contrast": ("contrast", (1, 0.2, 0.1, 0.05), ()),
    "contrast16": ("contrast, 16 bits", (1, 0.1, 0.01), ("--bits", 16)),
    "light": ("light, noise 8", (1, 0.3, 0.15), ("--noise", 8)),
    "gamma": ("gamma", (0.45, 2.2), ()),
}
OPTIONS = {"contrast16": "contrast"}  # of kinds that are not named after their option
COLUMNS = ("scene", "kind", "value", "threshold", "edge_threshold", "edges", "frames", "tracked", "right", "wrong",
           "lost", "rpe_translation_m", "rpe_rotation_deg", "end_drift_percent")


class Problem(Exception):
    """An error to report to the user."""


def call(command, allowed=(0,)):
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            check=False)
    if result.returncode not in allowed:
        line = " ".join(str(part) for part in command)
        raise Problem(f"{line}\nended with code {result.returncode}: {result.stderr.strip()}")


def measure(scene, kind, value, options, threshold=0):
    """Runs the rendered sequence with an edge threshold, 0 for the automatic one. Returns a row of the table."""
    output = options.out / "runs" / f"{scene}_{kind}_{value}_{threshold}"
    size = ["--size", options.size] if options.size else []
    device = ["--device", options.device] if options.device else []
    seed = ["--scene-seed", options.scene_seed] if options.scene_seed is not None else []
    # Code 5, many lost frames, is a result as well.
    call([options.quadedge, "demo", "--scene", scene, "--frames", options.frames, f"--{OPTIONS.get(kind, kind)}",
          value, "-o", output, "--force", "--quiet", "--edges.threshold", threshold,
          *{**KINDS, **LIGHT}[kind][2], *size, *device, *seed], allowed=(0, 5))
    with open(output / "frames.csv", encoding="utf-8") as file:
        frames = list(csv.DictReader(file))
    tracked = sum(1 for line in open(output / "trajectory.txt", encoding="utf-8") if not line.startswith("#"))
    row = dict.fromkeys(COLUMNS)
    row.update(scene=scene, kind=kind, value=value, threshold=threshold,
               edge_threshold=statistics.median(float(frame["edge_threshold"]) for frame in frames),
               edges=statistics.mean(int(frame["edges_left"]) for frame in frames), frames=options.frames,
               tracked=tracked, right=0, wrong=0, lost=options.frames - 1)
    if tracked < 2:
        return row
    judged = output / "evaluation.json"
    call([options.quadedge, "evaluate", "trajectory", output / "trajectory.txt", output / "groundtruth.txt", "--steps",
          "--step-metres", 0.005,
          "--step-degrees", 0.25, "--json", judged, "--force"])
    with open(judged, encoding="utf-8") as file:
        evaluation = json.load(file)
    row.update({name: evaluation["steps"][name] for name in ("right", "wrong", "lost")})
    errors = evaluation["accuracy"]["origin_aligned"]
    row.update(rpe_translation_m=errors["rpe_translation_m"]["mean"],
               rpe_rotation_deg=errors["rpe_rotation_deg"]["mean"],
               end_drift_percent=evaluation["accuracy"]["end_drift_percent"])
    return row


def plot(rows, options):
    """One plot per disturbance: the mean error of a step, with the numbers of lost and wrong steps at the points."""
    import matplotlib

    matplotlib.use("Agg")  # no window
    matplotlib.rcParams["svg.hashsalt"] = "quadedge"  # reproducible bytes
    from matplotlib import pyplot

    kinds = [kind for kind in KINDS if any(row["kind"] == kind for row in rows)]
    figure, axes = pyplot.subplots(2, len(kinds), figsize=(3.6 * len(kinds), 6), layout="constrained", squeeze=False,
                                   sharey="row")
    for column, kind in enumerate(kinds):
        for upper, (name, scale) in enumerate((("rpe_translation_m", 1e3), ("rpe_rotation_deg", 1))):
            axis = axes[upper][column]
            for index, scene in enumerate(options.scenes):
                found = [row for row in rows if row["kind"] == kind and row["scene"] == scene and row[name] is not None]
                axis.plot([row["value"] for row in found], [scale * row[name] for row in found], "o-",
                          color=f"C{index}", label=scene, markersize=4)
                for row in found:
                    note = ", ".join(f"{row[what]} {what}" for what in ("wrong", "lost") if row[what])
                    axis.annotate(note, (row["value"], scale * row[name]), color="red" if row["wrong"] else "black",
                                  fontsize=7,
                                  xytext=(0, 5), textcoords="offset points", ha="center")
            axis.set_yscale("log")
            axis.grid(alpha=0.3)
        axes[1][column].set_xlabel(KINDS[kind][0])
    axes[0][0].set_ylabel("mean error of a step [mm]")
    axes[1][0].set_ylabel("mean error of a step [deg]")
    axes[0][0].legend()
    figure.savefig(options.out / "disturbances.svg", metadata={"Date": None})


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, metavar="OUT")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--kinds", nargs="+", choices=[*KINDS, *LIGHT], default=list(KINDS))
    parser.add_argument("--values", nargs="+", type=float, help="instead of the default values of each kind")
    parser.add_argument("--frames", type=int, default=12)
    parser.add_argument("--scene-seed", type=int, help="as in `quadedge demo`")
    parser.add_argument("--size", help="image size, WxH; default 942x489")
    parser.add_argument("--device", help="as in `quadedge run`")
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge")
    return parser.parse_args()


def main():
    options = parse()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    try:
        for scene in options.scenes:
            for kind in options.kinds:
                for value in options.values or {**KINDS, **LIGHT}[kind][1]:
                    rows.append(measure(scene, kind, value, options))
                    row = rows[-1]
                    print(f"{scene} {kind} {value}: {row['right']} right, {row['wrong']} wrong, {row['lost']} lost",
                          flush=True)
    except Problem as problem:
        print(f"disturbance_sweep: {problem}", file=sys.stderr)
        return 1
    with open(options.out / "disturbances.csv", "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        table.writerows(rows)
    (options.out / "disturbances.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    plot(rows, options)
    return 0


if __name__ == "__main__":
    sys.exit(main())
