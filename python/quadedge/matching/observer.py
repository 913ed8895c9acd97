"""Measures what every filter keeps and loses while the pipeline runs over a pair or a sequence."""

from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np

from .. import Odometry, StereoFilter, Tap, TemporalFilter
from .counts import Judge, Pools, Tolerance, filter_counts, is_veridical, quad_pools, stereo_pools, temporal_pools
from .quad_pairs import PairMeasurement, measure_pairs
from .surfaces import OCCLUDED, UNKNOWN, VISIBLE, FrameTruth, true_later_positions, true_right_positions

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
    result: object = None
    """The FrameResult of the pipeline."""


@dataclass
class MatchingResult:
    """One pair or one sequence."""

    name: str
    frames: list[FrameMatching] = field(default_factory=list)


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


@dataclass
class _Search:
    """One search of the current frame, with what judges its candidates by side."""

    base: int
    measured: Temporal | None = None
    judges: dict[str, Judge] = field(default_factory=dict)
    quad_pools: Pools = None


class MatchingObserver(Tap):
    """A tap of one Odometry. To be called per frame: begin(), Odometry.track(), end(). seed: draws pairs of quads."""

    def __init__(self, rig, seed: int, tolerance: Tolerance):
        super().__init__()
        self._rig, self._seed, self._tolerance, self._frames = rig, seed, tolerance, {}

    def begin(self, number: int, truth: FrameTruth) -> None:
        """Sets the ground truth of the next frame. number: its number in the pipeline."""
        self._frames[number] = self._now = _Observed(truth)
        self._measured, self._searches, self._search = FrameMatching(), {}, None

    def end(self, result) -> FrameMatching:
        """What was measured. Only the temporal search that gave the motion of the frame is evaluated."""
        self._measured.result = result
        if search := self._searches.get(result.diagnostics.search):
            self._measured.temporal = search.measured
        # No later frame is matched with a frame before the keyframe.
        self._frames = {number: frame for number, frame in self._frames.items() if number >= result.reference_frame}
        return self._measured

    def edges(self, left, right) -> None:
        truth = true_right_positions(self._rig, self._now.truth, left)
        self._judge = Judge(truth, stereo_pools(self._rig, left, right, truth, self._tolerance), self._tolerance, right)
        known, counted = truth.state != UNKNOWN, self._judge.pools.everything
        self._measured.census = np.array([len(known), (~known).sum(), (known & ~counted).sum(),
                                          (counted & (truth.state == OCCLUDED)).sum(),
                                          (counted & truth.contour).sum()])
        self._measured.stereo += self._judge.of_baseline(StereoFilter.baseline)

    def stereo_filter(self, filter, candidates) -> None:
        self._measured.stereo += self._judge.of_lists(filter, candidates)

    def stereo(self, edges) -> None:
        left, right, row, truth = edges.left, edges.right, edges.left_index, self._judge.truth
        self._measured.stereo += self._judge.of_pairs(StereoFilter.best, row, *right.T)
        sides = [SimpleNamespace(x=xy[:, 0], y=xy[:, 1], direction=direction)
                 for xy, direction in ((left, edges.left_direction), (right, edges.right_direction))]
        veridical = is_veridical(truth, row, *right.T, self._tolerance)
        self._now.edges, self._now.veridical = _Stereo(*sides, edges.xyz, edges.direction), veridical
        true = np.stack([truth.x, truth.y], axis=1)[row]
        away, state = np.hypot(*(right.astype(float) - true).T), truth.state[row]
        kind = np.where(state == OCCLUDED, 3, np.where(veridical, 0, np.where(away <= self._tolerance.wrong, 1, 2)))
        self._measured.classes = np.bincount(kind[self._judge.pools.everything[row]], minlength=len(CLASSES))
        visible = state == VISIBLE
        dx, dy = (right[visible] - true[visible]).astype(float).T
        angle = edges.right_direction[visible].astype(float)
        self._measured.disparity_error = np.copysign(np.hypot(dx, dy), -dx).astype(np.float32)
        self._measured.across_error = np.abs(np.cos(angle) * dy - np.sin(angle) * dx).astype(np.float32)

    def temporal_search(self, search) -> None:
        found = self._search = self._searches[search.number] = _Search(search.base_frame)
        base, now, tolerance = self._frames[search.base_frame], self._now, self._tolerance
        # A subset of the edges gives a prediction, never a pose.
        if search.step != 1 or base.truth.world_from_left is None or now.truth.world_from_left is None:
            return
        found.measured = Temporal({})
        for side in SIDES:
            later = true_later_positions(self._rig, base.truth, now.truth, side, base.edges.left)
            targets = getattr(now.edges, side)
            pools = temporal_pools(getattr(base.edges, side).direction, base.veridical, targets, later, tolerance)
            found.judges[side] = Judge(later, pools, tolerance, targets)
            found.measured.tables[side] = found.judges[side].of_baseline(TemporalFilter.baseline)
        found.quad_pools = quad_pools(base.edges, base.veridical, now.edges,
                                      *(judge.truth for judge in found.judges.values()), tolerance)

    def temporal_filter(self, filter, side: str, candidates) -> None:
        if self._search.measured:
            self._search.measured.tables[side] += self._search.judges[side].of_lists(filter, candidates)

    def quads(self, quads) -> None:
        search = self._search
        if search.measured is None:
            return
        base, previous, rows = self._frames[search.base], quads.previous, len(self._frames[search.base].veridical)
        veridical = np.ones(len(previous), bool)
        for side, judge in search.judges.items():
            xy = getattr(quads, side).T
            search.measured.tables[side] += judge.of_pairs(TemporalFilter.best, previous, *xy)
            veridical &= is_veridical(judge.truth, previous, *xy, self._tolerance)
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
                                              veridical[usable], self._seed)


def observe(source, device: str, preset: str, config: dict, frames: int, tolerance: Tolerance,
            progress: Callable[[int, int], None] = lambda done, total: None) -> tuple[MatchingResult, object]:
    """Tracks the frames of a source with a tap on the pipeline; returns what it measured, and the DeviceInfo.

    frames: to use from the start; 0: all. progress: called with the number of frames done and their total."""
    config = config | {"odometry.key_rig": False}  # the tables refer to consecutive frames
    result, count = MatchingResult(source.name), min(frames or source.frames, source.frames)
    with Odometry(source.tracked, device, preset, config) as odometry:
        info = odometry.device
        observer = MatchingObserver(source.rig, odometry.config["seed"], tolerance)
        odometry.set_tap(observer)
        for number in range(count):
            frame = source.load(number)
            observer.begin(number, frame.truth)
            result.frames.append(observer.end(odometry.track(frame.stamp_ns, frame.left, frame.right)))
            progress(number + 1, count)
        odometry.set_tap(None)
    return result, info
