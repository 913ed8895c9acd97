"""Calibrations learned from recordings."""

import re

import numpy
import pytest

import quadedge


@pytest.fixture(scope="module")
def walk(command, tmp_path_factory):
    """A recording of the room, long enough to learn from."""
    folder = tmp_path_factory.mktemp("walk") / "walk"
    command("synth", folder, "--frames", 64, "--size", "400x208", "--quiet")
    return folder


def test_a_sound_rig_stays_and_a_turned_camera_is_learned(walk, tmp_path):
    dataset, given = quadedge.open_dataset(walk), tmp_path / "given.yaml"
    sound = quadedge.calibrate(dataset, most_pairs=12)
    assert (sound.verdict, sound.frames) == ("as_good", 64) and "as good as given" in sound.text
    numpy.testing.assert_array_equal(sound.rig().right_from_left, dataset.rig.right_from_left)
    sound.write(given)
    assert quadedge.Rig.from_file(given).baseline == dataset.rig.baseline
    sound.write(tmp_path / "stereo.yml", "opencv")
    assert quadedge.Rig.from_file(tmp_path / "stereo.yml").baseline == dataset.rig.baseline
    with pytest.raises(quadedge.UsageError, match="matlab.*kalibr, native, opencv"):
        sound.write(tmp_path / "rig.txt", "matlab")

    turned = tmp_path / "turned.yaml"
    turned.write_text(re.sub(r"rotation: \[.*\]", "rotation: [0.0035, 0, 0]", given.read_text()))
    learned = quadedge.calibrate(quadedge.open_dataset(walk, calibration=turned), most_pairs=12)
    assert learned.verdict == "better" and learned.contradiction > 15 > sound.contradiction
    assert all(after < before for before, after in zip(learned.unseen_given, learned.unseen_learned))
    count = len(learned.numbers)
    assert learned.covariance.shape == (count, count) and learned.pairs < 24 and learned.points > 100
    for number, variance in zip(learned.numbers, learned.covariance.diagonal()):
        assert number.sigma == pytest.approx(variance**0.5) and number.is_open == (number.sigma >= 0.7 * number.prior)
    # Rotation and principal point of the right camera resemble one another: what counts is where it sees.
    centre = numpy.array([0.0, 0.0, 1.0])
    seen = [rig.right.matrix @ rig.right_from_left[:3, :3] @ centre
            for rig in (dataset.rig, quadedge.Rig.from_file(turned), learned.rig())]
    rows = [point[1] / point[2] for point in seen]
    assert abs(rows[1] - rows[0]) > 0.7 and abs(rows[2] - rows[0]) < 0.25


def test_what_cannot_be_learned_from(walk):
    still = quadedge.calibrate(quadedge.open_dataset(walk, last_frame=1))
    assert still.verdict == "cannot_show" and still.pairs == 0
    with pytest.raises(quadedge.UsageError, match="most_pairs 1: expected 2 or more"):
        quadedge.calibrate(quadedge.open_dataset(walk), most_pairs=1)
