"""Pairs of images, frames, twists and places of quadedge.ros2, without a network."""

import itertools
from types import SimpleNamespace

import numpy
import pytest

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed: quadedge.ros2 cannot be tested")
pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.ros2 cannot be tested")

from quadedge.estimates import Estimates, of_base, twist_between  # noqa: E402
from quadedge.ros2.mount import StaticFrames, levelled, mount_of  # noqa: E402
from quadedge.ros2.pairs import LEFT, RIGHT, PairQueue  # noqa: E402
from quadedge.ros2.place import Place  # noqa: E402
from quadedge.ros_messages import BODY_FROM_OPTICAL, stamp_ns, transforms_message  # noqa: E402
from robot import image_message  # noqa: E402


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
    assert queue.counts.alone == [1, 0] and queue.counts.late == queue.counts.behind == 0
    assert given(queue, (RIGHT, 250), (RIGHT, 0), (RIGHT, 240)) == []
    assert queue.counts.late == 2 and queue.counts.without_stamp == 1
    for ms in (300, 350, 400):
        for side in (LEFT, RIGHT):
            queue.add(side, message_at(ms * 1_000_000))
    assert stamp_ns(queue.newest()[LEFT]) == 400_000_000 and queue.counts.behind == 2
    for number in range(30):
        queue.add(LEFT, message_at((500 + number) * 1_000_000_000))
    assert queue.counts.alone == [21, 0]  # ten wait


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


def result_at(seconds: float, pose: numpy.ndarray, **more):
    details = SimpleNamespace(covariance_in_reference=numpy.diag([1.0, 1, 1, 2, 2, 2]) * 1e-4,
                              base_frame=more.pop("base_frame", 0))
    return SimpleNamespace(**{"stamp_ns": round(seconds * 1e9), "is_tracked": True, "segment": 0, "new_key_rig": False,
                              "map_from_odometry": None, "ambiguous_motion": False, "covariance": numpy.eye(6) * 1e-4,
                              "reference_frame": 0, "world_from_left": pose, "current_from_reference": numpy.eye(4),
                              "diagnostics": details, **more})


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
