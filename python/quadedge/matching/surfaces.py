"""Ground truth of edges: the surface that an edge lies on, and where another view shows it (doc/matching.md).

Surfaces are arrays of nearness, (height, width) float32: the disparity, or focal length times baseline divided by the
depth [px]; NaN is unknown. Unlike depth, nearness is linear in the pixels of a plane and can be interpolated.
"""

from dataclasses import dataclass

import numpy as np

DEPTH_STEP = 1.0
"""Difference between neighbouring pixels above which they belong to different surfaces [px of nearness]."""
CONTOUR_REACH = 1.5
"""Distance from a depth step, across the edge, within which an edge is the occluding contour [px]: half a pixel for the
rounding of the map, and the displacement by the detector's blur and by inaccurate ground truth. Of the matched edges
within it, 80 to 99 % move with the nearer surface (rendered room and cables, Middlebury)."""
UNCLEAR_REACH = 2.5
"""On the farther side, an edge up to this distance may belong to either surface [px]: about half move with each."""
NORMAL_STEP = 0.5
UNKNOWN, VISIBLE, OCCLUDED = 0, 1, 2


@dataclass
class FrameTruth:
    """Ground truth of one stereo frame."""

    left: np.ndarray
    right: np.ndarray
    right_is_measured: bool = True
    """False if the right surface is predicted from the left one, see right_from_left()."""
    occluded: np.ndarray | None = None
    """(height, width) bool: left pixels that the data set marks as occluded in the right view."""
    depth_scale: float = 0.0
    """Depth [m] = depth_scale / nearness; 0 for pairs with disparities, whose true position is x - disparity."""
    world_from_left: np.ndarray | None = None
    """(4, 4): pose of the left camera; None for single pairs."""


@dataclass
class TruePositions:
    """Positions of N edges in another view, also of those that it occludes."""

    x: np.ndarray
    y: np.ndarray
    """(N,) float32 [px]; NaN without ground truth."""
    state: np.ndarray
    """(N,): UNKNOWN, VISIBLE or OCCLUDED."""
    contour: np.ndarray
    """(N,) bool: the edge lies on a depth step of its own view."""


def nearness(values: np.ndarray) -> np.ndarray:
    """A surface from positive nearness; infinite, NaN, zero and negative values are unknown."""
    return np.where(np.isfinite(values) & (values > 0), values, np.nan).astype(np.float32)


def from_depth(depth: np.ndarray, focal_times_baseline: float) -> np.ndarray:
    """A surface from depths z [m]; 0 is unknown."""
    with np.errstate(divide="ignore"):
        return nearness(focal_times_baseline / depth.astype(float))


def rounded(values: np.ndarray) -> np.ndarray:
    """The nearest integers, halves away from zero."""
    return np.copysign(np.floor(np.abs(values) + 0.5), values)


def nearest(surface: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Values at the pixels nearest to positions; NaN outside the image."""
    column, row = rounded(x), rounded(y)
    inside = (column >= 0) & (row >= 0) & (column < surface.shape[1]) & (row < surface.shape[0])
    found = np.full(inside.shape, np.nan)
    found[inside] = surface[row[inside].astype(int), column[inside].astype(int)]
    return found


def _interpolated(surface: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Bilinear over those of the four pixels around a position that are on the surface of the nearest one."""
    level = nearest(surface, x, y)
    total, weights = np.zeros(x.shape), np.zeros(x.shape)
    for k in range(4):
        at_x, at_y = np.floor(x) + k % 2, np.floor(y) + k // 2
        value = nearest(surface, at_x, at_y)
        same = np.abs(value - level) <= DEPTH_STEP
        weight = np.where(same, (1 - np.abs(at_x - x)) * (1 - np.abs(at_y - y)), 0)
        total += np.where(same, weight * value, 0)
        weights += weight
    return np.where(weights > 0, total / np.where(weights > 0, weights, 1), level)


def surface_at(surface: np.ndarray, x: np.ndarray, y: np.ndarray, direction: np.ndarray):
    """The nearness (N,) of the surface that each edge belongs to, NaN if unknown, and whether it is a contour (N,).

    The surface is sampled to both sides along the edge's normal. An unknown sample could hide a nearer surface that
    owns the edge. Where the samples differ by more than DEPTH_STEP, the edge is an occluding contour and belongs to the
    nearer surface; where a nearer surface begins a little farther away, nothing is said.
    direction: of the tangent [rad].
    """
    x, y, direction = (np.asarray(values, float) for values in (x, y, direction))
    offsets = np.arange(-CONTOUR_REACH, CONTOUR_REACH + NORMAL_STEP / 2, NORMAL_STEP)

    def across(steps):
        return nearest(surface, x[:, None] - np.sin(direction)[:, None] * steps,
                       y[:, None] + np.cos(direction)[:, None] * steps)

    samples = across(offsets)
    known = ~np.isnan(samples).any(axis=1)
    near = np.max(samples, axis=1, initial=-1)
    contour = known & (near - np.min(samples, axis=1, initial=np.inf) > DEPTH_STEP)
    weights = np.where(near[:, None] - samples > DEPTH_STEP, 0, np.exp(-2 * offsets**2))
    beyond = np.arange(CONTOUR_REACH + NORMAL_STEP, UNCLEAR_REACH + NORMAL_STEP / 2, NORMAL_STEP)
    unclear = ~contour & (across(np.concatenate([-beyond, beyond])) - near[:, None] > DEPTH_STEP).any(axis=1)
    values = np.where(contour, (weights * samples).sum(axis=1) / np.maximum(weights.sum(axis=1), 1e-300),
                      _interpolated(surface, x, y))
    return np.where(known & ~unclear, values, np.nan), contour


def visibility(surface: np.ndarray, x: np.ndarray, y: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Compares points with the view that they project into. VISIBLE: a pixel within 1.5 px has that nearness to within
    DEPTH_STEP. OCCLUDED: all known pixels are nearer, or the position is outside the image. UNKNOWN: no pixel is known,
    or the view shows something farther away, which contradicts the point."""
    inside = (x >= 0) & (y >= 0) & (x <= surface.shape[1] - 1) & (y <= surface.shape[0] - 1)
    around = [nearest(surface, rounded(x) + dx, rounded(y) + dy) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    shown = np.stack(around, axis=1)
    same = (np.abs(shown - value[:, None]) <= DEPTH_STEP).any(axis=1)
    nearer, farther = (shown > value[:, None]).any(axis=1), (shown <= value[:, None]).any(axis=1)
    state = np.where(same, VISIBLE, np.where(nearer & ~farther, OCCLUDED, UNKNOWN))
    return np.where(inside, state, OCCLUDED)


def right_from_left(left: np.ndarray, width: int) -> np.ndarray:
    """The right view's surface predicted from the left one (rectified pairs): every known pixel moves by its disparity,
    gaps between neighbours on one surface are filled, and the nearest surface wins."""
    right = np.full((left.shape[0], width), -np.inf, np.float32)
    values = left.astype(float)
    rows, columns = np.nonzero(~np.isnan(values))

    def put(row, column, value):
        chosen = (column >= 0) & (column < width)
        np.maximum.at(right, (row[chosen], column[chosen].astype(int)), value[chosen].astype(np.float32))

    value = values[rows, columns]
    put(rows, rounded(columns - value), value)
    following = np.append(values[:, 1:], np.full((len(values), 1), np.nan), axis=1)[rows, columns]
    joined = np.abs(following - value) <= DEPTH_STEP
    rows, columns, value, following = (array[joined] for array in (rows, columns, value, following))
    start, end = columns - value, columns + 1 - following
    first, last = np.minimum(start, end), np.maximum(start, end)
    length = np.where(start == end, 1, end - start)
    for step in range(3):  # neighbours on one surface are at most 2 px apart
        at = np.ceil(first) + step
        between = value + (following - value) * np.where(start == end, 0, (at - start) / length)
        put(rows[at <= last], at[at <= last], between[at <= last])
    return np.where(np.isinf(right), np.nan, right)


def _positions(x, y, state, contour, known) -> TruePositions:
    gone = np.where(known, 0, np.nan)
    return TruePositions((x + gone).astype(np.float32), (y + gone).astype(np.float32),
                         np.where(known, state, UNKNOWN), contour & known)


def _projected(camera, camera_from_points: np.ndarray, points: np.ndarray, surface, depth_scale: float,
               contour: np.ndarray, known: np.ndarray) -> TruePositions:
    """Points (N, 3) [m] as a camera with a surface of its view sees them."""
    seen = points @ camera_from_points[:3, :3].T + camera_from_points[:3, 3]
    front = seen[:, 2] > 0
    depth = np.where(front, seen[:, 2], np.nan)
    x, y = camera.fx * seen[:, 0] / depth + camera.cx, camera.fy * seen[:, 1] / depth + camera.cy
    state = np.where(front, visibility(surface, x, y, depth_scale / depth), OCCLUDED)
    return _positions(x, y, state, contour, known)


def _points(camera, x, y, depth) -> np.ndarray:
    """(N, 3): points in the camera's frame [m]."""
    rays = np.stack([(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, np.ones(len(x))], axis=1)
    return rays * depth[:, None]


def true_right_positions(rig, truth: FrameTruth, edges) -> TruePositions:
    """Of left edges, with x, y [px] and direction [rad], in the right image of the same frame."""
    x, y = edges.x.astype(float), edges.y.astype(float)
    value, contour = surface_at(truth.left, x, y, edges.direction)
    known = ~np.isnan(value)
    if truth.depth_scale > 0:
        return _projected(rig.right, rig.right_from_left, _points(rig.left, x, y, truth.depth_scale / value),
                          truth.right, truth.depth_scale, contour, known)
    state = visibility(truth.right, x - value, y, value)
    if not truth.right_is_measured:  # positions where a predicted view is empty count as visible
        state = np.where(state == UNKNOWN, VISIBLE, state)
    if truth.occluded is not None:
        # A contour belongs to the nearer surface, which is visible, whatever its pixel shows.
        marked = truth.occluded[rounded(y).astype(int), rounded(x).astype(int)]
        state = np.where(marked & ~contour, OCCLUDED, state)
    return _positions(x - value, y, state, contour, known)


def true_later_positions(rig, before: FrameTruth, now: FrameTruth, side: str, edges) -> TruePositions:
    """Of the left edges of `before`, in the image of that side of `now`; needs poses and depths of both frames."""
    now_from_before = np.linalg.inv(now.world_from_left) @ before.world_from_left
    x, y = edges.x.astype(float), edges.y.astype(float)
    value, contour = surface_at(before.left, x, y, edges.direction)
    points = _points(rig.left, x, y, before.depth_scale / value)
    if side == "left":
        return _projected(rig.left, now_from_before, points, now.left, now.depth_scale, contour, ~np.isnan(value))
    return _projected(rig.right, rig.right_from_left @ now_from_before, points, now.right, now.depth_scale, contour,
                      ~np.isnan(value))
