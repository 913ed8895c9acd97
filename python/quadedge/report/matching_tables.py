"""Tables of the matching evaluation, with both pools side by side."""

from .numbers import DASH, PLUS_MINUS, count, exists, percent
from .table import Cell, Table

NOTHING = {"recall": None, "precision": None}
POOLS = (("paired", ""), ("all", "_all"))


def _shares(row: dict, *keys: str) -> list[Cell]:
    """Shares in percent, with their standard deviations over frames; recall and precision unless others are given."""
    cells = []
    for key in keys or ("recall", "precision"):
        value, deviation = row.get(key), row.get(f"{key}_std")
        decimals = 4 if exists(value) and value < 0.0005 else 2
        spread = PLUS_MINUS + percent(deviation, decimals) if exists(deviation) else ""
        cells.append(Cell(percent(value, decimals) + spread, 100 * value if exists(value) else None))
    return cells


def _number(value: float | None, decimals: int, deviation: float | None = None) -> Cell:
    spread = f"{PLUS_MINUS}{deviation:.{decimals}f}" if exists(deviation) else ""
    return Cell(f"{value:.{decimals}f}{spread}" if exists(value) else DASH, value)


def _count(value: float | None) -> Cell:
    return Cell(count(value), value)


def overview_table(pairs: list[dict], pooled: dict) -> Table:
    """The final results, one row per data set."""
    kinds = ("correct", "inaccurate", "wrong", "occluded")
    shares = [(f"{what}, {pool} [%]", share) for what in ("stereo", "quads") for pool, _ in POOLS
              for share in ("recall", "precision")]
    table = Table("overview", "What is left at the end", [
        "data", "frames", "left edges", *(("final stereo edges", kind) for kind in kinds), *shares[:4],
        ("disparity", "median [px]"), *shares[4:]], has_result=len(pairs) > 1)
    everything = pooled | {"name": "pooled", "frames": sum(pair["frames"] for pair in pairs)}
    for summary in [*pairs, everything] if len(pairs) > 1 else pairs:
        stereo, quads = ([cell for row in rows for cell in _shares({key: row[key] for key in NOTHING})] for rows in (
            [(summary[f"stereo{suffix}"] or [NOTHING])[-1] for _, suffix in POOLS],
            [summary.get(f"quads{suffix}", NOTHING) for _, suffix in POOLS]))
        table.add(summary["name"], _count(summary["frames"]), _count(summary["left_edges"]["detected"]),
                  *[_count(summary["stereo_edges"][kind]) for kind in kinds], *stereo,
                  _number(summary["disparity_error_px"]["median"], 3), *quads)
    return table


def filter_table(name: str, title: str, summary: dict, key: str) -> Table:
    """Tables 1 and 2: recall, precision and ambiguity after every filter; disabled filters are marked."""
    both = [summary[f"{key}{suffix}"] for _, suffix in POOLS]
    columns = [(f"{pool}: {count(rows[0]['edges']) if rows else 0} edges", column)
               for (pool, _), rows in zip(POOLS, both)
               for column in ("recall [%]", "precision [%]", "per edge [%]", "ambiguity", "of pool", "max")]
    table = Table(name, title, ["", "filter", *columns], text_columns=2, has_result=True)
    for rows in zip(*both):
        cells = [[Cell("off")] * 6 if row.get("off") else
                 [*_shares(row, "recall", "precision", "precision_per_edge"), _number(row["ambiguity_mean"], 3),
                  _number(row.get("ambiguity_of_pool"), 3), _number(row["ambiguity_max"], 0)] for row in rows]
        table.add(rows[0]["order"], rows[0]["filter"], *cells[0], *cells[1])
    return table


def disparity_table(name: str, summary: dict) -> Table:
    """Errors of the final stereo edges, and the ground truth of the left edges."""
    columns = {("disparity error [px]", key): _number(summary["disparity_error_px"][key], 4)
               for key in ("median", "p90", "bias")}
    columns |= {("part across the edge [px]", key): _number(summary["across_error_px"][key], 4)
                for key in ("median", "p90")}
    columns |= {("left edges", text): _count(summary["left_edges"][key]) for key, text in (
        ("detected", "detected"), ("no_statement", "no statement"), ("along_line", "along the line"),
        ("occluded", "occluded"), ("contour", "on depth steps"))}
    return Table(name, "Final stereo edges against the truth, and what the truth says about the left edges",
                 list(columns), [list(columns.values())], text_columns=0)


def quad_table(name: str, summary: dict) -> Table:
    table = Table(name, "Quads", ["pool", "edges", "quads", "recall [%]", "precision [%]", "ambiguity"])
    for pool, suffix in POOLS:
        quads = summary[f"quads{suffix}"]
        table.add(pool, _count(quads["edges"]), _count(quads["kept"]), *_shares(quads),
                  _number(quads.get("ambiguity_mean"), 3, quads.get("ambiguity_std")))
    return table


def constraint_table(name: str, summary: dict) -> Table:
    rows = summary["constraints"]
    table = Table(name, f"Table 3: pairs of quads after each constraint, {count(rows[0]['pairs'])} pairs drawn",
                  ["", "constraint", "recall [%]", "precision [%]"], text_columns=2, has_result=True)
    for row in rows:
        table.add(row["order"], row["constraint"], *_shares(row))
    return table


def summary_tables(summary: dict, prefix: str = "") -> list[Table]:
    """The tables of one data set or of all; `prefix` is that of their names."""
    tables = [filter_table(f"{prefix}stereo", "Table 1: stereo", summary, "stereo"),
              disparity_table(f"{prefix}disparity", summary)]
    if "temporal_left" in summary:
        tables += [filter_table(f"{prefix}temporal_{side}", f"Table 2: in time, {side} images", summary,
                                f"temporal_{side}") for side in ("left", "right")]
        tables.append(quad_table(f"{prefix}quads", summary))
        if summary["constraints"][0]["pairs"] > 0:
            tables.append(constraint_table(f"{prefix}constraints", summary))
    return tables
