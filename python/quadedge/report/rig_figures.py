"""What a run shows of its rig over the right image, before and after learning: a table, maps, and how to read them."""

import numpy as np

from .figure import FEWEST_FRAMES, Figure
from .numbers import PLUS_MINUS
from .results import Run
from .table import Cell, Table

LEAST_LIMIT = 0.25  # px, of a colour scale: the maps of a sound rig are pale
NOISE = 2  # a map is noise up to this many times what independent samples leave
STATES = {"before": "calibration as given", "after": "with what was learned"}
TITLES = {"rows": "Vertical residuals", "columns": "Horizontal residuals"}


def rig_table(rig: dict) -> Table:
    """The maps in a few numbers."""
    table = Table("rig", "Residuals over the right image, vertical and horizontal (along the epipolar lines): medians "
                  "of cells [px]",
                  ["", "", "cells", "RMS", "largest", "scatter of single points"], text_columns=2)
    for axis, title in TITLES.items():
        for state, text in STATES.items():
            found = rig[axis][state]
            table.add(title if state == "before" else Cell("", title), text, found["cells"],
                      *[Cell.of(found[key], 2) for key in ("rms_px", "largest_px", "scatter_px")])
    table.notes = [rows_text(rig), columns_text(rig)]
    return table


def is_noise(found: dict) -> bool:
    """Whether the cells differ from 0 by what the scatter of single points explains."""
    return found["cells"] > 0 and found["rms_px"] <= NOISE * found["noise_px"]


def finds_something(rig: dict) -> bool:
    """Whether the run corrects its rig, or has an error of it that is above the noise."""
    corrected = rig["row_correction_px"] or any(rig.get("right_camera", {}).values())
    seen = [rig["rows"]["before"], rig["columns"]["after"]]
    return bool(corrected) or any(found["cells"] > 0 and not is_noise(found) for found in seen)


def rows_text(rig: dict) -> str:
    """What the maps of vertical residuals are, and whether the search corrects them."""
    text = "Vertical residuals: distances of points from their epipolar lines, positive downwards in rectified images. "
    if rig["row_correction_px"]:
        return text + f"The search corrects them by up to {rig['row_correction_px']:.2f} px, learned from these points."
    if is_noise(rig["rows"]["before"]):
        return text + "No errors above the noise level."
    return text + "They are off, but by too little or with too few points to be corrected."


def columns_text(rig: dict) -> str:
    """What is learned from horizontal residuals, and what their maps are."""
    start, end = (f"{round(value['px'], 2) + 0.0:+.2f}{PLUS_MINUS}{value['sigma_px']:.2f} px"
                  for value in map(rig["disparity_offset"].get, ("start", "end")))
    text = (f"Horizontal residuals: a common offset of all disparities is estimated, {start} at the start, {end} at "
            f"the end. Beside it, the calibration leaves errors of {rig['disparity_error_px']:.2f} px in disparities. "
            "The maps show measured minus predicted disparity at new keyframes; the prediction uses the "
            "points of the previous keyframe and the estimated motion. Errors of the calibration that both keyframes "
            "share cancel, so only those that depend on depth or image position show.")
    return text + (" No errors above the noise level." if is_noise(rig["columns"]["after"]) else "")


def rig_figures(run: Run) -> list[Figure]:
    """Maps of vertical and horizontal residuals, before and after, each pair with one scale."""
    if run.count() < FEWEST_FRAMES or not run.rig_maps:
        return []
    figures, rig = [], run.report["rig"]
    for axis, title in TITLES.items():
        maps = {text: run.rig_maps[f"{axis}_{state}"] for state, text in STATES.items()}
        limit = float(np.nanmax(np.abs(list(maps.values())), initial=LEAST_LIMIT))
        figures += [Figure(f"{run.name}_{axis}_{state}", f"{title}, {text}", "x in the right image [px]", "y [px]",
                           x_range=(-0.5, rig["width"] - 0.5), y_range=(rig["height"] - 0.5, -0.5), cells=cells,
                           cell_limit=limit, cell_label="[px]")
                    for state, (text, cells) in zip(STATES, maps.items())]
    return figures
