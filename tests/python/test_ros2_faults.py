"""Doubtful motions, cameras and clocks that change, bad input and wrong options of quadedge.ros2."""

import itertools
import os
import signal
import subprocess
import sys
import time

import numpy
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed: quadedge.ros2 cannot be tested")
pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.ros2 cannot be tested")

import quadedge  # noqa: E402
from quadedge.estimates import of_base  # noqa: E402
from quadedge.ros2.mount import mount_of  # noqa: E402
from quadedge.ros_messages import BODY_FROM_OPTICAL, stamp_ns, transforms_message  # noqa: E402
from robot import SECOND, Robot, expected_pose, is_unknown, pose_of, pose_of_transform, tracked  # noqa: E402

FULL = "a folder with results"


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
    with Robot(room.rig) as robot:
        robot.start(tmp_path, "--preset", "default", "--cloud", *["--withhold-ambiguous"] * withheld)
        stamps = play_pairs(robot, pairs, SECOND)
        with quadedge.Odometry(robot.stated_rig) as odometry:
            results = [odometry.track(stamp, *pair) for stamp, pair in zip(stamps, pairs)]
        flagged = {result.stamp_ns for result in results if result.ambiguous_motion}
        assert len(flagged) >= 2 and all(result.is_tracked for result in results)
        bases = {result.stamp_ns: result.diagnostics.base_frame for result in results}
        measured_from_flagged = {stamp for stamp, base in bases.items() if base >= 0 and stamps[base] in flagged}
        messages = robot.poses()
        assert set(messages) == set(stamps) - (flagged if withheld else set())
        for stamp, message in messages.items():
            if stamp in flagged:
                assert is_unknown(message.pose) and is_unknown(message.twist)
            elif stamp < min(flagged):
                assert not is_unknown(message.pose)
        # Of the frame that is measured from a doubtful one the motion is known, the place is not.
        assert measured_from_flagged
        assert all(is_unknown(messages[stamp].pose) for stamp in measured_from_flagged & set(messages))
        assert [stamp_ns(one) for message in robot.heard["/tf"] for one in message.transforms] == list(messages)
        said = [message.status[0] for message in robot.heard["/diagnostics"]]
        warned = [status for status in said if status.message.startswith("ambiguous motion: ")]
        assert warned and {status.level for status in warned} == {1}
        assert robot.diagnostics()["pairs tracked, ambiguous"] == str(len(flagged))
        assert "warning: frame" in robot.words and "ambiguous motion: " in robot.words


def test_a_camera_that_is_frozen(robot, frames, tmp_path):
    robot.start(tmp_path)
    stamps = play_pairs(robot, [(one.left, one.right) for one in (*frames[:2], *[frames[1]] * 4)], SECOND)
    last = robot.poses()[stamps[-1]]
    assert is_unknown(last.pose) and is_unknown(last.twist)
    assert not is_unknown(robot.poses()[stamps[1]].pose)
    robot.said("warning: the image of /stereo/left/image_raw repeats the one before")
    assert robot.diagnosed(1, "repeats the one before")


def test_pairs_that_are_lost_are_not_counted_as_tracked(robot, frames, tmp_path):
    robot.start(tmp_path)
    black = numpy.zeros_like(frames[0].left)
    play_pairs(robot, [(frames[0].left, frames[0].right), (black, black)], SECOND)
    robot.until(lambda: robot.diagnostics()["pairs lost"] == "1", "a lost pair")
    values = robot.diagnostics()
    assert values["pairs tracked"] == "1" and values["status"].startswith("lost_") and values["level"] == 2
    robot.play(frames[:2], 2 * SECOND)
    robot.until(lambda: robot.diagnostics()["level"] == 0, "an end of the warning", 30)  # it does not last to the end


def test_a_stopped_program_goes_on_with_the_newest_pair(robot, frames, tmp_path):
    robot.start(tmp_path)
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


def test_stamps_that_go_back_start_again_where_it_was_and_move_no_map(robot, frames, tmp_path):
    robot.start(tmp_path, "--loops", "-o", tmp_path / "out")
    last = robot.play(frames, 100 * SECOND) - 50_000_000
    robot.play(frames[5:], SECOND)
    robot.said("the stamps of /stereo/left/image_raw went back by 99.250 s")
    before, after = robot.poses()[last], robot.poses()[SECOND]
    numpy.testing.assert_allclose(pose_of(after), pose_of(before), atol=1e-12)
    assert before.pose.covariance[0] < 1 and is_unknown(after.pose)
    place = "not measured since 1.000 s: the stamps"
    robot.until(lambda: robot.diagnostics()["place in odom"].startswith(place), "diagnostics")
    values = robot.diagnostics()
    assert values["restarts"] == "1"
    assert "went back by 99.250 s" in values["last restart"] and values["level"] in (1, 2)  # 2: it has become silent
    in_map = {}
    for message in robot.heard["/tf"]:
        to_base, to_odom = map(pose_of_transform, message.transforms)
        in_map[stamp_ns(message.transforms[0])] = to_odom @ to_base
    assert numpy.linalg.norm(in_map[SECOND][:3, 3]) > 0.01
    numpy.testing.assert_allclose(in_map[SECOND], in_map[last], atol=1e-9)
    robot.end()
    assert [len((tmp_path / out / "frames.csv").read_text().splitlines()) for out in ("out", "out_2")] == [7, 2]


def test_results_that_cannot_be_written_stop_no_odometry(robot, frames, tmp_path):
    folder = tmp_path / "disk"
    robot.start(tmp_path, "-o", folder / "out")
    robot.play(frames[:3], 100 * SECOND)
    folder.rename(tmp_path / "gone")  # neither the end of these results nor the folder of the next can be written
    folder.touch()
    robot.play(frames[3:], SECOND)
    robot.said("the odometry goes on, and results of the last session are incomplete")
    robot.said("the odometry goes on without results")
    assert robot.diagnostics()["pairs refused"] == "0"
    robot.end()


def test_a_mount_that_comes_late(robot, frames, tmp_path):
    robot.start(tmp_path)
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
    assert is_unknown(messages[5].pose)
    del static


@pytest.mark.parametrize("apart_ns, words", [(20_000_000, "20.000 ms apart, more than the --tolerance of 5 ms"),
                                             (None, "0")])
def test_images_that_form_no_pairs(apart_ns, words, robot, frames, tmp_path):
    robot.start(tmp_path)
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
    stamp = robot.play(frames[:3], SECOND)
    camera = robot.rig.left
    wider = [quadedge.PinholeCamera(camera.fx * 1.25, camera.fy * 1.25, camera.cx, camera.cy, 320, 200)] * 2
    robot.rig = quadedge.Rig(*wider, robot.rig.right_from_left)
    robot.play(frames[3:5], stamp)
    robot.said("camera_info of the left camera has changed: the odometry starts again")


def test_images_that_cannot_be_used_are_named_and_left_out(robot, frames, tmp_path):
    robot.start(tmp_path)
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
    others = [robot.domain.advertise("/stereo/right/image_raw", "sensor_msgs/msg/Image"),
              robot.domain.advertise("/quadedge/odometry", "nav_msgs/msg/Odometry")]
    robot.start(tmp_path)
    robot.said("warning: 2 publishers on /stereo/right/image_raw, expected one")
    robot.said("warning: another program publishes /quadedge/odometry, too")
    stamps = itertools.count(SECOND, 100_000_000)

    def is_diagnosed() -> bool:  # where no images come, that is said instead
        robot.send(next(stamps), frames[0].left, frames[0].right)
        robot.listen(0.1)
        return robot.diagnosed(1, "another program")

    robot.until(is_diagnosed, "a warning")
    del others


def test_an_empty_domain_and_one_without_cameras(tmp_path):
    with Robot(listens=False) as robot:
        start = time.monotonic()
        robot.start(tmp_path)
        robot.said(f"domain {robot.number}: nobody publishes a topic of ROS 2")
        assert time.monotonic() - start > 5
        assert robot.end() < 5
        alone = robot.domain.advertise("/camera/image_raw", "sensor_msgs/msg/Image")
        robot.start(tmp_path)
        robot.said("found no stereo topics among /camera/image_raw (sensor_msgs/msg/Image)")
        del alone


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
