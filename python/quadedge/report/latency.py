"""A plot of the time per frame, by stage."""

import numpy as np

from .figure import FEWEST_FRAMES, GREY, Figure, every
from .results import Run

TIME = "time since the first frame [s]"
SLOW = 3  # times the 90th percentile
MOST_SLOW = 4  # that are marked
STAGE = "_ms"  # end of the names of their columns


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
