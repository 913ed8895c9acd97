"""Recordings, rendered sequences, trajectories, and their evaluation."""


import numpy
import pytest

import quadedge


def test_a_recording(room_folder, frames):
    dataset = quadedge.open_dataset(room_folder)
    assert len(dataset) == len(dataset.frames) == 6 and dataset.rig.disparity_range > 0
    assert dataset.frames[0].left.endswith(".png")
    for recorded, rendered in zip(dataset, frames):
        assert recorded.stamp_ns == rendered.stamp_ns and recorded.number == rendered.number
        numpy.testing.assert_array_equal(recorded.left, rendered.left)
        numpy.testing.assert_array_equal(recorded.right, rendered.right)
    numpy.testing.assert_allclose(dataset.truth.poses, quadedge.synthetic(frames=6).truth.poses, atol=1e-6)


def test_frames_outlive_their_dataset(room_folder):
    frame = next(iter(quadedge.open_dataset(room_folder)))
    left = frame.left
    copy = left.copy()
    del frame
    numpy.testing.assert_array_equal(left, copy)


def test_invalid_recordings_are_refused(tmp_path, command):
    with pytest.raises(quadedge.DataError) as raised:
        quadedge.open_dataset(tmp_path / "none")
    assert str(raised.value) in command("run", tmp_path / "none", "-o", tmp_path / "out", code=3).stderr


def test_an_error_names_the_damaged_image(room_folder, tmp_path):
    import shutil

    shutil.copytree(room_folder, tmp_path / "room")
    image = sorted((tmp_path / "room" / "rgb").glob("*.png"))[2]
    image.write_bytes(image.read_bytes()[:500])
    with pytest.raises(quadedge.DataError, match=image.name):
        list(quadedge.open_dataset(tmp_path / "room"))
    with pytest.raises(quadedge.DataError, match=image.name):
        quadedge.read_grey_image(image)
    with pytest.raises(quadedge.DataError, match="the left camera"):
        quadedge.decode_grey_image(image.read_bytes(), "the left camera")


def test_rendering(room):
    assert room.name == "room" and len(room) == 6
    numpy.testing.assert_array_equal(room[-1].left, room[5].left)
    with pytest.raises(IndexError):
        room[6]
    with pytest.raises(quadedge.UsageError, match="allowed: left, right"):
        room.depth(0, "middle")
    with pytest.raises(quadedge.UsageError, match="scene"):
        quadedge.synthetic(scene="moon")


def test_trajectories_are_written_and_read(tmp_path):
    poses = numpy.tile(numpy.eye(4), (5, 1, 1))
    poses[:, 0, 3] = numpy.arange(5) / 8
    written = quadedge.Trajectory(numpy.arange(5) * 50_000_000, poses)
    written.write_tum(tmp_path / "path.txt")
    written.write_kitti(tmp_path / "path_kitti.txt")
    read, rows = (quadedge.Trajectory.from_file(tmp_path / name) for name in ("path.txt", "path_kitti.txt"))
    numpy.testing.assert_array_equal(read.stamps_ns, written.stamps_ns)
    numpy.testing.assert_array_equal(read.poses, poses)
    numpy.testing.assert_array_equal(rows.poses, poses)
    with pytest.raises(quadedge.DataError, match="poses: found 5 x 4 x 4 numbers, expected 4 x 4 x 4"):
        quadedge.Trajectory(numpy.arange(4), poses)
    parts = quadedge.Trajectory(numpy.arange(5) * 50_000_000, poses, numpy.array([0, 0, 1, 1, 2], numpy.int32))
    parts.write_tum(tmp_path / "parts.txt")
    assert "\n# segment 1: " in (tmp_path / "parts.txt").read_text()
    numpy.testing.assert_array_equal(quadedge.Trajectory.from_file(tmp_path / "parts.txt").segments, [0, 0, 1, 1, 2])
    numpy.testing.assert_array_equal(read.segments, numpy.zeros(5))
    with pytest.raises(quadedge.DataError, match="segments: found 4 numbers, expected 5"):
        quadedge.Trajectory(numpy.arange(5), poses, numpy.zeros(4, numpy.int32))
    with pytest.raises(quadedge.DataError, match="absent.txt"):
        quadedge.Trajectory.from_file(tmp_path / "absent.txt")


def test_errors_of_a_trajectory():
    poses = numpy.tile(numpy.eye(4), (5, 1, 1))
    poses[:, 2, 3] = numpy.arange(5)
    stamps = numpy.arange(5) * 100_000_000
    off = poses.copy()
    off[4, 0, 3] = 0.5  # the last pose is off to the side
    evaluation = quadedge.evaluate_trajectory(quadedge.Trajectory(stamps, off), quadedge.Trajectory(stamps, poses))
    assert evaluation.matched == 5 and evaluation.path_length_m == 4
    assert evaluation.origin_aligned.ape_translation_m.max == pytest.approx(0.5)
    assert evaluation.origin_aligned.ape_translation_m.rmse == pytest.approx(0.5 / 5**0.5)
    numpy.testing.assert_allclose(evaluation.ape_translation_m, [0, 0, 0, 0, 0.5])
    numpy.testing.assert_array_equal(evaluation.stamps_ns, stamps)
    assert evaluation.end_drift_percent == pytest.approx(12.5)
    assert evaluation.segments == []
    parts = quadedge.Trajectory(stamps, off, numpy.array([0, 0, 0, 1, 1], numpy.int32))
    first, second = quadedge.evaluate_trajectory(parts, quadedge.Trajectory(stamps, poses)).segments
    assert (first.segment, first.matched, second.segment, second.matched) == (0, 3, 1, 2)
    assert first.origin_aligned.ape_translation_m.max == pytest.approx(0, abs=1e-12)
    assert second.origin_aligned.rpe_translation_m.mean == pytest.approx(0.5)
    late = quadedge.Trajectory(stamps + 10**12, poses)
    with pytest.raises(quadedge.DataError):
        quadedge.evaluate_trajectory(late, quadedge.Trajectory(stamps, poses))


def test_configuration():
    with pytest.raises(quadedge.UsageError, match="there is no preset 'fastest'; did you mean 'fast'"):
        quadedge.configuration("fastest")
    assert quadedge.presets() == ["fast", "default", "dense", "paper"]
    constants = quadedge.configuration("fast", {"stereo.max_disparity": 100, "pose.refine": False})
    assert constants["edges.budget"] == 5000 and constants["stereo.max_disparity"] == 100
    assert constants["pose.refine"] is False and constants["seed"] == quadedge.configuration()["seed"]


@pytest.mark.parametrize("config, error, words", [
    ({"stereo.max_disparty": 3}, quadedge.UsageError,
     "config:1: unknown key .stereo.max_disparty.; did you mean 'stereo.max_disparity'"),
    ({"seed": 1, "stereo.max_disparity": "far"}, quadedge.UsageError,
     "config:2: stereo.max_disparity: expected a number, found"),
    ({"no such key": 3}, quadedge.UsageError, "unknown key .no such key."),
    ({"device": "cpu"}, quadedge.UsageError, "the device is a separate argument"),
    ({"stereo.max_disparity": None}, TypeError, "stereo.max_disparity is NoneType, expected a number"),
    ({3: 3}, TypeError, "expected strings as keys"),
    ("no_such.toml", quadedge.UsageError, "no_such.toml: the configuration file cannot be read"),
])  # fmt: skip
def test_invalid_configurations_are_refused(config, error, words):
    with pytest.raises(error, match=words):
        quadedge.configuration(config=config)
