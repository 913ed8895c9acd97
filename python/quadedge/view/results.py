"""A finished run on rerun's time line."""

import csv
import json
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy

from ..errors import DataError
from .viewer import Viewer

_COUNTS = ("stereo_edges", "quads", "inliers")


@dataclass
class FrameRow:
    """What frames.csv and poses.csv say of a frame."""

    stamp_ns: int
    status: str
    new_key_rig: bool
    world_from_left: numpy.ndarray  #: (4, 4) [m]
    counts: dict[str, float]
    times_ms: dict[str, float]
    message: str

    @property
    def is_tracked(self) -> bool:
        return not self.status.startswith("lost")


def _table(path: Path) -> list[dict[str, str]]:
    if not path.is_file():
        raise DataError(f"{path}: found no such file, expected the results of `quadedge run`")
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _pose(row: dict[str, str]) -> numpy.ndarray:
    x, y, z, w = (float(row[name]) for name in ("qx", "qy", "qz", "qw"))
    pose = numpy.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]  # fmt: skip
    pose[:3, 3] = [float(row[name]) for name in "xyz"]
    return pose


def _times(row: dict[str, str]) -> dict[str, float]:
    return {name.removesuffix("_ms"): float(value) for name, value in row.items() if name.endswith("_ms") and value}


def read_frames(folder: Path) -> list[FrameRow]:
    """The frames of a results folder. Raises DataError for one that is none."""
    frames, poses = _table(folder / "frames.csv"), _table(folder / "poses.csv")
    if len(frames) != len(poses):
        raise DataError(f"{folder}: found {len(frames)} rows in frames.csv and {len(poses)} in poses.csv, expected the "
                        "same number")
    rows = []
    for frame, pose in zip(frames, poses):
        try:
            rows.append(FrameRow(
                int(frame["stamp_s"].replace(".", "")), frame["status"], frame["new_key_rig"] == "1", _pose(pose),
                {name: float(frame[name]) for name in _COUNTS}, _times(frame), frame["warning"] or frame["message"]))
        except (KeyError, ValueError, TypeError) as error:
            raise DataError(f"{folder}: row {len(rows)} of frames.csv or poses.csv is damaged ({error}), expected "
                            "those of `quadedge run`") from error
    return rows


def _recording_of(folder: Path, data: str | PathLike | None):
    """The Dataset that a run was made from; ``data``: where it lies now."""
    from .. import open_dataset

    report = folder / "report.json"
    try:
        source = json.loads(report.read_text())["input"]
    except (OSError, ValueError, KeyError) as error:
        raise DataError(f"{report}: found no input ({error}), expected the report of `quadedge run`") from error
    return open_dataset(source["path"] if data is None else data, format=source["format"])


def _show_with_images(folder: Path, rows: list[FrameRow], viewer: Viewer, data, device: str) -> None:
    """Tracks the recording again, with the run's configuration: edges are not among the results."""
    from .. import Odometry

    dataset = _recording_of(folder, data)
    odometry = Odometry(dataset, device, config=folder / "config.toml")
    numbers = {row.stamp_ns: number for number, row in enumerate(rows)}
    for frame in dataset:
        if frame.stamp_ns not in numbers:
            continue
        number = numbers[frame.stamp_ns]
        row = rows[number]
        odometry.track(frame.stamp_ns, frame.left, frame.right)
        viewer.start_frame(row.stamp_ns, number)
        viewer.log_images(odometry.rig, frame.left, frame.right)
        viewer.log_edges(odometry.details(), row.world_from_left, row.new_key_rig)


def show_results(folder: str | PathLike, viewer: Viewer, *, images: bool = True, data: str | PathLike | None = None,
                 device: str = "auto") -> int:
    """Shows a results folder of ``quadedge run``; returns its number of frames.

    Path, key rigs, counts and times come from its files. With ``images`` the recording is tracked once more for the
    edges and quads; ``data``: where it lies, when not where it was.

    Raises DataError for a folder without results, and for a recording that cannot be read.
    """
    folder = Path(folder)
    rows = read_frames(folder)
    for number, row in enumerate(rows):
        viewer.start_frame(row.stamp_ns, number)
        viewer.log_pose(row.world_from_left, row.is_tracked, row.new_key_rig)
        viewer.log_numbers(row.counts, row.times_ms, row.message)
    if images:
        _show_with_images(folder, rows, viewer, data, device)
    return len(rows)
