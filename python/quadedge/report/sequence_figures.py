"""Figures of one sequence: trajectory, errors, numbers of edges and quads, time per frame by stage."""

import numpy as np

from .figure import FEWEST_FRAMES, GREY, Figure, every, thinned
from .numbers import DEGREE, Unit, length_unit, significant
from .results import Run, Trajectory, is_lost

TIME = "time since the first frame [s]"
SLOW = 3  # times the 90th percentile
MOST_SLOW = 4  # that are marked
STAGE = "_ms"  # end of the names of their columns
MAP_STYLE, CLOSURE_STYLE = 4, 6  # segments have the styles below
EDGES = 8  # points of edges in space per point of a curve
AROUND = (1, 99)  # percentiles of the edges that the plot in space shows
PREDICTED = 1.5  # largest error in the plot that the band of predicted ones may stretch it to
MOST_KEY_RIGS = 0.4  # of the frames, to be marked


def _key_rig_stamps(run: Run) -> np.ndarray:
    """Of the frames that became keyframes; none where so many did that their marks would hide the curves."""
    chosen = (run.frames["new_key_rig"] == "1").to_numpy()
    return run.column("stamp_s")[chosen & (chosen.mean() < MOST_KEY_RIGS)]


def _at(stamps: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Indices of the stamps that are among those wanted."""
    return np.nonzero(np.isin(np.round(stamps, 6), np.round(wanted, 6)))[0]


def _paths(run: Run) -> list[tuple[str, Trajectory, int, str]]:
    """Name, poses, style and line style of every trajectory, starting with the ground truth."""
    paths = [("ground truth", run.truth, GREY, "dash")] if run.truth else []
    for segment, indices in run.segments():
        name = f"QuadEdge, segment {segment}" if segment else "QuadEdge"
        paths.append((name, run.estimate.part(indices), segment % MAP_STYLE, "solid"))
    if run.corrected:
        paths.append(("QuadEdge, loops closed", run.corrected, MAP_STYLE, "solid"))
    return paths


def _closures(run: Run) -> np.ndarray:
    """Positions of the two frames of every kept closure and a row of NaN, one after another, in the map [m]."""
    if not run.corrected:
        return np.empty((0, 3))
    stamps = run.column("stamp_s")
    ends = []
    for frame, other, verdict in zip(run.loops["frame"], run.loops["other"], run.loops["verdict"]):
        both = _at(run.corrected.stamps, stamps[[int(other), int(frame)]])
        if verdict == "kept" and len(both) == 2:
            ends += [*run.corrected.positions[both], np.full(3, np.nan)]
    return np.array(ends).reshape(-1, 3)


def _around(edges: np.ndarray, path: np.ndarray, limit: int) -> np.ndarray:
    """At most about `limit` edges, without the few that lie far from the others and from the path."""
    if not len(edges):
        return edges
    low, high = np.percentile(edges, AROUND, axis=0)
    low, high = np.minimum(low, path.min(axis=0)), np.maximum(high, path.max(axis=0))
    inside = edges[((edges >= low) & (edges <= high)).all(axis=1)]
    return inside[every(len(inside), limit)]


def trajectory_figures(run: Run, points: int) -> list[Figure]:
    """The trajectory in 3D among edges, from above and from the side."""
    if run.count() < FEWEST_FRAMES or len(run.estimate) < 2:
        return []
    paths = _paths(run)
    unit = length_unit(np.concatenate([path.positions.ravel() for _, path, _, _ in paths]))
    name = unit.name
    labels = {"x": f"x to the right [{name}]", "y": f"-y upward [{name}]", "z": f"z forward [{name}]"}
    space = Figure(f"{run.name}_trajectory", "Path and edges in space" if len(run.edges) else "Path in space",
                   labels["x"], labels["z"], labels["y"], wide=True)
    above = Figure(f"{run.name}_from_above", "Path from above", labels["x"], labels["z"], equal_units=True)
    side = Figure(f"{run.name}_from_the_side", "Path from the side", labels["z"], labels["y"], equal_units=True,
                  wide=True)
    rigs = _at(run.estimate.stamps, _key_rig_stamps(run))
    clouds = [(text, path.positions[every(len(path), points)], path.stamps[every(len(path), points)], style, dash,
               False) for text, path, style, dash in paths]
    chosen = rigs[every(len(rigs), points)]
    clouds.append(("new keyframe", run.estimate.positions[chosen], run.estimate.stamps[chosen], 2, "", True))
    for text, positions, stamps, style, dash, is_cloud in clouds:
        if not len(positions):
            continue
        x, y, z = (positions * unit.factor).T
        common = {"style": style, "points": is_cloud, "dash": dash, "times": stamps - run.start}
        space.add(text, x, z, -y, **common)
        above.add(text, x, z, **common)
        side.add(text, z, -y, **common)
    edges = _around(run.edges, run.estimate.positions, EDGES * points)
    if len(edges):
        x, y, z = (edges * unit.factor).T
        space.add_cloud("edges, by height", x, z, -y, -y)
    lines = _closures(run)
    if len(lines):
        x, y, z = (lines * unit.factor).T
        above.add("closures", x, z, style=CLOSURE_STYLE, dash="dot")
    return [space, above, side]


def error_figures(run: Run, points: int) -> list[Figure]:
    """Absolute errors, above bands of the deviations that the covariances predict, and errors per frame."""
    if run.errors is None or run.count() < FEWEST_FRAMES:
        return []
    figures, stamps = [], run.errors["stamp_s"].to_numpy()
    for key, title, quantity in (("ape_translation_m", "Position error (APE)", "APE translation"),
                                 ("ape_rotation_deg", "Orientation error (APE)", "APE rotation"),
                                 ("rpe_translation_m", "Position error per frame (RPE)", "RPE translation"),
                                 ("rpe_rotation_deg", "Orientation error per frame (RPE)", "RPE rotation")):
        values = run.errors[key].to_numpy()
        unit = length_unit(values) if key.endswith("_m") else DEGREE
        figure = Figure(f"{run.name}_{key.rsplit('_', 1)[0]}", title, TIME, f"{quantity} [{unit.name}]")
        figure.add("QuadEdge", *thinned(stamps - run.start, values * unit.factor, points))
        if key in run.predicted:
            _add_predicted(figure, run, key, unit, points, float(np.nanmax(values, initial=0)) * unit.factor)
        rigs = _at(stamps, _key_rig_stamps(run))
        rigs = rigs[every(len(rigs), points)]
        figure.add("new keyframe", stamps[rigs] - run.start, values[rigs] * unit.factor, style=2, points=True)
        figures.append(figure)
    return figures


def _add_predicted(figure: Figure, run: Run, key: str, unit: Unit, points: int, largest: float) -> None:
    """Adds the band from 0 to the predicted standard deviation, cut off where it would flatten the errors."""
    stamps, predicted = run.predicted[key]
    predicted = predicted * unit.factor
    top = float(np.nanmax(predicted, initial=0))
    within = ", within the segment" if run.report.get("segments", 1) > 1 else ""
    beyond = largest > 0 and top > PREDICTED * largest
    if beyond:
        figure.y_range = (0, PREDICTED * largest)
    up_to = f", up to {significant(top, 2)} {unit.name}" if beyond else ""
    figure.add("predicted standard deviation" + within + up_to,
               *thinned(stamps - run.start, predicted, points), style=GREY, dash="dot", fill="zero")


def frame_figures(run: Run, points: int) -> list[Figure]:
    """Edges and quads of every frame."""
    if run.count() < FEWEST_FRAMES:
        return []
    edges = Figure(f"{run.name}_edges", "Edges", TIME, "edges per frame")
    for style, (column, text) in enumerate((("edges_left", "left"), ("edges_right", "right"),
                                            ("stereo_edges", "stereo edges"))):
        edges.add(text, *thinned(run.times, run.column(column), points), style=style)
    quads = Figure(f"{run.name}_quads", "Quads, and the inliers of the pose", TIME, "quads per frame")
    for style, column in enumerate(("quads", "inliers")):
        quads.add(column, *thinned(run.times, run.column(column), points), style=style)
    lost = run.frames["status"].map(is_lost).to_numpy()
    if lost.any():
        chosen = np.nonzero(lost)[0][every(int(lost.sum()), points)]
        hover = [run.frames["status"][index] for index in chosen]
        quads.add("lost frame", run.times[chosen], np.zeros(len(chosen)), style=2, points=True, hover=hover)
    return [edges, quads]


def _stages(run: Run) -> list[str]:
    """The columns of the stages, in the order of their work."""
    names = list(run.frames)
    return [name for name in names[names.index("latency_ms") + 1:] if name.endswith(STAGE)]


def latency_figures(run: Run, points: int) -> list[Figure]:
    """The time of every frame as a stack of its stages, with the remainder on top. Slow frames, which would flatten the
    others, are marked at the upper end with their time."""
    if run.count() < FEWEST_FRAMES:
        return []
    figure = Figure(f"{run.name}_latency", "Time per frame, by stage", TIME, "time [ms]", wide=True)
    latency = run.column("latency_ms")
    slow = np.nonzero(latency > SLOW * np.nanpercentile(latency, 90))[0]
    slow = slow[np.argsort(-latency[slow], kind="stable")]
    top = 1.5 * float(np.nanmax(np.delete(latency, slow)))
    if len(slow):
        figure.y_range = (0, top)
    chosen = every(run.count(), points)
    floor = np.zeros(len(chosen))
    for style, stage in enumerate(_stages(run)):
        floor = floor + np.nan_to_num(run.column(stage)[chosen])
        figure.add(stage.removesuffix(STAGE), run.times[chosen], floor, style=style % 5,
                   fill="below" if style else "zero")
    figure.add("rest", run.times[chosen], np.maximum(latency[chosen], floor), style=GREY, fill="below")
    if len(slow):
        shown = sorted(slow[:MOST_SLOW])
        figure.add("slower than the plot", run.times[shown], np.full(len(shown), 0.97 * top), style=6, points=True,
                   labels=[f"frame {frame}: {latency[frame]:.0f} ms" for frame in shown])
    return [figure]
