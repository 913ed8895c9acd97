"""Made-up results of runs and evaluations, in the program's file formats."""

import json
import math
from pathlib import Path

from quadedge.report.batch_summary import pooled

DEVICE = {"name": "abacus", "platform": "wood", "driver": "1", "opencl": "none", "type": "cpu"}
ORIGIN = {"schema": 1, "version": "1.2.3", "commit": "0123456789ab", "date": "2026-05-04T03:02:01Z",
          "command": "quadedge run a/street"}
CONFIGURATION = {"config": {"seed": 1, "stereo": {"ncc_min": 0.55, "sift_max": 0}},
                 "config_changed": {"stereo.ncc_min": "0.55"}}


def statistics(mean: float | None) -> dict:
    return {"mean": mean, "std": mean and mean / 2, "rmse": mean and mean * 1.1, "max": mean and 3 * mean}


def pose_errors(rotation: float | None, translation: float) -> dict:
    return {"ape_rotation_deg": statistics(rotation), "ape_translation_m": statistics(translation),
            "rpe_rotation_deg": statistics(0.01), "rpe_translation_m": statistics(0.004)}


def accuracy(translation: float, open_rotation: str = "") -> dict:
    result = {"origin_aligned": pose_errors(0.5, translation),
              "se3_aligned": pose_errors(None if open_rotation else 0.3, translation / 2), "matched_poses": 12,
              "path_length_m": 20.0, "end_drift_percent": 1.25}
    part = {"pose": 1.2, "rotation": 1.0, "translation": 1.4}
    result["consistency"] = [{"frames": 5, "motions": 7, "error_m": 0.02, "promised_m": 0.01, "error_deg": 0.1,
                              "promised_deg": None, "normalised_error_squared_by_edges": part | {"pose": 4.5},
                              "normalised_error_squared": part}]
    return result | ({"se3_open_rotation": open_rotation} if open_rotation else {})


def write_report(folder: Path, report: dict, **changes) -> dict:
    """Writes a run's report.json with these keys changed; returns it."""
    (folder / "report.json").write_text(json.dumps(report | changes))
    return report | changes


def write_run(folder: Path, frames: int, drift: float = 0.01, *, lost: int = -1,
              breaks: bool = False, errors: dict | None = None) -> dict:
    """Writes a run along a bent path whose estimate drifts sideways; returns its report.

    breaks: the frames after the lost one are a segment of their own.
    """
    folder.mkdir(parents=True)
    (folder / "pictures").mkdir()
    rows, poses, truth, per_pose, covariances = [], [], [], [], []
    for i in range(frames):
        status = "first" if i == 0 else "lost_no_consensus" if i == lost else "tracked"
        segment = int(breaks and i > lost)
        rows.append(f"{i},{0.1 * i:.9f},{status},{segment},0,{1 if i % 4 == 0 else 0},{1000 + i},{1100 + i},500,400,"
                    f"390,{300 - i},{200 - i},{20 + i % 3},12,3,2")
        x, z = 2 * math.sin(0.3 * i), float(i)
        truth.append(f"{0.1 * i:.9f} {x + 3} 1 {z} 0 0 0 1")  # in another world frame
        if segment and i == lost + 1:
            poses.append("# segment 1: the motion since the poses above is unknown")
        if i != lost:
            poses.append(f"{0.1 * i:.9f} {x + drift * i} 0 {z} 0 0 0 1")
            per_pose.append(f"{0.1 * i:.9f},0,{drift * i},{'' if i == 0 else 0},{'' if i == 0 else drift}")
        covariances.append(f"{i},{0.1 * i:.9f},{1e-4 * i},{1e-4 * i},{2e-4 * i}")
    (folder / "frames.csv").write_text(
        "frame,stamp_s,status,segment,key_rig,new_key_rig,edges_left,edges_right,stereo_edges,temporal_left,"
        "temporal_right,quads,inliers,latency_ms,stereo_ms,temporal_ms,pose_ms\n" + "\n".join(rows) + "\n")
    (folder / "trajectory.txt").write_text("# stamp tx ty tz qx qy qz qw\n" + "\n".join(poses) + "\n")
    (folder / "groundtruth.txt").write_text("\n".join(truth) + "\n")
    (folder / "errors.csv").write_text("stamp_s,ape_rotation_deg,ape_translation_m,rpe_rotation_deg,rpe_translation_m\n"
                                       + "\n".join(per_pose) + "\n")
    (folder / "poses.csv").write_text("frame,stamp_s,covariance_x_x,covariance_y_y,covariance_z_z\n"
                                      + "\n".join(covariances) + "\n")
    report = ORIGIN | {
        "device": DEVICE, "input": {"path": "a/street", "format": "kitti", "name": folder.name, "frames": frames,
                                    "width": 640, "height": 480},
        "frames_tracked": frames - (lost >= 0), "frames_lost": int(lost >= 0), "key_rigs": 3, "warnings": [],
        "latency_ms": {"median": 21.0, "p90": 22.0, "p99": 22.0, "max": 22.0, "first": 20.0},
        "stages_ms": {"stereo": {"median": 12.0, "p90": 12.5}}, "memory_mb": {"host_peak": 100.0, "device_peak": 50.0},
        "accuracy": errors or accuracy(0.05)} | CONFIGURATION
    if breaks:
        report["segments_text"] = f"2 segments: an unknown motion lies between frames {lost - 1} and {lost + 1}"
        parts = [accuracy(0.02) | {"segment": 0}, accuracy(0.03) | {"segment": 1, "matched_poses": 1}]
        report["accuracy"] = report["accuracy"] | {"segments": parts}
    return write_report(folder, report, segments=1 + breaks)


def write_batch(folder: Path, names: list[str], frames: int = 12) -> dict:
    """Writes a batch of made-up runs; returns its summary."""
    entries = []
    for number, name in enumerate(names):
        report = write_run(folder / "sequences" / name, frames, 0.01 * (number + 1),
                           errors=accuracy(0.05 * (number + 1)))
        entries.append({"name": name, "status": "done", "exit_code": 0, "message": "", "path": f"a/{name}",
                        "format": "kitti", "jobs": 1, "device": "abacus", "frames": frames, "frames_tracked": frames,
                        "key_rigs": 3, "accuracy": report["accuracy"], "latency_ms": report["latency_ms"]})
    summary = ORIGIN | {"input": "a", "exit_code": 0, "min_tracked_percent": 50, "sequences": entries,
                        "all": {"frames": frames * len(names), "frames_tracked": frames * len(names),
                                "pooled": pooled([entry["accuracy"] for entry in entries]),
                                "latency_ms": entries[0]["latency_ms"]}} | CONFIGURATION
    (folder / "summary.json").write_text(json.dumps(summary))
    return summary


STEREO = ["baseline", "epipolar proximity", "SIFT", "NCC", "best"]
CONSTRAINTS = ["baseline", "length of D", "handedness"]


def _filter_rows(recall: float, edges: int) -> list[dict]:
    rows = []
    for order, name in enumerate(STEREO):
        rows.append({"order": order, "filter": name, "recall": recall - 0.01 * order, "precision": 0.00007 * 10**order,
                     "ambiguity_mean": 100.0 / (order + 1), "ambiguity_max": 7.0, "kept": 1000, "edges": edges,
                     "recall_std": 0.01, "precision_std": None, "ambiguity_std": 1.0})
    rows[2]["off"] = True
    return rows


def _summary() -> dict:
    quads = {"recall": 0.9, "precision": 0.95, "edges": 800, "kept": 700, "recall_std": 0.01, "precision_std": 0.02,
             "ambiguity_mean": 0.25, "ambiguity_std": 0.1}
    return {"left_edges": {"detected": 48299, "no_statement": 100, "along_line": 50, "occluded": 20, "contour": 30},
            "stereo_edges": {"correct": 900, "inaccurate": 50, "wrong": 7, "occluded": 3},
            "stereo": _filter_rows(1.0, 1000), "stereo_all": _filter_rows(0.8, 1300),
            "temporal_left": _filter_rows(1.0, 900), "temporal_left_all": _filter_rows(0.7, 1300),
            "temporal_right": _filter_rows(1.0, 900), "temporal_right_all": _filter_rows(0.7, 1300),
            "disparity_error_px": {"median": 0.046, "p90": 0.21, "bias": -0.003},
            "across_error_px": {"median": 0.02, "p90": 0.1}, "quads": quads, "quads_all": quads | {"recall": 0.6},
            "constraints": [{"order": order, "constraint": name, "recall": 1.0 - 0.1 * order, "precision": 0.5 + 0.1 *
                             order, "pairs": 1000, "recall_std": 0.0, "precision_std": 0.01}
                            for order, name in enumerate(CONSTRAINTS)]}


def made_up_matching(names: list[str], frames: int) -> dict:
    """What `python -m quadedge.matching --json` writes of the named data sets of `frames` frames each."""
    return ORIGIN | {
        "device": DEVICE, "input": names, "tolerance_px": 1.0, "wrong_px": 10.0,
        "pairs": [{"name": name, "frames": frames} | _summary() for name in names],
        "pooled": _summary()} | CONFIGURATION
