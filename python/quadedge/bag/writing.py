"""Writes MCAP recordings of nav_msgs/Odometry with covariances."""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path

from .. import DataError
from ..estimates import Estimates
from ..ros_messages import BODY_FROM_OPTICAL, message_store, odometry_message

_STAMP_END = 2**31 * 1_000_000_000  # builtin_interfaces/Time has 31 bits for seconds from 0


def write_mcap(folder: str | PathLike, results: Iterable, *, topic: str = "/odometry", frame: str = "odom",
               child_frame: str = "base_link", withhold_ambiguous: bool = False) -> Path:
    """Writes a ROS 2 recording (a folder with metadata.yaml and an .mcap file) of ``nav_msgs/Odometry``.

    results: from Odometry.track(). There is one message per tracked frame, with the pose of ``child_frame`` in
    ``frame`` and its covariance. Both frames have the axes of REP 103 (x forward, y left, z up); ``child_frame`` is a
    body frame at the left camera's position, whose x axis is the camera's viewing direction (REP 105).

    The twist is the velocity of ``child_frame`` along its own axes [m/s, rad/s], from the motion since the frame
    before. What is not known has variances of 1e6: pose and twist of frames with ``ambiguous_motion``, poses that were
    measured from such a frame, those of all segments after the first, and twists after a loss. withhold_ambiguous:
    writes no message of a frame with ``ambiguous_motion``.

    Returns the path of the .mcap file. Raises DataError if the folder exists or cannot be written and for stamps that
    ROS's messages cannot hold, ImportError without rosbags.
    """
    store = message_store()
    from rosbags.rosbag2 import StoragePlugin, Writer, WriterError

    folder = Path(folder)
    if folder.exists():
        raise DataError(f"{folder}: the file or folder exists, expected a new folder")
    results = list(results)
    for result in results:
        if result.is_tracked and not 0 <= result.stamp_ns < _STAMP_END:
            raise DataError(f"{folder}: found the stamp {result.stamp_ns} ns, expected 0 to {_STAMP_END - 1} ns, the "
                            "times of ROS")
    estimates = Estimates(BODY_FROM_OPTICAL)
    try:
        with Writer(folder, version=8, storage_plugin=StoragePlugin.MCAP) as writer:
            kind = "nav_msgs/msg/Odometry"
            connection = writer.add_connection(topic, kind, typestore=store)
            for result in results:
                estimate = estimates.add(result)
                if estimate is None or (withhold_ambiguous and result.ambiguous_motion):
                    continue
                message = odometry_message(result.stamp_ns, frame, child_frame, estimate.pose, estimate.covariance,
                                           estimate.twist)
                writer.write(connection, result.stamp_ns, store.serialize_cdr(message, kind))
    except (WriterError, OSError) as error:
        raise DataError(f"{folder}: the recording cannot be written ({error})") from error
    return next(folder.glob("*.mcap"))
