"""Figures as data, independent of how they are drawn: by plotly on pages, by matplotlib in files."""

from dataclasses import dataclass, field

import numpy as np

# Blue, orange, magenta, green, violet, grey, brown: distinguishable for colour-blind readers on light and dark pages.
COLOURS = ("#2f80d0", "#e08a00", "#c63f9d", "#2a9d7c", "#7a5af0", "#8a8f98", "#a0522d")
GREY = 5
# Each series also has a line style and a marker, with plotly's names.
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "solid", "longdashdot")
SYMBOLS = ("circle", "triangle-up", "x", "square", "diamond", "cross", "star")
_SHORTEST = 0.25  # of the longest axis of a 3D plot
FEWEST_FRAMES = 10  # fewer frames are not plotted


@dataclass
class Series:
    """A curve or point cloud. NaN in `y` interrupts a curve."""

    name: str
    x: np.ndarray | list
    y: np.ndarray | list
    z: np.ndarray | list | None = None
    style: int = 0
    """Index of colour, line style and marker."""
    points: bool = False
    """Markers instead of a curve."""
    fill: str = ""
    """Fills the area down to zero ("zero") or to the previous series ("below")."""
    dash: str = ""
    """Line style instead of that of `style`."""
    times: np.ndarray | None = None
    """Times of the points [s], if no axis shows them."""
    hover: list[str] | None = None
    """A hover text per point."""


@dataclass
class Marker:
    """A labelled vertical line."""

    x: float
    text: str


@dataclass
class Figure:
    """A plot of series with two axes, or three if the series have a z."""

    name: str
    """Name of its files; unique on a page."""
    title: str
    x_label: str
    y_label: str
    z_label: str = ""
    series: list[Series] = field(default_factory=list)
    markers: list[Marker] = field(default_factory=list)
    categories: list[str] | None = None
    """Labels of the x values 0, 1, ..."""
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    y_logarithmic: bool = False
    equal_units: bool = False
    wide: bool = False
    """Spans the width of the page."""

    @property
    def is_spatial(self) -> bool:
        return any(series.z is not None for series in self.series)

    def lengths(self, longest: float) -> list[float]:
        """Lengths of the three axes, at least a quarter of the longest, so that a straight path remains visible."""
        return [longest * max(share, _SHORTEST) for share in self._shares()]

    def spatial_title(self) -> str:
        """The title, with a remark if the axes are not to one scale."""
        return self.title + ("" if min(self._shares()) >= _SHORTEST else " (axes not to one scale)")

    def _shares(self) -> list[float]:
        extents = []
        for axis in ("x", "y", "z"):
            values = np.concatenate([np.asarray(getattr(series, axis), float) for series in self.series])
            extents.append(float(np.nanmax(values) - np.nanmin(values)))
        return [extent / max(*extents, 1e-9) for extent in extents]


def thinned(x: np.ndarray, y: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """At most about `limit` points of a curve: the lowest and the highest of every interval, so that peaks remain."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    if len(x) <= limit:
        return x, y
    kept: list[int] = []
    for stretch in np.array_split(np.arange(len(x)), max(limit // 2, 1)):
        finite = stretch[np.isfinite(y[stretch])]
        if len(finite):
            kept += sorted({int(finite[np.argmin(y[finite])]), int(finite[np.argmax(y[finite])])})
    return x[kept], y[kept]


def every(count: int, limit: int) -> np.ndarray:
    """Evenly spaced indices of at most about `limit` of `count` points, including the first and the last."""
    step = max(1, -(-count // limit))
    indices = np.arange(0, count, step)
    return indices if count == 0 or indices[-1] == count - 1 else np.append(indices, count - 1)
