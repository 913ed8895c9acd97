"""A robot in a domain of its own on the loopback: a stereo camera, a listener, and QuadEdge as another process."""

import itertools
import os
import signal
import subprocess
import sys
import time

import numpy

import quadedge
from quadedge.bag.calibration import rig_of
from quadedge.estimates import of_base
from quadedge.result_files import rotations
from quadedge.ros2.domain import Domain
from quadedge.ros_messages import BODY_FROM_OPTICAL, UNKNOWN, header, message_store, quaternion, stamp_ns

SECOND = 1_000_000_000
LEFT, RIGHT = "/stereo/left", "/stereo/right"
OUT = {"/quadedge/odometry": "nav_msgs/msg/Odometry", "/tf": "tf2_msgs/msg/TFMessage",
       "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray", "/quadedge/edges": "sensor_msgs/msg/PointCloud2"}
_numbers = itertools.count(60 + os.getpid() % 100)


def image_message(stamp: int, pixels: numpy.ndarray, encoding: str = "mono8"):
    height, width = pixels.shape
    return message_store().types["sensor_msgs/msg/Image"](
        header(stamp, "optical"), height, width, encoding, 0, width * pixels.itemsize,
        numpy.ascontiguousarray(pixels).view(numpy.uint8).reshape(-1))


def info_message(stamp: int, camera, tx: float):
    """camera_info of a rectified camera without distortion; tx: -fx baseline [px m]."""
    types = message_store().types
    k, p = camera.matrix, numpy.hstack([camera.matrix, [[tx], [0], [0]]])
    return types["sensor_msgs/msg/CameraInfo"](
        header(stamp, "optical"), camera.height, camera.width, "plumb_bob", numpy.zeros(5), k.reshape(-1),
        numpy.eye(3).reshape(-1), p.reshape(-1), 0, 0, types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False))


def tracked(rig, frames, stamps, **options) -> list:
    """The results of the same frames without topics."""
    with quadedge.Odometry(rig, preset="fast", **options) as odometry:
        return [odometry.track(stamp, frame.left, frame.right) for stamp, frame in zip(stamps, frames)]


def pose_of(message) -> list[float]:
    """Position and quaternion x y z w of an Odometry or a PoseWithCovarianceStamped."""
    position, turn = message.pose.pose.position, message.pose.pose.orientation
    return [position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w]


def expected_pose(result) -> list[float]:
    """The same of a result, without another mount of the camera."""
    pose, _ = of_base(result.world_from_left, None, BODY_FROM_OPTICAL)
    return [*pose[:3, 3], *quaternion(pose[:3, :3])]


def pose_of_transform(message) -> numpy.ndarray:
    shift, turn = message.transform.translation, message.transform.rotation
    pose = numpy.eye(4)
    pose[:3, :3] = rotations(numpy.array([[turn.x, turn.y, turn.z, turn.w]]))[0]
    pose[:3, 3] = shift.x, shift.y, shift.z
    return pose


def is_unknown(part) -> bool:
    """Whether the covariance of a pose or a twist says so."""
    return numpy.array_equal(part.covariance.reshape(6, 6), UNKNOWN)


class Robot:
    """Publishes frames of a rig and keeps what QuadEdge publishes, by topic. rig: None without camera_info. Use as a
    context manager.
    """

    def __init__(self, rig=None, listens: bool = True):
        self.number = next(_numbers)
        self.rig, self.domain = rig, Domain(self.number, loopback=True)
        self.program = [sys.executable, "-m", "quadedge.ros2", "--preset", "fast"]
        kind = "sensor_msgs/msg/Image"
        self.images = [self.domain.advertise(f"{side}/image_raw", kind) for side in (LEFT, RIGHT)] if listens else []
        self.infos = ([self.domain.advertise(f"{side}/camera_info", "sensor_msgs/msg/CameraInfo")
                       for side in (LEFT, RIGHT)] if rig else [])
        self.heard = {topic: [] for topic in OUT}
        self._subscriptions = {topic: self.domain.subscribe(topic, kind, reliable=True, depth=1000)
                               for topic, kind in OUT.items()}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if hasattr(self, "process") and self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def start(self, folder, *options: object) -> None:
        """Starts QuadEdge and waits until it has subscribed to the images."""
        self._words = folder / "stderr.txt"
        environment = {**os.environ, "ROS_DOMAIN_ID": str(self.number), "ROS_LOCALHOST_ONLY": "1"}
        call = [*map(str, self.program), *map(str, options)]
        with self._words.open("wb") as words:
            self.process = subprocess.Popen(call, env=environment, stderr=words)
        if self.images:
            self.said(f"left {LEFT}/image_raw, right {RIGHT}/image_raw")

    @property
    def words(self) -> str:
        return self._words.read_text()

    def listen(self, seconds: float = 0.0) -> None:
        end = time.monotonic() + seconds
        while True:
            for topic, subscription in self._subscriptions.items():
                self.heard[topic] += subscription.take()
            if (rest := end - time.monotonic()) <= 0:
                return
            time.sleep(min(rest, 0.01))

    def until(self, holds, what: str, seconds: float = 180.0) -> None:
        """Listens until a condition holds."""
        end = time.monotonic() + seconds
        while not holds():
            assert self.process.poll() is None, f"ended with {self.process.returncode}: {self.words}"
            assert time.monotonic() < end, f"waited for {what}: {self.words}"
            self.listen(0.05)

    def said(self, text: str, seconds: float = 180.0) -> None:
        self.until(lambda: text in self.words, text, seconds)

    def info(self, side: int, stamp: int = 1):
        camera = (self.rig.left, self.rig.right)[side]
        return info_message(stamp, camera, -camera.fx * self.rig.baseline if side else 0.0)

    @property
    def stated_rig(self):
        """The rig as camera_info states it."""
        return rig_of((self.info(0), self.info(1)), [LEFT, RIGHT], False, 255)

    def send(self, stamp: int, left, right, encoding: str = "mono8", sides=(0, 1)) -> None:
        for side in sides:
            if self.infos:
                self.infos[side].publish(self.info(side, stamp))
            self.images[side].publish(image_message(stamp, (left, right)[side], encoding))

    def poses(self) -> dict[int, object]:
        """The messages of odometry by stamp [ns]."""
        self.listen()
        return {stamp_ns(message): message for message in self.heard["/quadedge/odometry"]}

    def play(self, frames, first_stamp: int, step_ns: int = 50_000_000) -> int:
        """Sends frames and waits for the pose of each, and sends it again where the network has lost it; all frames are
        tracked. Returns the stamp after the last.
        """
        for number, frame in enumerate(frames):
            stamp, sent = first_stamp + number * step_ns, 0.0
            end = time.monotonic() + 180
            while stamp not in self.poses():
                assert time.monotonic() < end and self.process.poll() is None, self.words
                if time.monotonic() - sent > 0.5:
                    self.send(stamp, frame.left, frame.right)
                    sent = time.monotonic()
                self.listen(0.01)
        return first_stamp + len(frames) * step_ns

    def diagnostics(self) -> dict[str, str]:
        """The newest values, with the level and the message; waits for the first."""
        self.until(lambda: len(self.heard["/diagnostics"]) > 0, "diagnostics")
        status = self.heard["/diagnostics"][-1].status[0]
        return {pair.key: pair.value for pair in status.values} | {"level": status.level, "message": status.message}

    def diagnosed(self, level: int, text: str) -> bool:
        """Whether diagnostics of this level had this text in their message."""
        return any(message.status[0].level == level and text in message.status[0].message
                   for message in self.heard["/diagnostics"])

    def end(self) -> float:
        """Interrupts QuadEdge. Returns the seconds that it took to end."""
        start = time.monotonic()
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(30) == 0, self.words
        return time.monotonic() - start
