#!/usr/bin/env python3
"""Makes the whole accuracy table: QuadEdge, the paper's plain method and the OpenCV baseline on recorded and rendered sequences.

    accuracy_table.py OUT [--data FOLDER]                   everything; FOLDER (or QUADEDGE_DATA) holds the recorded sequences
    accuracy_table.py OUT --sequences room cables --frames 10 --systems default

OUT/accuracy.md and OUT/accuracy.json hold the tables, OUT/room.svg and OUT/cables.svg the trajectories of the rendered scenes beside the
truth, OUT/SYSTEM/SEQUENCE the results of each run. All figures come from `quadedge evaluate trajectory --steps`: origin-aligned
means. Needs matplotlib, the program `quadedge`, and for the baseline a build with -DQUADEDGE_BENCHMARKS=ON.
Exit code: 0 done, 1 a program failed, 2 wrong usage.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
# Name -> (title, folder below the data or rendered scene, first frame judged)
SEQUENCES = {
    "kitti06": ("KITTI 06, from frame 10", "kitti_odometry/sequences/06", 10),
    "kitti01": ("KITTI 01", "kitti_odometry/sequences/01", 0),
    "rest": ("EuRoC V1_01 at rest", "euroc_v1_01_easy_at_rest", 0),
    "keyframes": ("EuRoC V1_01 key frames", "euroc_v1_01_easy_keyframes", 0),
    "room": ("rendered room", None, 0),
    "cables": ("rendered cables", None, 0),
}
SYSTEMS = {"default": "QuadEdge", "paper": "QuadEdge, paper.toml", "opencv": "OpenCV SIFT + PnP"}
STEP_SEQUENCE = "keyframes"  # judged step by step: errors over all its frames say nothing
COMPLETE = "complete"  # empty file in the folder of a run that came to its end
ERRORS = ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m")


class Problem(Exception):
    """Something that a user should read."""


def call(command, allowed=(0,)):
    """Runs a program; its complaint becomes ours."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    if result.returncode not in allowed:
        raise Problem(f"{' '.join(str(part) for part in command)}\nended with code {result.returncode}: {result.stderr.strip()}")


def run(system, sequence, options):
    """Tracks a sequence with a system. Returns the folder with its results and what the truth is."""
    _, place, _ = SEQUENCES[sequence]
    output = options.out / system / sequence
    truth = options.data / place if place and not options.frames else output / "groundtruth.txt"
    if options.keep and (output / COMPLETE).exists():
        return output, truth
    shutil.rmtree(output, ignore_errors=True)
    if system == "opencv":
        frames = ["--frames", options.frames] if options.frames else []
        call([options.baseline, options.data / place if place else sequence, "-o", output, *frames])
    else:
        method = ["--config", REPOSITORY / "config" / "paper.toml"] if system == "paper" else []
        if options.device:
            method += ["--device", options.device]
        if place:
            frames = ["--frames", f"0:{options.frames}"] if options.frames else []
            command = [options.quadedge, "run", options.data / place]
        else:
            frames = ["--frames", options.frames] if options.frames else []
            command = [options.quadedge, "demo", "--scene", sequence]
        call([*command, "-o", output, "--quiet", *frames, *method], allowed=(0, 5))  # 5: many frames lost, which is a result too
    (output / COMPLETE).touch()
    return output, truth


def evaluate(system, sequence, options):
    """One entry of the tables."""
    output, truth = run(system, sequence, options)
    estimate, judged = output / "trajectory.txt", output / "evaluation.json"
    frames = sum(1 for _ in open(output / "trajectory_kitti.txt", encoding="utf-8"))
    tracked = sum(1 for line in open(estimate, encoding="utf-8") if not line.startswith("#"))
    entry = {"system": system, "sequence": sequence, "frames": frames, "tracked": tracked}
    first = SEQUENCES[sequence][2]
    if tracked - first < 2:
        return entry  # nothing to compare
    call([options.quadedge, "evaluate", "trajectory", estimate, truth, "--from-frame", first, "--steps", "--force", "--json", judged])
    with open(judged, encoding="utf-8") as file:
        evaluation = json.load(file)
    entry["errors"] = {name: evaluation["accuracy"]["origin_aligned"][name]["mean"] for name in ERRORS}
    entry["path_length_m"] = evaluation["accuracy"]["path_length_m"]
    entry["end_drift_percent"] = evaluation["accuracy"]["end_drift_percent"]
    entry["steps"] = {name: evaluation["steps"][name] for name in ("right", "wrong", "lost")}
    return entry


def number(value):
    return "-" if value is None else f"{value:.3g}"


def markdown(entries):
    """Both tables."""
    lines = ["| sequence | system | tracked | APE rotation [deg] | APE translation [m] | RPE rotation [deg] | RPE translation [m] | end drift [%] |",
             "|---|---|---|---|---|---|---|---|"]
    shown = None
    for entry in entries:
        if entry["sequence"] == STEP_SEQUENCE:
            continue
        title = SEQUENCES[entry["sequence"]][0]
        errors = [number(entry.get("errors", {}).get(name)) for name in ERRORS]
        cells = ["" if title == shown else title, SYSTEMS[entry["system"]], f"{entry['tracked']} / {entry['frames']}", *errors,
                 number(entry.get("end_drift_percent"))]
        lines.append("| " + " | ".join(cells) + " |")
        shown = title
    judged = [entry for entry in entries if entry["sequence"] == STEP_SEQUENCE]
    if judged:
        lines += ["", "| EuRoC V1_01 key frames | steps right | wrong, reported as good | said to be lost |", "|---|---|---|---|"]
        for entry in judged:
            steps = entry.get("steps", {"right": 0, "wrong": 0, "lost": entry["frames"] - 1})
            lines.append(f"| {SYSTEMS[entry['system']]} | {steps['right']} | {steps['wrong']} | {steps['lost']} |")
    return "\n".join(lines) + "\n"


def read_positions(file):
    """(x, z) of every pose of a TUM file [m]."""
    rows = [line.split() for line in open(file, encoding="utf-8") if line.strip() and not line.startswith("#")]
    return [float(row[1]) for row in rows], [float(row[3]) for row in rows]


def plot(scene, entries, options):
    """The paths from above, and how far each pose is from the true one."""
    import matplotlib

    matplotlib.use("Agg")  # no window
    matplotlib.rcParams["svg.hashsalt"] = "quadedge"  # the same bytes each run
    from matplotlib import pyplot

    figure, (above, away) = pyplot.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    for index, entry in enumerate(entries):
        folder = options.out / entry["system"] / scene
        if index == 0:
            above.plot(*read_positions(folder / "groundtruth.txt"), color="black", linewidth=3, alpha=0.3, label="truth")
        color = f"C{list(SYSTEMS).index(entry['system'])}"
        above.plot(*read_positions(folder / "trajectory.txt"), color=color, linewidth=1, label=SYSTEMS[entry["system"]])
        if "errors" not in entry:
            continue
        with open(folder / "evaluation.json", encoding="utf-8") as file:
            poses = json.load(file)["per_pose"][1:]  # the first, which the alignment makes equal, has no error
        away.plot([pose["stamp_ns"] * 1e-9 for pose in poses], [1e3 * pose["ape_translation_m"] for pose in poses], color=color,
                  label=SYSTEMS[entry["system"]])
    above.set(xlabel="x [m]", ylabel="z [m]", title=f"{SEQUENCES[scene][0]}, left camera from above", aspect="equal")
    away.set(xlabel="time [s]", ylabel="distance from the true position [mm]", yscale="log", title="origin-aligned")
    for axis in (above, away):
        axis.grid(alpha=0.3)
    above.legend()
    figure.savefig(options.out / f"{scene}.svg", metadata={"Date": None})
    pyplot.close(figure)


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, metavar="OUT")
    parser.add_argument("--data", type=Path, default=os.environ.get("QUADEDGE_DATA"), help="folder with the recorded sequences")
    parser.add_argument("--sequences", nargs="+", choices=SEQUENCES, default=list(SEQUENCES))
    parser.add_argument("--systems", nargs="+", choices=SYSTEMS, default=list(SYSTEMS))
    parser.add_argument("--frames", type=int, default=0, help="only the first N frames of each sequence")
    parser.add_argument("--keep", action="store_true", help="use the runs that are complete in OUT, to go on after an interruption")
    parser.add_argument("--device", help="as in `quadedge run`")
    parser.add_argument("--quadedge", type=Path, default=REPOSITORY / "build" / "quadedge")
    parser.add_argument("--baseline", type=Path, default=REPOSITORY / "build" / "bench" / "opencv_baseline")
    options = parser.parse_args()
    if options.data is None and any(SEQUENCES[name][1] for name in options.sequences):
        parser.error("recorded sequences need --data or QUADEDGE_DATA")
    return options


def main():
    options = parse()
    options.out.mkdir(parents=True, exist_ok=True)
    entries = []
    try:
        for sequence in options.sequences:
            for system in options.systems:
                print(f"{sequence}: {SYSTEMS[system]}", file=sys.stderr, flush=True)
                entries.append(evaluate(system, sequence, options))
                # Written each time, so that an interrupted table keeps what it has.
                table = markdown(entries)
                (options.out / "accuracy.md").write_text(table, encoding="utf-8")
                (options.out / "accuracy.json").write_text(json.dumps(entries, indent=1) + "\n", encoding="utf-8")
            if SEQUENCES[sequence][1] is None:
                plot(sequence, [entry for entry in entries if entry["sequence"] == sequence], options)
    except Problem as problem:
        print(f"accuracy_table: {problem}", file=sys.stderr)
        return 1
    print(table, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
