"""Masks of images from topics of ROS 2, on the wire."""

import itertools
import time

import numpy
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed: quadedge.ros2 cannot be tested")
pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.ros2 cannot be tested")

import quadedge  # noqa: E402
from quadedge.ros2.pairs import LEFT, RIGHT  # noqa: E402
from robot import SECOND, Robot, expected_pose, image_message, pose_of  # noqa: E402

STEP = 50_000_000
TOPICS = ("/people/left/image", "/people/right/image")  # which would pass for another pair of cameras
OPTIONS = ("--left-mask", TOPICS[0], "--right-mask", TOPICS[1])


@pytest.fixture(scope="module")
def walk():
    """A rendered room in which somebody walks through half of the view: frames, masks of the walker by frame and
    camera, true positions (N, 3) [m], and the rig.
    """
    room, empty = (quadedge.synthetic(frames=8, width=320, height=200, mover=part) for part in (0.5, 0))
    masks = [[numpy.where(room.depth(number, side) == empty.depth(number, side), 255, 0).astype(numpy.uint8)
              for side in ("left", "right")] for number in range(len(room))]
    assert numpy.mean(numpy.array(masks) == 0) > 0.4
    return list(room), masks, room.truth.poses[:, :3, 3], room.rig


@pytest.fixture
def robot(walk):
    with Robot(walk[3]) as made:
        made.masks = [made.domain.advertise(topic, "sensor_msgs/msg/Image") for topic in TOPICS]
        yield made


def send_masks(robot, stamp: int, masks, encoding: str = "mono8") -> None:
    for publisher, mask in zip(robot.masks, masks):
        if mask is not None:
            publisher.publish(image_message(stamp, mask, encoding))


def assert_positions(robot, results) -> None:
    """The published positions are those of these results."""
    assert [pose_of(message)[:3] for message in robot.poses().values()] == [expected_pose(one)[:3] for one in results]


def tracked(robot, walk, masks) -> list:
    """The results of the same frames with these masks, without topics."""
    with quadedge.Odometry(robot.stated_rig, preset="fast") as odometry:
        return [odometry.track(SECOND + number * STEP, frame.left, frame.right, *given)
                for number, (frame, given) in enumerate(zip(walk[0], masks))]


def play(robot, walk, masks, first: int = 0) -> None:
    """Sends frames, and 30 ms later their masks, until every frame has a pose: again where the network has lost one."""
    for number, given in enumerate(masks, first):
        stamp, frame = SECOND + number * STEP, walk[0][number]

        def has_pose() -> bool:
            robot.send(stamp, frame.left, frame.right)
            robot.listen(0.03)
            send_masks(robot, stamp, given)
            end = time.monotonic() + 1
            while stamp not in robot.poses() and time.monotonic() < end:
                robot.listen(0.01)
            return stamp in robot.poses()

        robot.until(has_pose, f"pair {number}")


def test_somebody_who_fills_half_of_the_view_is_masked(robot, walk, tmp_path):
    _, masks, truth, _ = walk
    robot.start(tmp_path, *OPTIONS, "--mask-wait", 20000)
    play(robot, walk, masks)
    expected = tracked(robot, walk, masks)
    assert_positions(robot, expected)
    assert max(numpy.linalg.norm(result.world_from_left[:3, 3] - true)
               for result, true in zip(expected, truth - truth[0])) < 0.01
    without = tracked(robot, walk, [(None, None)] * len(masks))
    assert any(result.ambiguous_motion or not result.is_tracked for result in without)
    robot.until(lambda: robot.diagnostics()["pairs tracked"] == str(len(masks)), "diagnostics")
    values = robot.diagnostics()
    assert values["pairs without a left mask"] == values["pairs without a right mask"] == "0"


def test_a_mask_that_comes_late(robot, walk, tmp_path):
    masks = walk[1]
    robot.start(tmp_path, *OPTIONS[:2], "--mask-wait", 50)
    play(robot, walk, [(None, None)])  # its pose comes without a mask
    send_masks(robot, SECOND, [masks[0][LEFT]])
    robot.said(f"warning: pairs are tracked without a mask of {TOPICS[0]}: ")

    def is_late() -> bool:
        send_masks(robot, SECOND, [masks[0][LEFT]])
        robot.listen(0.3)
        return robot.heard["/diagnostics"] and robot.diagnostics()["left masks late or repeated"] != "0"

    robot.until(is_late, "a late mask")
    assert robot.diagnostics()["pairs without a left mask"] == "1"
    assert robot.diagnosed(1, TOPICS[0])
    for _ in range(5):  # one that comes before its images is kept for them
        send_masks(robot, SECOND + STEP, [masks[1][LEFT]])
        robot.listen(0.2)
    play(robot, walk, [(None, None)], first=1)
    robot.until(lambda: robot.diagnostics()["pairs tracked"] == "2", "diagnostics")
    assert robot.diagnostics()["pairs without a left mask"] == "1"
    assert_positions(robot, tracked(robot, walk, [(None, None), (masks[1][LEFT], None)]))


def test_masks_of_another_size_or_encoding_are_named_and_left_out(robot, walk, tmp_path):
    masks = walk[1]
    robot.start(tmp_path, *OPTIONS, "--mask-wait", 20000)
    small = (masks[0][LEFT][:199], masks[0][RIGHT])
    play(robot, walk, [small])
    robot.said(f"warning: {TOPICS[0]}: found a mask of 320 x 199 pixels, expected 320 x 200, the size of its image; "
               "such pairs are tracked without")
    words = masks[1][RIGHT].astype(numpy.uint16)
    sent = itertools.count()

    def has_pose() -> bool:
        if next(sent) % 20 == 0:
            robot.send(SECOND + STEP, walk[0][1].left, walk[0][1].right)
            send_masks(robot, SECOND + STEP, [masks[1][LEFT], None])
            send_masks(robot, SECOND + STEP, [None, words], "mono16")
        return SECOND + STEP in robot.poses()

    robot.until(has_pose, "a pose")
    robot.said(f"warning: {TOPICS[1]}: found a mask with the encoding 'mono16', expected mono8")
    robot.until(lambda: robot.diagnostics()["right masks refused"] == "1", "diagnostics")
    values = robot.diagnostics()
    assert values["left masks refused"] == values["pairs without a left mask"] == "1"
    assert robot.diagnosed(1, "320 x 199")
    assert_positions(robot, tracked(robot, walk, [(None, masks[0][RIGHT]), (masks[1][LEFT], None)]))


def test_pairs_do_not_wait_for_ever_for_masks_that_nobody_publishes(walk, tmp_path):
    stamps = itertools.count(SECOND, STEP)
    with Robot(walk[3]) as robot:
        robot.start(tmp_path, *OPTIONS[:2], "--mask-wait", 50)
        frames = itertools.cycle([*walk[0], *walk[0][::-1]])

        def says(text: str) -> bool:
            frame = next(frames)
            robot.send(next(stamps), frame.left, frame.right)
            robot.listen(0.1)
            return text in robot.words

        silent = f"warning: pairs are tracked without a mask of {TOPICS[0]}: nobody publishes it"
        robot.until(lambda: says(f"{silent} (pairs no longer wait for one)"), "silence")
        assert f"{silent} (--mask-wait is 50 ms)" in robot.words
        robot.until(lambda: robot.diagnostics()["level"] == 1, "a warning")
        mask = robot.domain.advertise(TOPICS[0], "sensor_msgs/msg/Image")

        def comes_again() -> bool:
            mask.publish(image_message(SECOND, walk[1][0][LEFT]))
            return says(f"masks of {TOPICS[0]} come again")

        robot.until(comes_again, "an end of the silence")
