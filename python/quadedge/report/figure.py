"""Figures in plotly's format, which pages give to plotly in the browser."""

from dataclasses import dataclass, field

import numpy as np

# Blue, orange, magenta, green, violet, grey, brown: distinguishable for colour-blind readers on light and dark pages.
COLOURS = ("#2f80d0", "#e08a00", "#c63f9d", "#2a9d7c", "#7a5af0", "#8a8f98", "#a0522d")
GREY = 5
# Each style also has a line style and a marker; plotly has fewer markers in space.
_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "solid", "longdashdot")
_SYMBOLS = ("circle", "triangle-up", "x", "square", "diamond", "cross", "star")
_SPATIAL_SYMBOLS = ("circle", "square", "diamond", "circle-open", "square-open", "diamond-open", "circle")
_SHORTEST = 0.02  # axis of a 3D plot, of the longest, so that a flat path has an axis
_POINT_SCALE = "Viridis"  # of points that are coloured by a value
_DIGITS = 5
FEWEST_FRAMES = 10  # fewer frames are not plotted


@dataclass
class Figure:
    """A plot of curves and point clouds with two axes, or three if they have a z."""

    name: str
    """Unique on a page."""
    title: str
    x_label: str
    y_label: str
    z_label: str = ""
    traces: list[dict] = field(default_factory=list)
    """Curves and point clouds, as plotly takes them, with unrounded arrays."""
    categories: list[str] | None = None
    """Labels of the x values 0, 1, ..."""
    y_range: tuple[float, float] | None = None
    equal_units: bool = False
    wide: bool = False
    """Spans the width of the page."""

    def add(self, name: str, x, y, z=None, *, style: int = 0, points: bool = False, fill: str = "", dash: str = "",
            times: np.ndarray | None = None, hover: list[str] | None = None, labels: list[str] | None = None) -> None:
        """Adds a curve, which NaN in y interrupts, or a cloud of points.

        style: index of colour, line style and marker. dash: another line style. fill: fills the area down to zero
        ("zero") or to the previous curve ("below"). times: of the points [s], if no axis shows them. hover: texts.
        labels: texts beside the points.
        """
        spatial, colour = z is not None, COLOURS[style % len(COLOURS)]
        symbol = (_SPATIAL_SYMBOLS if spatial else _SYMBOLS)[style % len(_SYMBOLS)]
        axes = dict(zip("xyz", (np.asarray(values, float) for values in (x, y, z) if values is not None)))
        trace = {"name": name, "type": "scatter3d" if spatial else "scatter", **axes}
        if self.categories:
            trace["x"] = [self.categories[int(i)] for i in x]
        if points:
            trace |= {"mode": "markers", "marker": {"color": colour, "symbol": symbol, "size": 3 if spatial else 6}}
        else:
            line = dash or ("solid" if fill else _DASHES[style % len(_DASHES)])
            trace |= {"mode": "lines", "line": {"color": colour, "dash": line, "width": 6 if spatial else 2}}
            if self.categories:
                trace |= {"mode": "lines+markers", "marker": {"symbol": symbol, "size": 7}}
        if fill:
            opacity = "30" if style == GREY else "55"
            trace |= {"fill": "tozeroy" if fill == "zero" else "tonexty", "fillcolor": colour + opacity}
        if times is not None:
            position = "(%{x}, %{y}, %{z})" if spatial else "(%{x}, %{y})"
            trace |= {"customdata": times, "hovertemplate": position + "<br>%{customdata} s"}
        if labels:
            trace |= {"mode": "markers+text", "text": labels, "textposition": "bottom right", "hoverinfo": "x+text"}
        if hover:
            trace |= {"text": hover, "hoverinfo": "text+x+y" + ("+z" if spatial else "")}
        self.traces.append(trace)

    def add_cloud(self, name: str, x, y, z, values) -> None:
        """Adds points in space, each coloured by its value."""
        axes = dict(zip("xyz", (np.asarray(axis, float) for axis in (x, y, z))))
        marker = {"color": np.asarray(values, float), "colorscale": _POINT_SCALE, "size": 1.6, "opacity": 0.85}
        self.traces.append({"name": name, "type": "scatter3d", **axes, "mode": "markers", "marker": marker,
                            "hoverinfo": "skip"})

    @property
    def is_spatial(self) -> bool:
        return any("z" in trace for trace in self.traces)

    def shares(self) -> list[float]:
        """Lengths of the three axes of a plot in space, which have one scale: the longest is 1."""
        extents = [float(np.nanmax(values) - np.nanmin(values)) for values in
                   (np.concatenate([trace[axis] for trace in self.traces]) for axis in "xyz")]
        return [max(extent / max(*extents, 1e-9), _SHORTEST) for extent in extents]

    def _axis(self, axis: str) -> dict:
        shown = {"title": {"text": getattr(self, f"{axis}_label")}, "automargin": True}
        return shown | ({"range": list(self.y_range)} if axis == "y" and self.y_range else {})

    def plotly(self) -> dict:
        """The `data` and `layout` arguments of Plotly.newPlot. The page adds size, fonts and background colours."""
        layout: dict = {"title": {"text": self.title}}
        if self.is_spatial:
            shares = self.shares()
            layout["scene"] = {"aspectmode": "manual", "aspectratio": dict(zip("xyz", shares))} | {
                f"{axis}axis": self._axis(axis) | {"nticks": max(2, round(8 * share))}
                for axis, share in zip("xyz", shares)}
            return {"data": self.traces, "layout": layout}
        x, y = layout["xaxis"], layout["yaxis"] = self._axis("x"), self._axis("y")
        if self.categories:
            x |= {"type": "category", "categoryarray": self.categories, "categoryorder": "array", "tickangle": -40}
        if self.equal_units:
            y |= {"scaleanchor": "x", "scaleratio": 1}
        elif self.y_range is None and all(np.nanmin(trace["y"], initial=0) >= 0 for trace in self.traces):
            y["rangemode"] = "tozero"
        return {"data": self.traces, "layout": layout}


def rounded(values: np.ndarray) -> list:
    """An array as JSON has it: few digits, None for NaN."""
    return [float("%.*g" % (_DIGITS, value)) if value == value else None for value in values.tolist()]


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
