"""Figures of the matching evaluation (`python -m quadedge.matching`)."""

import numpy as np

from .figure import Figure
from .matching_tables import POOLS
from .numbers import exists, length_unit, short_count

MOST_POINTS = 130  # of a curve; finer bins are merged


def frames_of(pairs: list[dict]) -> int:
    return sum(len(pair["counts"]) for pair in pairs)


def filter_figure(key: str, title: str, summary: dict) -> Figure:
    """Recall and precision of both pools after every filter, by the filter's name. Disabled filters are omitted."""
    rows = [row for row in summary[key] if not row.get("off")]
    figure = Figure(f"filters_{key}", title, "", "share [%]", categories=[row["filter"] for row in rows],
                    y_range=(0, 102))
    for number, (pool, suffix) in enumerate(POOLS):
        shown = [row for row in summary[f"{key}{suffix}"] if not row.get("off")]
        for style, share in enumerate(("recall", "precision")):
            values = [100 * row[share] if exists(row[share]) else np.nan for row in shown]
            figure.add(f"{share}, {pool}", np.arange(len(values)), values, style=style + 2 * number,
                       dash="dash" if number else "solid")
    return figure


class _Curves:
    """The density over the bins within a range, and the cumulative share of all values at the ends of the bins."""

    def __init__(self, low: float, high: float, counts: dict, shown: tuple[float, float]):
        bins = np.array(counts["bins"], float)
        edges = np.linspace(low, high, len(bins) + 1)
        self.total = counts["below"] + bins.sum() + counts["above"]
        first = int(np.clip(np.searchsorted(edges, shown[0], "right") - 1, 0, len(bins) - 1))
        last = int(np.clip(np.searchsorted(edges, shown[1], "left"), first + 1, len(bins)))
        step = max(1, -(-(last - first) // MOST_POINTS))
        starts = np.arange(first, last, step)
        ends = np.minimum(starts + step, last)
        sums = np.array([bins[start:end].sum() for start, end in zip(starts, ends)])
        inside = max(sums.sum(), 1)
        self.values = 0.5 * (edges[starts] + edges[ends])
        self.density = sums / inside / (edges[ends] - edges[starts])
        below = counts["below"] + bins[:first].sum()
        self.ends = np.append(edges[first], edges[ends])
        self.cumulative = 100 * np.append(below, below + np.cumsum(sums)) / max(self.total, 1)


def _quantile(cue: dict, counts: dict, share: float) -> float:
    """The quantile of a histogram, with the precision of a bin."""
    bins = np.array(counts["bins"], float)
    edges = np.linspace(cue["low"], cue["high"], len(bins) + 1)
    sums = counts["below"] + np.cumsum(bins)
    total = sums[-1] + counts["above"]
    reached = np.nonzero(sums >= share * total)[0]
    return float(edges[reached[0] + 1]) if len(reached) else cue["high"]


def _count_of(counts: dict) -> int:
    return counts["below"] + sum(counts["bins"]) + counts["above"]


def _shown_range(cue: dict) -> tuple[float, float]:
    """A range that contains all thresholds, nearly all veridical pairs, and the beginning of the other pairs."""
    veridical, other, thresholds = cue["veridical"], cue["other"], cue["thresholds"]
    low = min(thresholds, default=cue["high"])
    high = max(thresholds, default=cue["low"])
    if cue["keeps_small"]:
        high *= 2
        low = min(0.0, _quantile(cue, veridical, 0.001)) if _count_of(veridical) else 0.0
    elif _count_of(other):
        low = min(low, _quantile(cue, other, 0.01))
    if _count_of(veridical):
        low = min(low, _quantile(cue, veridical, 0.001))
        high = max(high, _quantile(cue, veridical, 0.999))
    air = 0.04 * (high - low)
    return max(cue["low"], low - (air if low else 0)), min(cue["high"], high + air)


def _thresholds(cue: dict) -> list[tuple[float, str]]:
    """Markers at the thresholds. Several thresholds, as pooled data sets may have, share one label."""
    thresholds = sorted(cue["thresholds"])
    sign = "\u2264" if cue["keeps_small"] else "\u2265"
    label = f"{sign} {thresholds[-1]:.4g}" if thresholds else ""
    if len(thresholds) > 1:
        label = f"{thresholds[0]:.4g} to {thresholds[-1]:.4g}, per data set"
    return [(value, label if value == thresholds[-1] else "") for value in thresholds]


def cue_figures(cue: dict) -> list[Figure]:
    """Density and cumulative curve of one cue for veridical and other pairs of both pools."""
    shown = _shown_range(cue)
    axis = cue["cue"] + (f" [{cue['unit']}]" if cue["unit"] else "")
    name = f"cue_{cue['table']}_{cue['order']}"
    density = Figure(f"{name}_density", f"{cue['cue']}: density", axis,
                     "density" + (f" [1/{cue['unit']}]" if cue["unit"] else ""), x_range=shown,
                     markers=_thresholds(cue))
    cumulative = Figure(f"{name}_cumulative", f"{cue['cue']}: cumulative", axis, "share of pairs [%]", x_range=shown,
                        y_range=(0, 102), markers=_thresholds(cue))
    for number, (pool, suffix) in enumerate(POOLS):
        for style, kind in enumerate(("veridical", "other")):
            counts = cue.get(f"{kind}{suffix}")
            if not counts or not _count_of(counts):
                continue
            curves = _Curves(cue["low"], cue["high"], counts, shown)
            text = kind if f"{kind}_all" not in cue else f"{kind}, {pool}"
            dash = "dash" if number else "solid"
            density.add(f"{text} ({short_count(curves.total)})", curves.values, curves.density, style=style,
                        dash=dash, fill="" if number else "zero")
            cumulative.add(text, curves.ends, curves.cumulative, style=style, dash=dash)
    return [density, cumulative]


def disparity_figures(pooled: dict) -> list[Figure]:
    """The signed disparity error, and the share of edges below an error limit."""
    errors = pooled["disparity_error_histogram"]
    total = _count_of(errors)
    if total == 0:
        return []
    curves = _Curves(errors["low"], errors["high"], errors, (errors["low"], errors["high"]))
    density = Figure("disparity_error", "Error of the disparity", "error [px]", "density [1/px]")
    density.add(f"final stereo edges ({short_count(total)})", curves.values, curves.density, fill="zero")
    bins = np.array(errors["bins"], float)
    half = len(bins) // 2
    within = 100 * np.append(0, np.cumsum(bins[half:] + bins[:half][::-1])) / total
    limits = np.linspace(0, errors["high"], half + 1)
    cumulative = Figure("disparity_error_within", "Error within a limit", "largest absolute error [px]",
                        "share of edges [%]", y_range=(0, 102))
    cumulative.add("final stereo edges", limits, within)
    return [density, cumulative]


def count_figures(pairs: list[dict]) -> list[Figure]:
    """Counts by frame, or by the name of the data set if each has a single frame."""
    names = [pair["name"] for pair in pairs]
    single = len(pairs) > 1 and all(len(pair["counts"]) == 1 for pair in pairs) and len(set(names)) == len(names)
    frames = [frame for pair in pairs for frame in pair["counts"]]
    label = "" if single else "frame" if len(pairs) == 1 else "frame, data sets in sequence"
    figures = []
    for key, title, series in (("edges", "Edges", (("edges_left", "left"), ("edges_right", "right"))),
                               ("stereo_edges", "Stereo edges", (("stereo_edges", "stereo edges"),)),
                               ("temporal", "Stereo edges with a match in time",
                                (("temporal_left", "in the left images"), ("temporal_right", "in the right images"))),
                               ("quads", "Quads", (("quads", "quads"), ("inliers", "inliers of the pose")))):
        in_time = key in ("temporal", "quads")
        figure = Figure(f"counts_{key}", title, label, "count", categories=names if single else None)
        for style, (column, text) in enumerate(series):
            values = [frame[column] if not in_time or frame["temporal_left"] > 0 else np.nan for frame in frames]
            if np.isfinite(values).any():
                figure.add(text, np.arange(len(values)), values, style=style)
        if figure.traces:
            figures.append(figure)
    return figures


def count_distribution_figures(pairs: list[dict]) -> list[Figure]:
    """Figure 2: how often an image or a frame has so many edges, stereo edges, matches in time and quads."""
    figures = []
    for figure in count_figures(pairs):
        values = [trace["y"] for trace in figure.traces]
        values = [counts[np.isfinite(counts)] for counts in values]
        ends = np.histogram_bin_edges(np.concatenate(values), bins="sturges")
        shown = Figure(f"{figure.name}_distribution", figure.title, "count", "images" if "edges" in figure.name else
                       "frames")
        for style, (trace, counts) in enumerate(zip(figure.traces, values)):
            heights = np.histogram(counts, ends)[0]
            shown.add(trace["name"], np.repeat(ends, 2), np.pad(np.repeat(heights, 2), 1), style=style,
                      fill="zero")
        figures.append(shown)
    return figures


def accuracy_figures(pairs: list[dict], pooled: dict) -> list[Figure]:
    """Figure 7: the precision of pairs of quads and the error of the motions computed from them."""
    names = [row["constraint"] for row in pooled["constraints"]]
    frames = [frame for pair in pairs for frame in pair["counts"] if "pairs" in frame]
    metres = [point["translation_error_m"] for frame in frames for point in frame["pairs"]]
    figures = []
    for key, quantity, unit_name, factor in (
            ("rotation_error_deg", "rotation", "deg", 1.0),
            ("translation_error_m", "translation", length_unit(metres).name, length_unit(metres).factor)):
        single = Figure(f"motions_of_pairs_{quantity}", f"Motion of single pairs: {quantity}",
                        "precision of the pairs [%]", f"median error [{unit_name}]", y_logarithmic=True)
        for order, name in enumerate(names):
            points = [frame["pairs"][order] for frame in frames]
            points = [point for point in points if exists(point["precision"]) and exists(point[key])]
            if points:
                single.add(name, [100 * point["precision"] for point in points],
                           [factor * point[key] for point in points], style=order, points=True)
        whole = Figure(f"motions_of_quads_{quantity}", f"Motion of all quads: {quantity}",
                       "precision of the pairs, all constraints [%]", f"error [{unit_name}]", y_logarithmic=True)
        chosen = [frame for frame in frames if key in frame and exists(frame["pairs"][-1]["precision"])]
        if chosen:
            whole.add("one frame", [100 * frame["pairs"][-1]["precision"] for frame in chosen],
                      [factor * frame[key] for frame in chosen], points=True)
        figures += [figure for figure in (single, whole) if figure.traces]
    return figures
