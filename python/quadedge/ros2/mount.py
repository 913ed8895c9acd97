"""Where the left camera is mounted: the pose of its optical frame in the base's."""

import numpy

from ..errors import UsageError
from ..result_files import rotations
from ..ros_messages import BODY_FROM_OPTICAL


def _pose(quaternion: tuple[float, float, float, float], position: tuple[float, float, float]) -> numpy.ndarray:
    pose = numpy.eye(4)
    pose[:3, :3], pose[:3, 3] = rotations(numpy.array([quaternion]))[0], position
    return pose


def mount_of(text: str) -> numpy.ndarray:
    """The pose (4, 4) of "X,Y,Z,ROLL,PITCH,YAW" [m, rad], as static_transform_publisher takes it.

    With angles of zero the camera looks along x of the base. Raises UsageError for anything but six numbers.
    """
    try:
        x, y, z, *angles = (float(part) for part in text.split(","))
        half = numpy.array(angles) / 2
        (sr, sp, sy), (cr, cp, cy) = numpy.sin(half), numpy.cos(half)
    except ValueError:
        raise UsageError(f"--base-from-camera: found '{text}', expected six numbers, "
                         "X,Y,Z,ROLL,PITCH,YAW [m, rad]") from None
    turn = (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy)
    return _pose(turn, (x, y, z)) @ BODY_FROM_OPTICAL


def levelled(text: str) -> numpy.ndarray:
    """The pose (4, 4) in a levelled frame, z up, of axes in which gravity points along "X,Y,Z": the shortest turn.

    Raises UsageError for anything but three numbers that are not all zero.
    """
    try:
        x, y, z = (float(part) for part in text.split(","))
        length = numpy.linalg.norm((x, y, z))
        if not 0 < length < numpy.inf:
            raise ValueError
    except ValueError:
        raise UsageError(f"--gravity: found '{text}', expected three numbers, X,Y,Z, not all of them 0") from None
    up = -numpy.array([x, y, z]) / length
    # The half-way quaternion between up and z; opposite ones are turned about x.
    turn = (1.0, 0.0, 0.0, 0.0) if up[2] < -1 + 1e-9 else (up[1], -up[0], 0.0, 1 + up[2])
    return _pose(turn, (0.0, 0.0, 0.0))


class StaticFrames:
    """The frames of /tf_static."""

    def __init__(self):
        self._parents: dict[str, tuple[str, numpy.ndarray]] = {}

    def add(self, message) -> None:
        """Takes a tf2_msgs/TFMessage."""
        for one in message.transforms:
            turn, shift = one.transform.rotation, one.transform.translation
            pose = _pose((turn.x, turn.y, turn.z, turn.w), (shift.x, shift.y, shift.z))
            self._parents[one.child_frame_id.lstrip("/")] = one.header.frame_id.lstrip("/"), pose

    def _to_root(self, frame: str) -> dict[str, numpy.ndarray]:
        """The poses of a frame in itself and in all frames above it."""
        poses, pose = {frame: numpy.eye(4)}, numpy.eye(4)
        while frame in self._parents and self._parents[frame][0] not in poses:
            frame, step = self._parents[frame]
            pose = step @ pose
            poses[frame] = pose
        return poses

    def pose(self, base: str, frame: str) -> numpy.ndarray | None:
        """The pose (4, 4) of a frame in the base's; None if they are not connected."""
        above_base, above_frame = self._to_root(base.lstrip("/")), self._to_root(frame.lstrip("/"))
        common = next((name for name in above_frame if name in above_base), None)
        return None if common is None else numpy.linalg.inv(above_base[common]) @ above_frame[common]
