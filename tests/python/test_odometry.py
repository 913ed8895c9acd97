"""Odometry: poses like the command's, arrays, lifetimes, threads, errors."""

import gc
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy
import pytest

import quadedge


def track_all(source, **arguments):
    with quadedge.Odometry(source, **arguments) as odometry:
        return [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in source]


def write(results, path):
    tracked = [result for result in results if result.is_tracked]
    stamps = numpy.array([result.stamp_ns for result in tracked])
    quadedge.Trajectory(stamps, numpy.array([result.world_from_left for result in tracked])).write_tum(path)
    return path.read_bytes()


@pytest.fixture
def odometry(room):
    with quadedge.Odometry(room) as made:
        yield made


@pytest.fixture(scope="module")
def untouched(room):
    """An odometry for calls that are refused and must have no effect."""
    with quadedge.Odometry(room) as made:
        yield made


@pytest.mark.parametrize("arguments, options", [
    ({}, ()),
    ({"preset": "fast", "config": {"seed": 5, "stereo.max_disparity": 60}},
     ("--preset", "fast", "--seed", "5", "--stereo.max_disparity", "60")),
])  # fmt: skip
def test_poses_equal_the_commands_byte_for_byte(command, room_folder, tmp_path, arguments, options):
    command("run", room_folder, "-o", tmp_path / "out", "--quiet", *options)
    results = track_all(quadedge.open_dataset(room_folder), **arguments)
    assert len(results) == 6 and all(result.is_tracked for result in results)
    expected = (tmp_path / "out" / "trajectory.txt").read_bytes()
    assert write(results, tmp_path / "ours.txt") == expected
    again = track_all(quadedge.open_dataset(room_folder), config=tmp_path / "out" / "config.toml")
    assert write(again, tmp_path / "again.txt") == expected


def test_result_has_pose_and_covariance(room):
    first, second = track_all(room)[:2]
    assert first.status == "first" and second.status == "tracked"
    numpy.testing.assert_array_equal(first.world_from_left, numpy.eye(4))
    truth = room.truth.poses[1]
    assert numpy.linalg.norm(second.world_from_left[:3, 3] - truth[:3, 3]) < 0.01
    assert second.covariance.shape == (6, 6)
    numpy.testing.assert_allclose(second.covariance, second.covariance.T, rtol=1e-9)
    assert (numpy.linalg.eigvalsh(second.covariance) > 0).all()
    assert second.counts.quads >= second.counts.inliers > 100
    assert second.timing.latency_ms > 0 and second.timing.stages
    assert second.predicted_world_from_left is None
    assert second.diagnostics.base_frame == 0


def test_the_covariance_of_the_motion_has_the_translation_first(room):
    """Turned to the axes of the reference, it is the covariance of the pose there, without calibration errors."""
    config = {f"pose.rig_sigma_{name}": 0 for name in ("length", "axis", "lens")}
    config["pose.disparity_offset_sigma"] = 0
    result = track_all(room, config=config)[1]
    turn = result.current_from_reference[:3, :3].T
    rotation = turn @ result.relative_covariance[3:, 3:] @ turn.T
    numpy.testing.assert_allclose(rotation, result.diagnostics.covariance_in_reference[3:, 3:], rtol=1e-9)


def test_warnings_have_a_kind_and_come_once(room, frames):
    """The right camera pitched by half a degree."""
    pitch = numpy.radians(0.5)
    right_from_left = room.rig.right_from_left.copy()
    right_from_left[1:3, 1:3] = [[numpy.cos(pitch), -numpy.sin(pitch)], [numpy.sin(pitch), numpy.cos(pitch)]]
    with quadedge.Odometry(quadedge.Rig(room.rig.left, room.rig.right, right_from_left)) as odometry:
        results = [odometry.track(frame.stamp_ns, frame.left, frame.right) for frame in frames[:3]]
    assert [warning.kind for warning in results[0].warnings] == ["doubtful_calibration"]
    assert "pitched" in results[0].warnings[0].text
    assert results[1].warnings == results[2].warnings == []


def test_a_lost_frame_says_so_and_has_no_covariance(odometry, frames):
    odometry.track(0, frames[0].left, frames[0].right)
    grey = numpy.full_like(frames[0].left, 128)
    lost = odometry.track(1, grey, grey)
    assert lost.status == "lost_too_few_edges" and not lost.is_tracked
    assert lost.world_from_left is None and lost.current_from_reference is None
    assert lost.covariance is None and lost.relative_covariance is None and "stereo edges" in lost.message
    numpy.testing.assert_array_equal(lost.predicted_world_from_left, numpy.eye(4))  # no motion was found yet


def test_arrays_outlive_everything_and_cannot_be_written(room, frames):
    odometry = quadedge.Odometry(room)
    result = odometry.track(0, frames[0].left, frames[0].right)
    edges = odometry.edges()
    pose, xyz, ncc = result.world_from_left, edges.xyz, edges.ncc
    copies = pose.copy(), xyz.copy(), ncc.copy()
    odometry.close()
    del odometry, result, edges
    gc.collect()
    junk = [numpy.random.default_rng(0).random((500, 500)) for _ in range(4)]
    for array, copy in zip((pose, xyz, ncc), copies):
        numpy.testing.assert_array_equal(array, copy)
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    assert junk


def colour_of(grey):
    return numpy.repeat(grey[:, :, None], 3, axis=2)


def test_strided_and_read_only_images_give_the_same(room, frames):
    expected = track_all(room)[1].world_from_left
    with quadedge.Odometry(room) as odometry:
        for frame in frames[:2]:
            wide = numpy.zeros((frame.left.shape[0], frame.left.shape[1] + 37), numpy.uint8)
            wide[:, 5:-32] = frame.left
            colour = colour_of(frame.right)
            assert not frame.left.flags.writeable and not wide[:, 5:-32].flags.c_contiguous
            result = odometry.track(frame.stamp_ns, wide[:, 5:-32], colour[:, :, 1])
    numpy.testing.assert_array_equal(result.world_from_left, expected)
    with quadedge.Odometry(room) as odometry:
        for frame in frames[:2]:
            result = odometry.track(frame.stamp_ns, frame.left[:, :, None], colour_of(frame.right)[:, :, 1:2])
    numpy.testing.assert_array_equal(result.world_from_left, expected)


def test_images_of_16_bits(frames):
    deep = quadedge.synthetic(frames=2, width=320, height=200, bits=16)
    assert deep.rig.max_value == 65535 and deep[0].left.dtype == numpy.uint16
    assert [result.status for result in track_all(deep)] == ["first", "tracked"]
    expected = "values up to 255, the rig expects"
    with quadedge.Odometry(deep) as odometry, pytest.raises(quadedge.DataError, match=expected):
        odometry.track(0, frames[0].left, frames[0].right)


def test_two_threads_with_an_object_each(room):
    def poses(_=0):
        return [result.world_from_left.tobytes() for result in track_all(room)]

    with ThreadPoolExecutor(2) as threads:
        assert list(threads.map(poses, range(2))) == [poses()] * 2


FORKED = """
import os, signal, sys, quadedge
room = quadedge.synthetic(frames=3, width=320, height=200)
frames = list(room)

def status_of_fork(work):
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        try:
            work()
        except quadedge.DeviceError as error:
            os._exit(11 if "get_context" in str(error) else 12)
        os._exit(10)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

def track(odometry):
    for frame in frames:
        odometry.track(frame.stamp_ns, frame.left, frame.right)

assert status_of_fork(lambda: track(quadedge.Odometry(room))) == 10  # nothing was used before
odometry = quadedge.Odometry(room)
track(odometry)
last = frames[-1]
assert status_of_fork(lambda: odometry.track(last.stamp_ns, last.left, last.right)) == 11
assert status_of_fork(lambda: quadedge.Odometry(room)) == 11
assert status_of_fork(quadedge.devices) == 11
assert status_of_fork(lambda: track(quadedge.Odometry(room, "reference"))) == 10
odometry.track(last.stamp_ns, last.left, last.right)
"""


def test_a_forked_process_is_refused_once_opencl_was_used():
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", FORKED], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr


DISTORTED = """
image_width: 320
image_height: 200
camera_name: camera
camera_matrix: {rows: 3, cols: 3, data: [184, 0, 159.5, 0, 184, 99.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.1, 0.01, 0, 0, 0]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [184, 0, 159.5, TX, 0, 184, 99.5, 0, 0, 0, 1, 0]}
"""


def distorted_rig(folder, **arguments):
    for side, tx in (("left", "0"), ("right", "-20.0")):
        (folder / f"{side}.yaml").write_text(DISTORTED.replace("TX", tx))
    return quadedge.Rig.from_file((folder / "left.yaml", folder / "right.yaml"), **arguments)


def test_a_pixel_above_the_value_of_a_saturated_one_is_refused(tmp_path):
    left, right = (image.astype(numpy.uint16) * 16 for image in (LEFT, RIGHT))
    right[199, 319] = 4096
    with quadedge.Odometry(distorted_rig(tmp_path, max_value=4095)) as odometry:
        with pytest.raises(quadedge.DataError, match="right image has a pixel of 4096, the rig expects .* up to 4095"):
            odometry.track(0, left, right)


def test_a_device_by_its_index(room):
    by_index = quadedge.Odometry(room, device=0)
    assert by_index.device.index == 0 and quadedge.Device(numpy.int64(0)).info.index == 0
    assert len(quadedge.detect_edges(room[0].left, device=0)) > 100
    with pytest.raises(quadedge.DeviceError, match="no OpenCL device matches '99'"):
        quadedge.Odometry(room, device=99)
    for wrong in (0.5, True, None):
        with pytest.raises(TypeError, match="device: expected"):
            quadedge.Odometry(room, device=wrong)


def test_other_threads_run_while_a_frame_is_tracked(room, frames):
    """If track() held the GIL, the other thread could not count meanwhile."""
    counted = []
    stop = threading.Event()

    def count():
        while not stop.is_set():
            counted.append(None)
            stop.wait(0.0005)

    with quadedge.Odometry(room, device="reference") as odometry:
        thread = threading.Thread(target=count)
        thread.start()
        odometry.track(0, frames[0].left, frames[0].right)
        before = len(counted)
        odometry.track(1, frames[1].left, frames[1].right)
        during = len(counted) - before
        stop.set()
        thread.join()
    assert during > 3


LEFT, RIGHT = numpy.zeros((200, 320), numpy.uint8), numpy.zeros((200, 320), numpy.uint8)


@pytest.mark.parametrize("left, error, words", [
    (None, TypeError, "the left image is None, expected a numpy array of uint8 or uint16"),
    ("image.png", TypeError, "the left image is str, expected a numpy array"),
    (LEFT.astype(float), TypeError, "the left image is an array of float64, expected a numpy array of uint8 or uint16"),
    (LEFT.astype(">u2"), TypeError, "the left image is an array of >u2"),
    (LEFT[:, :-1], quadedge.DataError, "the left image has 319x200 pixels, the calibration expects 320x200"),
    (numpy.zeros((200, 320, 3), numpy.uint8), quadedge.DataError,
     r"the left image has 200 x 320 x 3 values, expected height x width: one grey channel. Convert colour first, for "
     r"example with cv2.cvtColor\(image, cv2.COLOR_BGR2GRAY\)"),
    (numpy.zeros((1, 200, 320), numpy.uint8), quadedge.DataError,
     "the left image has 1 x 200 x 320 values, expected height x width: one grey channel$"),
    (numpy.zeros(64000, numpy.uint8), quadedge.DataError, "the left image has 64000 values, expected height x width"),
    (numpy.zeros((0, 320), numpy.uint8), quadedge.DataError, "the left image is empty"),
    (LEFT[::-1], quadedge.DataError, "the left image has a stride of -320 bytes, expected at least the 320 of a row"),
    (LEFT[:, ::-1], quadedge.DataError, "the left image has a stride of -1 bytes from pixel to pixel"),
    (numpy.broadcast_to(LEFT[0], LEFT.shape), quadedge.DataError,
     "the left image has a stride of 0 bytes, expected at least the 320 of a row"),
    (LEFT.astype(numpy.uint16), quadedge.DataError, "pixel values up to 65535, the rig expects values up to 255: "
     "state the camera's as max_value of the rig"),
])  # fmt: skip
def test_invalid_images_are_refused(untouched, left, error, words):
    with pytest.raises(error, match=words):
        untouched.track(10**18, left, RIGHT)
    assert untouched.track(0, LEFT, RIGHT).reference_frame == -1  # no effect


def test_messages_equal_the_commands(command, room_folder, room, tmp_path):
    with quadedge.Odometry(room) as odometry:
        odometry.track(5, LEFT, RIGHT)
        with pytest.raises(quadedge.DataError, match="timestamp 4 ns goes back, expected at least 5 ns"):
            odometry.track(4, LEFT, RIGHT)
    cases = [({"config": {"stereo.ncc_min": 3}}, ("--stereo.ncc_min", "3"), "0.01 to 1"),
             ({"device": "toaster"}, ("--device", "toaster"), "no OpenCL device matches 'toaster'")]  # fmt: skip
    for arguments, options, words in cases:
        with pytest.raises(quadedge.Error, match=words) as raised:
            quadedge.Odometry(room, **arguments)
        done = command("run", room_folder, "-o", tmp_path / "out", *options, code=raised.value.exit_code)
        assert words in done.stderr


@pytest.mark.parametrize("source", [None, "camchain.yaml", numpy.eye(4)])
def test_invalid_rigs_are_refused(source):
    with pytest.raises(TypeError, match="expected a Rig, a Dataset or a Synthetic"):
        quadedge.Odometry(source)


def test_images_after_close_are_refused(room, frames):
    odometry = quadedge.Odometry(room)
    odometry.close()
    odometry.close()  # closing twice is allowed
    for late in (lambda: odometry.track(0, frames[0].left, frames[0].right), odometry.edges, odometry.details):
        with pytest.raises(quadedge.UsageError, match="the odometry is closed"):
            late()


def test_stamps_are_whole_numbers(odometry):
    with pytest.raises(TypeError):
        odometry.track(0.5, LEFT, RIGHT)
    assert odometry.track(numpy.int64(7), LEFT, RIGHT).stamp_ns == 7
