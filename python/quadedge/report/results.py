"""What a run leaves behind, read back (doc/reference.md, "Output of a run")."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path

import numpy as np
import pandas

from ..result_files import DamagedResults, expecting, numbers, read_json, read_table, rotations, whole_lines

STAMP_TOLERANCE_S = 0.01  # as the evaluation of trajectories matches poses


@dataclass
class Trajectory:
    """Poses of the left camera: stamps [s], positions (n x 3) [m], rotations (n x 3 x 3)."""

    stamps: np.ndarray
    positions: np.ndarray
    rotations: np.ndarray

    def __len__(self) -> int:
        return len(self.stamps)

    def part(self, indices: np.ndarray) -> "Trajectory":
        """The poses with these indices."""
        return Trajectory(self.stamps[indices], self.positions[indices], self.rotations[indices])


def read_tum(file: Path, *, may_be_cut: bool = False) -> Trajectory:
    """A trajectory in TUM format. Raises DamagedResults. `may_be_cut`: as for whole_lines()."""
    lines = [line.split() for line in whole_lines(file, may_be_cut=may_be_cut)]
    try:
        rows = [[float(word) for word in line] for line in lines if line and not line[0].startswith("#")]
    except ValueError as problem:
        raise DamagedResults(f"{file}: {problem}; expected a trajectory in TUM format") from None
    for number, row in enumerate(rows, 1):
        if len(row) != 8 or abs(np.linalg.norm(row[4:]) - 1) > 1e-3:
            raise DamagedResults(f"{file}: pose {number}: expected a stamp, a position and a quaternion of norm 1")
    values = np.array(rows, float).reshape(-1, 8)
    return Trajectory(values[:, 0], values[:, 1:4], rotations(values[:, 4:]))


def first_match(poses: Trajectory, others: Trajectory) -> tuple[int, int] | None:
    """The first pose that has one of (nearly) the same time in the other trajectory, and that one."""
    for i, stamp in enumerate(poses.stamps):
        if not len(others):
            return None
        j = int(np.argmin(np.abs(others.stamps - stamp)))
        if abs(others.stamps[j] - stamp) <= STAMP_TOLERANCE_S:
            return i, j
    return None


def moved(poses: Trajectory, index: int, position: np.ndarray, rotation: np.ndarray) -> Trajectory:
    """The trajectory in the world where its pose `index` is the given one."""
    turn = rotation @ poses.rotations[index].T
    return Trajectory(poses.stamps, (poses.positions - poses.positions[index]) @ turn.T + position,
                      turn @ poses.rotations)


def aligned(poses: Trajectory, reference: Trajectory) -> Trajectory | None:
    """Moved so that it agrees with the reference at the first time that both know; None where there is none."""
    match = first_match(poses, reference)
    return match and moved(poses, match[0], reference.positions[match[1]], reference.rotations[match[1]])


ERRORS = ("stamp_s", "ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m")


@dataclass
class Run:
    """One run. Positions are in the left camera's first pose that has ground truth: x right, y down, z forward [m]."""

    name: str
    folder: Path
    report: dict
    frames: pandas.DataFrame
    """The texts of frames.csv."""
    estimate: Trajectory
    truth: Trajectory | None
    errors: pandas.DataFrame | None
    """Of every pose against the ground truth, origin-aligned, against time [s, deg, m]; NaN where undefined."""
    predicted: dict[str, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)
    """Stamps [s], and what the covariances predict of the errors in the world: the roots of the traces of the
    position's part ("ape_translation_m") [m] and of the rotation's ("ape_rotation_deg") [deg]."""
    pictures: list[Path] = field(default_factory=list)
    corrected: Trajectory | None = None
    """The trajectory of the map, of a run with --loops."""
    loops: pandas.DataFrame | None = None
    """The texts of loops.csv."""
    edges: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    """Some edges in space, of edges.csv [m]."""

    @property
    def start(self) -> float:
        """Stamp of the first frame [s]."""
        return float(self.frames["stamp_s"][0])

    def column(self, name: str) -> np.ndarray:
        """A column of frames.csv as numbers."""
        return numbers(self.frames[name], self.folder / "frames.csv")

    @property
    def times(self) -> np.ndarray:
        """Of the frames, since the first one [s]."""
        return self.column("stamp_s") - self.start

    def segments(self) -> Iterator[tuple[int, np.ndarray]]:
        """Number of every segment and the indices of its estimated poses; a run before 0.2 has a single one."""
        numbers = self.column("segment") if "segment" in self.frames else np.zeros(self.count())
        of_poses = numbers[~self.frames["status"].map(is_lost)][:len(self.estimate)]
        for segment in np.unique(of_poses):
            yield int(segment), np.nonzero(of_poses == segment)[0]

    def count(self) -> int:
        return len(self.frames)

    def losses(self) -> Iterator[tuple[range, str, str]]:
        """Frames lost one after the other for the same reason: their numbers, the reason, the first one's message."""
        messages = self.frames.get("message", [""] * self.count())
        for status, group in groupby(range(self.count()), key=lambda number: self.frames["status"][number]):
            lost = list(group)
            if is_lost(status):
                yield range(lost[0], lost[-1] + 1), reason_of(status), messages[lost[0]]


REQUIRED_COLUMNS = ("stamp_s", "status", "new_key_rig", "latency_ms", "edges_left", "edges_right", "stereo_edges",
                    "quads", "inliers")


def read_run(folder: Path, name: str = "") -> Run:
    """Everything of one run's folder. Raises DamagedResults for what a finished run must have; errors.csv, poses.csv
    and pictures may be missing. A run that was killed left no report.json: its last rows may be cut."""
    killed = not (folder / "report.json").is_file()
    if killed and not (folder / "frames.csv").is_file():
        raise DamagedResults(f"{folder}: no report.json or frames.csv; expected the folder of a run")
    frames = read_table(folder / "frames.csv", may_be_cut=killed)
    for column in REQUIRED_COLUMNS:
        if column not in frames:
            raise DamagedResults(f"{folder / 'frames.csv'}: no column {column}; expected a frames.csv of a run")
    if frames.empty:
        raise DamagedResults(f"{folder / 'frames.csv'}: no frame; expected those of a run")
    report = report_of_killed(folder, frames) if killed else read_json(folder / "report.json", "the report of a run")
    estimate = read_tum(folder / "trajectory.txt", may_be_cut=killed)
    truth = read_tum(folder / "groundtruth.txt") if (folder / "groundtruth.txt").is_file() else None
    match = first_match(estimate, truth) if truth else None
    edges = read_edges(folder / "edges.csv") if (folder / "edges.csv").is_file() else np.empty((0, 3))
    if match:
        truth = moved(truth, match[1], np.zeros(3), np.eye(3))
        before, estimate = estimate, aligned(estimate, truth)
        turn = estimate.rotations[match[0]] @ before.rotations[match[0]].T
        edges = (edges - before.positions[match[0]]) @ turn.T + estimate.positions[match[0]]
    with expecting("the report of a run", folder / "report.json"):
        run = Run(name or report["input"]["name"], folder, report, frames, estimate, truth if match else None, None,
                  edges=edges)
    if (folder / "errors.csv").is_file() and match:
        table = read_table(folder / "errors.csv").reindex(columns=list(ERRORS))
        run.errors = pandas.DataFrame(numbers(table, folder / "errors.csv"), columns=list(ERRORS))
    if (folder / "poses.csv").is_file():
        run.predicted = read_predicted(folder / "poses.csv", may_be_cut=killed)
    if (folder / "trajectory_map.txt").is_file() and (folder / "loops.csv").is_file():
        corrected = read_tum(folder / "trajectory_map.txt")
        run.corrected = aligned(corrected, run.truth) if run.truth else corrected
        run.loops = read_table(folder / "loops.csv")
    if (folder / "pictures").is_dir():
        run.pictures = sorted((folder / "pictures").iterdir())
    return run


def read_predicted(file: Path, *, may_be_cut: bool) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Run.predicted of poses.csv; what has no covariances is missing. Raises DamagedResults."""
    columns = read_table(file, may_be_cut=may_be_cut)
    found = {}
    for key, axes, factor in (("ape_translation_m", ("x", "y", "z"), 1), ("ape_rotation_deg", ("rx", "ry", "rz"),
                                                                           180 / np.pi)):
        names = [f"covariance_{axis}_{axis}" for axis in axes]
        if set(names) <= set(columns):
            variance = numbers(columns[names], file).sum(axis=1)
            found[key] = numbers(columns["stamp_s"], file), factor * np.sqrt(variance)
    return found


def read_edges(file: Path) -> np.ndarray:
    """The points of edges.csv (n x 3) [m]. Raises DamagedResults."""
    columns, names = read_table(file), ["x_m", "y_m", "z_m"]
    if not set(names) <= set(columns):
        raise DamagedResults(f"{file}: no column {' or '.join(names)}; expected the edges of a run")
    return numbers(columns[names], file)


def report_of_killed(folder: Path, frames: pandas.DataFrame) -> dict:
    """What report.json would say of a run that was killed, as far as its other files tell. Raises DamagedResults."""
    latency = numbers(frames["latency_ms"], folder / "frames.csv")
    steady = latency[1:] if len(latency) > 1 else latency
    return {"input": {"name": folder.resolve().name, "frames": len(latency)},
            "ended_early": f"killed after {len(latency)} frames, before it could write report.json",
            "frames_tracked": int((~frames["status"].map(is_lost)).sum()),
            "key_rigs": int((frames["new_key_rig"] == "1").sum()),
            "warnings": [{"frame": number, "text": text} for number, text in enumerate(frames.get("warning", []))
                         if text],
            "latency_ms": {"first": latency[0], "max": steady.max()} | dict(zip(
                ("median", "p90", "p99"), np.percentile(steady, (50, 90, 99)).tolist()))}


def is_lost(status: str) -> bool:
    return status.startswith("lost")


def reason_of(status: str) -> str:
    """"no consensus" of the status "lost_no_consensus"."""
    return status.removeprefix("lost_").replace("_", " ")
