"""ROS recordings of every kind, written from a Dataset's files."""

from dataclasses import dataclass
from pathlib import Path

import numpy
import quadedge
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

KINDS = ("ros1", "ros2", "mcap")


@dataclass
class BagWriter:
    """Writes messages to a recording; ``kind`` is one of KINDS. Use as a context manager."""

    path: Path
    kind: str

    def __post_init__(self):
        self.is1 = self.kind == "ros1"
        self.store = get_typestore(Stores.ROS1_NOETIC if self.is1 else Stores.ROS2_HUMBLE)
        self.connections, self.recorded_ns = {}, 1_000_000_000

    def __enter__(self):
        if self.is1:
            self.path = self.path.with_suffix(".bag")
            self.writer = Writer1(self.path)
        else:
            plugin = StoragePlugin.MCAP if self.kind == "mcap" else StoragePlugin.SQLITE3
            self.writer = Writer2(self.path, version=8, storage_plugin=plugin)
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def write(self, topic: str, kind: str, **fields) -> None:
        """Writes a message, recorded a millisecond after the previous one."""
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        message = self.store.types[kind](**fields)
        data = self.store.serialize_ros1(message, kind) if self.is1 else self.store.serialize_cdr(message, kind)
        self.recorded_ns += 1_000_000
        self.writer.write(self.connections[topic], self.recorded_ns, data)

    def header(self, stamp_ns: int):
        stamp = self.store.types["builtin_interfaces/msg/Time"](*divmod(stamp_ns, 1_000_000_000))
        arguments = {"seq": 0} if self.is1 else {}
        return self.store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera", **arguments)

    def image(self, topic: str, stamp_ns: int, pixels: numpy.ndarray, encoding: str = "") -> None:
        channels = pixels.shape[2] if pixels.ndim == 3 else 1
        encoding = encoding or {1: "mono8", 3: "bgr8"}[channels]
        self.write(topic, "sensor_msgs/msg/Image", header=self.header(stamp_ns), height=pixels.shape[0],
                   width=pixels.shape[1], encoding=encoding, is_bigendian=0,
                   step=pixels.shape[1] * channels * pixels.itemsize,
                   data=numpy.ascontiguousarray(pixels).view(numpy.uint8).reshape(-1))

    def compressed(self, topic: str, stamp_ns: int, file: str | Path) -> None:
        self.write(topic, "sensor_msgs/msg/CompressedImage", header=self.header(stamp_ns), format="png",
                   data=numpy.frombuffer(Path(file).read_bytes(), numpy.uint8))

    def camera_info(self, topic: str, stamp_ns: int, camera, tx: float, distortion=(0,) * 5, cy: float = 0.0) -> None:
        """Writes the camera_info of a rectified camera; tx: -fx baseline [px m], cy: how far the recorded image's
        principal point is below the rectified one's [px].
        """
        k = camera.matrix.copy()
        k[1, 2] += cy
        p = numpy.hstack([camera.matrix, [[tx], [0], [0]]]).reshape(-1)
        matrices = {"D": numpy.array(distortion, float), "K": k.reshape(-1), "R": numpy.eye(3).reshape(-1), "P": p}
        if not self.is1:
            matrices = {name.lower(): value for name, value in matrices.items()}
        region = self.store.types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
        self.write(topic, "sensor_msgs/msg/CameraInfo", header=self.header(stamp_ns), height=camera.height,
                   width=camera.width, distortion_model="plumb_bob", binning_x=0, binning_y=0, roi=region, **matrices)

    def infos(self, rig, distortion=(0,) * 5, right_cy: float = 0.0) -> None:
        """Writes the camera_info of both cameras."""
        right_tx = -rig.right.fx * rig.baseline
        self.camera_info("/stereo/left/camera_info", 1, rig.left, 0.0, distortion)
        self.camera_info("/stereo/right/camera_info", 1, rig.right, right_tx, distortion, right_cy)

    def pair(self, stamp_ns: int, left: numpy.ndarray, right: numpy.ndarray, encoding: str = "",
             topic: str = "/stereo/{}/image_raw") -> None:
        for side, pixels in (("left", left), ("right", right)):
            self.image(topic.format(side), stamp_ns, pixels, encoding)


def room_recording(path: Path, rig, frames, kind: str = "mcap", topic: str = "/stereo/{}/image_raw") -> Path:
    """A recording of frames with camera_info, each a nanosecond late: a stamp of 0 counts as none."""
    with BagWriter(path, kind) as bag:
        bag.infos(rig)
        for frame in frames:
            bag.pair(frame.stamp_ns + 1, frame.left, frame.right, topic=topic)
    return bag.path


def messages_of(folder: Path) -> list:
    with AnyReader([folder]) as reader:
        return [reader.deserialize(data, connection.msgtype) for connection, _, data in reader.messages()]


def poses(source, frames, **options) -> list:
    """The results of tracking frames; source: a rig or a data set."""
    with quadedge.Odometry(source, **options) as odometry:
        return [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in frames]


def tum_of(results, folder: Path) -> bytes:
    """The poses of the tracked ones in TUM's format, as `quadedge run` writes them."""
    tracked = [result for result in results if result.is_tracked]
    stamps, segments = ([getattr(result, name) for result in tracked] for name in ("stamp_ns", "segment"))
    quadedge.Trajectory(numpy.array(stamps), numpy.array([result.world_from_left for result in tracked]),
                        numpy.array(segments, numpy.int32)).write_tum(folder / "expected.txt")
    return (folder / "expected.txt").read_bytes()
