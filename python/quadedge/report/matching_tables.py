"""Tables of the matching evaluation, with both pools side by side."""

import numpy as np

from .numbers import DASH, PLUS_MINUS, count, exists, percent
from .table import Cell, Table

OFF = "off"
NOTHING = {"recall": None, "precision": None}
POOLS = (("paired", ""), ("all", "_all"))
QUANTITIES = (("edges_left", "edges, left", False), ("edges_right", "edges, right", False),
              ("stereo_edges", "stereo edges", False), ("temporal_left", "with a match in time, left", True),
              ("temporal_right", "with a match in time, right", True), ("quads", "quads", True),
              ("inliers", "inliers of the pose", True))


def _share(value: float | None, deviation: float | None = None) -> Cell:
    """A share in percent, with its standard deviation over frames."""
    decimals = 4 if exists(value) and value < 0.0005 else 2
    text = percent(value, decimals)
    if exists(deviation):
        text += PLUS_MINUS + percent(deviation, decimals)
    return Cell(text, 100 * value if exists(value) else None)


def _shares(row: dict) -> list[Cell]:
    """Recall and precision."""
    return [_share(row[key], row.get(f"{key}_std")) for key in ("recall", "precision")]


def _number(value: float | None, decimals: int) -> Cell:
    return Cell(f"{value:.{decimals}f}" if exists(value) else DASH, value)


def _count(value: float | None) -> Cell:
    return Cell(count(value), value)


def overview_table(pairs: list[dict], pooled: dict) -> Table:
    """The final results, one row per data set."""
    table = Table("overview", "What is left at the end",
                  ["data", "frames", "left edges", "correct", "inaccurate", "wrong", "occluded",
                   *["recall", "precision"] * 2, "median [px]", *["recall", "precision"] * 2])
    table.groups = [("", 3), ("final stereo edges", 4), ("stereo, paired [%]", 2), ("stereo, all [%]", 2),
                    ("disparity", 1), ("quads, paired [%]", 2), ("quads, all [%]", 2)]
    rows = [(pair["name"], pair["frames"], pair) for pair in pairs]
    if len(pairs) > 1:
        rows.append(("pooled", sum(pair["frames"] for pair in pairs), pooled))
        table.result_rows = 1
    for name, frames, summary in rows:
        cells = [Cell(name), _count(frames), _count(summary["left_edges"]["detected"])]
        cells += [_count(summary["stereo_edges"][kind]) for kind in ("correct", "inaccurate", "wrong", "occluded")]
        for _, suffix in POOLS:
            last = (summary[f"stereo{suffix}"] or [NOTHING])[-1]
            cells += [_share(last["recall"]), _share(last["precision"])]
        cells.append(_number(summary["disparity_error_px"]["median"], 3))
        for _, suffix in POOLS:
            quads = summary.get(f"quads{suffix}", NOTHING)
            cells += [_share(quads["recall"]), _share(quads["precision"])]
        table.add(*cells)
    return table


def filter_table(name: str, title: str, summary: dict, key: str) -> Table:
    """Tables 1 and 2: recall, precision and ambiguity after every filter; disabled filters are marked."""
    both = [summary[f"{key}{suffix}"] for _, suffix in POOLS]
    columns = ["recall [%]", "precision [%]", "per edge [%]", "ambiguity", "of pool", "max"]
    table = Table(name, title, ["", "filter", *columns * 2], text_columns=2)
    table.groups = [("", 2)]
    for (pool, _), rows in zip(POOLS, both):
        table.groups.append((f"{pool}: {count(rows[0]['edges']) if rows else 0} edges", 6))
    for paired, everything in zip(*both):
        cells = [paired["order"], paired["filter"]]
        for row in (paired, everything):
            if row.get("off"):
                cells += [Cell(OFF)] * 6
            else:
                cells += [*_shares(row), _share(row.get("precision_per_edge")), _number(row["ambiguity_mean"], 3),
                          _number(row.get("ambiguity_of_pool"), 3), _number(row["ambiguity_max"], 0)]
        table.add(*cells)
    table.result_rows = 1
    return table


def disparity_table(name: str, summary: dict) -> Table:
    """Errors of the final stereo edges, and the ground truth of the left edges."""
    table = Table(name, "Final stereo edges against the truth, and what the truth says about the left edges",
                  ["median", "p90", "bias", "median", "p90", "detected", "no statement", "along the line", "occluded",
                   "on depth steps"], text_columns=0)
    table.groups = [("disparity error [px]", 3), ("part across the edge [px]", 2), ("left edges", 5)]
    disparity, across, census = (summary[key] for key in ("disparity_error_px", "across_error_px", "left_edges"))
    table.add(*[_number(disparity[key], 4) for key in ("median", "p90", "bias")],
              *[_number(across[key], 4) for key in ("median", "p90")],
              *[_count(census[key]) for key in ("detected", "no_statement", "along_line", "occluded", "contour")])
    return table


def quad_table(name: str, summary: dict) -> Table:
    table = Table(name, "Quads", ["pool", "edges", "quads", "recall [%]", "precision [%]", "ambiguity"])
    for pool, suffix in POOLS:
        quads = summary[f"quads{suffix}"]
        ambiguity = _number(quads.get("ambiguity_mean"), 3)
        if exists(quads.get("ambiguity_std")):
            ambiguity.text += PLUS_MINUS + f"{quads['ambiguity_std']:.3f}"
        table.add(pool, _count(quads["edges"]), _count(quads["kept"]), *_shares(quads), ambiguity)
    return table


def constraint_table(name: str, summary: dict) -> Table:
    rows = summary["constraints"]
    table = Table(name, f"Table 3: pairs of quads after each constraint, {count(rows[0]['pairs'])} pairs drawn",
                  ["", "constraint", "recall [%]", "precision [%]"], text_columns=2, result_rows=1)
    for row in rows:
        table.add(row["order"], row["constraint"], *_shares(row))
    return table


def count_table(pairs: list[dict]) -> Table:
    """Numbers of edges, stereo edges, temporal matches and quads per frame."""
    table = Table("counts", "Counts of a frame", ["per frame", "frames", "mean", "std", "min", "median", "max"])
    for key, text, in_time in QUANTITIES:
        values = np.array([frame[key] for pair in pairs for frame in pair["counts"]
                           if not in_time or frame["temporal_left"] > 0], float)
        if not len(values):
            continue
        spread = float(values.std()) if len(values) > 1 else None
        table.add(text, *[_count(value) for value in (len(values), float(values.mean()), spread, float(values.min()),
                                                      float(np.median(values)), float(values.max()))])
    return table
