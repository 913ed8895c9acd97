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
