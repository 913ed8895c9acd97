"""Plots of the paths through the rendered scenes, for scripts/measure.py. Needs matplotlib."""

import json

import tables
from measurements import SYSTEMS
from stamped import drawing, save_svg


def plot(scene, rows, options):
    """The paths from above, and the distance of each pose from the true one."""
    pyplot = drawing()

    def positions(file):
        poses = [line.split() for line in open(file, encoding="utf-8") if line.strip() and not line.startswith("#")]
        return [float(pose[1]) for pose in poses], [float(pose[3]) for pose in poses]

    figure, (above, away) = pyplot.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    above.plot(*positions(options.work / rows[0]["system"] / scene / "groundtruth.txt"), color="black", linewidth=3,
               alpha=0.3, label="truth")
    for row in rows:
        folder = options.work / row["system"] / scene
        style = {"color": f"C{SYSTEMS.index(row['system'])}", "label": tables.SYSTEMS[row["system"]]}
        above.plot(*positions(folder / "trajectory.txt"), linewidth=1, **style)
        if "end_drift_percent" not in row:
            continue
        # Skips the first pose, whose error is zero by the alignment.
        poses = json.loads((folder / "evaluation_0.json").read_text(encoding="utf-8"))["per_pose"][1:]
        away.plot([pose["stamp_ns"] * 1e-9 for pose in poses], [1e3 * pose["ape_translation_m"] for pose in poses],
                  **style)
    above.set(xlabel="x [m]", ylabel="z [m]", title=f"rendered {scene}, left camera from above", aspect="equal")
    away.set(xlabel="time [s]", ylabel="distance from the true position [mm]", yscale="log", title="origin-aligned")
    for axis in (above, away):
        axis.grid(alpha=0.3)
    above.legend()
    save_svg(figure, options.out / f"{scene}.svg")
    pyplot.close(figure)
