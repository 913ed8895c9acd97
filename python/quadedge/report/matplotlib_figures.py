"""Writes figures as SVG and PDF files."""

from pathlib import Path

import matplotlib
import numpy as np

from .figure import COLOURS, DASHES, SYMBOLS, Figure, Series

matplotlib.use("Agg")  # no window
from matplotlib import pyplot, ticker  # noqa: E402  the backend is chosen before

_DASHES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-.", "longdash": (0, (8, 3)),
           "longdashdot": (0, (8, 3, 1, 3))}
_SYMBOLS = {"circle": "o", "triangle-up": "^", "x": "x", "square": "s", "diamond": "D", "cross": "P", "star": "*"}
_STYLE = {"svg.hashsalt": "quadedge", "svg.fonttype": "none", "font.size": 9, "axes.grid": True, "grid.alpha": 0.35,
          "axes.spines.top": False, "axes.spines.right": False}


def _draw(axes, figure: Figure, series: Series, below: np.ndarray | None) -> None:
    colour = COLOURS[series.style % len(COLOURS)]
    x, y = np.asarray(series.x, float), np.asarray(series.y, float)
    parts = (x, y, np.asarray(series.z, float)) if figure.is_spatial else (x, y)
    if series.points:
        symbol = _SYMBOLS[SYMBOLS[series.style % len(SYMBOLS)]]
        axes.plot(*parts, linestyle="", marker=symbol, markersize=4, color=colour, label=series.name)
        return
    marker = _SYMBOLS[SYMBOLS[series.style % len(SYMBOLS)]] if figure.categories else ""
    dash = _DASHES[series.dash or ("solid" if series.fill else DASHES[series.style % len(DASHES)])]
    axes.plot(*parts, linestyle=dash, marker=marker, markersize=4, linewidth=1.4, color=colour, label=series.name)
    if series.fill:
        floor = below if series.fill == "below" and below is not None else 0
        axes.fill_between(x, floor, y, color=colour, alpha=0.3, linewidth=0)


def _finish(axes, figure: Figure) -> None:
    axes.set_title(figure.spatial_title() if figure.is_spatial else figure.title)
    axes.set_xlabel(figure.x_label)
    axes.set_ylabel(figure.y_label)
    if figure.is_spatial:
        axes.set_zlabel(figure.z_label)
        axes.set_box_aspect(figure.lengths(1), zoom=0.85)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(ticker.MaxNLocator(4))
        return
    for marker in figure.markers:
        axes.axvline(marker.x, color=COLOURS[5], linestyle="--", linewidth=1, label=marker.text or None)
    if figure.categories:
        axes.set_xticks(range(len(figure.categories)), figure.categories, rotation=40, ha="right")
    if figure.x_range:
        axes.set_xlim(*figure.x_range)
    if figure.y_range:
        axes.set_ylim(*figure.y_range)
    if figure.y_logarithmic:
        axes.set_yscale("log")
    if figure.equal_units:
        axes.set_aspect("equal", adjustable="datalim")


def write_figure(figure: Figure, folder: Path) -> list[Path]:
    """Writes FOLDER/NAME.svg and FOLDER/NAME.pdf and returns their paths. The same figure gives the same bytes."""
    with pyplot.rc_context(_STYLE):
        picture, axes = pyplot.subplots(figsize=(7 if figure.wide else 5, 4), layout="constrained",
                                        subplot_kw={"projection": "3d"} if figure.is_spatial else {})
        below = None
        for series in figure.series:
            _draw(axes, figure, series, below)
            below = np.asarray(series.y, float)
        _finish(axes, figure)
        if any(series.name for series in figure.series):
            axes.legend(fontsize=8, framealpha=0.6)
        files = [folder / f"{figure.name}.svg", folder / f"{figure.name}.pdf"]
        picture.savefig(files[0], metadata={"Date": None})
        picture.savefig(files[1], metadata={"CreationDate": None})
        pyplot.close(picture)
    return files
