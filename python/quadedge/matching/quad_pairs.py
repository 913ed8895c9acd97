"""Pairs of quads under the constraints of the paper's Equation 9: Table 3, Figures 6 and 7.

N pairs of points with tangents are arrays (4, N, 3): the first point, its tangent, the second point, its tangent, in
the left camera frame of their time [m].
"""

from dataclasses import dataclass

import numpy as np

from .cues import ANGLE, LENGTH, MIN_ANGLE, MIN_DETERMINANT, TANGENT, Cues, histogram

CONSTRAINTS = ("all pairs", "length of D", "angle of D and T1", "angle of D and T2", "angle of T1 and T2",
               "D not along T1", "handedness")
DRAWN_PAIRS = 200_000
MOST_MOTIONS, FEWEST_MOTIONS = 2000, 50
"""Of the motions that a median is taken of."""


@dataclass
class PairMeasurement:
    """Of one frame, after each of CONSTRAINTS: pairs and veridical ones, and the median errors of the motions that
    single pairs give, (rotation [deg], translation [m]); NaN of too few."""

    pairs: np.ndarray
    veridical: np.ndarray
    errors: np.ndarray


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


def check_constraints(before: np.ndarray, now: np.ndarray):
    """The quantities (5, N) that the first five constraints compare with their thresholds; whether each of the six
    holds (6, N); and whether the fifth does only with the roles of the quads exchanged (N,)."""
    length, first, second, tangents, determinant = _shape(before)
    length_now, first_now, second_now, tangents_now, determinant_now = _shape(now)
    apart = (length > 0) & (length_now > 0)
    differences = [np.abs(length - length_now), np.abs(first - first_now), np.abs(second - second_now),
                   np.abs(tangents - tangents_now)]
    crosses = [np.maximum(np.abs(a), np.abs(b)) < np.cos(np.radians(MIN_ANGLE))
               for a, b in ((first, first_now), (second, second_now))]
    informative = np.minimum(np.abs(determinant), np.abs(determinant_now)) > MIN_DETERMINANT
    passed = np.stack([apart & (differences[0] < LENGTH * length), apart & (differences[1] < ANGLE),
                       apart & (differences[2] < ANGLE), differences[3] < TANGENT, apart & (crosses[0] | crosses[1]),
                       apart & (~informative | ((determinant > 0) == (determinant_now > 0)))])
    # The roles of the quads are interchangeable: the better of both counts, before and after.
    angles = [np.degrees(np.arccos(np.minimum(1, np.maximum(np.abs(a), np.abs(b)))))
              for a, b in ((first, first_now), (second, second_now))]
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.stack([differences[0] / length, *differences[1:], np.maximum(*angles)])
    return np.where(apart, values, np.nan), passed, ~crosses[0] & crosses[1]


def _frames(pairs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Orthonormal frames [D / |D|, part of T1 across it, their product] as columns, and whether they exist."""
    d, tangent = pairs[2] - pairs[0], pairs[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        first = d / np.sqrt(_dot(d, d))[:, None]
        cosine = _dot(first, tangent)
        across = tangent - cosine[:, None] * first
        across /= np.sqrt(_dot(across, across))[:, None]
    return np.stack([first, across, np.cross(first, across)], axis=-1), np.abs(cosine) < 1


def motion_of_pairs(before: np.ndarray, now: np.ndarray) -> np.ndarray:
    """(N, 4, 4): the motions that map pairs to pairs (Proposition 2), midpoint to midpoint; NaN where there is none."""
    (frames, exists), (frames_now, exists_now) = _frames(before), _frames(now)
    motions = np.zeros((len(frames), 4, 4))
    motions[:, 3, 3] = 1
    motions[:, :3, :3] = frames_now @ frames.transpose(0, 2, 1)
    middle, middle_now = (0.5 * (pairs[0] + pairs[2]) for pairs in (before, now))
    motions[:, :3, 3] = middle_now - np.einsum("nij,nj->ni", motions[:, :3, :3], middle)
    motions[~(exists & exists_now)] = np.nan
    return motions


def motion_errors(estimates: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """(..., 2): rotation [deg] and translation [m] of truth^-1 estimate, for motions (..., 4, 4)."""
    off = np.linalg.inv(truth) @ estimates
    skew = np.stack([off[..., 2, 1] - off[..., 1, 2], off[..., 0, 2] - off[..., 2, 0], off[..., 1, 0] - off[..., 0, 1]],
                    axis=-1)
    trace = np.trace(off[..., :3, :3], axis1=-2, axis2=-1)
    angle = np.degrees(np.arctan2(np.sqrt(_dot(skew, skew)), trace - 1))
    return np.stack([angle, np.sqrt(_dot(off[..., :3, 3], off[..., :3, 3]))], axis=-1)


def _median(errors: np.ndarray) -> np.ndarray:
    if len(errors) < FEWEST_MOTIONS:
        return np.full(2, np.nan)
    return np.sort(errors, axis=0)[len(errors) // 2]


def measure_pairs(before, now, veridical: np.ndarray, seed: int, now_from_before: np.ndarray,
                  cues: Cues) -> PairMeasurement:
    """Draws pairs of quads uniformly.

    before, now: points and tangents (Q, 3) of the quads at both times. veridical: (Q,) bool. cues: gets the
    distributions of the constraints.
    """
    measured = PairMeasurement(np.zeros(len(CONSTRAINTS), int), np.zeros(len(CONSTRAINTS), int),
                               np.full((len(CONSTRAINTS), 2), np.nan))
    if len(veridical) < 2:
        return measured
    drawn = np.random.default_rng(seed).integers(len(veridical), size=(DRAWN_PAIRS, 2))
    a, b = drawn[drawn[:, 0] != drawn[:, 1]].T
    both = veridical[a] & veridical[b]
    pairs = [np.stack([points[a], tangents[a], points[b], tangents[b]]) for points, tangents in (before, now)]
    values, passed, swapped = check_constraints(*pairs)
    pairs = [np.where(swapped[:, None], each[[2, 3, 0, 1]], each) for each in pairs]
    solvable = _frames(pairs[0])[1] & _frames(pairs[1])[1]
    left = np.ones(len(a), bool)
    for order in range(len(CONSTRAINTS)):
        if order:
            left &= passed[order - 1]
        measured.pairs[order], measured.veridical[order] = left.sum(), (left & both).sum()
        if ("constraints", order + 1) in cues:
            cue = cues["constraints", order + 1]
            cue.of["veridical"] += histogram(values[order, left & both], *cue.bins)
            cue.of["other"] += histogram(values[order, left & ~both], *cue.bins)
        rows = np.nonzero(left & solvable)[0][:MOST_MOTIONS]
        motions = motion_of_pairs(*(each[:, rows] for each in pairs))
        measured.errors[order] = _median(motion_errors(motions, now_from_before))
    return measured
