"""The results of the matching evaluation as a JSON document (doc/matching.md)."""

import datetime

import numpy as np

from .. import __version__, configuration
from .counts import ratio
from .cues import Cues, histogram, histogram_document
from .observer import CENSUS, CLASSES, SIDES, MatchingResult, Tolerance, add_cues
from .quad_pairs import CONSTRAINTS

SCHEMA = 1
"""Incremented when a key changes its meaning."""
SIFT_FILTERS = {"SIFT", "nearly best SIFT"}
POOLS = (("paired", ""), ("everything", "_all"))
COUNTS = ("edges_left", "edges_right", "stereo_edges", "temporal_left", "temporal_right", "quads", "inliers")
DISPARITY_RANGE = 1.5


def _number(value) -> float | None:
    """JSON has no NaN: a value that does not exist is null."""
    return float(value) if np.isfinite(value) else None


def _deviation(values) -> float | None:
    """Standard deviation of the finite values (divided by N); None for fewer than two."""
    values = np.array([value for value in values if np.isfinite(value)])
    return float(values.std()) if len(values) > 1 else None


def _quantile(values: np.ndarray, fraction: float) -> float | None:
    return float(np.sort(values)[int(fraction * (len(values) - 1) + 0.5)]) if len(values) else None


def _is_off(row, before) -> bool:
    """Whether a filter of SIFT has no limit, so that everything passes."""
    def kept(which):
        return [(counts.candidates, counts.veridical, counts.alive) for counts in (which.paired, which.everything)]

    return before is not None and row.filter in SIFT_FILTERS and kept(row) == kept(before)


def _table(tables: list[list], pool: str) -> list[dict]:
    """Sums over the frames' tables, with standard deviations over the frames."""
    lines, before = [], None
    for rows in zip(*tables):
        row, frames = sum(rows[1:], rows[0]), [getattr(frame, pool) for frame in rows]
        counts = getattr(row, pool)
        lines.append({"order": row.order, "filter": row.filter, "recall": _number(counts.recall),
                      "precision": _number(counts.precision),
                      "precision_per_edge": _number(ratio(counts.precisions, counts.alive)),
                      "ambiguity_mean": _number(counts.ambiguity),
                      "ambiguity_of_pool": _number(ratio(counts.candidates, counts.pool) - 1),
                      "ambiguity_max": float(counts.most - 1) if counts.most else None,
                      "kept": counts.candidates, "edges": counts.pool,
                      **{f"{name}_std": _deviation([getattr(frame, name) for frame in frames])
                         for name in ("recall", "precision", "ambiguity")}})
        if _is_off(row, before):
            lines[-1]["off"] = True
        before = row
    return lines


def _quads(frames: list, pool: int) -> dict:
    counts = [frame.quads[pool] for frame in frames]
    total, competing = sum(counts[1:], counts[0]), [frame.competing[pool] for frame in frames]
    return {"recall": _number(total.recall), "precision": _number(total.precision), "edges": total.pool,
            "kept": total.candidates, "recall_std": _deviation([each.recall for each in counts]),
            "precision_std": _deviation([each.precision for each in counts]),
            "ambiguity_mean": _number(ratio(sum(competing), total.candidates)),
            "ambiguity_std": _deviation([ratio(each, of.candidates) for each, of in zip(competing, counts)])}


def _constraints(frames: list) -> list[dict]:
    pairs, veridical = (np.array([getattr(frame.pairs, name) for frame in frames]) for name in ("pairs", "veridical"))
    with np.errstate(invalid="ignore", divide="ignore"):
        recall, precision = veridical / veridical[:, :1], veridical / pairs
    return [{"order": order, "constraint": name,
             "recall": _number(ratio(veridical[:, order].sum(), veridical[:, 0].sum())),
             "precision": _number(ratio(veridical[:, order].sum(), pairs[:, order].sum())),
             "pairs": int(pairs[:, order].sum()), "recall_std": _deviation(recall[:, order]),
             "precision_std": _deviation(precision[:, order])} for order, name in enumerate(CONSTRAINTS)]


def summary(results: list[MatchingResult]) -> dict:
    """The tables of one or several results."""
    frames = [frame for result in results for frame in result.frames]
    stereo = [frame.stereo for frame in frames if frame.stereo]
    temporal = [frame.temporal for frame in frames if frame.temporal]
    errors, across = (np.concatenate([getattr(frame, name) for frame in frames])
                      for name in ("disparity_error", "across_error"))
    content = {"left_edges": dict(zip(CENSUS, sum(frame.census for frame in frames).tolist())),
               "stereo_edges": dict(zip(CLASSES, sum(frame.classes for frame in frames).tolist()))}
    for pool, suffix in POOLS:
        content[f"stereo{suffix}"] = _table(stereo, pool)
    content["disparity_error_px"] = {"median": _quantile(np.abs(errors), 0.5), "p90": _quantile(np.abs(errors), 0.9),
                                     "bias": _quantile(errors, 0.5)}
    content["across_error_px"] = {"median": _quantile(across, 0.5), "p90": _quantile(across, 0.9)}
    if temporal:
        for pool, suffix in POOLS:
            for side in SIDES:
                content[f"temporal_{side}{suffix}"] = _table([frame.tables[side] for frame in temporal], pool)
        content |= {"quads": _quads(temporal, 0), "quads_all": _quads(temporal, 1),
                    "constraints": _constraints(temporal)}
    return content


def _distributions(cues: Cues) -> list[dict]:
    shown = []
    for (table, order), cue in cues.items():
        if cue.of["veridical"].sum() + cue.of["other"].sum() == 0:
            continue
        low, high, _ = cue.bins
        entry = {"table": table, "order": order, "cue": cue.name, "unit": cue.unit, "keeps_small": cue.keeps_small,
                 "thresholds": cue.thresholds, "low": float(low), "high": float(high), "other_is_sample": cue.sampled}
        both = cue.of["veridical_all"].sum() + cue.of["other_all"].sum() > 0
        shown.append(entry | {kind: histogram_document(counts) for kind, counts in cue.of.items()
                              if both or not kind.endswith("_all")})
    return shown


def _per_frame(frame) -> dict:
    result = frame.result
    entry = {"status": result.status} | {name: getattr(result.counts, name) for name in COUNTS}
    if result.message:
        entry["message"] = result.message
    if frame.motion is not None:
        entry |= dict(zip(("rotation_error_deg", "translation_error_m"), frame.motion.tolist()))
    if frame.temporal:
        pairs = frame.temporal.pairs
        entry["pairs"] = [{"precision": _number(ratio(veridical, count)), "rotation_error_deg": _number(rotation),
                           "translation_error_m": _number(translation)}
                          for count, veridical, (rotation, translation) in zip(pairs.pairs, pairs.veridical,
                                                                               pairs.errors)]
    return entry


def _text(value) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _configuration(config: dict) -> dict:
    """`config`, every constant in its section, and `config_changed`, those that are not at their defaults."""
    nested, defaults = {}, configuration()
    for key in defaults:
        section, _, name = key.rpartition(".")
        (nested.setdefault(section, {}) if section else nested)[name] = config[key]
    return {"config": nested, "config_changed": {key: _text(config[key]) for key, value in defaults.items()
                                                 if config[key] != value}}


def document(results: list[MatchingResult], device, config: dict, inputs: list[str], tolerance: Tolerance = Tolerance(),
             command: str = "") -> dict:
    """`pairs` with one entry per pair or sequence, and `pooled` over all of them. Recall and precision are fractions.

    device: a DeviceInfo. config: all values, as given. inputs: as the command names them.
    """
    content = {"schema": SCHEMA, "version": __version__,
               "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), "command": command,
               "device": {name: getattr(device, name) for name in ("name", "platform", "driver", "opencl", "type")},
               "input": list(inputs), "tolerance_px": tolerance.position, "wrong_px": tolerance.wrong,
               **_configuration(config)}
    content["pairs"] = [{"name": result.name, "frames": len(result.frames),
                         "counts": [_per_frame(frame) for frame in result.frames], **summary([result])}
                        for result in results]
    cues = {}
    for result in results:
        add_cues(cues, result.cues)
    errors = np.concatenate([frame.disparity_error for result in results for frame in result.frames])
    content["pooled"] = {**summary(results), "distributions": _distributions(cues),
                         "disparity_error_histogram": {"low": -DISPARITY_RANGE, "high": DISPARITY_RANGE,
                                                       **histogram_document(histogram(
                                                           errors, -DISPARITY_RANGE, DISPARITY_RANGE, 300))}}
    return content
