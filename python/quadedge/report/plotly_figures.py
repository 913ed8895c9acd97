"""Converts figures to plotly's format, as dictionaries: plotly itself runs only in the browser."""

import numpy as np

from .figure import COLOURS, DASHES, SYMBOLS, Figure, Series

_DIGITS = 5
_SPATIAL_SYMBOLS = ("circle", "square", "diamond", "circle-open", "square-open", "diamond-open", "circle")


def _values(values) -> list:
    """Rounded numbers; None where a curve is interrupted."""
    exact = np.asarray(values, float).tolist()
    return [float("%.*g" % (_DIGITS, value)) if value == value else None for value in exact]


def _trace(figure: Figure, series: Series) -> dict:
    colour = COLOURS[series.style % len(COLOURS)]
    symbols = _SPATIAL_SYMBOLS if figure.is_spatial else SYMBOLS
    symbol = symbols[series.style % len(symbols)]
    x = [figure.categories[int(i)] for i in series.x] if figure.categories else _values(series.x)
    trace = {"name": series.name, "x": x, "y": _values(series.y)}
    if figure.is_spatial:
        trace |= {"type": "scatter3d", "z": _values(series.z)}
    else:
        trace["type"] = "scatter"
    if series.points:
        size = 3 if figure.is_spatial else 6
        trace |= {"mode": "markers", "marker": {"color": colour, "symbol": symbol, "size": size}}
    else:
        dash = series.dash or ("solid" if series.fill else DASHES[series.style % len(DASHES)])
        trace |= {"mode": "lines", "line": {"color": colour, "dash": dash, "width": 4 if figure.is_spatial else 2}}
        if figure.categories:
            trace |= {"mode": "lines+markers", "marker": {"symbol": symbol, "size": 7}}
    if series.fill:
        trace |= {"fill": "tozeroy" if series.fill == "zero" else "tonexty", "fillcolor": colour + "55"}
    if series.times is not None:
        position = "(%{x}, %{y}, %{z})" if figure.is_spatial else "(%{x}, %{y})"
        trace |= {"customdata": _values(series.times), "hovertemplate": position + "<br>%{customdata} s"}
    if series.hover:
        trace |= {"text": series.hover, "hoverinfo": "text+x+y" + ("+z" if figure.is_spatial else "")}
    return trace


def _axis(label: str, limits: tuple[float, float] | None = None) -> dict:
    axis = {"title": {"text": label}, "automargin": True}
    if limits:
        axis["range"] = list(limits)
    return axis


def to_plotly(figure: Figure) -> dict:
    """The `data` and `layout` arguments of Plotly.newPlot. The page adds size, fonts and background colours."""
    data = [_trace(figure, series) for series in figure.series]
    layout: dict = {"title": {"text": figure.title}}
    if figure.is_spatial:
        layout["title"]["text"] = figure.spatial_title()
        layout["scene"] = {"xaxis": _axis(figure.x_label), "yaxis": _axis(figure.y_label),
                           "zaxis": _axis(figure.z_label), "aspectmode": "manual",
                           "aspectratio": dict(zip("xyz", figure.lengths(1.4))),
                           "camera": {"eye": {"x": -0.85, "y": -1.5, "z": 0.8},
                                      "center": {"x": 0, "y": 0, "z": -0.12}}}
        return {"data": data, "layout": layout}
    layout["xaxis"] = _axis(figure.x_label, figure.x_range)
    layout["yaxis"] = _axis(figure.y_label, figure.y_range)
    if figure.categories:
        layout["xaxis"] |= {"type": "category", "categoryarray": figure.categories, "categoryorder": "array",
                            "tickangle": -40}
    if figure.y_logarithmic:
        layout["yaxis"] |= {"type": "log", "dtick": 1}
    elif figure.y_range is None and not figure.equal_units and all(np.nanmin(series.y, initial=0) >= 0
                                                                   for series in figure.series):
        layout["yaxis"]["rangemode"] = "tozero"
    if figure.equal_units:
        layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1}
    layout["shapes"] = [{"type": "line", "x0": marker.x, "x1": marker.x, "yref": "paper", "y0": 0, "y1": 1,
                         "line": {"dash": "dash", "width": 1.5, "color": COLOURS[5]}} for marker in figure.markers]
    layout["annotations"] = [{"x": marker.x, "yref": "paper", "y": 1, "yanchor": "bottom", "showarrow": False,
                              "text": marker.text} for marker in figure.markers if marker.text]
    return {"data": data, "layout": layout}
