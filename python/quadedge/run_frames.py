"""The frames in the results folder of a run."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy

from .errors import DataError
from .result_files import read_table, rotations

_COUNTS = ("stereo_edges", "quads", "inliers")
_AXES = ("x", "y", "z", "rx", "ry", "rz")
_UPPER_TRIANGLE = [(i, j) for i in range(6) for j in range(i, 6)]


@dataclass
class RunDiagnostics:
    """Those attributes of FrameDiagnostics that a twist is made of."""

    base_frame: int
    covariance_in_reference: numpy.ndarray | None  #: (6, 6) [m, rad]


@dataclass
class RunFrame:
    """One frame in frames.csv and poses.csv; the attributes that FrameResult has, too, have the same meaning."""

    stamp_ns: int
    status: str
    segment: int
    reference_frame: int
    new_key_rig: bool
    ambiguous_motion: bool
    world_from_left: numpy.ndarray | None  #: (4, 4) [m]
    predicted_world_from_left: numpy.ndarray | None  #: (4, 4) [m], of a lost frame
    covariance: numpy.ndarray | None  #: (6, 6) of world_from_left [m, rad], within the segment
    current_from_reference: numpy.ndarray | None  #: (4, 4) [m]
    diagnostics: RunDiagnostics
    counts: dict[str, float]
    times_ms: dict[str, float]
    message: str

    @property
    def is_tracked(self) -> bool:
        return not self.status.startswith("lost")

    @property
    def pose_or_prediction(self) -> numpy.ndarray:
        return self.predicted_world_from_left if self.world_from_left is None else self.world_from_left


def _pose(row: dict[str, str], prefix: str = "") -> numpy.ndarray | None:
    texts = [row[prefix + name] for name in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    if not all(texts):
        return None
    pose, values = numpy.eye(4), numpy.array([float(text) for text in texts])
    pose[:3, :3], pose[:3, 3] = rotations(values[None, 3:])[0], values[:3]
    return pose


def _covariance(row: dict[str, str], prefix: str = "") -> numpy.ndarray | None:
    texts = {(i, j): row[f"{prefix}covariance_{_AXES[i]}_{_AXES[j]}"] for i, j in _UPPER_TRIANGLE}
    if not all(texts.values()):
        return None
    covariance = numpy.empty((6, 6))
    for (i, j), text in texts.items():
        covariance[i, j] = covariance[j, i] = float(text)
    return covariance


def _stamp_ns(text: str) -> int:
    seconds, _, fraction = text.partition(".")
    return int(seconds + fraction.ljust(9, "0"))


def _times(row: dict[str, str]) -> dict[str, float]:
    return {name.removesuffix("_ms"): float(value) for name, value in row.items() if name.endswith("_ms") and value}


def read_frames(folder: str | PathLike) -> list[RunFrame]:
    """The frames of a results folder. Raises DataError for a folder without results, and for damaged ones."""
    folder = Path(folder)
    frames, poses = (read_table(folder / name).to_dict("records") for name in ("frames.csv", "poses.csv"))
    if len(frames) != len(poses):
        raise DataError(f"{folder}: found {len(frames)} rows in frames.csv and {len(poses)} in poses.csv, expected the "
                        "same number")
    rows = []
    for frame, pose in zip(frames, poses):
        try:
            key_from_current = _pose(pose, "reference_")
            rows.append(RunFrame(
                _stamp_ns(frame["stamp_s"]), frame["status"], int(frame.get("segment", 0)),
                int(pose.get("reference_frame", -1)), frame["new_key_rig"] == "1", frame.get("ambiguous_motion") == "1",
                *((None, _pose(pose)) if frame["status"].startswith("lost") else (_pose(pose), None)),
                _covariance(pose), None if key_from_current is None else numpy.linalg.inv(key_from_current),
                RunDiagnostics(int(pose.get("base_frame", -1)), _covariance(pose, "reference_")),
                {name: float(frame[name]) for name in _COUNTS}, _times(frame), frame["warning"] or frame["message"]))
        except (KeyError, ValueError) as error:
            raise DataError(f"{folder}: row {len(rows)} of frames.csv or poses.csv is damaged ({error}), expected "
                            "those of `quadedge run`") from error
    return rows
