"""A figure as data: what it shows, not how it is drawn. The page draws it with plotly, files with matplotlib."""

from dataclasses import dataclass, field

import numpy as np

# Blue, orange, magenta, green, violet, grey: told apart by colour-blind readers, on white and on dark grounds.
COLOURS = ("#2f80d0", "#e08a00", "#c63f9d", "#2a9d7c", "#7a5af0", "#8a8f98", "#a0522d")
GREY = 5
# Beside its colour each series has a dash and a shape; both in plotly's words.
DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "solid", "longdashdot")
SYMBOLS = ("circle", "triangle-up", "x", "square", "diamond", "cross", "star")
_SHORTEST = 0.25  # of the longest axis of a plot in space
FEWEST_FRAMES = 10  # a plot over fewer frames says less than the tables


@dataclass
class Series:
    """One curve or cloud of points. `y` may hold NaN, where a curve is interrupted."""

    name: str
    x: np.ndarray | list
    y: np.ndarray | list
    z: np.ndarray | list | None = None
    style: int = 0
    """Number of its colour, dash and shape."""
    points: bool = False
    """Shapes instead of a curve."""
    fill: str = ""
    """"zero": the area below the curve, "below": down to the series before."""
    dash: str = ""
    """Instead of the style's."""
    times: np.ndarray | None = None
    """Of the points [s], where no axis tells them."""
    hover: list[str] | None = None
    """One text per point, where the numbers do not say enough."""


@dataclass
class Marker:
    """A vertical line at a value of x."""

    x: float
    text: str


@dataclass
class Figure:
    """A plot of series over two axes, or three where the series have a z."""

    name: str
    """Of its files; unique on a page."""
    title: str
    x_label: str
    y_label: str
    z_label: str = ""
    series: list[Series] = field(default_factory=list)
    markers: list[Marker] = field(default_factory=list)
    categories: list[str] | None = None
    """Names instead of the numbers 0, 1, ... on the axis of x."""
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    y_logarithmic: bool = False
    equal_units: bool = False
    wide: bool = False
    """Over the width of the page."""

    @property
    def is_spatial(self) -> bool:
        return any(series.z is not None for series in self.series)

    def lengths(self, longest: float) -> list[float]:
        """Of the three axes. A straight road would be nothing but a line: none is shorter than a quarter."""
        return [longest * max(share, _SHORTEST) for share in self._shares()]

    def spatial_title(self) -> str:
        """The title, which says where the axes are not to one scale."""
        return self.title + ("" if min(self._shares()) >= _SHORTEST else " (axes not to one scale)")

    def _shares(self) -> list[float]:
        extents = []
        for axis in ("x", "y", "z"):
            values = np.concatenate([np.asarray(getattr(series, axis), float) for series in self.series])
            extents.append(float(np.nanmax(values) - np.nanmin(values)))
        return [extent / max(*extents, 1e-9) for extent in extents]


def thinned(x: np.ndarray, y: np.ndarray, limit: int) -> tuple[np.ndarray, np.ndarray]:
    """At most about `limit` points of a curve: of every stretch the lowest and the highest, so that no peak is lost."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    if len(x) <= limit:
        return x, y
    kept: list[int] = []
    for stretch in np.array_split(np.arange(len(x)), max(limit // 2, 1)):
        there = stretch[np.isfinite(y[stretch])]
        if len(there):
            kept += sorted({int(there[np.argmin(y[there])]), int(there[np.argmax(y[there])])})
    return x[kept], y[kept]


def every(count: int, limit: int) -> np.ndarray:
    """Indices of at most about `limit` of so many points, the first and the last among them."""
    step = max(1, -(-count // limit))
    indices = np.arange(0, count, step)
    return indices if count == 0 or indices[-1] == count - 1 else np.append(indices, count - 1)
