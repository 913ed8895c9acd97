"""Measures what every filter keeps and loses while the pipeline runs over a pair or a sequence."""

import copy
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np

from .. import Odometry, StereoFilter, Tap, TemporalFilter
from .counts import (Pools, Tolerance, filter_counts, is_veridical, line_angle, near_truth, quad_pools, stereo_pools,
                     temporal_pools)
from .cues import Cues, Judge, make_cues
from .quad_pairs import PairMeasurement, measure_pairs, motion_errors
from .surfaces import OCCLUDED, UNKNOWN, VISIBLE, FrameTruth, TruePositions, true_later_positions, true_right_positions

SIDES = ("left", "right")
CLASSES = ("correct", "inaccurate", "wrong", "occluded")
"""Of final stereo edges: within Tolerance.position of the true position, within Tolerance.wrong, beyond it, and matches
of edges that the right view does not show, which must be wrong."""
CENSUS = ("detected", "no_statement", "along_line", "occluded", "contour")
"""Of left edges: all; without ground truth; along their epipolar line, which are not matched; of the others, those that
the right view does not show, and those on depth steps."""


@dataclass
class Temporal:
    """Evaluation of the temporal search that gave the motion of a frame."""

    tables: dict[str, list[dict]]
    """Table 2, by side: filter_counts() of its rows."""
    quads: list[dict] = None
    """The same of the quads, with their competing clusters."""
    pairs: PairMeasurement = None


@dataclass
class FrameMatching:
    """One frame. Errors are those of final stereo edges with known, visible true position [px]."""

    stereo: list[dict] = field(default_factory=list)
    """Table 1: filter_counts() of its rows."""
    census: np.ndarray = field(default_factory=lambda: np.zeros(len(CENSUS), int))
    """Numbers of CENSUS."""
    classes: np.ndarray = field(default_factory=lambda: np.zeros(len(CLASSES), int))
    """Numbers of CLASSES in the pool of all edges."""
    disparity_error: np.ndarray = field(default_factory=lambda: np.empty(0, np.float32))
    """(N,): position along the epipolar line minus the true one."""
    across_error: np.ndarray = field(default_factory=lambda: np.empty(0, np.float32))
    """(N,): absolute error across the edge."""
    temporal: Temporal | None = None
    """None for first and lost frames, single pairs, and if the true motion is unknown."""
    motion: np.ndarray | None = None
    """(2,): errors of the motion estimated since the frame that this one was matched with, [deg] and [m]."""
    result: object = None
    """The FrameResult of the pipeline."""


@dataclass
class FinalMatches:
    """The final stereo edges of a frame with ground truth: (N, 3) x, y [px] and direction [rad]; (N, 2) true position
    in the right image [px]; (N,) index of CLASSES."""

    left: np.ndarray
    right: np.ndarray
    true: np.ndarray
    kind: np.ndarray


@dataclass
class MatchingResult:
    """One pair or one sequence."""

    name: str
    frames: list[FrameMatching] = field(default_factory=list)
    cues: Cues = field(default_factory=dict)
    drawn: tuple | None = None
    """Number, left and right image, and FinalMatches of the last frame."""


@dataclass
class _Stereo:
    """Stereo edges by side, with x, y [px] and direction [rad], and their points in space."""

    left: SimpleNamespace
    right: SimpleNamespace
    points: np.ndarray
    tangents: np.ndarray


@dataclass
class _Observed:
    """A frame with which others may be matched."""

    truth: FrameTruth
    edges: _Stereo | None = None
    veridical: np.ndarray | None = None
    pose: np.ndarray | None = None


@dataclass
class _Search:
    """One search of the current frame, with the ground truth of its edges."""

    base: int
    expected: dict
    measured: Temporal | None = None
    later: dict[str, TruePositions] = field(default_factory=dict)
    pools: dict[str, Pools] = field(default_factory=dict)
    quad_pools: Pools = None
    cues: Cues = field(default_factory=dict)


def add_cues(sums: Cues, cues: Cues) -> None:
    """Adds histograms and merges thresholds."""
    for key, cue in cues.items():
        if key in sums:
            sums[key] += cue
        else:
            sums[key] = copy.deepcopy(cue)


def _next(filter):
    return type(filter)(int(filter) + 1)


def _lists(rows: np.ndarray, count: int, target: np.ndarray, xy: np.ndarray):
    """Candidates of ascending rows as lists over all rows, at positions (N, 2)."""
    first = np.searchsorted(rows, np.arange(count + 1)).astype(np.int32)
    return SimpleNamespace(first=first, target=target, x=xy[:, 0], y=xy[:, 1], cue=np.empty(0, np.float32))


class _EpipolarLines:
    """Lines of left points in the right image, in the pipeline's single precision."""

    def __init__(self, rig):
        right, pose = rig.right.matrix, rig.right_from_left
        self._h = (right @ pose[:3, :3] @ np.linalg.inv(rig.left.matrix)).astype(np.float32)
        self._t = (right @ pose[:3, 3]).astype(np.float32)

    def of(self, left, right):
        """Distances along and across the lines of left points at which right points lie [px]."""
        x, y = (self._h[row, 0] * left[0] + self._h[row, 1] * left[1] + self._h[row, 2] for row in (0, 1))
        z = self._h[2, 0] * left[0] + self._h[2, 1] * left[1] + self._h[2, 2]
        x, y = x / z, y / z
        dx, dy = self._t[0] - x * self._t[2], self._t[1] - y * self._t[2]
        length = np.sqrt(dx * dx + dy * dy)
        ex, ey = dx / length, dy / length
        return ((right[0] - x) * ex + (right[1] - y) * ey, np.abs((right[1] - y) * ex - (right[0] - x) * ey))


class MatchingObserver(Tap):
    """A tap of one Odometry. To be called per frame: begin(), Odometry.track(), end(). config: the effective one."""

    def __init__(self, rig, config: dict, tolerance: Tolerance):
        super().__init__()
        if not config["stereo.max_disparity"] and not config["stereo.min_depth"]:
            config = config | {"stereo.max_disparity": rig.disparity_range}
        self._rig, self._config, self._tolerance = rig, config, tolerance
        self._lines, self._frames, self._number = _EpipolarLines(rig), {}, -1
        self.matches: FinalMatches | None = None

    def begin(self, number: int, truth: FrameTruth) -> None:
        """Sets the ground truth of the next frame. number: its number in the pipeline."""
        self._number = number
        self._frames[number] = self._now = _Observed(truth)
        self._measured, self._cues = FrameMatching(), make_cues(self._rig, self._config)
        self._searches, self._search = {}, None

    def end(self, result) -> tuple[FrameMatching, Cues]:
        """What was measured, and the cues. Only the temporal search that gave the motion of the frame is evaluated."""
        self._measured.result, self._now.pose = result, result.pose_or_prediction
        search = self._searches.get(result.diagnostics.search)
        if search is not None:
            base = self._frames[search.base]
            if self._is_known_motion(base):
                self._measured.motion = motion_errors(np.linalg.inv(self._now.pose) @ base.pose,
                                                      self._motion_since(base))
            self._measured.temporal = search.measured
            add_cues(self._cues, search.cues)
        # No later frame is matched with a frame before the keyframe.
        self._frames = {number: frame for number, frame in self._frames.items() if number >= result.reference_frame}
        return self._measured, self._cues

    def _is_known_motion(self, base: _Observed) -> bool:
        return base.truth.world_from_left is not None and self._now.truth.world_from_left is not None

    def _motion_since(self, base: _Observed) -> np.ndarray:
        return np.linalg.inv(self._now.truth.world_from_left) @ base.truth.world_from_left

    def edges(self, left, right) -> None:
        self._left, self._right = left, right
        self._truth = true_right_positions(self._rig, self._now.truth, left)
        self._pools = stereo_pools(self._rig, left, right, self._truth, self._tolerance)
        known, counted = self._truth.state != UNKNOWN, self._pools.everything
        self._measured.census = np.array([len(known), (~known).sum(), (known & ~counted).sum(),
                                          (counted & (self._truth.state == OCCLUDED)).sum(),
                                          (counted & self._truth.contour).sum()])
        self._judge = Judge(self._truth, self._pools, self._tolerance, right)
        self._measured.stereo += self._baseline(StereoFilter.baseline, self._judge)
        self._collect_stereo(StereoFilter.baseline, None)

    def _baseline(self, filter, judge: Judge) -> list[dict]:
        """Row 0: every edge is paired with every target, without creating the lists."""
        rows = len(judge.truth.x)
        found, _ = near_truth(judge.truth, judge.pools.everything, judge.targets, self._tolerance)
        return filter_counts(filter, np.full(rows, len(judge.targets.x)), np.bincount(found, minlength=rows),
                             judge.pools)

    @staticmethod
    def _row(filter, lists, judge: Judge) -> list[dict]:
        row, _, veridical = judge.candidates(lists)
        return filter_counts(filter, np.diff(lists.first), np.bincount(row[veridical], minlength=len(lists.first) - 1),
                             judge.pools)

    def stereo_filter(self, filter, candidates) -> None:
        self._measured.stereo += self._row(filter, candidates, self._judge)
        self._collect_stereo(filter, candidates)

    def stereo(self, edges) -> None:
        left, right, row = edges.left, edges.right, edges.left_index
        lists = _lists(row, len(self._left.x), edges.right_index, right)
        self._measured.stereo += self._row(StereoFilter.best, lists, self._judge)
        sides = [SimpleNamespace(x=xy[:, 0], y=xy[:, 1], direction=direction)
                 for xy, direction in ((left, edges.left_direction), (right, edges.right_direction))]
        veridical = is_veridical(self._truth, row, right[:, 0], right[:, 1], self._tolerance)
        self._now.edges, self._now.veridical = _Stereo(*sides, edges.xyz, edges.direction), veridical
        true = np.stack([self._truth.x, self._truth.y], axis=1)[row]
        away, state = np.hypot(*(right.astype(float) - true).T), self._truth.state[row]
        kind = np.where(state == OCCLUDED, 3, np.where(veridical, 0, np.where(away <= self._tolerance.wrong, 1, 2)))
        judged = self._pools.everything[row]
        self._measured.classes = np.bincount(kind[judged], minlength=len(CLASSES))
        self.matches = FinalMatches(*(np.stack([side.x, side.y, side.direction], axis=1)[judged] for side in sides),
                                    true[judged], kind[judged])
        visible = state == VISIBLE
        dx, dy = (right[visible] - true[visible]).astype(float).T
        angle = edges.right_direction[visible].astype(float)
        self._measured.disparity_error = np.copysign(np.hypot(dx, dy), -dx).astype(np.float32)
        self._measured.across_error = np.abs(np.cos(angle) * dy - np.sin(angle) * dx).astype(np.float32)

    def temporal_search(self, search) -> None:
        self._search = self._searches[search.number] = _Search(search.base_frame,
                                                               {"left": search.left, "right": search.right})
        base = self._frames[search.base_frame]
        # A subset of the edges gives a prediction, never a pose.
        if search.step != 1 or not self._is_known_motion(base):
            return
        found, now, tolerance = self._search, self._now, self._tolerance
        found.measured, found.cues = Temporal({side: [] for side in SIDES}), make_cues(self._rig, self._config)
        for side in SIDES:
            found.later[side] = true_later_positions(self._rig, base.truth, now.truth, side, base.edges.left)
            found.pools[side] = temporal_pools(getattr(base.edges, side).direction, base.veridical,
                                               getattr(now.edges, side), found.later[side], tolerance)
            found.measured.tables[side] += self._baseline(TemporalFilter.baseline, self._judge_of(side))
            self._collect_temporal(TemporalFilter.baseline, side, None)
        found.quad_pools = quad_pools(base.edges, base.veridical, now.edges, *found.later.values(), tolerance)

    def _judge_of(self, side: str) -> Judge:
        return Judge(self._search.later[side], self._search.pools[side], self._tolerance,
                     getattr(self._now.edges, side))

    def temporal_filter(self, filter, side: str, candidates) -> None:
        if self._search.measured is None:
            return
        self._search.measured.tables[side] += self._row(filter, candidates, self._judge_of(side))
        self._collect_temporal(filter, side, candidates)

    def quads(self, quads) -> None:
        search = self._search
        if search.measured is None:
            return
        base, previous, rows = self._frames[search.base], quads.previous, len(self._frames[search.base].veridical)
        veridical = np.ones(len(previous), bool)
        for side in SIDES:
            xy = getattr(quads, side)
            lists = _lists(previous, rows, quads.current, xy)
            search.measured.tables[side] += self._row(TemporalFilter.best, lists, self._judge_of(side))
            veridical &= is_veridical(search.later[side], previous, xy[:, 0], xy[:, 1], self._tolerance)
        found = [np.bincount(which, minlength=rows) for which in (previous, previous[veridical])]
        search.measured.quads = filter_counts(
            TemporalFilter.best, *found, search.quad_pools,
            competing=np.bincount(previous, quads.competing_clusters, minlength=rows).astype(int))
        points = [(edges.points[index], edges.tangents[index])
                  for edges, index in ((base.edges, previous), (self._now.edges, quads.current))]
        usable = search.quad_pools.everything[previous]
        for xyz, _ in points:
            usable &= np.isfinite(xyz).all(axis=1)
        search.measured.pairs = measure_pairs(*((xyz[usable], tangent[usable]) for xyz, tangent in points),
                                              veridical[usable], self._config["seed"], self._motion_since(base),
                                              search.cues)

    def _collect_stereo(self, filter, candidates) -> None:
        """The cue of the filter that follows `filter`."""
        cue = self._cues.get(("stereo", int(_next(filter))))
        if cue is None:
            return
        left, right, judge = self._left, self._right, self._judge

        def line(part):
            return lambda row, target: self._lines.of((left.x[row], left.y[row]), (right.x[target], right.y[target]))[
                part]

        if filter == StereoFilter.baseline:
            judge.collect_unfiltered(self._config["seed"], line(1), cue)
        elif filter == StereoFilter.epipolar_distance:
            judge.collect(candidates, line(0), cue)
        elif filter == StereoFilter.disparity:
            judge.collect(candidates, lambda row, target: line_angle(left.direction[row], right.direction[target]), cue)
        else:
            self._collect_similarity(_next(filter), candidates, judge, cue)

    def _collect_temporal(self, filter, side: str, candidates) -> None:
        """The same for the temporal search in progress."""
        cue = self._search.cues.get((f"temporal_{side}", int(_next(filter))))
        if cue is None:
            return
        now, expected, judge = getattr(self._now.edges, side), self._search.expected[side], self._judge_of(side)
        if filter == TemporalFilter.baseline:
            judge.collect_unfiltered(self._config["seed"], lambda row, target: np.hypot(
                now.x[target] - expected.x[row], now.y[target] - expected.y[row]), cue)
        elif filter == TemporalFilter.displacement:
            def turned(row, target):
                angle = expected.direction[row].astype(float) - now.direction[target]
                return np.degrees(np.abs(angle - 2 * np.pi * np.rint(angle / (2 * np.pi))))

            judge.collect(candidates, turned, cue)
        else:
            self._collect_similarity(_next(filter), candidates, judge, cue)

    @staticmethod
    def _collect_similarity(filter, candidates, judge: Judge, cue) -> None:
        relative = {"nearly_best_ncc": "highest", "nearly_best_sift": "lowest"}.get(filter.name, "")
        judge.collect_scores(candidates, cue, relative)


def observe(source, device: str, preset: str, config: dict, frames: int, tolerance: Tolerance,
            progress: Callable[[int, int], None] = lambda done, total: None) -> tuple[MatchingResult, object]:
    """Tracks the frames of a source with a tap on the pipeline; returns what it measured, and the DeviceInfo.

    frames: to use from the start; 0: all. progress: called with the number of frames done and their total."""
    config = config | {"odometry.key_rig": False}  # the tables refer to consecutive frames
    result, count = MatchingResult(source.name), min(frames or source.frames, source.frames)
    with Odometry(source.tracked, device, preset, config) as odometry:
        info = odometry.device
        observer = MatchingObserver(source.rig, odometry.config, tolerance)
        odometry.set_tap(observer)
        for number in range(count):
            frame = source.load(number)
            observer.begin(number, frame.truth)
            measured, cues = observer.end(odometry.track(frame.stamp_ns, frame.left, frame.right))
            result.frames.append(measured)
            add_cues(result.cues, cues)
            progress(number + 1, count)
        odometry.set_tap(None)
    result.drawn = (count - 1, frame.left, frame.right, observer.matches) if count else None
    return result, info
