"""Odometry is written as MCAP, and recordings are tracked from the shell."""

import json
import os
import subprocess
from types import SimpleNamespace

import numpy
import pytest

import quadedge

pytest.importorskip("rosbags", reason="rosbags is not installed: quadedge.bag cannot be tested")

import quadedge.bag  # noqa: E402
from bags import BagWriter, messages_of, poses, room_recording, tum_of  # noqa: E402
from quadedge.estimates import Estimates  # noqa: E402
from quadedge.result_files import rotations  # noqa: E402
from quadedge.ros_messages import BODY_FROM_OPTICAL, stamp_ns  # noqa: E402
from quadedge.run_frames import read_frames  # noqa: E402


@pytest.fixture
def room_bag(room, frames, tmp_path):
    return room_recording(tmp_path / "room", room.rig, frames)


def position(message) -> list[float]:
    point = message.pose.pose.position
    return [point.x, point.y, point.z]


def made_up_result(stamp: int, **values):
    nothing = SimpleNamespace(base_frame=0, covariance_in_reference=None)
    return SimpleNamespace(stamp_ns=stamp, is_tracked=True, segment=0, reference_frame=0, ambiguous_motion=False,
                           new_key_rig=False, diagnostics=nothing, **values)


def test_odometry_of_ambiguous_frames_is_unknown_or_withheld(boarded, tmp_path):
    room, pairs = boarded
    with quadedge.Odometry(room) as odometry:
        files = quadedge.ResultFiles(tmp_path / "run", odometry, "room")
        results = [odometry.track(100 * number, *pair) for number, pair in enumerate(pairs)]
        for result in results:
            files.add(result)
        files.finish()
    flagged = [number for number, result in enumerate(results) if result.ambiguous_motion]
    assert len(flagged) >= 2
    for name, tracked in (("results", results), ("files", read_frames(tmp_path / "run"))):
        quadedge.bag.write_mcap(tmp_path / name, tracked)
        for number, message in enumerate(messages_of(tmp_path / name)):
            unknown = [part.covariance[0] == 1e6 for part in (message.pose, message.twist)]
            assert unknown == [True, True] if number in flagged else number > flagged[0] or not unknown[0]
        quadedge.bag.write_mcap(tmp_path / f"{name} withheld", tracked, withhold_ambiguous=True)
        assert len(messages_of(tmp_path / f"{name} withheld")) == len(pairs) - len(flagged)
    for one, other in zip(messages_of(tmp_path / "results"), messages_of(tmp_path / "files"), strict=True):
        for part in ("pose", "twist"):
            numpy.testing.assert_allclose(getattr(one, part).covariance, getattr(other, part).covariance, rtol=1e-9)
        assert one.twist.twist.linear.x == pytest.approx(other.twist.twist.linear.x, rel=1e-6, abs=1e-9)


def test_odometry_is_written_with_covariance(room, tmp_path):
    results = poses(room, room)
    file = quadedge.bag.write_mcap(tmp_path / "odometry", results, child_frame="camera")
    assert file.suffix == ".mcap"
    read, estimates = messages_of(tmp_path / "odometry"), Estimates(BODY_FROM_OPTICAL)
    assert len(read) == len(results)
    assert read[0].header.frame_id == "odom" and read[0].child_frame_id == "camera"
    axes = numpy.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])  # forward, left, up
    for message, result in zip(read, results):
        assert stamp_ns(message) == result.stamp_ns
        numpy.testing.assert_array_equal(position(message), axes @ result.world_from_left[:3, 3])
        turned = numpy.kron(numpy.eye(2), axes)
        numpy.testing.assert_allclose(message.pose.covariance.reshape(6, 6), turned @ result.covariance @ turned.T)
        twist = estimates.add(result).twist
        linear = message.twist.twist.linear
        assert [linear.x, linear.y, linear.z] == (list(twist[0][:3]) if twist else [0, 0, 0])
        assert message.twist.covariance[0] == (twist[1][0, 0] if twist else 1e6)
        turn = message.pose.pose.orientation
        numpy.testing.assert_allclose(rotations(numpy.array([[turn.x, turn.y, turn.z, turn.w]]))[0],
                                      axes @ result.world_from_left[:3, :3] @ axes.T, atol=1e-12)
    with pytest.raises(quadedge.DataError, match="expected a new folder"):
        quadedge.bag.write_mcap(tmp_path / "odometry", results)


def test_odometry_has_the_axes_of_rep_103(tmp_path):
    """The camera has moved 3 m forward, 1 m to the left and 2 m up, and turned left by 90 degrees."""
    pose = numpy.array([[0, 0, -1, -1], [0, 1, 0, -2], [1, 0, 0, 3], [0, 0, 0, 1]], float)  # optical axes
    covariance = numpy.diag([1.0, 2, 3, 4, 5, 6])  # right, down, forward; about them
    covariance[0, 2] = covariance[2, 0] = 0.5  # to the right goes with forward
    result = made_up_result(5, world_from_left=pose, covariance=covariance)
    later = SimpleNamespace(**{**vars(result), "stamp_ns": 6, "segment": 1})
    quadedge.bag.write_mcap(tmp_path / "odometry", [result, later])
    message, of_later = messages_of(tmp_path / "odometry")
    assert message.header.frame_id == "odom" and message.child_frame_id == "base_link"
    assert position(message) == [3, 1, 2]
    turn = message.pose.pose.orientation
    half = numpy.sqrt(0.5)  # 90 degrees about z, which points up
    numpy.testing.assert_allclose([turn.x, turn.y, turn.z, turn.w], [0, 0, half, half], atol=1e-12)
    expected = numpy.diag([3.0, 1, 2, 6, 4, 5])
    expected[0, 1] = expected[1, 0] = -0.5
    numpy.testing.assert_allclose(message.pose.covariance.reshape(6, 6), expected, atol=1e-12)
    assert of_later.pose.covariance[0] == 1e6 and position(of_later)[0] == 3  # unknown in another segment


@pytest.mark.parametrize("stamp", [-5, 2**31 * 10**9, 2**63 - 1])
def test_odometry_with_stamps_that_ros_cannot_hold_is_refused_and_leaves_no_folder(tmp_path, stamp):
    result = made_up_result(stamp, world_from_left=numpy.eye(4), covariance=None)
    with pytest.raises(quadedge.DataError, match=f"found the stamp {stamp} ns, expected 0 to"):
        quadedge.bag.write_mcap(tmp_path / "a" / "b" / "odometry", [result])
    assert list(tmp_path.iterdir()) == []
    latest = SimpleNamespace(**{**vars(result), "stamp_ns": 2**31 * 10**9 - 1})
    assert quadedge.bag.write_mcap(tmp_path / "odometry", [latest]).exists()


def test_from_the_shell(room_bag, bag_command, command, tmp_path):
    out = tmp_path / "out"
    done = bag_command(room_bag, "-o", out, "--preset", "fast", "--", "--points", tmp_path / "map.ply")
    assert "6 pairs" in done.stdout and "tracked    6 of 6" in done.stdout
    recording = quadedge.bag.open_bag(room_bag)
    results = poses(recording.rig, recording, preset="fast")
    assert (out / "trajectory.txt").read_bytes() == tum_of(results, tmp_path)
    quadedge.bag.write_mcap(tmp_path / "ours", results)
    for one, other in zip(messages_of(tmp_path / "ours"), messages_of(out / "odometry"), strict=True):
        assert one.header.stamp == other.header.stamp and one.child_frame_id == other.child_frame_id == "base_link"
        numpy.testing.assert_allclose(position(other), position(one), atol=1e-12)
        numpy.testing.assert_allclose(other.pose.covariance, one.pose.covariance, rtol=1e-9, atol=1e-20)
    for name in ("frames.csv", "poses.csv"):
        assert len((out / name).read_text().splitlines()) == 7
    assert (tmp_path / "map.ply").read_bytes().startswith(b"ply")
    assert json.loads((out / "report.json").read_text())["input"]["name"] == str(room_bag)
    command("report", out)
    again = bag_command(room_bag, "-o", out, code=2)
    assert not again.stdout.count("tracked") and "--force" in again.stderr
    bag_command(room_bag, "-o", out, "--preset", "fast", "--", "--force")
    assert len(list((out / "odometry").glob("*.mcap"))) == 1
    (out / "odometry/metadata.yaml").unlink()  # as if it were somebody else's folder
    bag_command(room_bag, "-o", out, "--", "--force", code=2)
    absent = bag_command("absent.bag", code=3)
    assert absent.stderr.startswith("quadedge.bag: absent.bag: found no readable recording")


def test_progress_is_shown_on_a_terminal(room_bag, bag_command, tmp_path):
    import pty

    controller, terminal = pty.openpty()
    bag_command(room_bag, "-o", tmp_path / "out", capture_output=False, stdout=subprocess.PIPE, stderr=terminal)
    os.close(terminal)
    shown = b""
    try:
        while piece := os.read(controller, 4096):
            shown += piece
    except OSError:  # how Linux reports that the other end is closed
        pass
    os.close(controller)
    assert b"frame" in shown and b"6" in shown


def test_an_image_in_the_middle_that_cannot_be_read(room, frames, bag_command, tmp_path):
    with BagWriter(tmp_path / "room", "mcap") as bag:
        bag.infos(room.rig)
        for number, frame in enumerate(frames):
            bag.pair(frame.stamp_ns + 1, frame.left, frame.right, "mono8" if number < 4 else "jxl8")
    done = bag_command(bag.path, "-o", tmp_path / "out", code=3, timeout=120)
    assert "found the encoding 'jxl8'" in done.stderr
    assert not (tmp_path / "out" / "odometry").exists()


def test_what_a_run_would_refuse_is_refused_at_once(room, frames, bag_command, tmp_path):
    with BagWriter(tmp_path / "first", "ros2") as bag:
        bag.infos(room.rig)
        bag.pair(5, frames[0].left, frames[0].right, "jxl8")
    for options in ((), ("-o", tmp_path / "out")):
        done = bag_command(bag.path, *options, code=3)
        assert "found the encoding 'jxl8'" in done.stderr and "Traceback" not in done.stderr
    with BagWriter(tmp_path / "infos", "ros2") as bag:
        for side in ("left", "right"):
            bag.camera_info(f"/stereo/{side}/camera_info", 5, room.rig.left, 0.0)
        bag.pair(5, frames[0].left, frames[0].right)
    done = bag_command(bag.path, "-o", tmp_path / "out", code=3)
    assert "a baseline above zero" in done.stderr
    assert f"{bag.path}: /stereo/right/camera_info" in done.stderr and "/tmp/tmp" not in done.stderr
