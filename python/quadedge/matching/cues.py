"""Distributions of the filters' cues over veridical and other pairs (the paper's Figures 3, 5 and 6)."""

from dataclasses import dataclass, field

import numpy as np

from .counts import Pools, Tolerance, is_veridical, near_truth
from .surfaces import TruePositions

DRAWN_OTHERS = 40
"""Of the other pairs before the first filter, per row."""
LENGTH, ANGLE, TANGENT, MIN_ANGLE, MIN_DETERMINANT = 0.13, 0.12, 0.32, 14.0, 0.1
"""Thresholds of the paper's Equation 9; host/tracker/motion/pose_constants.hpp."""
SIFT_NEARLY_BEST, SUPPORT_WEIGHT, TEMPORAL_ORIENTATION = 0.4, 0.4, 10.0
"""Constants of the cascades; host/tracker/common/matching_constants.hpp."""
_SLACK = 1e-3
"""Bins: in single precision, an NCC of one may slightly exceed one."""


def histogram(values: np.ndarray, low: float, high: float, count: int) -> np.ndarray:
    """(count + 2,): numbers of values below low .. high, in its bins of equal width, and above; NaN is ignored."""
    values, ends = np.asarray(values, float), np.linspace(low, high, count + 1)
    ends[[0, -1]] += _SLACK * (ends[1] - ends[0]) * np.array([-1, 1])
    return np.concatenate([[(values < ends[0]).sum()], np.histogram(values, ends)[0], [(values > ends[-1]).sum()]])


def histogram_document(counts: np.ndarray) -> dict:
    return {"below": int(counts[0]), "bins": counts[1:-1].tolist(), "above": int(counts[-1])}


KINDS = ("veridical", "other", "veridical_all", "other_all")


@dataclass
class Cue:
    """Values of one cue over the pairs that reach the filter using it."""

    name: str
    unit: str
    keeps_small: bool
    thresholds: list[float]
    bins: tuple[float, float, int]
    sampled: bool = False
    """The other pairs are a random sample, because there are too many."""
    of: dict[str, np.ndarray] = field(default_factory=dict)
    """Histograms by KINDS."""

    def __post_init__(self):
        self.of = self.of or {kind: np.zeros(self.bins[2] + 2, int) for kind in KINDS}

    def add(self, values: np.ndarray, veridical: np.ndarray, paired: np.ndarray) -> None:
        """Values of pairs of the pool of all edges; `paired` marks those of the other pool."""
        for kind, chosen in zip(KINDS, (veridical & paired, ~veridical & paired, veridical, ~veridical)):
            self.of[kind] += histogram(np.asarray(values)[chosen], *self.bins)

    def __iadd__(self, other: "Cue") -> "Cue":
        for kind in KINDS:
            self.of[kind] += other.of[kind]
        self.thresholds += [value for value in other.thresholds if value not in self.thresholds]
        return self


Cues = dict[tuple[str, int], Cue]
"""By cascade (stereo, temporal_left, temporal_right, constraints) and number of the filter or constraint."""


def _similarities(cues: Cues, table: str, first: str, sift_max: float, ncc: tuple, sift_nearly_best: float) -> None:
    uses_sift = sift_max > 0  # 0: without SIFT
    by_name = {"ncc": Cue("NCC", "", False, [ncc[0]], (-1, 1, 100)),
               "sift": Cue("SIFT distance", "", True, [sift_max] if uses_sift else [], (0, 800, 100))}
    start = 4 if table == "stereo" else 3
    for order, name in enumerate(("sift", "ncc") if first == "sift" else ("ncc", "sift"), start):
        cues[table, order] = by_name[name]
    cues[table, start + 2] = Cue("NCC / best NCC", "", False, [ncc[1]], (0, 1, 100))
    cues[table, start + 3] = Cue("best SIFT / SIFT distance", "", False, [sift_nearly_best] if uses_sift else [],
                                 (0, 1, 100))


def make_cues(rig, config: dict) -> Cues:
    """All cues, without values. config: the effective one, with the disparity limit of the data set."""
    def of(key):
        return config[key]

    rectified = np.allclose(rig.right_from_left[:3, :3], np.eye(3), atol=1e-9) and rig.left.fx == rig.right.fx
    disparity = [of("stereo.max_disparity")] if of("stereo.max_disparity") > 0 else (
        [rig.left.fx * rig.baseline / of("stereo.min_depth")] if of("stereo.min_depth") > 0 and rectified else [])
    support = SUPPORT_WEIGHT if of("stereo.relaxation_rounds") > 0 else 0
    cues = {("stereo", 1): Cue("distance from the epipolar line", "px", True, [of("stereo.epipolar_distance")],
                               (0, 5, 100), True),
            ("stereo", 2): Cue("disparity", "px", True, disparity, (-20, 480, 500)),
            ("stereo", 3): Cue("difference of directions", "deg", True, [of("stereo.orientation")], (0, 90, 180))}
    _similarities(cues, "stereo", "sift", of("stereo.sift_max"), (of("stereo.ncc_min"), of("stereo.ncc_nearly_best")),
                  SIFT_NEARLY_BEST)
    cues["stereo", 9] = Cue("similarity of representatives", "", False,
                            [float(np.float32(of("stereo.refined_ncc_min")) - np.float32(support))], (-1, 1, 100))
    for side in ("temporal_left", "temporal_right"):
        cues[side, 1] = Cue("distance from the expected position", "px", True, [of("temporal.radius")], (0, 50, 200),
                            True)
        cues[side, 2] = Cue("difference of directions", "deg", True, [TEMPORAL_ORIENTATION], (0, 180, 360))
        _similarities(cues, side, "ncc", of("temporal.sift_max"),
                      (of("temporal.ncc_min"), of("temporal.ncc_nearly_best")), of("temporal.sift_nearly_best"))
    for order, (name, threshold, high) in enumerate((("relative difference of |D|", LENGTH, 1),
                                                     ("difference of cos(D, T1)", ANGLE, 2),
                                                     ("difference of cos(D, T2)", ANGLE, 2),
                                                     ("difference of T1 . T2", TANGENT, 2)), 1):
        cues["constraints", order] = Cue(name, "", True, [threshold], (0, high, 200))
    cues["constraints", 5] = Cue("angle between D and T1", "deg", False, [MIN_ANGLE], (0, 90, 90))
    return cues


@dataclass
class Judge:
    """What decides whether a candidate is veridical, and which pools its row belongs to."""

    truth: TruePositions
    pools: Pools
    tolerance: Tolerance
    targets: object
    """The other edges, with x and y [px]."""

    def candidates(self, lists) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Row, target and whether it is veridical, of every candidate in the lists."""
        row, target = np.repeat(np.arange(len(lists.first) - 1), np.diff(lists.first)), lists.target
        refined = len(lists.x) == len(target)
        x, y = (lists.x, lists.y) if refined else (self.targets.x[target], self.targets.y[target])
        return row, target, is_veridical(self.truth, row, x, y, self.tolerance)

    def collect(self, lists, values, cue: Cue) -> None:
        """Adds values(row, target) of all candidates."""
        row, target, veridical = self.candidates(lists)
        chosen = self.pools.everything[row]
        row = row[chosen]
        cue.add(values(row, target[chosen]), veridical[chosen], self.pools.paired[row])

    def collect_scores(self, lists, cue: Cue, relative: str = "") -> None:
        """Adds the scores in the lists; relative to the best of each list: value / "highest" or "lowest" / value."""
        if len(lists.cue) != len(lists.target):
            return
        scores, first = lists.cue.astype(float), lists.first
        if relative and len(scores):
            best = np.maximum if relative == "highest" else np.minimum
            filled = np.diff(first) > 0
            best = np.repeat(best.reduceat(scores, first[:-1][filled]), np.diff(first)[filled])
            with np.errstate(divide="ignore", invalid="ignore"):
                scores = scores / best if relative == "highest" else np.where(scores > 0, best / scores, 1.0)
        row, _, veridical = self.candidates(lists)
        chosen = self.pools.everything[row]
        cue.add(scores[chosen], veridical[chosen], self.pools.paired[row[chosen]])

    def collect_unfiltered(self, seed: int, values, cue: Cue) -> None:
        """Before the first filter, when every row is paired with every target: all veridical pairs, and DRAWN_OTHERS of
        the others per row."""
        size = len(self.targets.x)
        if not size:
            return
        row, target = near_truth(self.truth, self.pools.everything, self.targets, self.tolerance)
        cue.add(values(row, target), np.ones(len(row), bool), self.pools.paired[row])
        # Each kind of row has its own draws, so that their samples are independent.
        for kind, rows in enumerate((self.pools.paired, self.pools.everything & ~self.pools.paired)):
            row = np.repeat(np.nonzero(rows)[0], DRAWN_OTHERS)
            target = np.random.default_rng(seed + kind).integers(size, size=len(row))
            other = ~is_veridical(self.truth, row, self.targets.x[target], self.targets.y[target], self.tolerance)
            row, target = row[other], target[other]
            cue.add(values(row, target), np.zeros(len(row), bool), self.pools.paired[row])
