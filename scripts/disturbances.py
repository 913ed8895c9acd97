"""Disturbances of the camera over rendered sequences, for scripts/measure.py. The plot needs matplotlib.

The disturbances are the light of every second frame (factor 0.5 to 2), the right camera's exposure (factor 0.5 to 2),
motion blur (up to 5 px, with a handheld camera, because on the ellipse the image moves less than that per frame),
camera noise (up to 8 grey levels) and the fraction of the image covered by an independently moving board (up to 40 %);
and low light and low contrast. A step is wrong if it is reported as tracked and its error exceeds 5 mm + 10 % of the
motion or 0.25 degrees (`quadedge evaluate trajectory --steps`).
"""

import csv
import json
import statistics

from stamped import drawing, save_svg

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
# Steps are a few cm: a limit of 5 cm would hide any error.
STEP_OF_RENDERED = ("--step-metres", 0.005, "--step-degrees", 0.25)
OPTIONS = {"contrast16": "contrast"}  # of kinds that are not named after their option
COLUMNS = ("scene", "kind", "value", "threshold", "edge_threshold", "edges", "frames", "tracked", "right", "wrong",
           "lost", "rpe_translation_m", "rpe_rotation_deg", "end_drift_percent")


def measure(scene, kind, value, threshold, frames_and_size, programs):
    """Runs the rendered sequence with an edge threshold, 0 for the automatic one. Returns a row of the table."""
    quadedge, (count, size) = programs.options.quadedge, frames_and_size
    output = programs.options.work / "disturbances" / f"{scene}_{kind}_{value}_{threshold}"
    # Code 5, many lost frames, is a result as well.
    programs.call([quadedge, "demo", "--scene", scene, "--frames", count, f"--{OPTIONS.get(kind, kind)}", value, "-o",
                   output, "--force", "--quiet", "--edges.threshold", threshold, "--size", size,
                   *{**KINDS, **LIGHT}[kind][2]], allowed=(0, 5))
    with open(output / "frames.csv", encoding="utf-8") as file:
        frames = list(csv.DictReader(file))
    tracked = sum(1 for line in open(output / "trajectory.txt", encoding="utf-8") if not line.startswith("#"))
    row = dict.fromkeys(COLUMNS)
    row.update(scene=scene, kind=kind, value=value, threshold=threshold,
               edge_threshold=statistics.median(float(frame["edge_threshold"]) for frame in frames),
               edges=statistics.mean(int(frame["edges_left"]) for frame in frames), frames=count,
               tracked=tracked, right=0, wrong=0, lost=count - 1)
    if tracked < 2:
        return row
    judged = output / "evaluation.json"
    programs.call([quadedge, "evaluate", "trajectory", output / "trajectory.txt", output / "groundtruth.txt", "--steps",
                   *STEP_OF_RENDERED, "--json", judged, "--force"])
    evaluation = json.loads(judged.read_text(encoding="utf-8"))
    row.update({name: evaluation["steps"][name] for name in ("right", "wrong", "lost")})
    errors = evaluation["accuracy"]["origin_aligned"]
    row.update(rpe_translation_m=errors["rpe_translation_m"]["mean"],
               rpe_rotation_deg=errors["rpe_rotation_deg"]["mean"],
               end_drift_percent=evaluation["accuracy"]["end_drift_percent"])
    return row


def plot(rows, folder):
    """One plot per disturbance: the mean error of a step, with the numbers of lost and wrong steps at the points."""
    pyplot = drawing()
    kinds = [kind for kind in KINDS if any(row["kind"] == kind for row in rows)]
    figure, axes = pyplot.subplots(2, len(kinds), figsize=(3.6 * len(kinds), 6), layout="constrained", squeeze=False,
                                   sharey="row")
    for column, kind in enumerate(kinds):
        for upper, (name, scale) in enumerate((("rpe_translation_m", 1e3), ("rpe_rotation_deg", 1))):
            axis = axes[upper][column]
            for index, scene in enumerate(dict.fromkeys(row["scene"] for row in rows)):
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
    save_svg(figure, folder / "disturbances.svg")
