"""The results of a batch in one table: how each sequence ended, what its files say, and all of them together."""

import json
import math
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas

from ..errors import DataError, DeviceError, Error, UsageError
from ..result_files import DamagedResults, expecting, numbers, read_json, read_table
from . import make_page
from .error_tables import ALIGNMENTS, ERRORS, STATISTICS
from .numbers import exists, share_of
from .page import write_atomically
from .results import read_run

SCHEMA = 1  # of summary.json; grows when a key changes its meaning
TOO_FEW_TRACKED = 5
FROM_BAD_TO_WORSE = (0, TOO_FEW_TRACKED, UsageError.exit_code, DataError.exit_code, DeviceError.exit_code,
                     Error.exit_code)
ACCURACY = (*ALIGNMENTS, "matched_poses", "rpe_steps", "path_length_m", "end_drift_percent", "se3_open_rotation")


def read_plan(out: Path) -> dict:
    """OUT/batch.json. Raises DamagedResults."""
    plan = read_json(out / "batch.json", "what `quadedge batch` is to run")
    with expecting("what `quadedge batch` is to run", out / "batch.json"):
        return plan | {"jobs": int(plan["jobs"]), "sequences": [dict(sequence) for sequence in plan["sequences"]]}


def is_finished(folder: Path) -> bool:
    """Whether a folder holds the whole result of a sequence that did not fail."""
    try:
        if read_json(folder / "member.json", "how a sequence ended").get("exit_code") != 0:
            return False
        run = read_run(folder)
        with expecting("the report of a run", folder / "report.json"):
            return run.count() == run.report["input"]["frames"] and len(run.estimate) == run.report["frames_tracked"]
    except DamagedResults:
        return False


@dataclass
class Row:
    """One sequence in summary.json, and the latencies of its frames [ms]."""

    entry: dict
    latencies: np.ndarray


def read_row(folder: Path, name: str, plan: dict) -> Row:
    """What `folder` says of a sequence; a damaged result counts as failed."""
    entry = {"name": name, "status": "not run", "exit_code": DataError.exit_code, "message": "not run", "path": "",
             "format": "", "jobs": 1}
    nothing = np.empty(0)
    if not (folder / "member.json").is_file():
        return Row(entry, nothing)
    entry["status"] = "failed"
    try:
        member = read_json(folder / "member.json", "how a sequence ended")
        with expecting("how a sequence ended", folder / "member.json"):
            entry |= {key: member[key] for key in ("path", "format", "exit_code", "message", "jobs")}
        if entry["exit_code"] != 0:
            return Row(entry, nothing)
        frames = read_table(folder / "frames.csv")
        latencies = numbers(frames["latency_ms"], folder / "frames.csv") if "latency_ms" in frames else nothing
        with expecting("the report of a run", folder / "report.json"):
            return Row(entry | _figures(read_json(folder / "report.json", "the report of a run"), plan), latencies)
    except DamagedResults as problem:
        message = f"its results are damaged: {problem}"
        return Row(entry | {"exit_code": DataError.exit_code, "message": message}, nothing)


def _figures(report: dict, plan: dict) -> dict:
    """What summary.json has of a finished run."""
    frames, tracked = report["input"]["frames"], report["frames_tracked"]
    entry = {"status": "done", "device": report.get("device", {}).get("name", ""), "frames": frames,
             "frames_tracked": tracked, "tracked_fraction": tracked / frames if frames else None,
             "key_rigs": report["key_rigs"], "segments": report.get("segments", 1), "latency_ms": report["latency_ms"]}
    if 100 * tracked < plan["min_tracked_percent"] * frames:
        entry |= {"status": "too few tracked", "exit_code": TOO_FEW_TRACKED,
                  "message": f"tracked {tracked} of {frames} frames"}
    if "accuracy" in report:
        entry["accuracy"] = {key: report["accuracy"][key] for key in ACCURACY if key in report["accuracy"]}
    return entry


def outcome(folder: Path, name: str, plan: dict) -> str:
    """How a sequence ended, in one line."""
    entry = read_row(folder, name, plan).entry
    if "frames" not in entry:
        return f"failed: {entry['message']}"
    text = f"{entry['frames_tracked']} of {entry['frames']} frames tracked"
    if "accuracy" in entry:
        errors = entry["accuracy"]["origin_aligned"]
        rotation, translation = errors["ape_rotation_deg"]["mean"], errors["ape_translation_m"]["mean"]
        if exists(rotation) and exists(translation):
            text += f", APE {rotation:.3f} deg, {translation:.4f} m"
    return text


def pooled(parts: list[dict]) -> dict:
    """The accuracy of several sequences together, every pose with the same weight."""
    def steps(part: dict) -> int:
        return part.get("rpe_steps", part["matched_poses"] - 1)

    def pool(alignment: str, error: str) -> dict:
        found = pandas.DataFrame([part[alignment][error] for part in parts], dtype=float)
        found["weight"] = [part["matched_poses"] if error.startswith("ape") else steps(part) for part in parts]
        found = found.dropna(subset=["mean"])
        if not found["weight"].sum():
            return dict.fromkeys(STATISTICS)
        mean, square = (np.average(values, weights=found["weight"]) for values in (found["mean"], found["rmse"] ** 2))
        return {"mean": mean, "std": math.sqrt(max(0, square - mean**2)), "rmse": math.sqrt(square),
                "max": found["max"].max()}

    path = sum(part["path_length_m"] or 0 for part in parts)
    drift = sum((part["end_drift_percent"] or 0) * (part["path_length_m"] or 0) for part in parts)
    return {alignment: {error: pool(alignment, error) for error in ERRORS} for alignment in ALIGNMENTS} | {
        "matched_poses": sum(part["matched_poses"] for part in parts), "rpe_steps": sum(map(steps, parts)),
        "path_length_m": path, "end_drift_percent": drift / path if path else None}


def latency_of(rows: list[Row]) -> dict:
    """Over all frames but the first of each sequence, whose median is `first` [ms]."""
    timed = [row.latencies for row in rows if len(row.latencies)]
    steady = np.concatenate([latencies[1:] for latencies in timed]) if timed else np.empty(0)
    if not len(steady):
        return dict.fromkeys(("median", "p90", "p99", "max", "first"))
    values = dict(zip(("median", "p90", "p99", "max"), np.percentile(steady, (50, 90, 99, 100)).tolist()))
    return values | {"first": float(np.median([latencies[0] for latencies in timed]))}


def worst(codes: Iterable[int]) -> int:
    """The worst of several exit codes."""
    return max(codes, key=FROM_BAD_TO_WORSE.index, default=0)


def summarise(out: Path, plan: dict) -> dict:
    """summary.json: all figures, unrounded."""
    rows = [read_row(out / "sequences" / sequence["name"], sequence["name"], plan) for sequence in plan["sequences"]]
    entries = [row.entry for row in rows]
    ran = [entry for entry in entries if "frames" in entry]
    parts = [entry["accuracy"] for entry in ran if "accuracy" in entry]
    frames, tracked = (sum(entry[key] for entry in ran) for key in ("frames", "frames_tracked"))
    origin = {key: plan[key] for key in ("version", "commit", "date", "command", "input", "config", "config_changed",
                                         "min_tracked_percent") if key in plan}
    everything = {"frames": frames, "frames_tracked": tracked, "tracked_fraction": tracked / frames if frames else None,
                  "latency_ms": latency_of(rows)}
    if parts:
        everything["pooled"] = pooled(parts)
    return {"schema": SCHEMA} | origin | {"exit_code": worst(entry["exit_code"] for entry in entries),
                                          "sequences": entries, "all": everything}


def summarise_batch(out: Path, plan: dict) -> int:
    """Writes summary.json, its page and its tables, and prints the tables; what failed goes to standard error. Returns
    the worst exit code."""
    summary = summarise(out, plan)
    write_atomically(out / "summary.json", json.dumps(summary, indent=2) + "\n")
    make_page(out, markdown=out / "summary.md")
    print((out / "summary.md").read_text(encoding="utf-8"))
    done = sum(entry["status"] == "done" for entry in summary["sequences"])
    everything = summary["all"]
    print(f"{done} of {len(summary['sequences'])} sequences done, frames tracked: "
          f"{share_of(everything['frames_tracked'], everything['frames'])}; results in {out}", flush=True)
    for entry in summary["sequences"]:
        if entry["status"] != "done":
            print(f"quadedge: {entry['name']} ({entry['status']}): {entry['message']}", file=sys.stderr)
    return summary["exit_code"]
