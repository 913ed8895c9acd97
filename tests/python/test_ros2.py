"""Topics of ROS 2 on the wire, with Cyclone DDS on both sides and with Fast DDS on the other."""

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
from quadedge.ros2.domain import dds_type_name  # noqa: E402
from quadedge.ros2.mount import StaticFrames, mount_of  # noqa: E402
from quadedge.ros2.pairs import LEFT, RIGHT, PairQueue  # noqa: E402
from quadedge.ros_messages import (BODY_FROM_OPTICAL, UNKNOWN, message_store, of_base, quaternion,  # noqa: E402
                                   stamp_ns, transforms_message, twist_between)
from robot import OUT, Robot, image_message  # noqa: E402
from ros_definitions import FOLDER, fields, idl, with_parts  # noqa: E402

SECOND = 1_000_000_000
KINDS = [*OUT.values(), "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo",
         "std_msgs/msg/Empty"]
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
    results = tracked(robot.stated_rig, frames, list(robot.poses()))
    before = None
    for message, result in zip(robot.poses().values(), results, strict=True):
        pose, covariance = of_base(result.world_from_left, result.covariance, mount)
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
        assert pose_of(message) == [*pose[:3, 3], *quaternion(pose[:3, :3])]
        numpy.testing.assert_array_equal(message.pose.covariance.reshape(6, 6), covariance)
        twist = twist_between(before, result, mount)
        linear = message.twist.twist.linear
        assert [linear.x, linear.y, linear.z] == (list(twist[0][:3]) if twist else [0, 0, 0])
        before = result
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
    assert pose_of(robot.poses()[stamp])[:3] == [0, 0, 0]


def test_frames_of_tf_static_and_other_names(robot, frames, tmp_path):
    static = robot.domain.advertise("/tf_static", "tf2_msgs/msg/TFMessage", latched=True)
    up, optical = mount_of("0,0,1,0,0,0") @ numpy.linalg.inv(BODY_FROM_OPTICAL), BODY_FROM_OPTICAL
    static.publish(transforms_message(1, [("base_link", "mast", up), ("mast", "optical", optical)]))
    odometry = robot.domain.subscribe("/odom", "nav_msgs/msg/Odometry", reliable=True)
    robot.start(tmp_path, "--remap", "/quadedge/odometry:=/odom", "--no-tf")
    robot.said("left /stereo/left/image_raw")
    for number, frame in enumerate(frames):
        robot.send(SECOND * (number + 1), frame.left, frame.right)
        robot.listen(0.5)
    robot.said("the camera's mount is that of /tf_static: optical in base_link")
    robot.until(odometry.take, "odometry")
    assert not robot.heard["/tf"] and not robot.poses()


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
    ([], "five", "ROS_DOMAIN_ID: found 'five', expected a number from 0 to 232"),
    ([], "233", "domain: found 233, expected a number from 0 to 232"),
])  # fmt: skip
def test_wrong_options(options, domain, words):
    no_network = "<General><Interfaces><NetworkInterface name='none9'/></Interfaces></General>"
    done = subprocess.run([sys.executable, "-m", "quadedge.ros2", *options], capture_output=True, text=True, timeout=60,
                          env={**os.environ, "ROS_DOMAIN_ID": domain, "CYCLONEDDS_URI": no_network})
    assert done.returncode == 2 and words in done.stderr


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


@pytest.fixture(scope="session")
def fast_dds(tmp_path_factory):
    """The other side with Fast DDS, whose types are generated from the published definitions."""
    if not shutil.which("fastddsgen") or not (FOLDER / "nav_msgs").is_dir():
        pytest.skip("fastddsgen or ros-nav-msgs is not installed: Fast DDS cannot be the other side")
    folder = tmp_path_factory.mktemp("fastdds")
    (folder / "Messages.idl").write_text(idl(KINDS))
    subprocess.run(["fastddsgen", "-replace", "Messages.idl"], cwd=folder, check=True, capture_output=True)
    subprocess.run(["c++", "-std=c++17", "-O1", "-w", f"-I{folder}", Path(__file__).parent / "fastdds_side.cpp",
                    "Messages.cxx", "MessagesPubSubTypes.cxx", "-lfastrtps", "-lfastcdr", "-o", "side"],
                   cwd=folder, check=True)  # fmt: skip
    return folder / "side"


def test_with_fast_dds_on_the_other_side(fast_dds, robot, room, frames, tmp_path):
    played = [frames[i] for i in (0, 1, 2, 3, 4, 5, 4, 3, 2, 1, 0) * 4]
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
    results, before = tracked(robot.stated_rig, pairs, list(odometry)), None
    for words, result in zip(odometry.values(), results, strict=True):
        assert words[:2] == ["odom", "base_link"]
        numbers = [float.fromhex(word) for word in words[2:]]
        _, covariance = of_base(result.world_from_left, result.covariance, BODY_FROM_OPTICAL)
        twist = twist_between(before, result, BODY_FROM_OPTICAL)
        assert numbers[:7] == expected_pose(result) and numbers[7:43] == list(covariance.reshape(36))
        assert numbers[43] == (twist[0][0] if twist else 0)
        before = result
    assert [int(line[1]) for line in lines if line[0] == "tf"] == list(odometry)
    assert all(line[3] == "12" and int(line[4]) == 12 * int(line[2]) and line[5] == "z"
               for line in lines if line[0] == "edges")
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


def result_at(seconds: float, pose: numpy.ndarray, **more):
    details = SimpleNamespace(covariance_in_reference=numpy.diag([1.0, 1, 1, 2, 2, 2]) * 1e-4)
    return SimpleNamespace(**{"stamp_ns": round(seconds * 1e9), "is_tracked": True, "segment": 0, "new_key_rig": False,
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


def test_static_frames_are_followed_through_a_common_one():
    frames, step = StaticFrames(), numpy.eye(4)
    step[:3, 3] = 1, 2, 3
    frames.add(transforms_message(1, [("body", "base_link", step), ("body", "mast", step), ("mast", "eye", step)]))
    numpy.testing.assert_allclose(frames.pose("base_link", "eye"), step)
    assert frames.pose("base_link", "elsewhere") is None
