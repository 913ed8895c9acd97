"""Writes poses: TUM files, and MCAP recordings of nav_msgs/Odometry with covariances."""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

import numpy

from .. import DataError, Trajectory


# Axes of REP 103 (x forward, y left, z up) from optical ones (x right, y down, z forward).
_BODY_FROM_OPTICAL = numpy.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def _tracked(results: Iterable) -> list:
    return [result for result in results if result.is_tracked]


def write_tum(path: str | PathLike, results: Iterable) -> None:
    """Writes the poses of all tracked frames, byte for byte as ``quadedge run``.

    results: from Odometry.track(). The axes are optical: x right, y down, z forward.
    """
    tracked = _tracked(results)
    stamps = numpy.array([result.stamp_ns for result in tracked], numpy.int64)
    poses = numpy.array([result.world_from_left for result in tracked], float).reshape(-1, 4, 4)
    segments = numpy.array([result.segment for result in tracked], numpy.int32)
    Trajectory(stamps, poses, segments).write_tum(path)


def quaternion(rotation: numpy.ndarray) -> numpy.ndarray:
    """The quaternion (x, y, z, w), w >= 0, of a (3, 3) rotation matrix."""
    # The largest of the four squares is safe to divide by (Shepperd 1978).
    m, trace = rotation, numpy.trace(rotation)
    squares = numpy.array([m[0, 0], m[1, 1], m[2, 2], trace])
    best = int(numpy.argmax(squares))
    q = numpy.empty(4)
    if best == 3:
        q[:] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1 + trace
    else:
        i, j, k = best, (best + 1) % 3, (best + 2) % 3
        q[i] = 1 - trace + 2 * m[i, i]
        q[j], q[k], q[3] = m[j, i] + m[i, j], m[k, i] + m[i, k], m[k, j] - m[j, k]
    q /= numpy.linalg.norm(q)
    return -q if q[3] < 0 else q


def _in_body_axes(pose: numpy.ndarray, covariance: numpy.ndarray | None) -> tuple:
    """A pose (4, 4) and its covariance (6, 6), with the axes of both frames changed from optical to REP 103."""
    turned = numpy.eye(4)
    turned[:3, :3] = _BODY_FROM_OPTICAL @ pose[:3, :3] @ _BODY_FROM_OPTICAL.T
    turned[:3, 3] = _BODY_FROM_OPTICAL @ pose[:3, 3]
    if covariance is None:
        return turned, None
    both = numpy.kron(numpy.eye(2), _BODY_FROM_OPTICAL)
    return turned, both @ covariance @ both.T


def _odometry_message(types, result, frame: str, child_frame: str, optical_axes: bool):
    header = types["std_msgs/msg/Header"](
        types["builtin_interfaces/msg/Time"](*divmod(result.stamp_ns, 1_000_000_000)), frame)
    pose, covariance = result.world_from_left, result.covariance
    if result.segment > 0:  # no measurement connects the pose with the origin of the frame
        covariance = None
    if not optical_axes:
        pose, covariance = _in_body_axes(pose, covariance)
    position = types["geometry_msgs/msg/Point"](*map(float, pose[:3, 3]))
    orientation = types["geometry_msgs/msg/Quaternion"](*map(float, quaternion(pose[:3, :3])))
    unknown = numpy.zeros(36)
    unknown[0] = -1  # the convention of ROS messages for an unknown covariance
    zero = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
    return types["nav_msgs/msg/Odometry"](
        header, child_frame,
        types["geometry_msgs/msg/PoseWithCovariance"](
            types["geometry_msgs/msg/Pose"](position, orientation),
            unknown if covariance is None else numpy.ascontiguousarray(covariance, float).reshape(36)),
        types["geometry_msgs/msg/TwistWithCovariance"](types["geometry_msgs/msg/Twist"](zero, zero), unknown))


def write_mcap(folder: str | PathLike, results: Iterable, *, topic: str = "/odometry", frame: str = "odom",
               child_frame: str | None = None, optical_axes: bool = False) -> Path:
    """Writes a ROS 2 recording (a folder with metadata.yaml and an .mcap file) of ``nav_msgs/Odometry``.

    results: from Odometry.track(). There is one message per tracked frame, with the pose of ``child_frame`` in
    ``frame`` and its covariance. Both frames have the axes of REP 103 (x forward, y left, z up), and ``child_frame`` is
    "base_link" unless given: a body frame at the left camera's position, whose x axis is the camera's viewing direction
    (REP 105). With ``optical_axes`` both frames have the axes of the camera (x right, y down, z forward), and
    ``child_frame`` is "left_camera" unless given.

    The twist is unknown, and so are the covariances of all segments after the first, whose place in ``frame`` is not
    measured: their first element is -1. Returns the path of the .mcap
    file. Raises DataError if the folder exists or cannot be written, ImportError without rosbags.
    """
    try:
        from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise ImportError("quadedge.bag needs rosbags; `pip install quadedge[bag]` installs it") from error
    folder = Path(folder)
    if folder.exists():
        raise DataError(f"{folder}: the file or folder exists, expected a new folder")
    child_frame = child_frame or ("left_camera" if optical_axes else "base_link")
    store = get_typestore(Stores.ROS2_HUMBLE)
    try:
        with Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP) as writer:
            kind = "nav_msgs/msg/Odometry"
            connection = writer.add_connection(topic, kind, typestore=store)
            for result in _tracked(results):
                message = _odometry_message(store.types, result, frame, child_frame, optical_axes)
                writer.write(connection, result.stamp_ns, store.serialize_cdr(message, kind))
    except (WriterError, OSError) as error:
        raise DataError(f"{folder}: the recording cannot be written ({error})") from error
    return next(folder.glob("*.mcap"))
