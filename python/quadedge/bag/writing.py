"""Poses for others to read: TUM, and an MCAP of nav_msgs/Odometry with covariances."""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

import numpy

from .. import DataError, Trajectory


def _tracked(results: Iterable) -> list:
    return [result for result in results if result.is_tracked]


def write_tum(path: str | PathLike, results: Iterable) -> None:
    """Writes the poses of tracked frames, byte for byte as ``quadedge run`` does. results: of Odometry.track()."""
    tracked = _tracked(results)
    stamps = numpy.array([result.stamp_ns for result in tracked], numpy.int64)
    poses = numpy.array([result.world_from_left for result in tracked], float).reshape(-1, 4, 4)
    Trajectory(stamps, poses).write_tum(path)


def quaternion(rotation: numpy.ndarray) -> numpy.ndarray:
    """(x, y, z, w) of a (3, 3) rotation, w >= 0."""
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


def _odometry_message(types, result, frame: str, child_frame: str):
    header = types["std_msgs/msg/Header"](
        types["builtin_interfaces/msg/Time"](*divmod(result.stamp_ns, 1_000_000_000)), frame)
    pose = result.world_from_left
    position = types["geometry_msgs/msg/Point"](*map(float, pose[:3, 3]))
    orientation = types["geometry_msgs/msg/Quaternion"](*map(float, quaternion(pose[:3, :3])))
    covariance = numpy.zeros((6, 6)) if result.covariance is None else result.covariance
    unknown = numpy.zeros(36)
    unknown[0] = -1  # as ROS's messages say that nothing is known
    zero = types["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
    return types["nav_msgs/msg/Odometry"](
        header, child_frame,
        types["geometry_msgs/msg/PoseWithCovariance"](
            types["geometry_msgs/msg/Pose"](position, orientation),
            unknown if result.covariance is None else numpy.ascontiguousarray(covariance, float).reshape(36)),
        types["geometry_msgs/msg/TwistWithCovariance"](types["geometry_msgs/msg/Twist"](zero, zero), unknown))


def write_mcap(folder: str | PathLike, results: Iterable, *, topic: str = "/odometry", frame: str = "odom",
               child_frame: str = "left_camera") -> Path:
    """Writes a ROS 2 recording (a folder with metadata.yaml and an .mcap file) of ``nav_msgs/Odometry``.

    A message per tracked frame: the left camera's pose in the frame of the first one (x right, y down, z forward) and
    its covariance. The twist is unknown, and so is the covariance where it is None: -1 in its first place says so.
    Returns the .mcap file. Raises DataError when the folder exists.
    """
    try:
        from rosbags.rosbag2 import StoragePlugin, Writer, WriterError
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise ImportError("quadedge.bag needs rosbags; `pip install quadedge[bag]` installs it") from error
    folder = Path(folder)
    if folder.exists():
        raise DataError(f"{folder}: found something of that name, expected a new folder")
    store = get_typestore(Stores.ROS2_HUMBLE)
    try:
        with Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP) as writer:
            kind = "nav_msgs/msg/Odometry"
            connection = writer.add_connection(topic, kind, typestore=store)
            for result in _tracked(results):
                message = _odometry_message(store.types, result, frame, child_frame)
                writer.write(connection, result.stamp_ns, store.serialize_cdr(message, kind))
    except (WriterError, OSError) as error:
        raise DataError(f"{folder}: the recording cannot be written ({error})") from error
    return next(folder.glob("*.mcap"))
