"""Which edges have a counterpart, and what a filter leaves of their candidates: recall, precision and ambiguity."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas

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


def filter_counts(filter, candidates: np.ndarray, veridical: np.ndarray, pools: Pools, **sums) -> list[dict]:
    """Sums over the edges of either pool, from the numbers of candidates and of veridical ones of every row; can be
    added over frames and pairs, but for `most`. filter: a StereoFilter or TemporalFilter. sums: of every row, too."""
    counts = []
    for pool, rows in vars(pools).items():
        kept, true = candidates[rows], veridical[rows]
        alive = kept > 0
        counts.append({"order": int(filter), "filter": filter.title, "pool": pool, "edges": len(kept),
                       "found": (true > 0).sum(), "alive": alive.sum(), "kept": kept.sum(), "veridical": true.sum(),
                       "most": kept.max(initial=0), "precisions": (true[alive] / kept[alive]).sum(),
                       **{name: values[rows].sum() for name, values in sums.items()}})
    return counts


def shares(counts: pandas.DataFrame) -> pandas.DataFrame:
    """With the recall (edges with a veridical candidate / edges), the precision (veridical candidates / all), and the
    ambiguity: candidates of the edges that have any, minus 1; of quads, the clusters that compete with one."""
    ambiguity = counts["competing"] / counts["kept"] if "competing" in counts else counts["kept"] / counts["alive"] - 1
    return counts.assign(recall=counts["found"] / counts["edges"], precision=counts["veridical"] / counts["kept"],
                         ambiguity=ambiguity)


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


@dataclass
class Judge:
    """What decides whether a candidate is veridical, and which pools its row belongs to."""

    truth: TruePositions
    pools: Pools
    tolerance: Tolerance
    targets: Any
    """The other edges, with x and y [px]."""

    def of_baseline(self, filter) -> list[dict]:
        """filter_counts() of row 0: every edge is paired with every target, without creating the lists."""
        rows = len(self.truth.x)
        found, _ = near_truth(self.truth, self.pools.everything, self.targets, self.tolerance)
        return filter_counts(filter, np.full(rows, len(self.targets.x)), np.bincount(found, minlength=rows), self.pools)

    def of_lists(self, filter, lists) -> list[dict]:
        """filter_counts() of Candidates; they lie at their targets unless they have positions of their own."""
        kept, target = np.diff(lists.first), lists.target
        row = np.repeat(np.arange(len(kept)), kept)
        x, y = (lists.x, lists.y) if len(lists.x) == len(target) else (self.targets.x[target], self.targets.y[target])
        return self.of_pairs(filter, row, x, y)

    def of_pairs(self, filter, row: np.ndarray, x: np.ndarray, y: np.ndarray) -> list[dict]:
        """filter_counts() of candidates at positions, each with its row."""
        veridical = is_veridical(self.truth, row, x, y, self.tolerance)
        return filter_counts(filter, *(np.bincount(which, minlength=len(self.truth.x)) for which in (
            row, row[veridical])), self.pools)
