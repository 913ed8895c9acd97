"""Tracks the images of two topics and publishes what a robot takes from odometry."""

import argparse
import time
from collections import Counter
from collections.abc import Callable

import numpy

from .. import DataError, Rig
from ..bag.calibration import rig_of
from ..bag.images import grey_image
from ..bag.topics import CAMERA_INFO, StereoTopics, find_topics
from ..ros_messages import (BODY_FROM_OPTICAL, cloud_message, diagnostics_message, odometry_message, of_base, stamp_ns,
                            transforms_message, twist_between)
from ..session import Session
from .domain import Domain
from .mount import StaticFrames, mount_of
from .pairs import LEFT, RIGHT, PairQueue

SIDES = ("left", "right")
_ODOMETRY, _EDGES, _RESET = "/quadedge/odometry", "/quadedge/edges", "/quadedge/reset"
_SETTLED_S, _SILENCE_S, _NOBODY_S = 0.5, 2.0, 5.0
_GOOD, _WARNING, _ERROR = range(3)


def _name(name: str, remaps: list[str]) -> str:
    """A topic after --remap FROM:=TO."""
    return dict(remap.split(":=", 1) for remap in remaps).get(name, name)


def given_rig(calibration: str, maximum: int = 255):
    """The rig of --calibration FILE[,FILE]. maximum: value of a saturated pixel. Raises DataError."""
    return Rig.from_file(tuple(calibration.split(",")) if "," in calibration else calibration, max_value=maximum)


class Waiting:
    """Waits for the topics of two cameras to be published."""

    def __init__(self, domain: Domain, options: argparse.Namespace, say: Callable):
        self._domain, self._options, self._say = domain, options, say

    def topics(self, stopped: list) -> tuple[StereoTopics, dict[str, str]] | None:
        """The topics and the kinds of all, as soon as they stay the same for a moment; None if stopped."""
        options, start, since, found = self._options, time.monotonic(), 0.0, None
        given = StereoTopics(options.left, options.right, options.left_info, options.right_info)
        while not stopped:
            kinds, now, problem = dict(self._domain.publications()), time.monotonic(), ""
            try:
                topics = find_topics(kinds, f"domain {self._domain.number}", given)
                if not options.calibration and not (topics.left_info and topics.right_info):
                    problem = (f"domain {self._domain.number}: found no camera_info beside {topics.left} and "
                               f"{topics.right}, expected one of each camera, or --calibration FILE")
            except DataError as error:
                topics, problem = None, str(error)
            if problem:
                found = None
                if start is not None and now - start > _NOBODY_S:
                    self._say(problem + "; waiting" if kinds else
                              f"domain {self._domain.number}: nobody publishes a topic of ROS 2 (is ROS_DOMAIN_ID that "
                              "of the robot?); waiting")
                    start = None
            elif topics != found:
                found, since = topics, now
            elif now - since > _SETTLED_S:
                return topics, kinds
            time.sleep(0.1)
        return None


class Node:
    """Subscribes to two cameras of a domain and publishes odometry."""

    def __init__(self, domain: Domain, topics: StereoTopics, kinds: dict[str, str], options: argparse.Namespace,
                 say: Callable):
        self._domain, self._topics, self._options, self._say = domain, topics, options, say
        self._queue = PairQueue(round(options.tolerance * 1e6))
        self._images = [domain.subscribe(name, kinds[name], reliable=options.reliable)
                        for name in (topics.left, topics.right)]
        self._infos, self._info_topics = [None, None], [None, None]
        if not options.calibration:
            self._info_topics = [domain.subscribe(name, CAMERA_INFO) for name in (topics.left_info, topics.right_info)]
        self._static, self._frames = domain.subscribe("/tf_static", "tf2_msgs/msg/TFMessage", reliable=True,
                                                      latched=True, depth=100), StaticFrames()
        self._reset = domain.subscribe(_name(_RESET, options.remap), "std_msgs/msg/Empty", reliable=True)
        self._odometry = domain.advertise(_name(_ODOMETRY, options.remap), "nav_msgs/msg/Odometry")
        self._tf = None if options.no_tf else domain.advertise(_name("/tf", options.remap), "tf2_msgs/msg/TFMessage",
                                                               depth=100)
        self._diagnostics = domain.advertise(_name("/diagnostics", options.remap),
                                             "diagnostic_msgs/msg/DiagnosticArray")
        self._edges = (domain.advertise(_name(_EDGES, options.remap), "sensor_msgs/msg/PointCloud2", depth=1)
                       if options.cloud else None)
        self._base_from_camera = mount_of(options.base_from_camera) if options.base_from_camera else None
        self._session: Session | None = None
        self._sessions = 0
        self._last = None  # result
        self._origin, self._origin_known, self._pose = numpy.eye(4), True, numpy.eye(4)  # in odom
        self._said: set[str] = set()
        self._heard = [time.monotonic()] * 2
        self._silent = [False, False]
        self._problem, self._warnings = "", Counter()
        self._began = self._second = time.monotonic()
        self._latencies_ms: list[float] = []

    def run(self, stopped: list) -> None:
        """Tracks until ``stopped`` has an element."""
        try:
            while not stopped:
                self._domain.wait(0.1)
                self._receive()
                if pair := self._queue.newest():
                    self._track(*pair, time.monotonic())
                if time.monotonic() - self._second >= 1:
                    self._each_second()
        finally:
            self._end_session()

    def _say_once(self, text: str) -> None:
        if text not in self._said:
            self._said.add(text)
            self._say(text)

    # What comes in.

    def _receive(self) -> None:
        for message in self._static.take():
            self._frames.add(message)
        for side, topic in enumerate(self._info_topics):
            for message in topic.take() if topic else ():
                self._take_info(side, message)
        for side, topic in enumerate(self._images):
            for message in topic.take():
                self._heard[side] = time.monotonic()
                if back := self._queue.add(side, message):
                    self._start_again(f"the stamps of {self._image_topic(side)} went back by {back / 1e9:.3f} s (a "
                                      "clock that was set, or a recording that starts again)")
        if self._reset.take():
            self._start_again("reset", keep_pose=False)

    def _image_topic(self, side: int) -> str:
        return self._topics.right if side == RIGHT else self._topics.left

    def _take_info(self, side: int, message) -> None:
        said = [message.height, message.width, message.distortion_model, *message.d, *message.k, *message.r, *message.p]
        before, self._infos[side] = self._infos[side], (said, message)
        if before is not None and before[0] != said:
            self._start_again(f"camera_info of the {SIDES[side]} camera has changed")

    def _start_again(self, why: str, keep_pose: bool = True) -> None:
        """Ends the session; the next pair begins another, at the last pose, whose place is then not measured."""
        if not keep_pose:
            self._origin, self._origin_known = numpy.eye(4), True
        if self._session is None:
            return
        self._end_session()
        if keep_pose:
            self._origin, self._origin_known = self._pose, False
        self._say(f"{why}: the odometry starts again, " + ("at the last pose, with an unknown covariance" if keep_pose
                                                           else "at the origin"))

    def _end_session(self) -> None:
        if self._session:
            self._session.close()
        self._session = self._last = None

    def _rig(self, maximum: int):
        """The rig from --calibration or camera_info; None while camera_info is missing. Raises DataError."""
        if self._options.calibration:
            return given_rig(self._options.calibration, maximum)
        if None in self._infos:
            return None
        rectified = self._topics.names_rectified if self._options.rectified is None else self._options.rectified
        return rig_of(tuple(info for _, info in self._infos), [self._topics.left_info, self._topics.right_info],
                      rectified, maximum)

    def _start_session(self, rig, frame: str) -> None:
        options = self._options
        if self._base_from_camera is None:
            found = self._frames.pose(options.base_frame, frame)
            self._base_from_camera = BODY_FROM_OPTICAL if found is None else found
            self._say(f"the camera's mount is that of /tf_static: {frame} in {options.base_frame}" if found is not None
                      else f"/tf_static does not connect {options.base_frame} with the frame '{frame}' of the images: "
                      "the camera counts as the base, looking forward (--base-from-camera states another mount)")
        self._sessions += 1
        output = f"{options.output}_{self._sessions}" if options.output and self._sessions > 1 else None
        self._session = Session(rig, f"domain {self._domain.number}: {self._topics.left}", options, self._say, output)
        self._say(f"tracking {rig.left.width} x {rig.left.height} px on {self._session.odometry.device.name}")

    # What goes out.

    def _refuse(self, why, since: float = 0.0) -> None:
        """Leaves a pair out, and says why unless what lacks has had no time to come since the start."""
        self._queue.counts.refused += 1
        self._problem = str(why)
        if time.monotonic() - since > _SILENCE_S:
            self._say_once(f"{why}; such images are left out")

    def _track(self, left, right, arrived: float) -> None:
        try:
            images = [grey_image(message, self._image_topic(side)) for side, message in enumerate((left, right))]
            rig = self._session is None and self._rig(numpy.iinfo(images[LEFT].dtype).max)
        except DataError as error:
            return self._refuse(error)
        if rig is None:
            return self._refuse("images come without camera_info", since=self._began)
        if rig:
            self._start_session(rig, left.header.frame_id)
        try:
            result = self._session.odometry.track(stamp_ns(left), *images)
        except (DataError, TypeError) as error:
            return self._refuse(error)
        self._queue.counts.pairs += 1
        self._problem = "" if result.is_tracked else result.message
        self._warnings.update(str(warning.kind) for warning in result.warnings)
        if result.is_tracked:
            self._publish(result, left.header.frame_id)
        self._latencies_ms.append((time.monotonic() - arrived) * 1e3)
        self._session.keep(result)
        self._last = result

    def _publish(self, result, frame: str) -> None:
        options, mount = self._options, self._base_from_camera
        known = result.covariance if result.segment == 0 and self._origin_known else None
        pose, covariance = of_base(result.world_from_left, known, mount)
        self._pose = self._origin @ pose
        message = odometry_message(result.stamp_ns, options.odom_frame, options.base_frame, self._pose, covariance,
                                   twist_between(self._last, result, mount))
        self._odometry.publish(message)
        transforms = [(options.odom_frame, options.base_frame, self._pose)]
        if result.map_from_odometry is not None:
            in_base_axes, _ = of_base(result.map_from_odometry, None, mount)
            transforms.append((options.map_frame, options.odom_frame, in_base_axes @ numpy.linalg.inv(self._origin)))
        if self._tf:
            self._tf.publish(transforms_message(result.stamp_ns, transforms))
        if self._edges:
            self._edges.publish(cloud_message(result.stamp_ns, frame, self._session.odometry.edges().xyz))

    def _each_second(self) -> None:
        """Notes what is silent or doubled, and publishes the state."""
        now = time.monotonic()
        faults = [f"{topic.publishers} publishers on {self._image_topic(side)}, expected one"
                  for side, topic in enumerate(self._images) if topic.publishers > 1]
        for text in faults:
            self._say_once(f"warning: {text}")
        silent = []
        for side in (LEFT, RIGHT):
            silence = now - self._heard[side]
            if silence > _SILENCE_S:
                silent.append(f"no image of {self._image_topic(side)} for {silence:.0f} s")
            if self._silent[side] != (silence > _SILENCE_S):
                self._silent[side] = silence > _SILENCE_S
                self._say(f"warning: {silent[-1]}" if self._silent[side] else
                          f"images of {self._image_topic(side)} come again")
        self._publish_state(silent, faults)
        self._second, self._latencies_ms = now, []

    def _publish_state(self, silent: list[str], faults: list[str]) -> None:
        counts, last, times = self._queue.counts, self._last, self._latencies_ms
        status = "no images" if silent else last.status if last else "waiting"
        values = {"status": status, "reason": self._problem, "warnings": ", ".join(self._warnings),
                  "latency of the pair [ms]": f"{numpy.median(times):.1f}" if times else "",
                  "largest latency [ms]": f"{max(times):.1f}" if times else "", **counts.by_name()}
        error, warning = "; ".join(silent) or self._problem, "; ".join(faults) or ", ".join(self._warnings)
        level = _ERROR if error else _WARNING if warning or not last else _GOOD
        self._diagnostics.publish(diagnostics_message(time.time_ns(), "quadedge: stereo odometry", level,
                                                      error or warning or status, values))
