"""ROS recordings of every kind, written from a Dataset's files."""

from dataclasses import dataclass
from pathlib import Path

import numpy
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

    def camera_info(self, topic: str, stamp_ns: int, camera, tx: float) -> None:
        """Writes the camera_info of a rectified camera without distortion; tx: -fx baseline [px m]."""
        k = camera.matrix.reshape(-1)
        p = numpy.hstack([camera.matrix, [[tx], [0], [0]]]).reshape(-1)
        matrices = {"D": numpy.zeros(5), "K": k, "R": numpy.eye(3).reshape(-1), "P": p}
        if not self.is1:
            matrices = {name.lower(): value for name, value in matrices.items()}
        region = self.store.types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
        self.write(topic, "sensor_msgs/msg/CameraInfo", header=self.header(stamp_ns), height=camera.height,
                   width=camera.width, distortion_model="plumb_bob", binning_x=0, binning_y=0, roi=region, **matrices)
