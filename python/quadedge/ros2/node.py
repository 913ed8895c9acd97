"""Tracks the images of two topics and publishes what a robot takes from odometry."""

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy

from .. import DataError, Error
from ..bag.calibration import given_rig, rig_of
from ..bag.images import grey_image
from ..bag.topics import CAMERA_INFO, StereoTopics
from ..ros_messages import cloud_message, odometry_message, pose_message, stamp_ns, transforms_message
from ..session import Session
from .domain import Domain
from .localisation import Localisation
from .masks import Masks, MaskTopic
from .mount import StaticFrames, levelled, mount_of
from .pairs import LEFT, RIGHT, PairQueue
from .place import Place, Placed
from .service import Trigger
from .state import State
from .watch import SILENCE_S, Watch

SIDES = ("left", "right")
_ODOMETRY, _EDGES, _RESET = "/quadedge/odometry", "/quadedge/edges", "/quadedge/reset"
_SAVE_MAP, _LOAD_MAP, _MAP_POSE = "/quadedge/save_map", "/quadedge/load_map", "/quadedge/map_pose"


class Node:
    """Subscribes to two cameras of a domain and publishes odometry. options: checked."""

    def __init__(self, domain: Domain, topics: StereoTopics, kinds: dict[str, str], options: argparse.Namespace,
                 say: Callable):
        self._domain, self._topics, self._options, self._say = domain, topics, options, say
        tolerance_ns = round(options.tolerance * 1e6)
        self._queue = PairQueue(tolerance_ns)
        image_topics = (topics.left, topics.right)
        self._images = [domain.subscribe(name, kinds[name], reliable=options.reliable) for name in image_topics]
        self._watch = Watch(domain, image_topics, self._images, self._queue, tolerance_ns, say)
        self._masks = Masks({side: MaskTopic(domain, name, SIDES[side], options.reliable, say) for side, name in
                             enumerate((options.left_mask, options.right_mask)) if name},
                            tolerance_ns, options.mask_wait / 1e3)
        self._infos, self._info_topics = [None, None], [None, None]
        if not options.calibration:
            self._info_topics = [domain.subscribe(name, CAMERA_INFO) for name in (topics.left_info, topics.right_info)]
        self._static, self._frames = domain.subscribe("/tf_static", "tf2_msgs/msg/TFMessage", reliable=True,
                                                      latched=True, depth=100), StaticFrames()
        self._reset = domain.subscribe(self._name(_RESET), "std_msgs/msg/Empty", reliable=True)
        self._odometry = domain.advertise(self._name(_ODOMETRY), "nav_msgs/msg/Odometry")
        self._tf = None if options.no_tf else domain.advertise(self._name("/tf"), "tf2_msgs/msg/TFMessage", depth=100)
        self._diagnostics = domain.advertise(self._name("/diagnostics"), "diagnostic_msgs/msg/DiagnosticArray")
        self._edges = (domain.advertise(self._name(_EDGES), "sensor_msgs/msg/PointCloud2", depth=1)
                       if options.cloud else None)
        self._localisation, self._map_from_odom = Localisation(options, say) if options.map else None, None
        self._map_pose = (domain.advertise(self._name(_MAP_POSE), "geometry_msgs/msg/PoseWithCovarianceStamped")
                          if options.map else None)
        self._services = [Trigger(domain, self._name(name), answer) for name, answer in (
            (_RESET, self._answer_reset), (_SAVE_MAP, self._answer_save), (_LOAD_MAP, self._answer_load))]
        self._place, self._camera_frame = Place(levelled(options.gravity) if options.gravity else numpy.eye(4)), ""
        self._clock = domain.subscribe("/clock", "rosgraph_msgs/msg/Clock") if options.use_sim_time else None
        self._clock_ns = 0
        self._session: Session | None = None
        self._sessions = 0
        self._before = [None, None]  # images of the pair before
        self._said: set[str] = set()
        self._state = State()
        self._began = self._second = time.monotonic()

    def _name(self, topic: str) -> str:
        return self._options.remaps.get(topic, topic)

    def run(self, stopped: list) -> None:
        """Tracks until ``stopped`` has an element."""
        pair = None
        try:
            while not stopped:
                self._domain.wait(0.0 if pair else self._masks.rest_s(0.1))  # the next pair may have come meanwhile
                self._receive()
                pair = None
                if self._lacks_info():
                    self._watch.pair()
                elif pair := self._queue.newest(self._masks.ready):
                    self._track(*pair, self._masks.arrived)
                    self._watch.pair()  # afterwards: the first pair builds kernels
                    self._receive()
                if time.monotonic() - self._second >= 1:
                    self._publish_state()
        finally:
            try:
                self._end_session()
            finally:
                if self._localisation:
                    self._localisation.close()

    # What comes in.

    def _receive(self) -> None:
        for message in self._clock.take() if self._clock else ():
            self._clock_ns = message.clock.sec * 1_000_000_000 + message.clock.nanosec
        for message in self._static.take():
            self._frames.add(message)
            self._find_mount()
        for side, topic in enumerate(self._info_topics):
            for message in topic.take() if topic else ():
                self._take_info(side, message)
        for side, topic in enumerate(self._images):
            for message in topic.take():
                self._watch.hear(side)
                if back := self._queue.add(side, message):
                    self._masks.forget()
                    self._start_again(f"the stamps of {self._image_topic(side)} went back by {back / 1e9:.3f} s (a "
                                      "clock that was set, or a recording that starts again)")
        self._masks.receive()
        if self._reset.take():
            self._start_again("reset", keep_pose=False)
        for service in self._services:
            service.work()

    def _answer_reset(self) -> tuple[bool, str]:
        self._start_again("reset", keep_pose=False)
        return True, "the odometry starts again at the origin"

    def _answer_save(self) -> tuple[bool, str]:
        file = self._options.save_map
        if not file:
            return False, "found no --save-map FILE, expected it with --loops when the program starts"
        if self._session is None:
            return False, "found no tracked pair, expected images first"
        try:
            self._session.odometry.save_map(file)
        except Error as error:
            return False, str(error)
        return True, f"the map is in {file}"

    def _answer_load(self) -> tuple[bool, str]:
        if not self._localisation:
            return False, "found no --map FILE, expected it when the program starts"
        return self._localisation.load()

    def _image_topic(self, side: int) -> str:
        return self._topics.right if side == RIGHT else self._topics.left

    def _take_info(self, side: int, message) -> None:
        roi = message.roi
        said = [message.height, message.width, message.distortion_model, *message.d, *message.k, *message.r, *message.p,
                message.binning_x, message.binning_y, roi.x_offset, roi.y_offset, roi.width, roi.height]
        before, self._infos[side] = self._infos[side], (said, message)
        if before is not None and before[0] != said:
            self._start_again(f"camera_info of the {SIDES[side]} camera has changed")
            if self._localisation:  # with the new rig
                self._localisation.forget()
                self._localisation.load()

    def _lacks_info(self) -> bool:
        """Whether images have to wait for camera_info. Says so when it has had time to come."""
        if self._options.calibration or None not in self._infos:
            return False
        if sum(self._queue.counts.images) and time.monotonic() - self._began > SILENCE_S:
            self._state.refuse("images come without camera_info")
            self._say_once("images come without camera_info; waiting")
        return True

    def _find_mount(self) -> None:
        """Takes the camera's mount from /tf_static as soon as it is there, unless an option states it."""
        options, frame = self._options, self._camera_frame
        if not frame or options.base_from_camera:
            return
        found = self._frames.pose(options.base_frame, frame)
        if found is None:
            return
        if self._place.set_mount(found):
            self._say(f"/tf_static connects {options.base_frame} with {frame} only now: the base goes on from where it "
                      "is, with an unknown covariance")
        self._say_once(f"the camera's mount is that of /tf_static: {frame} in {options.base_frame}")

    def _start_again(self, why: str, keep_pose: bool = True) -> None:
        """Ends the session; the next pair begins another, at the last pose, whose place is then not measured."""
        if not keep_pose:
            self._place.reset()
            self._map_from_odom = None
            if self._localisation:
                self._localisation.forget()
        if self._session is None:
            return
        if keep_pose and self._options.save_map:
            self._keep_map(f"{self._options.save_map}.{self._sessions}")
        try:
            self._end_session()
        except DataError as error:  # a full disk does not stop a robot
            self._say(f"warning: {error}; the odometry goes on, and results of the last session are incomplete")
        if keep_pose:
            self._place.restart(why)
        self._state.restart(why)
        self._say(f"{why}: the odometry starts again, " + ("at the last pose, with an unknown covariance" if keep_pose
                                                           else "at the origin"))

    def _keep_map(self, file: str) -> None:
        """Saves the map of a session that ends unasked, since the next one begins another."""
        try:
            self._session.odometry.save_map(file)
            self._say(f"the map until then is in {file}")
        except Error as error:
            self._say(f"warning: the map until then is lost: {error}")

    def _end_session(self) -> None:
        session, self._session, self._before = self._session, None, [None, None]
        if session:
            session.close()

    def _rig(self, maximum: int):
        """The rig from --calibration or camera_info. Raises DataError."""
        if self._options.calibration:
            return given_rig(self._options.calibration, maximum)
        rectified = self._topics.names_rectified if self._options.rectified is None else self._options.rectified
        return rig_of(tuple(info for _, info in self._infos), [self._topics.left_info, self._topics.right_info],
                      rectified, maximum)

    def _start_session(self, rig, frame: str) -> None:
        options = self._options
        if not self._camera_frame:
            self._camera_frame = frame
            if options.base_from_camera:
                self._place.set_mount(mount_of(options.base_from_camera))
            elif self._frames.pose(options.base_frame, frame) is None:
                self._say(f"/tf_static does not connect {options.base_frame} with the frame '{frame}' of the images: "
                          "the camera counts as the base, looking forward (--base-from-camera states another mount)")
            self._find_mount()
        self._sessions += 1
        output = f"{options.output}_{self._sessions}" if options.output and self._sessions > 1 else options.output
        while self._sessions > 1 and output and not options.force and Path(output).exists():  # of an earlier start
            self._sessions += 1
            output = f"{options.output}_{self._sessions}"
        self._session = Session(rig, options, self._say)
        if output:
            try:
                self._session.begin_files(output, f"domain {self._domain.number}: {self._topics.left}")
            except Error as error:
                self._say(f"warning: {error}; the odometry goes on without results")
        self._say(f"tracking {rig.left.width} x {rig.left.height} px on {self._session.odometry.device.name}")

    # What goes out.

    def _say_once(self, text: str) -> None:
        if text not in self._said:
            self._said.add(text)
            self._say(text)

    def _refuse(self, why) -> None:
        """Leaves a pair out, and says why."""
        self._queue.counts.refused += 1
        self._state.refuse(str(why))
        self._say_once(f"{why}; such images are left out")

    def _track(self, left, right, arrived: float) -> None:
        try:
            images = [grey_image(message, self._image_topic(side)) for side, message in enumerate((left, right))]
            masks = self._masks.take((stamp_ns(left), stamp_ns(right)), images)
            if self._session is None:
                self._start_session(self._rig(numpy.iinfo(images[LEFT].dtype).max), left.header.frame_id)
            result = self._session.odometry.track(stamp_ns(left), *images, *masks)
        except (DataError, TypeError) as error:
            return self._refuse(error)
        doubt = self._doubt(result, images)
        placed = self._place.add(result, bool(doubt))
        if self._localisation:
            self._localise(result, [*images, *masks], placed)
        if placed and not (result.ambiguous_motion and self._options.withhold_ambiguous):
            self._publish(result, placed, left.header.frame_id)
        self._count(result, placed, doubt)
        self._state.take(result, doubt, (time.monotonic() - arrived) * 1e3)
        try:
            self._session.keep(result)
        except DataError as error:  # a full disk does not stop a robot
            self._session.end_files()
            self._say(f"warning: {error}; the odometry goes on, and its results end here")

    def _localise(self, result, images: list, placed: Placed | None) -> None:
        """Publishes what was found in the map, and gives this pair, its images and masks, for a search."""
        for found in self._localisation.take():
            self._map_from_odom = found.map_from_odom
            self._map_pose.publish(pose_message(found.stamp_ns, self._options.map_frame, found.map_from_base,
                                                found.covariance))
        if placed:
            placed.map_from_odom = self._map_from_odom
            self._localisation.offer(self._session.rig, result, images, placed.pose, self._place.mount)

    def _doubt(self, result, images: list) -> str:
        """Why the motion of a pair is doubtful, although it is tracked; mostly empty."""
        before, self._before = self._before, images
        for side, (one, other) in enumerate(zip(before, images)):
            if one is not None and numpy.array_equal(one, other):
                why = f"the image of {self._image_topic(side)} repeats the one before (does the camera stand still?)"
                self._say_once(f"warning: {why}; twist and covariance of such pairs count as unknown")
                return why
        if self._queue.clock_is_doubtful:
            return "stamps went back a little before this pair"
        return result.message if result.ambiguous_motion else ""

    def _count(self, result, placed: Placed | None, doubt: str) -> None:
        counts = self._queue.counts
        counts.tracked += result.is_tracked
        counts.lost += not result.is_tracked
        counts.ambiguous += result.ambiguous_motion
        if placed:
            unknown = self._place.unknown or (result.message if result.segment else "") or doubt
            self._state.place(result.stamp_ns, "" if placed.covariance is not None else unknown or "it was measured "
                              "from an ambiguous pair")

    def _publish(self, result, placed: Placed, frame: str) -> None:
        options = self._options
        self._odometry.publish(odometry_message(result.stamp_ns, options.odom_frame, options.base_frame, placed.pose,
                                                placed.covariance, placed.twist))
        transforms = [(options.odom_frame, options.base_frame, placed.pose)]
        if placed.map_from_odom is not None:
            transforms.append((options.map_frame, options.odom_frame, placed.map_from_odom))
        if self._tf:
            self._tf.publish(transforms_message(result.stamp_ns, transforms))
        if self._edges:
            self._edges.publish(cloud_message(result.stamp_ns, frame, self._session.odometry.edges().xyz))

    def _publish_state(self) -> None:
        """Looks for what is silent or doubled, and publishes the state of the last second."""
        values = self._queue.counts.by_name() | self._masks.values()
        values |= self._localisation.values() if self._localisation else {}
        problems, faults = self._watch.problems(), self._watch.faults(self._name(_ODOMETRY)) + self._masks.faults()
        now_ns = self._clock_ns if self._clock else time.time_ns()
        self._diagnostics.publish(self._state.message(now_ns, problems, faults, values))
        self._second = time.monotonic()
