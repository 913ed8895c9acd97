"""ROS recordings as sequences of stereo frames."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path

import numpy

from .. import DataError, Error, Rig
from ..ros_messages import message_store, stamp_ns
from .calibration import rig_of, write_calibration
from .images import grey_image
from .pairing import Pairing, pair_parts, pair_stamps
from .topics import TOLERANCE_NS, StereoTopics, find_topics


@dataclass(frozen=True)
class BagFrame:
    """A stereo frame."""

    stamp_ns: int  #: stamp of the left image [ns]
    left: numpy.ndarray  #: (height, width), uint8 or uint16
    right: numpy.ndarray  #: (height, width), uint8 or uint16
    starts_segment: bool = False  #: its stamp goes back: Odometry.restart() is due before it is tracked


class Recording:
    """A stereo recording, opened by open_bag(). Iterating yields a BagFrame per pair of images, in order of time.

    name: its paths. topics: the topics of both cameras. pairing: which images form pairs, and which were dropped.
    has_recorded_stamps: True if all stamps of the headers are zero, so that the times of recording replace them.
    """

    def __init__(self, paths: Sequence[Path], topics: StereoTopics, calibration, tolerance_ns: int,
                 sort_stamps: bool, restarts: bool, rectified: bool | None):
        self.name = ", ".join(str(path) for path in paths)
        self._paths = paths
        self._may_go_back = sort_stamps or restarts
        self._calibration = calibration
        self.has_recorded_stamps: bool = False
        with self._reader() as reader:
            kinds = {connection.topic: connection.msgtype for connection in reader.connections}
            self.topics: StereoTopics = find_topics(kinds, self.name, topics)
            #: whether the given calibration describes rectified images beside those recorded
            self.calibration_states_p: bool = calibration is not None and rectified is True
            self.rectified: bool = self.topics.names_rectified if rectified is None else rectified
            self._infos = self._first_infos(reader)
            left_ns, right_ns = self._stamps(reader)
        self._left_ns = left_ns
        self.pairing: Pairing = (pair_parts if restarts else pair_stamps)(left_ns, right_ns, tolerance_ns)
        if not self.pairing.pairs:
            raise DataError(f"{self.name}: found no two images of {self.topics.left} and {self.topics.right} within "
                            f"{tolerance_ns / 1e6:g} ms ({self.pairing})")

    @contextmanager
    def _reader(self):
        """The open recording. Errors raised while it is read become a DataError that names it."""
        store = message_store()
        from rosbags.highlevel import AnyReader

        try:
            with AnyReader(self._paths, default_typestore=store) as reader:
                yield reader
        except Error:
            raise
        except Exception as error:  # damaged recordings raise many kinds of exceptions
            reason = str(error) or type(error).__name__
            raise DataError(f"{self.name}: found no readable recording ({reason}), expected a .bag file, a ROS 2 "
                            "folder or an .mcap file") from error

    def _messages(self, reader, topics: tuple[str, ...]) -> Iterator[tuple[str, int, object]]:
        """Topic, time of recording [ns] and message, in the order of recording."""
        connections = [connection for connection in reader.connections if connection.topic in topics]
        for connection, recorded_ns, data in reader.messages(connections):
            yield connection.topic, recorded_ns, reader.deserialize(data, connection.msgtype)

    def _first_infos(self, reader) -> dict[str, object]:
        """The first camera_info message of each camera, by topic."""
        wanted = {self.topics.left_info, self.topics.right_info} - {""}
        found: dict[str, object] = {}
        for topic, _, message in self._messages(reader, tuple(wanted)) if wanted else ():
            found.setdefault(topic, message)
            if len(found) == len(wanted):
                break
        return found

    def _stamps(self, reader) -> tuple[list[int], list[int]]:
        """Stamps of all left and right images [ns]; the times of recording if all stamps are zero."""
        stamps: dict[str, list[int]] = {self.topics.left: [], self.topics.right: []}
        recorded: dict[str, list[int]] = {self.topics.left: [], self.topics.right: []}
        for topic, recorded_ns, message in self._messages(reader, (self.topics.left, self.topics.right)):
            stamps[topic].append(stamp_ns(message))
            recorded[topic].append(recorded_ns)
        self.has_recorded_stamps = not any(stamps[self.topics.left]) and not any(stamps[self.topics.right])
        chosen = recorded if self.has_recorded_stamps else stamps
        if not self._may_go_back:
            for topic, list_ns in chosen.items():
                self._refuse_falling(topic, list_ns)
        return chosen[self.topics.left], chosen[self.topics.right]

    def _refuse_falling(self, topic: str, stamps_ns: list[int]) -> None:
        """Raises DataError for a stamp below an earlier one: a clock that was set, or recordings that were merged."""
        last = 0
        for number, stamp in enumerate(stamps_ns):
            if 0 < stamp < last:
                raise DataError(f"{self.name}: found stamp {stamp} ns after {last} ns in message {number} of {topic}, "
                                "expected increasing stamps: was a clock set, or a simulation restarted? "
                                "--restarts (restarts=True) starts a new segment there, --sort-stamps "
                                "(sort_stamps=True) takes the images in the order of their stamps")
            last = max(last, stamp)

    @property
    def stamps_ns(self) -> list[int]:
        """The stamps of all frames [ns]."""
        return [self._left_ns[left] for left, _ in self.pairing.pairs]

    def _camera_infos(self) -> tuple:
        """The camera_info messages of both cameras. Raises DataError where one is missing."""
        missing = [topic for topic, info in ((self.topics.left, self.topics.left_info),
                                             (self.topics.right, self.topics.right_info)) if info not in self._infos]
        if missing:
            raise DataError(f"{self.name}: found no camera_info of {' and '.join(missing)}, expected one beside the "
                            "images, or others by --left-info and --right-info (left_info=, right_info=), or a "
                            "calibration file")
        return self._infos[self.topics.left_info], self._infos[self.topics.right_info]

    @property
    def has_calibration(self) -> bool:
        """True if there is a rig: from a given calibration, or from camera_info of both cameras."""
        return self._calibration is not None or len(self._infos) == 2

    @cached_property
    def rig(self) -> Rig:
        """The rig from the calibration given to open_bag(), or from camera_info. Raises DataError without either."""
        max_value = 65535 if next(iter(self)).left.dtype == numpy.uint16 else 255
        if self._calibration is not None:
            return Rig.from_file(self._calibration, max_value=max_value, rectified=self.calibration_states_p)
        infos, topics = self._camera_infos(), (self.topics.left_info, self.topics.right_info)
        return rig_of(infos, [f"{self.name}: {topic}" for topic in topics], self.rectified, max_value)

    def write_calibration(self, folder: Path) -> str:
        """The calibration as ``quadedge run --calibration`` takes it; camera_info is written to files in ``folder``."""
        given = self._calibration
        if given is None:
            given = write_calibration(folder, self._camera_infos(), self.rectified)
        return ",".join(map(str, given)) if isinstance(given, (tuple, list)) else str(given)

    def __len__(self) -> int:
        return len(self.pairing.pairs)

    def __iter__(self) -> Iterator[BagFrame]:
        """Reads the recording once. Keeps images only until they are yielded."""
        pairs = self.pairing.pairs
        wanted = {(self.topics.left, left) for left, _ in pairs} | {(self.topics.right, right) for _, right in pairs}
        waiting: dict[tuple[str, int], object] = {}
        place = {self.topics.left: -1, self.topics.right: -1}
        turn, shapes = 0, None
        with self._reader() as reader:
            for topic, _, message in self._messages(reader, (self.topics.left, self.topics.right)):
                place[topic] += 1
                if (topic, place[topic]) not in wanted:
                    continue
                waiting[topic, place[topic]] = message
                while turn < len(pairs):
                    left, right = (self.topics.left, pairs[turn][0]), (self.topics.right, pairs[turn][1])
                    if left not in waiting or right not in waiting:
                        break
                    frame = self._frame(waiting.pop(left), waiting.pop(right), self._left_ns[left[1]],
                                        turn in self.pairing.restarts)
                    shapes = self._same_shapes(frame, shapes)
                    yield frame
                    turn += 1

    def _same_shapes(self, frame: BagFrame, expected: list | None) -> list:
        """Shapes and types of both images. Raises DataError for others than those of the first frame."""
        found = [(image.shape, image.dtype) for image in (frame.left, frame.right)]
        for topic, one, other in zip((self.topics.left, self.topics.right), found, expected or found):
            if one != other:
                words = [f"{width} x {height} pixels of {kind}" for (height, width), kind in (one, other)]
                raise DataError(f"{self.name}: {topic} at {frame.stamp_ns} ns: found {words[0]}, expected "
                                f"{words[1]}, as in the first frame")
        return found

    def _frame(self, left, right, stamp_ns: int, starts_segment: bool) -> BagFrame:
        return BagFrame(stamp_ns, grey_image(left, f"{self.name}: {self.topics.left} at {stamp_ns} ns"),
                        grey_image(right, f"{self.name}: {self.topics.right} at {stamp_ns} ns"), starts_segment)


def open_bag(path: str | PathLike | Sequence[str | PathLike], *, left: str = "", right: str = "", left_info: str = "",
             right_info: str = "", calibration=None, tolerance_ns: int = TOLERANCE_NS, sort_stamps: bool = False,
             restarts: bool = False, rectified: bool | None = None) -> Recording:
    """Opens a stereo recording: one or several ``.bag`` files of ROS 1, a ROS 2 folder, or an ``.mcap`` file.

    left, right: image topics, of type ``sensor_msgs/Image`` or ``CompressedImage``; by default found by their names.
    left_info, right_info: their topics of ``sensor_msgs/CameraInfo``, by default beside the images. calibration: files
    as for Rig.from_file(), instead of the recorded camera_info. tolerance_ns: largest difference between the stamps of
    a pair [ns]; images without a partner are dropped and counted in ``Recording.pairing``. sort_stamps: takes images in
    the order of their stamps; by default a stamp that goes back is refused. restarts: such a stamp starts a new
    segment, see ``BagFrame.starts_segment``. rectified: whether the images are those of the projection matrix P, not
    those of K and D; by default only if their topics say so.

    Raises DataError for a path that is not a readable recording or has no stereo topics, ImportError without rosbags.
    """
    paths = [path] if isinstance(path, (str, PathLike)) else list(path)
    topics = StereoTopics(left, right, left_info, right_info)
    return Recording([Path(one) for one in paths], topics, calibration, tolerance_ns, sort_stamps, restarts, rectified)
