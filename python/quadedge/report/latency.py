"""The time per frame: a plot by stage, and why single frames are slow."""

import numpy as np

from .figure import FEWEST_FRAMES, GREY, Figure, every
from .results import Run, is_lost

TIME = "time since the first frame [s]"
SLOW = 3  # a frame is slow from this many medians on
MOST_SLOW = 4  # that are explained
WARM_UP = 3  # frames in which a driver may finish kernels
RICH = 1.5  # a frame has many edges from this many medians on
STAGE = "_ms"  # end of the names of their columns


def _stages(run: Run) -> list[str]:
    """The columns of the stages, in the order of their work."""
    names = list(run.frames)
    return [name for name in names[names.index("latency_ms") + 1:] if name.endswith(STAGE)]


def slow_frames(run: Run) -> list[int]:
    """Frames that took several times the median, slowest first."""
    latency = run.column("latency_ms")
    slow = np.nonzero(latency > SLOW * np.nanmedian(latency))[0]
    return [int(frame) for frame in slow[np.argsort(-latency[slow], kind="stable")]]


def latency_figures(run: Run, points: int) -> list[Figure]:
    """The time of every frame as a stack of its stages, with the remainder on top. Slow frames, which would flatten the
    others, are marked at the upper end with their time."""
    if run.count() < FEWEST_FRAMES:
        return []
    figure = Figure(f"{run.name}_latency", "Time per frame, by stage", TIME, "time [ms]", wide=True)
    latency = run.column("latency_ms")
    slow = [frame for frame in slow_frames(run) if latency[frame] > 3 * np.nanpercentile(latency, 90)]
    top = 1.5 * float(np.nanmax(np.delete(latency, slow)))
    if slow:
        figure.y_range = (0, top)
    chosen = every(run.count(), points)
    floor = np.zeros(len(chosen))
    for style, stage in enumerate(_stages(run)):
        floor = floor + np.nan_to_num(run.column(stage)[chosen])
        figure.add(stage.removesuffix(STAGE), run.times[chosen], floor, style=style % 5,
                   fill="below" if style else "zero")
    figure.add("rest", run.times[chosen], np.maximum(latency[chosen], floor), style=GREY, fill="below")
    if slow:
        shown = sorted(slow[:MOST_SLOW])
        figure.add("slower than the plot", run.times[shown], np.full(len(shown), 0.97 * top), style=6, points=True,
                   labels=[f"frame {frame}: {latency[frame]:.0f} ms" for frame in shown])
    return [figure]


def slow_texts(run: Run) -> list[str]:
    """A sentence or two on every slow frame."""
    frames = slow_frames(run)
    texts = [_why_slow(run, frame) for frame in frames[:MOST_SLOW]]
    if len(frames) > MOST_SLOW:
        texts.append(f"{len(frames) - MOST_SLOW} more frames took over {SLOW} times the median.")
    return texts


def _why_slow(run: Run, frame: int) -> str:
    latency, edges = run.column("latency_ms"), run.column("edges_left")
    stages = {name.removesuffix(STAGE): float(np.nan_to_num(run.column(name)[frame])) for name in _stages(run)}
    slowest = max(stages, key=stages.get, default="")
    text = f"Frame {frame} took {latency[frame]:.0f} ms" + (
        f", {stages[slowest]:.0f} ms of it in the stage \"{slowest}\"." if slowest else ".")
    if frame < WARM_UP:
        return text + (" OpenCL drivers finish compiling a kernel where it first runs; later runs on this machine take "
                       "it from the driver's cache.")
    if is_lost(run.frames["status"][frame]):
        return text + " It was lost: all searches were tried in turn."
    if edges[frame] > RICH * np.nanmedian(edges):
        return text + f" It has {edges[frame]:.0f} edges; the median is {np.nanmedian(edges):.0f}."
    before = frame > 0 and is_lost(run.frames["status"][frame - 1])
    if before:
        return text + " The frame before was lost, so that its motion was searched more widely."
    return text + " Its counts are like those of the other frames: another program may have used the processor."
