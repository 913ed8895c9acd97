"""Messages of ROS, made from results and read from recordings and topics. Needs rosbags."""

from functools import cache

import numpy

# Axes of REP 103 (x forward, y left, z up) from optical ones (x right, y down, z forward).
BODY_FROM_OPTICAL = numpy.array([[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0],
                                 [0.0, 0.0, 0.0, 1.0]])  # fmt: skip
# Filters such as robot_localization take the absolute value of a negative variance and raise a small one a little, so
# that only a large one tells them that a quantity is not known.
UNKNOWN = numpy.diag(numpy.full(6, 1e6))


@cache
def message_store():
    """The definitions of ROS 2's messages, of rosbags. Raises ImportError without rosbags."""
    try:
        from rosbags.typesys import Stores, get_typestore
    except ImportError as error:
        raise ImportError("messages of ROS need rosbags; `pip install rosbags` installs it") from error
    return get_typestore(Stores.ROS2_HUMBLE)


def stamp_ns(message) -> int:
    """The stamp of a message's header [ns]."""
    stamp = message.header.stamp
    return stamp.sec * 1_000_000_000 + stamp.nanosec


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


def header(stamp: int, frame: str):
    """A std_msgs/Header. stamp: [ns]."""
    types = message_store().types
    return types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](*divmod(stamp, 1_000_000_000)), frame)


def odometry_message(stamp: int, frame: str, child_frame: str, pose: numpy.ndarray, covariance: numpy.ndarray | None,
                     twist: tuple[numpy.ndarray, numpy.ndarray] | None = None):
    """A nav_msgs/Odometry. What is None is not known: its variances are those of UNKNOWN."""
    types = message_store().types
    vector, (velocity, velocity_covariance) = types["geometry_msgs/msg/Vector3"], twist or (numpy.zeros(6), UNKNOWN)
    return types["nav_msgs/msg/Odometry"](
        header(stamp, frame), child_frame,
        _pose(pose, UNKNOWN if covariance is None else covariance),
        types["geometry_msgs/msg/TwistWithCovariance"](
            types["geometry_msgs/msg/Twist"](vector(*map(float, velocity[:3])), vector(*map(float, velocity[3:]))),
            numpy.ascontiguousarray(velocity_covariance, float).reshape(36)))


def pose_message(stamp: int, frame: str, pose: numpy.ndarray, covariance: numpy.ndarray):
    """A geometry_msgs/PoseWithCovarianceStamped of a pose (4, 4) and its covariance (6, 6)."""
    types = message_store().types
    return types["geometry_msgs/msg/PoseWithCovarianceStamped"](header(stamp, frame), _pose(pose, covariance))


def _pose(pose: numpy.ndarray, covariance: numpy.ndarray):
    types = message_store().types
    return types["geometry_msgs/msg/PoseWithCovariance"](
        types["geometry_msgs/msg/Pose"](
            types["geometry_msgs/msg/Point"](*map(float, pose[:3, 3])),
            types["geometry_msgs/msg/Quaternion"](*map(float, quaternion(pose[:3, :3])))),
        numpy.ascontiguousarray(covariance, float).reshape(36))


def transforms_message(stamp: int, transforms: list[tuple[str, str, numpy.ndarray]]):
    """A tf2_msgs/TFMessage of (frame, child frame, pose of the child (4, 4))."""
    types = message_store().types
    vector, turn = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Quaternion"]
    return types["tf2_msgs/msg/TFMessage"]([
        types["geometry_msgs/msg/TransformStamped"](
            header(stamp, frame), child, types["geometry_msgs/msg/Transform"](
                vector(*map(float, pose[:3, 3])), turn(*map(float, quaternion(pose[:3, :3])))))
        for frame, child, pose in transforms])


def diagnostics_message(stamp: int, name: str, level: int, text: str, values: dict[str, object]):
    """A diagnostic_msgs/DiagnosticArray of one status. level: 0 good, 1 a warning, 2 an error."""
    types = message_store().types
    pairs = [types["diagnostic_msgs/msg/KeyValue"](key, str(value)) for key, value in values.items()]
    return types["diagnostic_msgs/msg/DiagnosticArray"](
        header(stamp, ""), [types["diagnostic_msgs/msg/DiagnosticStatus"](level, name, text, "", pairs)])


def cloud_message(stamp: int, frame: str, points: numpy.ndarray):
    """A sensor_msgs/PointCloud2 of the finite ones among points (N, 3) [m]."""
    types = message_store().types
    points = numpy.ascontiguousarray(points[numpy.isfinite(points).all(axis=1)], "<f4")
    fields = [types["sensor_msgs/msg/PointField"](name, 4 * i, 7, 1) for i, name in enumerate("xyz")]  # 7: float32
    return types["sensor_msgs/msg/PointCloud2"](header(stamp, frame), 1, len(points), fields, False, 12,
                                                12 * len(points), points.view(numpy.uint8).reshape(-1), True)
