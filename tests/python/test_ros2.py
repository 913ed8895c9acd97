"""Topics of ROS 2 on the wire, with Cyclone DDS on both sides and with Fast DDS on the other."""

import itertools
import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed: quadedge.ros2 cannot be tested")
pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.ros2 cannot be tested")

import quadedge  # noqa: E402
from quadedge.bag import write_tum  # noqa: E402
from quadedge.result_files import rotations  # noqa: E402
from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.idl import types as idl_types  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from quadedge.ros2.domain import BASES, dds_type_name, taken  # noqa: E402
from quadedge.ros2.mount import StaticFrames, levelled, mount_of  # noqa: E402
from quadedge.ros2.pairs import LEFT, RIGHT, PairQueue  # noqa: E402
from quadedge.ros2.place import Place  # noqa: E402
from quadedge.ros2.service import trigger_type  # noqa: E402
from quadedge.ros2.state import learned  # noqa: E402
from quadedge.estimates import Estimates, of_base, twist_between  # noqa: E402
from quadedge.ros_messages import (BODY_FROM_OPTICAL, UNKNOWN, diagnostics_message, message_store,  # noqa: E402
                                   quaternion, stamp_ns, transforms_message)
from robot import OUT, Robot, image_message  # noqa: E402
from ros_definitions import FOLDER, TRIGGER, fields, idl, with_parts  # noqa: E402

SECOND = 1_000_000_000
FULL = "a folder with results"
KINDS = [*OUT.values(), "geometry_msgs/msg/PoseWithCovarianceStamped", "sensor_msgs/msg/Image",
         "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo", "std_msgs/msg/Empty"]
needs_definitions = pytest.mark.skipif(not (FOLDER / "sensor_msgs").is_dir(),
                                       reason="ros-sensor-msgs and others are not installed: no published definitions")


@pytest.fixture
def robot(room):
    made = Robot(room.rig)
    yield made
    made.close()


def tracked(rig, frames, stamps, **options):
    with quadedge.Odometry(rig, preset="fast", **options) as odometry:
        return [odometry.track(stamp, frame.left, frame.right) for stamp, frame in zip(stamps, frames)]


def pose_of(message):
    """Of an Odometry or a PoseWithCovarianceStamped."""
    position, turn = message.pose.pose.position, message.pose.pose.orientation
    return [position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w]


def expected_pose(result):
    pose, _ = of_base(result.world_from_left, None, BODY_FROM_OPTICAL)
    return [*pose[:3, 3], *quaternion(pose[:3, :3])]


def test_the_flight_at_20_hz_gives_the_poses_of_a_run(flight_folder, tmp_path):
    frames = list(quadedge.open_dataset(flight_folder, last_frame=40))
    files = [flight_folder / "mav0" / camera / "sensor.yaml" for camera in ("cam0", "cam1")]
    robot = Robot()
    try:
        robot.start(tmp_path, "--calibration", f"{files[0]},{files[1]}", "-o", tmp_path / "out")
        robot.said("left /stereo/left/image_raw, right /stereo/right/image_raw")
        robot.play(frames[:1], frames[0].stamp_ns)
        start = time.monotonic()
        for number, frame in enumerate(frames[1:]):
            robot.listen(start + number / 20 - time.monotonic())
            robot.send(frame.stamp_ns, frame.left, frame.right)
        robot.listen(2)
        assert robot.end() < 5
    finally:
        robot.close()
    poses = robot.poses()
    pairs = [frame for frame in frames if frame.stamp_ns in poses]
    assert len(pairs) >= 5  # a busy machine drops pairs; what is tracked is then compared on the same pairs
    results = tracked(quadedge.Rig.from_file(files), pairs, list(poses))
    assert [pose_of(message) for message in poses.values()] == [expected_pose(result) for result in results]
    write_tum(tmp_path / "expected.txt", results)
    assert (tmp_path / "out" / "trajectory.txt").read_bytes() == (tmp_path / "expected.txt").read_bytes()
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["frames_tracked"] == len(pairs) and len(read_rows(tmp_path / "out" / "poses.csv")) == len(pairs)


def read_rows(file: Path) -> list[str]:
    return file.read_text().splitlines()[1:]


def test_everything_that_is_published(robot, room, frames, tmp_path):
    robot.start(tmp_path, "--cloud", "--loops", "--base-from-camera", "0.1,0,0.2,0,0,0")
    robot.said("left /stereo/left/image_raw")
    robot.play(frames, SECOND)
    robot.until(lambda: len(robot.heard["/quadedge/edges"]) >= 6 and len(robot.heard["/diagnostics"]) > 2, "the rest")
    mount = mount_of("0.1,0,0.2,0,0,0")
    results, estimates = tracked(robot.stated_rig, frames, list(robot.poses())), Estimates(mount)
    for message, result in zip(robot.poses().values(), results, strict=True):
        pose, covariance = of_base(result.world_from_left, result.covariance, mount)
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
        assert pose_of(message) == [*pose[:3, 3], *quaternion(pose[:3, :3])]
        numpy.testing.assert_array_equal(message.pose.covariance.reshape(6, 6), covariance)
        twist = estimates.add(result).twist
        linear = message.twist.twist.linear
        assert [linear.x, linear.y, linear.z] == (list(twist[0][:3]) if twist else [0, 0, 0])
    assert numpy.array_equal(message.twist.covariance.reshape(6, 6), twist[1])
    transforms = [(one.header.frame_id, one.child_frame_id) for message in robot.heard["/tf"]
                  for one in message.transforms]
    assert transforms == [("odom", "base_link"), ("map", "odom")] * 6
    cloud = robot.heard["/quadedge/edges"][-1]
    assert cloud.header.frame_id == "optical" and cloud.width > 300 and len(cloud.data) == 12 * cloud.width
    points = cloud.data.view("<f4").reshape(-1, 3)
    assert numpy.isfinite(points).all() and (points[:, 2] > 0).all()
    robot.until(lambda: any(message.status[0].level == 0 and message.status[0].message == "tracked"
                            for message in robot.heard["/diagnostics"]), "good diagnostics")
    assert robot.diagnostics()["pairs tracked"] == "6"
    reset = robot.domain.advertise("/quadedge/reset", "std_msgs/msg/Empty")
    robot.listen(1)
    reset.publish(message_store().types["std_msgs/msg/Empty"](0))
    robot.said("reset: the odometry starts again, at the origin")
    stamp = robot.play(frames[:1], 2 * SECOND) - 50_000_000
    assert pose_of(robot.poses()[stamp])[:3] == [0, 0, 0] and robot.poses()[stamp].pose.covariance[0] < 1


def test_frames_of_tf_static_and_other_names(robot, frames, tmp_path):
    static = robot.domain.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
    up, optical = mount_of("0,0,1,0,0,0") @ numpy.linalg.inv(BODY_FROM_OPTICAL), BODY_FROM_OPTICAL
    static.publish(transforms_message(1, [("base_link", "mast", up), ("mast", "optical", optical)]))
    odometry = robot.domain.subscribe("/odom", "nav_msgs/msg/Odometry", reliable=True)
    robot.start(tmp_path, "--remap", "/quadedge/odometry:=/odom", "--no-tf")
    robot.said("left /stereo/left/image_raw")
    stamps = itertools.count(SECOND, SECOND)

    def published() -> list:
        robot.send(next(stamps), frames[0].left, frames[0].right)
        robot.listen(0.5)
        return odometry.take()

    robot.until(published, "odometry")
    robot.said("the camera's mount is that of /tf_static: optical in base_link")
    assert not robot.heard["/tf"] and not robot.poses()


# Motions that are doubtful.


def play_pairs(robot, pairs, first_stamp: int) -> list[int]:
    """Sends pairs at 20 Hz of their stamps and waits until each is counted. Returns the stamps."""
    stamps = [first_stamp + number * 50_000_000 for number in range(len(pairs))]
    for number, (stamp, pair) in enumerate(zip(stamps, pairs)):
        def is_counted() -> bool:
            robot.send(stamp, *pair)
            robot.listen(0.5)
            values = robot.diagnostics() if robot.heard["/diagnostics"] else {}
            return int(values.get("pairs tracked", 0)) + int(values.get("pairs lost", 0)) > number

        robot.until(is_counted, f"pair {number}")
    return stamps


@pytest.mark.parametrize("withheld", [False, True])
def test_pairs_with_an_ambiguous_motion(withheld, boarded, tmp_path):
    room, pairs = boarded
    robot = Robot(room.rig)
    try:
        robot.start(tmp_path, "--cloud", *["--withhold-ambiguous"] * withheld)
        robot.said("left /stereo/left/image_raw")
        stamps = play_pairs(robot, pairs, SECOND)
        with quadedge.Odometry(robot.stated_rig, preset="fast") as odometry:
            results = [odometry.track(stamp, *pair) for stamp, pair in zip(stamps, pairs)]
        flagged = {result.stamp_ns for result in results if result.ambiguous_motion}
        assert len(flagged) >= 2 and all(result.is_tracked for result in results)
        bases = {result.stamp_ns: result.diagnostics.base_frame for result in results}
        measured_from_flagged = {stamp for stamp, base in bases.items() if base >= 0 and stamps[base] in flagged}
        messages = robot.poses()
        assert set(messages) == set(stamps) - (flagged if withheld else set())
        for stamp, message in messages.items():
            is_unknown = [numpy.array_equal(part.covariance.reshape(6, 6), UNKNOWN)
                          for part in (message.pose, message.twist)]
            if stamp in flagged:
                assert is_unknown == [True, True]
            elif stamp < min(flagged):
                assert not is_unknown[0]
        # Of the frame that is measured from a doubtful one the motion is known, the place is not.
        assert measured_from_flagged and all(
            stamp not in messages or numpy.array_equal(messages[stamp].pose.covariance.reshape(6, 6), UNKNOWN)
            for stamp in measured_from_flagged)
        assert [stamp_ns(one) for message in robot.heard["/tf"] for one in message.transforms] == list(messages)
        said = [message.status[0] for message in robot.heard["/diagnostics"]]
        warned = [status for status in said if status.message.startswith("ambiguous motion: ")]
        assert warned and {status.level for status in warned} == {1}
        assert robot.diagnostics()["pairs tracked, ambiguous"] == str(len(flagged))
        assert "warning: frame" in robot.words and "ambiguous motion: " in robot.words
    finally:
        robot.close()


def test_a_camera_that_is_frozen(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamps = play_pairs(robot, [(one.left, one.right) for one in (*frames[:2], *[frames[1]] * 4)], SECOND)
    for part in (robot.poses()[stamps[-1]].pose, robot.poses()[stamps[-1]].twist):
        assert numpy.array_equal(part.covariance.reshape(6, 6), UNKNOWN)
    assert not numpy.array_equal(robot.poses()[stamps[1]].pose.covariance.reshape(6, 6), UNKNOWN)
    robot.said("warning: the image of /stereo/left/image_raw repeats the one before")
    assert any(message.status[0].level == 1 and "repeats the one before" in message.status[0].message
               for message in robot.heard["/diagnostics"])


def test_pairs_that_are_lost_are_not_counted_as_tracked(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    black = numpy.zeros_like(frames[0].left)
    play_pairs(robot, [(frames[0].left, frames[0].right), (black, black)], SECOND)
    robot.until(lambda: robot.diagnostics()["pairs lost"] == "1", "a lost pair")
    values = robot.diagnostics()
    assert values["pairs tracked"] == "1" and values["status"].startswith("lost_") and values["level"] == 2
    robot.play(frames[:2], 2 * SECOND)
    robot.until(lambda: robot.diagnostics()["level"] == 0, "an end of the warning", 30)  # it does not last to the end


# Maps, services and other clocks.


class Client:
    """Calls a service of std_srvs/srv/Trigger as rmw_cyclonedds_cpp does: a header says whose request it is."""

    def __init__(self, robot, name: str):
        participant, self._robot, self._number = robot.domain.participant, robot, 0
        qualities = Qos(Policy.Reliability.Reliable(max_blocking_time=0), Policy.History.KeepLast(10),
                        Policy.DataRepresentation(use_cdrv0_representation=True))
        self._requests = DataWriter(participant, Topic(participant, f"rq{name}Request", trigger_type("Request")),
                                    qualities)
        self._replies = DataReader(participant, Topic(participant, f"rr{name}Reply", trigger_type("Response")),
                                   qualities)

    def call(self) -> tuple[bool, str]:
        self._number += 1
        asked = struct.pack("<Qq", 0x0123456789ABCDEF, self._number)
        self._robot.until(lambda: self._requests.get_matched_subscriptions() and
                          self._replies.get_matched_publications(), "the service")
        self._requests.write(trigger_type("Request")(b"\0\1\0\0" + asked + b"\0"))
        replies: list = []
        self._robot.until(lambda: replies.extend(taken(self._replies)) or replies, "a reply")
        data = replies[0].data[4:]
        success, length = struct.unpack_from("<?xxxI", data, 16)
        assert data[:16] == asked and data[24 + length - 1:24 + length] == b"\0"
        return success, data[24:24 + length - 1].decode()


def test_services_save_a_map_and_another_run_finds_its_place_in_it(room, frames, tmp_path):
    map_file, robot = tmp_path / "places.map", Robot(room.rig)
    try:
        robot.start(tmp_path, "--loops", "--save-map", map_file)
        robot.said("left /stereo/left/image_raw")
        save = Client(robot, "/quadedge/save_map")
        assert save.call() == (False, "found no tracked pair, expected images first")
        robot.play(frames, SECOND)
        assert save.call() == (True, f"the map is in {map_file}") and map_file.is_file()
        assert Client(robot, "/quadedge/load_map").call()[0] is False
        assert Client(robot, "/quadedge/reset").call() == (True, "the odometry starts again at the origin")
        stamp = robot.play(frames[2:3], 10 * SECOND) - 50_000_000
        assert pose_of(robot.poses()[stamp])[:3] == [0, 0, 0]
    finally:
        robot.close()
    expected = tracked(room.rig, frames, range(1, 7))
    robot = Robot(room.rig)
    try:
        robot.start(tmp_path, "--map", map_file)
        robot.said("left /stereo/left/image_raw")
        located = robot.domain.subscribe("/quadedge/map_pose", "geometry_msgs/msg/PoseWithCovarianceStamped",
                                         reliable=True, depth=100)
        stamps, found, sent = itertools.count(SECOND, 50_000_000), [], {}

        def is_located() -> bool:  # forward and back, from the fourth frame on
            stamp = next(stamps)
            sent[stamp] = (3, 4, 5, 4)[len(sent) % 4]
            robot.send(stamp, frames[sent[stamp]].left, frames[sent[stamp]].right)
            robot.listen(0.2)
            found.extend(located.take())
            return len(found) >= 2 and any(len(message.transforms) == 2 for message in robot.heard["/tf"])

        robot.until(is_located, "a place in the map", 300)
        for message in found:
            assert message.header.frame_id == "map" and message.pose.covariance[0] < 1e-2
            pose, _ = of_base(expected[sent[stamp_ns(message)]].world_from_left, None, BODY_FROM_OPTICAL)
            numpy.testing.assert_allclose(pose_of(message)[:3], pose[:3, 3], atol=0.01)
        both = next(message.transforms for message in robot.heard["/tf"] if len(message.transforms) == 2)
        assert [(one.header.frame_id, one.child_frame_id) for one in both] == [("odom", "base_link"), ("map", "odom")]
        to_base, to_odom = map(pose_of_transform, both)
        pose, _ = of_base(expected[sent[stamp_ns(both[0])]].world_from_left, None, BODY_FROM_OPTICAL)
        numpy.testing.assert_allclose((to_odom @ to_base)[:3, 3], pose[:3, 3], atol=0.02)
        assert Client(robot, "/quadedge/load_map").call()[0] is True
        robot.until(lambda: int(robot.diagnostics()["pairs located"]) >= 2, "diagnostics")
    finally:
        robot.close()


def test_the_time_of_a_simulation(robot, frames, tmp_path):
    clock = robot.domain.advertise("/clock", "rosgraph_msgs/msg/Clock")
    robot.start(tmp_path, "--use-sim-time")
    robot.said("left /stereo/left/image_raw")
    types = message_store().types

    def is_stamped() -> bool:
        clock.publish(types["rosgraph_msgs/msg/Clock"](types["builtin_interfaces/msg/Time"](77, 5)))
        robot.listen(0.2)
        return any(stamp_ns(message) == 77 * SECOND + 5 for message in robot.heard["/diagnostics"])

    robot.until(is_stamped, "the time of the simulation")


# Falling behind, and cameras that change.


def test_a_stopped_program_goes_on_with_the_newest_pair(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp = robot.play(frames, SECOND)
    robot.process.send_signal(signal.SIGSTOP)
    for number in range(20):
        robot.send(stamp + number * 50_000_000, frames[number % 6].left, frames[number % 6].right)
        robot.listen(0.05)
    robot.process.send_signal(signal.SIGCONT)
    robot.listen(2)
    assert sum(found >= stamp for found in robot.poses()) <= 10  # no queue is worked off
    robot.play(frames[:2], stamp + 2 * SECOND)


def test_a_camera_that_stops_is_named(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp, before = robot.play(frames[:3], SECOND), len(robot.words)
    for number in range(40):
        robot.send(stamp + number * 100_000_000, frames[0].left, frames[0].right, sides=(0,))
        robot.listen(0.1)
    robot.until(lambda: "warning: no image of /stereo/right/image_raw for" in robot.words[before:], "a warning")
    assert "no image of /stereo/left" not in robot.words[before:]
    robot.until(lambda: "right" in robot.diagnostics()["message"], "diagnostics")
    assert robot.diagnostics()["level"] == 2 and int(robot.diagnostics()["left images alone"]) >= 20
    robot.play(frames[:1], stamp + 10 * SECOND)
    robot.said("images of /stereo/right/image_raw come again")


def test_stamps_that_go_back_start_again_where_it_was(robot, frames, tmp_path):
    robot.start(tmp_path, "-o", tmp_path / "out")
    robot.said("left /stereo/left/image_raw")
    last = robot.play(frames, 100 * SECOND) - 50_000_000
    robot.play(frames[5:], SECOND)
    robot.said("the stamps of /stereo/left/image_raw went back by 99.250 s")
    before, after = robot.poses()[last], robot.poses()[SECOND]
    numpy.testing.assert_allclose(pose_of(after), pose_of(before), atol=1e-12)
    assert before.pose.covariance[0] < 1 and numpy.array_equal(after.pose.covariance.reshape(6, 6), UNKNOWN)
    robot.end()
    assert len(read_rows(tmp_path / "out" / "frames.csv")) == 6
    assert len(read_rows(tmp_path / "out_2" / "frames.csv")) == 1


def test_a_restart_is_in_diagnostics_and_moves_no_map(robot, frames, tmp_path):
    robot.start(tmp_path, "--loops")
    robot.said("left /stereo/left/image_raw")
    robot.play(frames, 100 * SECOND)
    robot.play(frames[5:], SECOND)
    place = "not measured since 1.000 s: the stamps"
    robot.until(lambda: robot.diagnostics()["place in odom"].startswith(place), "diagnostics")
    values = robot.diagnostics()
    assert values["restarts"] == "1"
    assert "went back by 99.250 s" in values["last restart"] and values["level"] in (1, 2)  # 2: it has become silent
    poses = {}
    for message in robot.heard["/tf"]:
        to_base, to_odom = [pose_of_transform(one) for one in message.transforms]
        poses[stamp_ns(message.transforms[0])] = to_odom @ to_base
    assert numpy.linalg.norm(poses[SECOND][:3, 3]) > 0.01
    numpy.testing.assert_allclose(poses[SECOND], poses[100 * SECOND + 250_000_000], atol=1e-9)


def pose_of_transform(message) -> numpy.ndarray:
    shift, turn = message.transform.translation, message.transform.rotation
    pose = numpy.eye(4)
    pose[:3, :3] = rotations(numpy.array([[turn.x, turn.y, turn.z, turn.w]]))[0]
    pose[:3, 3] = shift.x, shift.y, shift.z
    return pose


def test_stamps_that_go_back_a_little(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp = robot.play(frames, 10 * SECOND)
    for number in range(6):
        robot.send(stamp - 300_000_000 + number * 50_000_000, frames[5].left, frames[5].right)
        robot.listen(0.3)
    robot.said("the stamps of /stereo/left/image_raw went back by 0.250 s")


def test_a_mount_that_comes_late(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp = robot.play(frames[:3], SECOND)
    robot.said("/tf_static does not connect base_link with the frame 'optical'")
    static = robot.domain.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
    mount = mount_of("0.13,0,0,0,0,1.5707963267948966")  # it looks to the left
    static.publish(transforms_message(1, [("base_link", "optical", mount)]))
    robot.said("/tf_static connects base_link with optical only now")
    robot.play(frames[3:], stamp)
    messages = list(robot.poses().values())
    results = tracked(robot.stated_rig, frames, list(robot.poses()))
    assert pose_of(messages[2]) == expected_pose(results[2])
    at = {name: of_base(results[i].world_from_left, None, mount)[0] for i, name in ((2, "then"), (5, "now"))}
    before, _ = of_base(results[2].world_from_left, None, BODY_FROM_OPTICAL)
    expected = before @ numpy.linalg.inv(at["then"]) @ at["now"]
    numpy.testing.assert_allclose(pose_of(messages[5])[:3], expected[:3, 3], atol=1e-9)
    assert numpy.array_equal(messages[5].pose.covariance.reshape(6, 6), UNKNOWN)
    del static


@pytest.mark.parametrize("apart_ns, words", [(20_000_000, "20.000 ms apart, more than the --tolerance of 5 ms"),
                                             (None, "0")])
def test_images_that_form_no_pairs(apart_ns, words, robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp = robot.play(frames[:2], SECOND)

    def is_said() -> bool:
        nonlocal stamp
        stamp += 100_000_000
        for side in (0, 1):
            given = 0 if apart_ns is None else stamp + side * apart_ns
            robot.send(given, frames[0].left, frames[0].right, sides=(side,))
        robot.listen(0.1)
        both = "images of /stereo/left/image_raw and /stereo/right/image_raw come"
        return f"{both}, but form no pairs: their stamps are {words}" in robot.words

    robot.until(is_said, words)
    robot.until(lambda: "form no pairs" in robot.diagnostics()["message"], "diagnostics")
    assert robot.diagnostics()["level"] == 2
    robot.play(frames[:1], stamp + SECOND)
    robot.said("form pairs\n")


def test_camera_info_that_changes_starts_again(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp = robot.play(frames[:3], SECOND)
    camera = robot.rig.left
    wider = [quadedge.PinholeCamera(camera.fx * 1.25, camera.fy * 1.25, camera.cx, camera.cy, 320, 200)] * 2
    robot.rig = quadedge.Rig(*wider, robot.rig.right_from_left)
    robot.play(frames[3:5], stamp)
    robot.said("camera_info of the left camera has changed: the odometry starts again")


# Bad input.


def test_images_that_cannot_be_used_are_named_and_left_out(robot, frames, tmp_path):
    robot.start(tmp_path)
    robot.said("left /stereo/left/image_raw")
    stamp, one = SECOND, frames[0]
    for encoding, left, text in (("jxl8", one.left, "found the encoding 'jxl8', expected one of mono8"),
                                 ("mono8", one.left[:100], "left image has 320x100 pixels")):
        for _ in range(40):
            robot.send(stamp, left, left if encoding == "mono8" else one.right, encoding)
            stamp += 50_000_000
            robot.listen(0.05)
            if text in robot.words:
                break
        assert text in robot.words and "such images are left out" in robot.words
    robot.until(lambda: robot.heard["/diagnostics"] and robot.diagnostics()["level"] == 2, "diagnostics", 10)
    robot.play(frames[:2], stamp + SECOND)
    assert int(robot.diagnostics()["pairs refused"]) >= 1


def test_two_publishers_on_one_topic(robot, frames, tmp_path):
    second = robot.domain.advertise("/stereo/right/image_raw", "sensor_msgs/msg/Image")
    robot.start(tmp_path)
    robot.said("warning: 2 publishers on /stereo/right/image_raw, expected one")
    del second


def test_two_programs_that_publish_the_same_odometry(robot, frames, tmp_path):
    other = robot.domain.advertise("/quadedge/odometry", "nav_msgs/msg/Odometry")
    robot.start(tmp_path)
    robot.said("warning: another program publishes /quadedge/odometry, too")
    robot.until(lambda: any("another program" in message.status[0].message for message in robot.heard["/diagnostics"]),
                "a warning")
    del other


def test_an_empty_domain_and_one_without_cameras(tmp_path):
    robot = Robot(listens=False)
    try:
        start = time.monotonic()
        robot.start(tmp_path)
        robot.said(f"domain {robot.number}: nobody publishes a topic of ROS 2")
        assert time.monotonic() - start > 5
        assert robot.end() < 5
        alone = robot.domain.advertise("/camera/image_raw", "sensor_msgs/msg/Image")
        robot.start(tmp_path)
        robot.said("found no stereo topics among /camera/image_raw (sensor_msgs/msg/Image)")
        del alone
    finally:
        robot.close()


@pytest.mark.parametrize("options, domain, words", [
    ([], "6", "domain 6: the network cannot be used; expected an interface that is up"),
    (["--remap", "odom"], "5", "--remap: found 'odom', expected two topics"),
    (["--base-from-camera", "1,2"], "5", "--base-from-camera: found '1,2', expected six numbers"),
    (["--device", "quantum"], "5", "quantum"),
    (["--config", "no.toml"], "5", "no.toml"),
    (["--left", "/a", "--right", "/a"], "5", "found /a twice"),
    (["--odom-frame", "base_link"], "5", "found base_link, base_link, map, expected three names"),
    (["--left-mask", "/a", "--right-mask", "/a"], "5", "found /a twice"),
    (["--left", "/a", "--right", "/b", "--right-mask", "/a"], "5", "found /a, the topic of a camera"),
    (["--mask-wait", "-1"], "5", "found -1, expected a finite number"),
    (["--tolerance", "nan"], "5", "found nan, expected a finite number"),
    (["--gravity", "0,0,0"], "5", "--gravity: found '0,0,0', expected three numbers"),
    (["--map", "no.map"], "5", "no.map: found no such file"),
    (["--save-map", "a.map"], "5", "--save-map: found no --loops"),
    (["--output", FULL], "5", "the folder holds results (config.toml)"),
    ([], "five", "ROS_DOMAIN_ID: found 'five', expected a number from 0 to 232"),
    ([], "233", "domain: found 233, expected a number from 0 to 232"),
])  # fmt: skip
def test_wrong_options(options, domain, words, tmp_path):
    (tmp_path / "config.toml").touch()
    options = [tmp_path if one == FULL else one for one in options]
    no_network = "<General><Interfaces><NetworkInterface name='none9'/></Interfaces></General>"
    done = subprocess.run([sys.executable, "-m", "quadedge.ros2", *options], capture_output=True, text=True, timeout=60,
                          env={**os.environ, "ROS_DOMAIN_ID": domain, "CYCLONEDDS_URI": no_network})
    expected = {"quantum": 4, "no.map: found no such file": 3}.get(words, 2)
    assert done.returncode == expected and words in done.stderr, done.stderr
    assert "Traceback" not in done.stderr


# The wire.


@needs_definitions
def test_messages_are_those_that_are_published():
    """The definitions that CDR is read and written with, against those of Debian's packages."""
    nodes = {"": "BASE", "[]": "SEQUENCE"}
    for kind in with_parts(KINDS):
        read = []
        for name, (node, content) in message_store().fielddefs[kind][1]:
            array = {"ARRAY": f"[{content[1]}]", "SEQUENCE": "[]"}.get(node.name, "")
            base = content[0][1] if array else content
            read.append((base[0] if isinstance(base, tuple) else base, name, array))
            assert nodes.get(array, "ARRAY") == node.name or (array == "" and node.name == "NAME")
        assert read == fields(kind), kind
    assert dds_type_name("sensor_msgs/msg/Image") == "sensor_msgs::msg::dds_::Image_"


def test_diagnostics_match_a_reader_that_declares_the_types_of_rosidl():
    """In IDL a byte of ROS is an octet and a char is a uint8; Cyclone DDS compares the types of both ends."""
    from dataclasses import dataclass

    from cyclonedds.domain import DomainParticipant
    from cyclonedds.idl import IdlStruct, types

    @dataclass
    class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
        sec: types.int32
        nanosec: types.uint32

    @dataclass
    class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
        stamp: Time
        frame_id: str

    @dataclass
    class KeyValue(IdlStruct, typename="diagnostic_msgs.msg.dds_.KeyValue_"):
        key: str
        value: str

    @dataclass
    class Status(IdlStruct, typename="diagnostic_msgs.msg.dds_.DiagnosticStatus_"):
        level: types.byte
        name: str
        message: str
        hardware_id: str
        values: types.sequence[KeyValue]

    @dataclass
    class Diagnostics(IdlStruct, typename="diagnostic_msgs.msg.dds_.DiagnosticArray_"):
        header: Header
        status: types.sequence[Status]

    robot = Robot(listens=False)
    publisher = robot.domain.advertise("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray")
    other = DomainParticipant(robot.number)
    reader = DataReader(other, Topic(other, "rt/diagnostics", Diagnostics))
    end = time.monotonic() + 30
    while not reader.get_matched_publications():
        assert time.monotonic() < end
        time.sleep(0.05)
    publisher.publish(diagnostics_message(SECOND, "name", 2, "text", {"key": 1}))
    while not (messages := taken(reader)):
        assert time.monotonic() < end
        time.sleep(0.05)
    status = messages[0].status[0]
    assert (status.level, status.message, status.values[0].value) == (2, "text", "1")


def test_bases_are_those_of_rosidl():
    names = {"bool": bool, "byte": "byte", "char": "uint8", "string": str,
             **{name: name for name in ("int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
                                        "float32", "float64")}}  # fmt: skip
    assert BASES == {name: getattr(idl_types, kind) if isinstance(kind, str) else kind for name, kind in names.items()}


@pytest.fixture(scope="session")
def fast_dds(tmp_path_factory):
    """The other side with Fast DDS, whose types are generated from the published definitions."""
    if not shutil.which("fastddsgen") or not (FOLDER / "nav_msgs").is_dir():
        pytest.skip("fastddsgen or ros-nav-msgs is not installed: Fast DDS cannot be the other side")
    folder = tmp_path_factory.mktemp("fastdds")
    (folder / "Messages.idl").write_text(idl(KINDS) + TRIGGER)
    subprocess.run(["fastddsgen", "-replace", "Messages.idl"], cwd=folder, check=True, capture_output=True)
    subprocess.run(["c++", "-std=c++17", "-O1", "-w", f"-I{folder}", Path(__file__).parent / "fastdds_side.cpp",
                    "Messages.cxx", "MessagesPubSubTypes.cxx", "-lfastrtps", "-lfastcdr", "-o", "side"],
                   cwd=folder, check=True)  # fmt: skip
    return folder / "side"


def test_with_fast_dds_on_the_other_side(fast_dds, robot, room, frames, tmp_path):
    played = [frames[i] for i in (0, 1, 2, 3, 4, 5, 4, 3, 2, 1) * 4]
    rig, stamps = room.rig, [SECOND + number * 50_000_000 for number in range(len(played))]
    with (tmp_path / "frames").open("wb") as file:
        file.write(struct.pack("<3i4d", rig.left.width, rig.left.height, len(played), rig.left.fx, rig.left.cx,
                               rig.left.cy, rig.baseline))
        for stamp, frame in zip(stamps, played):
            file.write(struct.pack("<q", stamp) + frame.left.tobytes() + frame.right.tobytes())
    alone = Robot(listens=False)
    try:
        alone.start(tmp_path, "--cloud")
        done = subprocess.run([fast_dds, str(alone.number), tmp_path / "frames"], capture_output=True, text=True,
                              timeout=120)
        alone.end()
    finally:
        alone.close()
    lines = [line.split() for line in done.stdout.splitlines()]
    odometry = {int(line[1]): line[2:] for line in lines if line[0] == "odometry"}
    assert len(odometry) >= 10, f"{done.stderr} {alone.words}"
    pairs = [frame for stamp, frame in zip(stamps, played) if stamp in odometry]
    results, estimates = tracked(robot.stated_rig, pairs, list(odometry)), Estimates(BODY_FROM_OPTICAL)
    for words, result in zip(odometry.values(), results, strict=True):
        assert words[:2] == ["odom", "base_link"]
        numbers = [float.fromhex(word) for word in words[2:]]
        _, covariance = of_base(result.world_from_left, result.covariance, BODY_FROM_OPTICAL)
        twist = estimates.add(result).twist
        assert numbers[:7] == expected_pose(result) and numbers[7:43] == list(covariance.reshape(36))
        assert numbers[43] == (twist[0][0] if twist else 0)
    assert [int(line[1]) for line in lines if line[0] == "tf"] == list(odometry)
    assert all(line[3] == "12" and int(line[4]) == 12 * int(line[2]) and line[5] == "z"
               for line in lines if line[0] == "edges")
    # The requests of a client of Fast DDS are carried out and answered, but what it takes for the number of the request
    # is no part of the message, so that Cyclone DDS cannot send it.
    assert [line for line in done.stdout.splitlines() if line.startswith("reply ")] == [
        "reply /quadedge/reset 1 0 1 the odometry starts again at the origin",
        "reply /quadedge/save_map 1 0 0 found no --save-map FILE, expected it with --loops when the program starts",
        "reply /quadedge/load_map 1 0 0 found no --map FILE, expected it when the program starts"]
    assert "reset: the odometry starts again, at the origin" in alone.words and "| restarts = 1 |" in done.stdout
    assert "| status = tracked | reason =  |" in done.stdout and f"| pairs tracked = {len(odometry)} |" in done.stdout


# Parts.


def message_at(stamp: int):
    return image_message(stamp, numpy.zeros((1, 1), numpy.uint8))


def given(queue, *images: tuple[int, int]) -> list:
    """The pairs that a queue gives after each of these (side, stamp in ms)."""
    pairs = []
    for side, ms in images:
        queue.add(side, message_at(ms * 1_000_000))
        if pair := queue.newest():
            pairs.append(tuple(stamp_ns(message) // 1_000_000 for message in pair))
    return pairs


def test_pairs_as_they_arrive():
    queue = PairQueue(5_000_000)
    assert given(queue, (LEFT, 100), (RIGHT, 103), (RIGHT, 150), (LEFT, 149)) == [(100, 103), (149, 150)]
    assert given(queue, (LEFT, 200), (LEFT, 250), (RIGHT, 250)) == [(250, 250)]
    assert queue.counts.alone == [1, 0] and queue.counts.dropped == 1
    assert given(queue, (RIGHT, 250), (RIGHT, 0), (RIGHT, 240)) == []
    assert queue.counts.late == 2 and queue.counts.without_stamp == 1
    for ms in (300, 350, 400):
        for side in (LEFT, RIGHT):
            queue.add(side, message_at(ms * 1_000_000))
    assert stamp_ns(queue.newest()[LEFT]) == 400_000_000 and queue.counts.behind == 2
    for number in range(30):
        queue.add(LEFT, message_at((500 + number) * 1_000_000_000))
    assert queue.counts.alone == [21, 0]  # ten wait


def test_a_clock_that_goes_back_is_noticed_once():
    queue = PairQueue(5_000_000)
    assert given(queue, (LEFT, 90_000), (RIGHT, 90_000), (LEFT, 90_050)) == [(90_000, 90_000)]
    assert queue.add(LEFT, message_at(SECOND)) == 89_050_000_000
    assert queue.add(RIGHT, message_at(SECOND)) == 0
    assert [stamp_ns(message) for message in queue.newest()] == [SECOND, SECOND]


def test_a_clock_that_goes_back_a_little_is_noticed_by_three_late_images():
    queue, times = PairQueue(5_000_000), [1000 + 50 * i for i in range(6)]
    given(queue, *[(side, ms) for ms in times for side in (LEFT, RIGHT)])
    back = [queue.add(side, message_at(ms * 1_000_000)) for ms in (950, 1000, 1050) for side in (LEFT, RIGHT)]
    assert back == [0, 0, 0, 0, 300_000_000, 0]
    assert given(queue, (RIGHT, 1100), (LEFT, 1100)) == [(1050, 1050), (1100, 1100)]


def test_one_late_image_makes_the_next_motion_doubtful():
    queue = PairQueue(5_000_000)
    assert given(queue, (LEFT, 1000), (RIGHT, 1000)) and not queue.clock_is_doubtful
    assert given(queue, (LEFT, 980), (LEFT, 1030), (RIGHT, 1030)) == [(1030, 1030)] and queue.clock_is_doubtful
    assert given(queue, (LEFT, 1030), (LEFT, 1080), (RIGHT, 1080)) and not queue.clock_is_doubtful  # repeated, not late


def test_the_base_away_from_the_camera():
    """The camera is 2 m ahead of the base; it turns left by 90 degrees about the base."""
    mount = mount_of("2,0,0,0,0,0")
    turn = numpy.eye(4)
    turn[:2, :2] = [[0, -1], [1, 0]]
    world_from_left = numpy.linalg.inv(mount) @ turn @ mount
    covariance = numpy.zeros((6, 6))
    covariance[4, 4] = 0.01  # about the camera's y axis, which points down
    pose, of_pose = of_base(world_from_left, covariance, mount)
    numpy.testing.assert_allclose(pose, turn, atol=1e-12)
    expected = numpy.zeros((6, 6))
    expected[5, 5] = 0.01
    expected[0, 0], expected[0, 5], expected[5, 0] = 0.04, 0.02, 0.02  # the base is 2 m behind, at -y of the camera
    numpy.testing.assert_allclose(of_pose, expected, atol=1e-12)
    numpy.testing.assert_allclose(mount_of("0,0,0,0,0,1.5707963267948966")[:3, :3] @ [0, 0, 1], [0, 1, 0], atol=1e-12)


def test_what_a_rig_has_learned_is_told_as_an_error_of_the_depth():
    """0.05 px less than true of the 5 px of a point at 10 m make it appear at 10.1 m."""
    rig = SimpleNamespace(left=SimpleNamespace(fx=500.0), baseline=0.1)
    words = learned(SimpleNamespace(disparity_offset=0.05, disparity_offset_sigma=0.01), rig)
    assert words == {"disparity offset [px]": "+0.050 +- 0.010",
                     "depth error as calibrated at 1, 2, 5, 10 m [%]": "+0.1, +0.2, +0.5, +1.0"}


def test_gravity_levels_odom():
    for gravity in ("0,0,-9.8", "3,-2,-9", "9.8,0,0", "0,0,1"):
        pose, fall = levelled(gravity), numpy.array([float(part) for part in gravity.split(",")])
        numpy.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, numpy.eye(3), atol=1e-12)
        numpy.testing.assert_allclose(pose[:3, :3] @ fall / numpy.linalg.norm(fall), [0, 0, -1], atol=1e-12)
    place = Place(levelled("9.8,0,-9.8"))  # the base looks down by 45 degrees
    pose, half = numpy.eye(4), numpy.sqrt(0.5)
    place.add(result_at(1.0, pose), False)
    pose[2, 3] = 1  # a metre along the view
    placed = place.add(result_at(1.1, pose), False)
    numpy.testing.assert_allclose(placed.pose[:3, 3], [half, 0, -half], atol=1e-12)
    numpy.testing.assert_allclose(placed.covariance, numpy.eye(6) * 1e-4, atol=1e-12)


def result_at(seconds: float, pose: numpy.ndarray, **more):
    details = SimpleNamespace(covariance_in_reference=numpy.diag([1.0, 1, 1, 2, 2, 2]) * 1e-4,
                              base_frame=more.pop("base_frame", 0))
    return SimpleNamespace(**{"stamp_ns": round(seconds * 1e9), "is_tracked": True, "segment": 0, "new_key_rig": False,
                              "map_from_odometry": None, "ambiguous_motion": False, "covariance": numpy.eye(6) * 1e-4,
                              "reference_frame": 0, "world_from_left": pose, "current_from_reference": numpy.eye(4),
                              "diagnostics": details, **more})


def test_the_twist_is_that_of_a_circle():
    """Half a turn per second to the left on a circle of 1 m: forward at pi m/s."""
    def at(angle):
        pose = numpy.eye(4)
        pose[:2, :2] = [[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]]
        pose[:2, 3] = numpy.sin(angle), 1 - numpy.cos(angle)
        return numpy.linalg.inv(BODY_FROM_OPTICAL) @ pose @ BODY_FROM_OPTICAL

    before, now = result_at(1.0, at(0.3)), result_at(1.1, at(0.3 + numpy.pi / 10))
    twist, covariance = twist_between(before, now, BODY_FROM_OPTICAL)
    numpy.testing.assert_allclose(twist, [numpy.pi, 0, 0, 0, 0, numpy.pi], atol=1e-9)
    numpy.testing.assert_allclose(numpy.diag(covariance), numpy.array([1, 1, 1, 2, 2, 2]) * 2e-2, rtol=1e-9)
    key = result_at(1.0, at(0.3), new_key_rig=True, reference_frame=7)
    assert twist_between(key, now, BODY_FROM_OPTICAL)[1][0, 0] == pytest.approx(1e-2)
    for other in (None, result_at(1.0, at(0.3), segment=1), result_at(1.0, at(0.3), reference_frame=7),
                  result_at(1.0, at(0.3), is_tracked=False)):
        assert twist_between(other, now, BODY_FROM_OPTICAL) is None


def test_the_twist_after_a_gap_states_what_an_acceleration_leaves():
    """Forward with 1 m/s, then braking by 1 m/s^2: the mean of 0.6 s is 0.3 m/s above the velocity at their end."""
    def at(seconds: float):
        pose, t = numpy.eye(4), max(seconds - 2, 0)
        pose[2, 3] = seconds - t**2 / 2
        return result_at(seconds, pose)

    estimates = Estimates(BODY_FROM_OPTICAL)
    for number in range(41):
        twist, covariance = estimates.add(at(number / 20)).twist or (None, None)
    assert twist[0] == pytest.approx(1) and covariance[0, 0] == pytest.approx(0.08, rel=2e-3)
    twist, covariance = estimates.add(at(2.6)).twist
    deviation = numpy.sqrt(covariance[0, 0])
    assert twist[0] - 0.4 == pytest.approx(0.3) and 0.1 < deviation < 0.6


def test_what_is_measured_from_an_ambiguous_frame_is_not_known():
    def add(**more):
        seconds = next(times)
        found = estimates.add(result_at(seconds, numpy.eye(4), **more))
        return found and (found.covariance is not None, found.twist is not None)

    estimates, times = Estimates(BODY_FROM_OPTICAL), itertools.count(1)
    assert add(new_key_rig=True) == (True, False)  # frame 0
    assert add() == (True, True)
    assert add(ambiguous_motion=True) == (False, False)
    assert add() == (True, False)  # measured from frame 0, not from the ambiguous one
    assert add() == (True, True)
    assert add(ambiguous_motion=True, new_key_rig=True) == (False, False)  # frame 5
    assert add(reference_frame=5, base_frame=5) == (False, True)
    assert add(is_tracked=False) is None
    assert add(reference_frame=5, base_frame=6, new_key_rig=True) == (False, False)  # frame 8
    assert add(reference_frame=8, base_frame=8) == (False, True)
    assert add() == (True, False)  # measured from frame 0 again
    assert add(segment=1) == (False, False)


def test_a_twist_from_a_doubtful_frame_is_not_known():
    """A driver repeats an image: the next motion is that of two intervals."""
    def has_twist(doubt=False, **more):
        return estimates.add(result_at(next(times), numpy.eye(4), **more), doubt).twist is not None

    estimates, times = Estimates(BODY_FROM_OPTICAL), itertools.count(1)
    assert not has_twist(new_key_rig=True) and has_twist()
    assert not has_twist(doubt=True) and not has_twist() and has_twist()
    # Measured from an ambiguous frame itself, as the keyframe is out of view: where that frame is does not matter.
    assert not has_twist(ambiguous_motion=True) and has_twist(base_frame=5, new_key_rig=True)


def test_static_frames_are_followed_through_a_common_one():
    frames, step = StaticFrames(), numpy.eye(4)
    step[:3, 3] = 1, 2, 3
    frames.add(transforms_message(1, [("body", "base_link", step), ("body", "mast", step), ("mast", "eye", step)]))
    numpy.testing.assert_allclose(frames.pose("base_link", "eye"), step)
    assert frames.pose("base_link", "elsewhere") is None
