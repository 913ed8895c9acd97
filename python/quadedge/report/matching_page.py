"""The page of the matching evaluation: the effect of every filter, measured against ground truth."""

from .figure import FEWEST_FRAMES, Figure
from .matching_figures import accuracy_figures, count_figures, cue_figures, disparity_figures, filter_figure
from .matching_tables import count_table, overview_table, summary_tables
from .numbers import percent, significant
from .page import Facts, Figures, Page, Section, Text, Tile
from .run_tables import configuration_table, device_text, origin

MOST_MESSAGES = 12
CASCADES = (("stereo", "Stereo (Figure 3)", "stereo pairs"),
            ("temporal_left", "In time, left images (Figure 5)", "pairs in time"),
            ("temporal_right", "In time, right images (Figure 5)", "pairs in time"))


def matching_page(content: dict, drawings: dict[str, list[Figure]] = {}) -> Page:  # noqa: B006  only read
    """The page of what `python -m quadedge.matching --json` writes. drawings: of the pairs or sequences, by name."""
    pairs, pooled = content["pairs"], content["pooled"]
    title = pairs[0]["name"] if len(pairs) == 1 else f"{len(pairs)} data sets"
    page = Page(f"Matching report: {title}", _facts(content), lead=_lead(content), tiles=_tiles(pooled))
    page.sections.append(Section("Overview", [overview_table(pairs, pooled), *_messages(pairs)],
                                 explained="matching.md"))
    page.sections.append(Section("Tables, pooled" if len(pairs) > 1 else "Tables", summary_tables(pooled)))
    figures = [filter_figure("stereo", "Stereo, after every filter", pooled)]
    for side in ("left", "right"):
        if f"temporal_{side}" in pooled:
            figures.append(filter_figure(f"temporal_{side}", f"In time, {side} images, after every filter", pooled))
    page.sections[-1].blocks += [
        Figures(figures, "Shares of both pools after every filter."),
        Figures(disparity_figures(pooled), "Final stereo edges whose true position is visible: estimated minus true "
                                           "disparity.")]
    if len(pairs) > 1:
        for number, pair in enumerate(pairs):
            page.sections.append(Section(f"Tables of {pair['name']}", summary_tables(pair, f"{number}_"), 3, fold=True))
    page.sections.append(_counts(pairs))
    page.sections += _distributions(pooled)
    page.sections += _accuracy(pairs, pooled)
    page.sections += _drawings(drawings)
    page.sections.append(_terms(content))
    page.sections.append(Section("Configuration", [configuration_table(content)], fold=True,
                                 explained="configuration.md"))
    return page


def _lead(content: dict) -> str:
    return (f"A match is correct within {content['tolerance_px']:g} px of the true position. Recall: share of the "
            "edges that still have a correct candidate; precision: correct candidates / all candidates. All terms are "
            "below, in \"Terms\".")


def _tiles(pooled: dict) -> list[Tile]:
    """Stereo edges, then quads, each with recall and precision."""
    last = (pooled["stereo"] or [{"recall": None, "precision": None}])[-1]
    tiles = [Tile("Precision of stereo edges", f"{percent(last['precision'], 1)} %",
                  f"recall {percent(last['recall'], 1)} %")]
    if "quads" in pooled:
        quads = pooled["quads"]
        tiles.append(Tile("Precision of quads", f"{percent(quads['precision'], 1)} %",
                          f"recall {percent(quads['recall'], 1)} %"))
    error = pooled["disparity_error_px"]
    tiles.append(Tile("Error of the disparity", f"{significant(error['median'], 2)} px",
                      f"median; p90 {significant(error['p90'], 2)} px"))
    return tiles


def _facts(content: dict) -> Facts:
    return Facts(origin(content, device_text(content["device"]), ", ".join(content["input"])))


def _terms(content: dict) -> Section:
    """The words of the tables."""
    terms = Facts([
        ("Veridical", f"within {content['tolerance_px']:g} px of the true position, where it is visible"),
        ("Pool: paired", "edges whose counterpart was detected (the paper's pool): recall starts at 100 % by "
                         "construction"),
        ("Pool: all", "all edges with ground truth, including those whose counterpart is occluded or was "
                                "not detected"),
        ("Recall", "share of the pool's edges that still have a veridical candidate"),
        ("Precision", "veridical candidates / all candidates"),
        ("Per edge", "mean of that ratio over edges that have candidates, as the paper's authors take it"),
        ("Ambiguity", "candidates beyond the first, per edge that has any"),
        ("Of pool", "the paper's ambiguity: candidates / edges of the pool - 1"),
        ("\u00b1", "standard deviation over frames; each pair counts as one")])
    return Section("Terms", [terms], fold=True, explained="matching.md")


def _messages(pairs: list[dict]) -> list:
    """Messages of the pipeline: lost frames, exhausted buffers."""
    messages = [(f"{pair['name']}, frame {number}", frame["message"]) for pair in pairs
                for number, frame in enumerate(pair["counts"]) if "message" in frame]
    if not messages:
        return []
    if len(messages) > MOST_MESSAGES:
        messages = [*messages[:MOST_MESSAGES], ("and", f"{len(messages) - MOST_MESSAGES} more frames")]
    return [Text("Messages of the pipeline:"), Facts(messages)]


def _counts(pairs: list[dict]) -> Section:
    section = Section("Counts per frame", [count_table(pairs)])
    if sum(pair["frames"] for pair in pairs) < FEWEST_FRAMES:
        section.blocks.append(_needs_frames("Distributions of the counts (Figure 2)"))
        return section
    section.blocks.append(Figures(count_figures(pairs), "Figure 2: distributions of the numbers of edges, stereo "
                                                        "edges, pairs in time and quads over the frames."))
    return section


def _needs_frames(what: str) -> Text:
    return Text(f"{what}: needs at least {FEWEST_FRAMES} frames.")


def _distributions(pooled: dict) -> list[Section]:
    cues = pooled["distributions"]
    if not cues:
        return []
    text = Text("Each cue over the pairs that reach the filter that uses it. Solid: edges of the pool paired, dashed: "
                "all edges. Densities are normalised over the displayed range, cumulative curves over all pairs, so "
                "that they end below 100 % if pairs lie beyond the range. Vertical lines: thresholds.")
    sections = [Section("Distributions of the cues", [text])]
    for table, title, pairs in CASCADES:
        figures = [figure for cue in cues if cue["table"] == table for figure in cue_figures(cue)]
        if figures:
            caption = (f"Veridical and other {pairs}. Of the other pairs before the first filter, 40 per edge are "
                       "sampled; the count beside a curve is that of the sampled pairs.")
            sections.append(Section(title, [Figures(figures, caption)], 3))
    figures = [figure for cue in cues if cue["table"] == "constraints" for figure in cue_figures(cue)]
    if figures:
        caption = ("The quantities compared by the constraints of Equation 9, over the pairs of quads that satisfy all "
                   "previous constraints. A pair is veridical if both quads are. The sixth constraint, equal "
                   "handedness, has no threshold.")
        sections.append(Section("Pairs of quads (Figure 6)", [Figures(figures, caption)], 3))
    return sections


def _accuracy(pairs: list[dict], pooled: dict) -> list[Section]:
    if not any("pairs" in frame for pair in pairs for frame in pair["counts"]):
        return []
    if sum(pair["frames"] for pair in pairs) < FEWEST_FRAMES:
        return [Section("Precision of pairs and accuracy of motions",
                        [_needs_frames("Precision of pairs and accuracy of motions (Figure 7)")])]

    caption = ("Figure 7. Single pairs: one point per frame and constraint. Each pair of quads that satisfies the "
               "constraints up to this one yields a motion (Proposition 2); the figure shows the median error of up to "
               "2000 such motions. All quads: the error of the motion estimated by the pipeline.")
    return [Section("Precision of pairs and accuracy of motions", [Figures(accuracy_figures(pairs, pooled), caption)])]


def _drawings(drawings: dict[str, list[Figure]]) -> list[Section]:
    """One fold per pair or sequence."""
    if not drawings:
        return []
    text = Text("The final stereo edges with ground truth in the left and the right image of the last frame: correct "
                "ones (Figure 8), inaccurate and wrong ones (Figure 9).")
    return [Section("Drawings", [text]), *(
        Section(f"Drawings of {name}", [Figures(figures)], 3, fold=True, open=number == 0)
        for number, (name, figures) in enumerate(drawings.items()))]
