"""Pairs of quads under the constraints of the paper's Equation 9: Table 3.

N pairs of points with tangents are arrays (4, N, 3): the first point, its tangent, the second point, its tangent, in
the left camera frame of their time [m].
"""

from dataclasses import dataclass

import numpy as np

CONSTRAINTS = ("all pairs", "length of D", "angle of D and T1", "angle of D and T2", "angle of T1 and T2",
               "D not along T1", "handedness")
LENGTH, ANGLE, TANGENT, MIN_ANGLE, MIN_DETERMINANT = 0.13, 0.12, 0.32, 14.0, 0.1
"""Thresholds of Equation 9; host/tracker/motion/pose_constants.hpp."""
DRAWN_PAIRS = 200_000


@dataclass
class PairMeasurement:
    """Of one frame, after each of CONSTRAINTS: pairs and veridical ones."""

    pairs: np.ndarray
    veridical: np.ndarray


def _dot(a, b):
    return (a * b).sum(axis=-1)


def _shape(pairs: np.ndarray):
    """Length of D, its cosines with T1 and T2, T1 . T2, and det(D / |D|, T1, T2)."""
    first, first_tangent, second, second_tangent = pairs
    d = second - first
    length = np.sqrt(_dot(d, d))
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = d / length[:, None]
    return (length, _dot(unit, first_tangent), _dot(unit, second_tangent), _dot(first_tangent, second_tangent),
            _dot(unit, np.cross(first_tangent, second_tangent)))


def check_constraints(before: np.ndarray, now: np.ndarray) -> np.ndarray:
    """Whether each of the six constraints holds (6, N)."""
    length, first, second, tangents, determinant = _shape(before)
    length_now, first_now, second_now, tangents_now, determinant_now = _shape(now)
    apart = (length > 0) & (length_now > 0)
    # The roles of the quads are interchangeable: one of both has to cross its D, before and after.
    crosses = [np.maximum(np.abs(a), np.abs(b)) < np.cos(np.radians(MIN_ANGLE))
               for a, b in ((first, first_now), (second, second_now))]
    informative = np.minimum(np.abs(determinant), np.abs(determinant_now)) > MIN_DETERMINANT
    return np.stack([apart & (np.abs(length - length_now) < LENGTH * length),
                     apart & (np.abs(first - first_now) < ANGLE), apart & (np.abs(second - second_now) < ANGLE),
                     np.abs(tangents - tangents_now) < TANGENT, apart & (crosses[0] | crosses[1]),
                     apart & (~informative | ((determinant > 0) == (determinant_now > 0)))])


def measure_pairs(before, now, veridical: np.ndarray, seed: int) -> PairMeasurement:
    """Draws pairs of quads uniformly.

    before, now: points and tangents (Q, 3) of the quads at both times. veridical: (Q,) bool.
    """
    if len(veridical) < 2:
        return PairMeasurement(*np.zeros((2, len(CONSTRAINTS)), int))
    drawn = np.random.default_rng(seed).integers(len(veridical), size=(DRAWN_PAIRS, 2))
    a, b = drawn[drawn[:, 0] != drawn[:, 1]].T
    pairs = [np.stack([points[a], tangents[a], points[b], tangents[b]]) for points, tangents in (before, now)]
    left = np.logical_and.accumulate([np.ones(len(a), bool), *check_constraints(*pairs)])
    return PairMeasurement(left.sum(axis=1), (left & veridical[a] & veridical[b]).sum(axis=1))
