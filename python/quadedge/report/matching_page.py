"""The page of the matching evaluation: the effect of every filter, measured against ground truth."""

import numpy as np

from .figure import Figure
from .matching_tables import POOLS, overview_table, summary_tables
from .numbers import exists, percent, significant
from .page import Facts, Figures, Page, Section, Tile
from .run_tables import configuration_table, device_text, origin

CASCADES = {"stereo": "Stereo, after every filter", "temporal_left": "In time, left images, after every filter",
            "temporal_right": "In time, right images, after every filter"}


def matching_page(content: dict) -> Page:
    """The page of what `python -m quadedge.matching --json` writes."""
    pairs, pooled = content["pairs"], content["pooled"]
    title = pairs[0]["name"] if len(pairs) == 1 else f"{len(pairs)} data sets"
    lead = (f"A match is correct within {content['tolerance_px']:g} px of the true position. Recall: share of the "
            "edges that still have a correct candidate; precision: correct candidates / all candidates.")
    page = Page(f"Matching report: {title}",
                Facts(origin(content, device_text(content["device"]), ", ".join(content["input"]))), lead=lead,
                tiles=_tiles(pooled))
    page.sections.append(Section("Overview", [overview_table(pairs, pooled)], explained="matching.md"))
    figures = [_filter_figure(key, title, pooled) for key, title in CASCADES.items() if key in pooled]
    page.sections.append(Section("Tables, pooled" if len(pairs) > 1 else "Tables",
                                 [*summary_tables(pooled), Figures(figures, "Shares of both pools.")],
                                 explained="matching.md#terms"))
    for number, pair in enumerate(pairs if len(pairs) > 1 else []):
        page.sections.append(Section(f"Tables of {pair['name']}", summary_tables(pair, f"{number}_"), 3, fold=True))
    page.sections.append(Section("Configuration", [configuration_table(content)], fold=True,
                                 explained="configuration.md"))
    return page


def _tiles(pooled: dict) -> list[Tile]:
    """Stereo edges, then quads, each with recall and precision."""
    error, last = pooled["disparity_error_px"], (pooled["stereo"] or [{"recall": None, "precision": None}])[-1]
    shares = [("stereo edges", last)] + ([("quads", pooled["quads"])] if "quads" in pooled else [])
    return [*(Tile(f"Precision of {what}", f"{percent(found['precision'], 1)} %",
                   f"recall {percent(found['recall'], 1)} %") for what, found in shares),
            Tile("Error of the disparity", f"{significant(error['median'], 2)} px",
                 f"median; p90 {significant(error['p90'], 2)} px")]


def _filter_figure(key: str, title: str, summary: dict) -> Figure:
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
