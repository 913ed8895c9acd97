"""The results of the matching evaluation as a JSON document (doc/matching.md)."""

import datetime

import numpy as np
import pandas

from .. import __version__, configuration
from .counts import Tolerance, shares
from .observer import CENSUS, CLASSES, SIDES, MatchingResult
from .quad_pairs import CONSTRAINTS

SCHEMA = 1
"""Incremented when a key changes its meaning."""
SIFT_FILTERS = {"SIFT", "nearly best SIFT"}
POOLS = (("paired", ""), ("everything", "_all"))
SHARES = ["recall", "precision", "ambiguity"]
FILTER_COLUMNS = ["order", "filter", "recall", "precision", "precision_per_edge", "ambiguity_mean", "ambiguity_of_pool",
                  "ambiguity_max", "kept", "edges", *(f"{share}_std" for share in SHARES)]
QUAD_COLUMNS = ["recall", "precision", "edges", "kept", "recall_std", "precision_std", "ambiguity_mean",
                "ambiguity_std"]
COUNTS = ("edges_left", "edges_right", "stereo_edges", "temporal_left", "temporal_right", "quads", "inliers")


def _deviations(values):
    """Standard deviations over frames that have a value (divided by N); NaN for fewer than two."""
    return values.std(ddof=0).where(values.count() > 1)


def _quantile(values: np.ndarray, fraction: float) -> float | None:
    return float(np.sort(values)[int(fraction * (len(values) - 1) + 0.5)]) if len(values) else None


def _sums(counts: list[dict], pool: str) -> pandas.DataFrame:
    """Over the frames, by the number and name of the filter, with the standard deviations of the shares."""
    frames = shares(pandas.DataFrame(counts))
    groups = frames[frames["pool"] == pool].groupby(["order", "filter"])
    sums = shares(groups.sum(numeric_only=True)).assign(most=groups["most"].max())
    return sums.join(_deviations(groups[SHARES]).add_suffix("_std"))


def _records(sums: pandas.DataFrame, columns: list[str]) -> list[dict]:
    sums = sums.reset_index().rename(columns={"ambiguity": "ambiguity_mean"})[columns]
    return sums.astype(object).where(sums.notna(), None).to_dict("records")


def _table(counts: list[dict], pool: str) -> list[dict]:
    """Sums over the frames; `off` marks filters of SIFT without a limit, which everything passes."""
    if not counts:
        return []
    sums, everything = _sums(counts, pool), _sums(counts, "everything")
    rows = _records(sums.assign(precision_per_edge=sums["precisions"] / sums["alive"],
                                ambiguity_of_pool=sums["kept"] / sums["edges"] - 1,
                                ambiguity_max=(sums["most"] - 1.0).where(sums["most"] > 0)), FILTER_COLUMNS)
    for row, changed in zip(rows, everything[["kept", "veridical", "alive"]].diff().any(axis=1)):
        if row["filter"] in SIFT_FILTERS and not changed:
            row["off"] = True
    return rows


def _quads(frames: list, pool: str) -> dict:
    return _records(_sums([row for frame in frames for row in frame.quads], pool), QUAD_COLUMNS)[0]


def _constraints(frames: list) -> list[dict]:
    pairs, veridical = (pandas.DataFrame([getattr(frame.pairs, name) for frame in frames], columns=list(CONSTRAINTS))
                        for name in ("pairs", "veridical"))
    true = veridical.sum()
    table = pandas.DataFrame({"order": range(len(CONSTRAINTS)), "recall": true / true.iloc[0],
                              "precision": true / pairs.sum(), "pairs": pairs.sum(),
                              "recall_std": _deviations(veridical.div(veridical.iloc[:, 0], axis=0)),
                              "precision_std": _deviations(veridical / pairs)}).rename_axis("constraint")
    return _records(table, ["order", "constraint", "recall", "precision", "pairs", "recall_std", "precision_std"])


def summary(results: list[MatchingResult]) -> dict:
    """The tables of one or several results."""
    frames = [frame for result in results for frame in result.frames]
    stereo = [row for frame in frames for row in frame.stereo]
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
                counts = [row for frame in temporal for row in frame.tables[side]]
                content[f"temporal_{side}{suffix}"] = _table(counts, pool)
        content |= {"quads": _quads(temporal, "paired"), "quads_all": _quads(temporal, "everything"),
                    "constraints": _constraints(temporal)}
    return content


def _per_frame(frame) -> dict:
    result = frame.result
    entry = {"status": result.status} | {name: getattr(result.counts, name) for name in COUNTS}
    return entry | ({"message": result.message} if result.message else {})


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
    return content | {"pooled": summary(results)}
