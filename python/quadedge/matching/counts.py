"""Which edges have a counterpart, and what a filter leaves of their candidates: recall, precision and ambiguity."""

from dataclasses import astuple, dataclass

import numpy as np

from .surfaces import UNKNOWN, VISIBLE, TruePositions

LINE_TOLERANCE = 0.5
"""Largest distance of stereo counterparts from the epipolar line [px]."""
STEREO_DIRECTION, TEMPORAL_DIRECTION = 5.0, 10.0
"""Largest difference of the directions of counterparts [deg], modulo 180."""
MIN_EPIPOLAR_ANGLE = 4.0
"""Edges at a smaller angle to their epipolar line are not matched [deg]; host/tracker/common/matching_constants.hpp."""


@dataclass
class Tolerance:
    position: float = 1.0
    """Distance from the true position within which a candidate is veridical [px]."""
    wrong: float = 10.0
    """Distance beyond which a match is wrong; below, it is only inaccurate [px]."""


@dataclass
class Pools:
    """Rows that a table covers, (rows,) bool."""

    paired: np.ndarray
    """Visible edges with a detected counterpart, the paper's pool: the initial recall is 1 by construction."""
    everything: np.ndarray
    """Every edge with a known true position, also occluded ones, whose candidates are never veridical."""


def ratio(part, whole) -> float:
    return part / whole if whole > 0 else np.nan


@dataclass
class Counts:
    """Sums over the edges of one pool; can be added over frames and pairs."""

    pool: int = 0
    found: int = 0
    """Edges with a veridical candidate."""
    alive: int = 0
    """Edges with any candidate."""
    candidates: int = 0
    veridical: int = 0
    most: int = 0
    """Largest number of candidates of one edge."""
    precisions: float = 0.0
    """Sum over the edges with candidates."""

    @classmethod
    def of(cls, candidates: np.ndarray, veridical: np.ndarray) -> "Counts":
        """From the numbers of candidates and of veridical ones of every edge of the pool."""
        alive = candidates > 0
        return cls(len(candidates), int((veridical > 0).sum()), int(alive.sum()), int(candidates.sum()),
                   int(veridical.sum()), int(candidates.max(initial=0)),
                   float((veridical[alive] / candidates[alive]).sum()))

    def __add__(self, other: "Counts") -> "Counts":
        sums = [a + b for a, b in zip(astuple(self), astuple(other))]
        sums[5] = max(self.most, other.most)
        return Counts(*sums)

    @property
    def recall(self) -> float:
        return ratio(self.found, self.pool)

    @property
    def precision(self) -> float:
        return ratio(self.veridical, self.candidates)

    @property
    def ambiguity(self) -> float:
        """Mean number of candidates of the edges that have any, minus 1."""
        return ratio(self.candidates, self.alive) - 1


@dataclass
class FilterRow:
    """One row of Table 1 or 2."""

    order: int
    filter: str
    paired: Counts
    everything: Counts

    def __add__(self, other: "FilterRow") -> "FilterRow":
        return FilterRow(self.order, self.filter, self.paired + other.paired, self.everything + other.everything)


def filter_row(filter, candidates: np.ndarray, veridical: np.ndarray, pools: Pools) -> FilterRow:
    """From the numbers of candidates and of veridical ones of every row. filter: a StereoFilter or TemporalFilter."""
    of = [Counts.of(candidates[pool], veridical[pool]) for pool in (pools.paired, pools.everything)]
    return FilterRow(int(filter), filter.title, *of)


def line_angle(a, b) -> np.ndarray:
    """Angle between directions [rad] modulo a half turn [deg]."""
    turned = np.asarray(a, float) - np.asarray(b, float)
    return np.degrees(np.abs(turned - np.pi * np.rint(turned / np.pi)))


def is_veridical(truth: TruePositions, rows: np.ndarray, x: np.ndarray, y: np.ndarray, tolerance: Tolerance):
    """Whether positions are near the true ones of those rows; False for occluded and unknown edges."""
    away = np.hypot(x.astype(float) - truth.x[rows], y.astype(float) - truth.y[rows])
    return (truth.state[rows] == VISIBLE) & (away <= tolerance.position)


class Nearby:
    """Finds the edges of an image near positions."""

    def __init__(self, x: np.ndarray, y: np.ndarray):
        self._x, self._y = x.astype(float), y.astype(float)
        self._left = self._x.min(initial=0) - 1
        self._width = self._x.max(initial=0) - self._left + 1
        keys = np.floor(self._y) * self._width + (self._x - self._left)
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]

    def pairs(self, x: np.ndarray, y: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """Indices of positions and of the edges within `radius` of them [px]."""
        slack = 1e-6
        x, y = x.astype(float), y.astype(float)
        start, end = (np.clip(x + reach - self._left, 0, self._width) for reach in (-radius - slack, radius + slack))
        found = [(np.empty(0, int), np.empty(0, int))]
        for row in range(int(np.ceil(2 * radius)) + 1):
            rows = np.floor(y - radius) + row
            first = np.searchsorted(self._keys, rows * self._width + start - slack, "left")
            number = np.searchsorted(self._keys, rows * self._width + end + slack, "right") - first
            number[~(rows <= np.floor(y + radius))] = 0
            position = np.repeat(np.arange(len(x)), number)
            within = np.arange(len(position)) - np.repeat(np.cumsum(number) - number, number)
            edge = self._order[np.repeat(first, number) + within]
            near = np.hypot(self._x[edge] - x[position], self._y[edge] - y[position]) <= radius
            found.append((position[near], edge[near]))
        return tuple(np.concatenate(part) for part in zip(*found))


def near_truth(truth: TruePositions, rows: np.ndarray, targets, tolerance: Tolerance):
    """Pairs of a row, of those in the mask that are visible, and a target within the tolerance of its true position."""
    rows = np.nonzero(rows & (truth.state == VISIBLE))[0]
    position, target = Nearby(targets.x, targets.y).pairs(truth.x[rows], truth.y[rows], tolerance.position)
    return rows[position], target


def _marked(size: int, rows: np.ndarray) -> np.ndarray:
    marks = np.zeros(size, bool)
    marks[rows] = True
    return marks


def stereo_pools(rig, left, right, truth: TruePositions, tolerance: Tolerance) -> Pools:
    """An edge is paired if a right edge lies within the tolerances of its true position, line and direction."""
    k, pose = rig.left.matrix, rig.right_from_left
    t = pose[:3, 3]
    cross = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]])
    fundamental = np.linalg.inv(rig.right.matrix).T @ cross @ pose[:3, :3] @ np.linalg.inv(k)
    epipole = k @ (-pose[:3, :3].T @ t)
    pixels = np.stack([left.x, left.y, np.ones(len(left.x))], axis=1).astype(float)
    along = epipole[:2] - epipole[2] * pixels[:, :2]
    crosses = ~(line_angle(left.direction, np.arctan2(along[:, 1], along[:, 0])) < MIN_EPIPOLAR_ANGLE)
    everything = crosses & (truth.state != UNKNOWN)
    row, target = near_truth(truth, everything, right, tolerance)
    line = pixels[row] @ fundamental.T
    distance = np.abs(line[:, 0] * right.x[target] + line[:, 1] * right.y[target] + line[:, 2])
    fits = (distance / np.hypot(line[:, 0], line[:, 1]) <= LINE_TOLERANCE) & (
        line_angle(left.direction[row], right.direction[target]) <= STEREO_DIRECTION)
    return Pools(_marked(len(pixels), row[fits]), everything)


def temporal_pools(direction: np.ndarray, veridical: np.ndarray, now, truth: TruePositions,
                   tolerance: Tolerance) -> Pools:
    """In one image. An edge is paired if its stereo edge is veridical, and a current one lies within the tolerances of
    its true position and its earlier direction."""
    row, target = near_truth(truth, veridical, now, tolerance)
    fits = line_angle(direction[row], now.direction[target]) <= TEMPORAL_DIRECTION
    return Pools(_marked(len(direction), row[fits]), truth.state != UNKNOWN)


def quad_pools(before, veridical: np.ndarray, now, left_truth: TruePositions, right_truth: TruePositions,
               tolerance: Tolerance) -> Pools:
    """An edge is paired if ONE current stereo edge is the counterpart in both images."""
    everything = (left_truth.state != UNKNOWN) & (right_truth.state != UNKNOWN)
    row, target = near_truth(left_truth, veridical & everything, now.left, tolerance)
    fits = is_veridical(right_truth, row, now.right.x[target], now.right.y[target], tolerance)
    for side in ("left", "right"):
        a, b = getattr(before, side).direction[row], getattr(now, side).direction[target]
        fits &= line_angle(a, b) <= TEMPORAL_DIRECTION
    return Pools(_marked(len(veridical), row[fits]), everything)
