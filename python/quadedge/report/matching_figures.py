"""Figures of the matching evaluation (`python -m quadedge.matching`)."""

import numpy as np

from .figure import Figure
from .matching_tables import POOLS, QUANTITIES, frame_counts
from .numbers import exists, length_unit, short_count


def filter_figure(key: str, title: str, summary: dict) -> Figure:
    """Recall and precision of both pools after every filter, by the filter's name. Disabled filters are omitted."""
    rows = {suffix: [row for row in summary[f"{key}{suffix}"] if not row.get("off")] for _, suffix in POOLS}
    figure = Figure(f"filters_{key}", title, "", "share [%]", categories=[row["filter"] for row in rows[""]],
                    y_range=(0, 102))
    for number, (pool, suffix) in enumerate(POOLS):
        for style, share in enumerate(("recall", "precision")):
            values = [100 * row[share] if exists(row[share]) else np.nan for row in rows[suffix]]
            figure.add(f"{share}, {pool}", np.arange(len(values)), values, style=style + 2 * number,
                       dash="dash" if number else "solid")
    return figure


class _Curves:
    """The ends of a histogram's bins, density in the bins within a range, and cumulative shares [%] at all ends."""

    def __init__(self, histogram: dict, counts: dict, shown: tuple[float, float] = (-np.inf, np.inf)):
        bins = np.array(counts["bins"], float)
        self.ends = np.linspace(histogram["low"], histogram["high"], len(bins) + 1)
        self.total = counts["below"] + bins.sum() + counts["above"]
        self.values = 0.5 * (self.ends[1:] + self.ends[:-1])
        inside = (self.values >= shown[0]) & (self.values <= shown[1])
        self.density = np.where(inside, bins, np.nan) / max(bins[inside].sum(), 1) / np.diff(self.ends)
        self.cumulative = 100 * (counts["below"] + np.append(0, bins.cumsum())) / max(self.total, 1)

    def quantile(self, percent: float) -> float:
        """With the precision of a bin."""
        return float(self.ends[min(np.searchsorted(self.cumulative, percent), len(self.ends) - 1)])


def _shown_range(cue: dict, veridical: _Curves, other: _Curves) -> tuple[float, float]:
    """A range that contains all thresholds, nearly all veridical pairs, and the beginning of the other pairs."""
    places = [value * factor for value in cue["thresholds"] for factor in ((0, 2) if cue["keeps_small"] else (1,))]
    places += [veridical.quantile(percent) for percent in (0.1, 99.9)] if veridical.total else []
    places += [other.quantile(1)] if other.total and not cue["keeps_small"] else []
    places = places or [cue["low"], cue["high"]]
    air = 0.04 * (max(places) - min(places))
    return max(cue["low"], min(places) - air), min(cue["high"], max(places) + air)


def cue_figures(cue: dict) -> list[Figure]:
    """Density and cumulative curve of one cue for veridical and other pairs of both pools."""
    shown = _shown_range(cue, *(_Curves(cue, cue[kind]) for kind in ("veridical", "other")))
    unit = cue["unit"]
    sign = "\u2264" if cue["keeps_small"] else "\u2265"
    thresholds = [(value, f"{sign} {value:.4g}") for value in cue["thresholds"]]
    name, axis = f"cue_{cue['table']}_{cue['order']}", cue["cue"] + (f" [{unit}]" if unit else "")
    density = Figure(f"{name}_density", f"{cue['cue']}: density", axis, "density" + (f" [1/{unit}]" if unit else ""),
                     x_range=shown, markers=thresholds)
    cumulative = Figure(f"{name}_cumulative", f"{cue['cue']}: cumulative", axis, "share of pairs [%]", x_range=shown,
                        y_range=(0, 102), markers=thresholds)
    for number, (pool, suffix) in enumerate(POOLS):
        for style, kind in enumerate(("veridical", "other")):
            if f"{kind}{suffix}" not in cue:
                continue
            curves = _Curves(cue, cue[f"{kind}{suffix}"], shown)
            text = kind if f"{kind}_all" not in cue else f"{kind}, {pool}"
            dash = "dash" if number else "solid"
            if curves.total:
                density.add(f"{text} ({short_count(curves.total)})", curves.values, curves.density, style=style,
                            dash=dash, fill="" if number else "zero")
                cumulative.add(text, curves.ends, curves.cumulative, style=style, dash=dash)
    return [density, cumulative]


def disparity_figures(pooled: dict) -> list[Figure]:
    """The signed disparity error, and the share of edges below an error limit."""
    errors = pooled["disparity_error_histogram"]
    curves = _Curves(errors, errors)
    if curves.total == 0:
        return []
    density = Figure("disparity_error", "Error of the disparity", "error [px]", "density [1/px]")
    density.add(f"final stereo edges ({short_count(curves.total)})", curves.values, curves.density, fill="zero")
    half = len(curves.values) // 2
    within = Figure("disparity_error_within", "Error within a limit", "largest absolute error [px]",
                    "share of edges [%]", y_range=(0, 102))
    within.add("final stereo edges", curves.ends[half:], curves.cumulative[half:] - curves.cumulative[half::-1])
    return [density, within]


def count_figures(pairs: list[dict]) -> list[Figure]:
    """Figure 2: how often an image or a frame has so many edges, stereo edges, matches in time and quads."""
    counts, figures = frame_counts(pairs), []
    for title, columns in (("Edges", ["edges_left", "edges_right"]), ("Stereo edges", ["stereo_edges"]),
                           ("Stereo edges with a match in time", ["temporal_left", "temporal_right"]),
                           ("Quads", ["quads", "inliers"])):
        values = [counts[column].dropna() for column in columns]
        if not sum(map(len, values)):
            continue
        ends = np.histogram_bin_edges(np.concatenate(values), bins="sturges")
        figure = Figure(f"counts_{columns[0]}", title, "count", "frames")
        for style, (column, of) in enumerate(zip(columns, values)):
            figure.add(QUANTITIES[column], np.repeat(ends, 2), np.pad(np.repeat(np.histogram(of, ends)[0], 2), 1),
                       style=style, fill="zero")
        figures.append(figure)
    return figures


def accuracy_figures(pairs: list[dict], pooled: dict) -> list[Figure]:
    """Figure 7: the precision of pairs of quads and the error of the motions computed from them."""
    frames = [frame for pair in pairs for frame in pair["counts"] if "pairs" in frame]
    unit = length_unit([point["translation_error_m"] for frame in frames for point in frame["pairs"]])
    figures = []
    for key, quantity, name, factor in (("rotation_error_deg", "rotation", "deg", 1.0),
                                        ("translation_error_m", "translation", *unit)):
        single = Figure(f"motions_of_pairs_{quantity}", f"Motion of single pairs: {quantity}",
                        "precision of the pairs [%]", f"median error [{name}]", y_logarithmic=True)
        whole = Figure(f"motions_of_quads_{quantity}", f"Motion of all quads: {quantity}",
                       "precision of the pairs, all constraints [%]", f"error [{name}]", y_logarithmic=True)
        series = [(single, row["constraint"], order, [2 * (frame["pairs"][order],) for frame in frames])
                  for order, row in enumerate(pooled["constraints"])]
        series.append((whole, "one frame", 0, [(frame["pairs"][-1], frame) for frame in frames]))
        for figure, text, style, points in series:
            points = [(100 * pair["precision"], factor * of[key]) for pair, of in points
                      if exists(pair["precision"]) and exists(of.get(key))]
            if points:
                figure.add(text, *zip(*points), style=style, points=True)
        figures += [figure for figure in (single, whole) if figure.traces]
    return figures
