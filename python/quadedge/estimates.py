"""What a filter may take from results: poses and twists of a base, with covariances that state what is not known."""

from dataclasses import dataclass

import numpy

from .ros_messages import quaternion

# Accelerations that nothing is known of: the mean velocity between two frames differs from the velocity at the second
# one by half of what an acceleration changes meanwhile. Standard deviations per axis, before any are seen.
_ACCELERATION = numpy.array([1.0, 1.0, 1.0, 1.0, 1.0, 1.0])  # m/s^2, rad/s^2
_MEMORY_S = 1.0  # accelerations that are older count for little


def _cross(v: numpy.ndarray) -> numpy.ndarray:
    """The matrix of the cross product with v."""
    return numpy.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def moved_covariance(covariance: numpy.ndarray, rotation: numpy.ndarray, lever: numpy.ndarray) -> numpy.ndarray:
    """A covariance (6, 6) of translation and rotation for a point at ``lever`` [m], along rotated axes."""
    jacobian = numpy.zeros((6, 6))
    jacobian[:3, :3] = jacobian[3:, 3:] = rotation
    jacobian[:3, 3:] = -rotation @ _cross(lever)
    return jacobian @ covariance @ jacobian.T


def of_base(pose: numpy.ndarray, covariance: numpy.ndarray | None, base_from_camera: numpy.ndarray) -> tuple:
    """The pose (4, 4) of the base in the frame of its first pose, and its covariance (6, 6), from the camera's."""
    camera_from_base = numpy.linalg.inv(base_from_camera)
    moved = base_from_camera @ pose @ camera_from_base
    if covariance is None:
        return moved, None
    return moved, moved_covariance(covariance, base_from_camera[:3, :3], pose[:3, :3] @ camera_from_base[:3, 3])


def _velocity(motion: numpy.ndarray, seconds: float) -> numpy.ndarray:
    """The constant twist (6), linear then angular, that makes a motion (4, 4) in this time."""
    x, y, z, w = quaternion(motion[:3, :3])
    axis = numpy.array([x, y, z])
    sine = numpy.linalg.norm(axis)
    angle = 2 * numpy.arctan2(sine, w)
    turn = _cross(axis * (angle / sine if sine > 1e-12 else 2.0))
    second = (1 / 12 if angle < 1e-4 else (1 - angle / 2 / numpy.tan(angle / 2)) / angle**2)
    linear = (numpy.eye(3) - turn / 2 + second * turn @ turn) @ motion[:3, 3]
    return numpy.concatenate([linear, [turn[2, 1], turn[0, 2], turn[1, 0]]]) / seconds


def twist_between(before, now, base_from_camera: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray] | None:
    """The mean twist (6) of the base between two results, in its own axes, and its covariance (6, 6).

    None where no measurement connects them. Errors that both poses share count twice, so that the covariance is rather
    too large.
    """
    if before is None or not (before.is_tracked and now.is_tracked) or before.segment != now.segment:
        return None
    reference = now.diagnostics.covariance_in_reference
    if reference is None:
        return None
    if not before.new_key_rig:
        if before.reference_frame != now.reference_frame or before.diagnostics.covariance_in_reference is None:
            return None
        reference = reference + before.diagnostics.covariance_in_reference
    seconds = (now.stamp_ns - before.stamp_ns) / 1e9
    if seconds <= 0:
        return None
    camera_from_base = numpy.linalg.inv(base_from_camera)
    motion = base_from_camera @ numpy.linalg.inv(before.world_from_left) @ now.world_from_left @ camera_from_base
    in_camera = moved_covariance(reference, now.current_from_reference[:3, :3], numpy.zeros(3))
    covariance = moved_covariance(in_camera, base_from_camera[:3, :3], camera_from_base[:3, 3])
    return _velocity(motion, seconds), covariance / seconds**2


@dataclass
class Estimate:
    """The base at the time of one tracked frame."""

    pose: numpy.ndarray  #: (4, 4) [m], in the frame of its first pose
    covariance: numpy.ndarray | None  #: (6, 6) of the pose [m, rad], along the axes of that frame; None: not known
    twist: tuple[numpy.ndarray, numpy.ndarray] | None  #: (6) [m/s, rad/s] in its own axes, and (6, 6); None: not known


class Estimates:
    """The base in every tracked frame. base_from_camera: pose (4, 4) of the left camera's optical frame in the base's.

    The pose and the twist of an ambiguous frame are not known, nor is the pose of a frame that was measured from one
    whose own is not, nor that of any segment after the first. A twist is known only from a frame whose place is, or
    that the motion was measured from.
    """

    def __init__(self, base_from_camera: numpy.ndarray):
        self.base_from_camera = base_from_camera
        self._last, self._twist, self._accelerations = None, None, _ACCELERATION**2
        self._keys: dict[int, bool] = {}  # by the number of a keyframe, whether its pose is known
        self._new_key: bool | None = None  # the same of the newest one, until a frame names its number
        self._is_known = True  # the same of the last frame with a pose
        self._doubt = False  # of the last frame

    def add(self, result, doubt: bool = False) -> Estimate | None:
        """The base in the next frame; None if it is lost. doubt: whether images or stamps make the motion doubtful."""
        last, self._last = self._last, result
        doubted, self._doubt = self._doubt, doubt
        if not result.is_tracked:
            self._twist = None
            return None
        is_first = not self._keys  # its own keyframe
        is_clear = not result.ambiguous_motion and not doubt
        self._is_known = self._is_measured_from_known(result) and is_clear and result.segment == 0
        if result.new_key_rig and not is_first:
            self._new_key = self._is_known
        pose, covariance = of_base(result.world_from_left, result.covariance, self.base_from_camera)
        is_placed = last is None or not last.ambiguous_motion or (
            last.new_key_rig or result.diagnostics.base_frame != result.reference_frame)  # measured from it
        twist = twist_between(last, result, self.base_from_camera) if is_clear and is_placed and not doubted else None
        if twist is not None:
            twist = self._at_stamp(*twist, (result.stamp_ns - last.stamp_ns) / 1e9)
        else:
            self._twist = None
        return Estimate(pose, covariance if self._is_known else None, twist)

    def _is_measured_from_known(self, result) -> bool:
        """Whether the pose of the frame that a pose was measured against is known: the keyframe, or the last one."""
        key, base = result.reference_frame, result.diagnostics.base_frame
        if key not in self._keys:  # a keyframe that no result has reported was the last frame before a loss
            self._keys[key] = self._is_known if self._new_key is None else self._new_key
            self._new_key = None
        return self._keys[key] and (base in (key, -1) or self._is_known)

    def _at_stamp(self, mean: numpy.ndarray, covariance: numpy.ndarray, seconds: float) -> tuple:
        """A mean twist as the one at the end of its interval: with what accelerations may have changed."""
        if self._twist is not None:
            before, seconds_before = self._twist
            seen = (2 * (mean - before) / (seconds + seconds_before)) ** 2
            weight = -numpy.expm1(-seconds / _MEMORY_S)
            self._accelerations = (1 - weight) * self._accelerations + weight * seen
        self._twist = mean, seconds
        return mean, covariance + numpy.diag(self._accelerations) * (seconds / 2) ** 2
