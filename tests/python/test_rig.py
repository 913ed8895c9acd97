"""Rigs from numbers and from calibration files."""

import numpy
import pytest

import quadedge

CAMERA = dict(fx=400.0, fy=401.0, cx=159.5, cy=99.5, width=320, height=200)


def right_from_left(baseline: float) -> numpy.ndarray:
    transform = numpy.eye(4)
    transform[0, 3] = -baseline
    return transform


def test_a_rig_from_numbers():
    camera = quadedge.PinholeCamera(**CAMERA)
    rig = quadedge.Rig(camera, camera, right_from_left(0.12))
    assert rig.baseline == 0.12 and rig.max_value == 255 and rig.left.width == 320
    numpy.testing.assert_array_equal(rig.right_from_left, right_from_left(0.12))
    numpy.testing.assert_array_equal(rig.left.matrix, [[400, 0, 159.5], [0, 401, 99.5], [0, 0, 1]])


@pytest.mark.parametrize("transform, words", [
    (right_from_left(0), "stereo rig: found a baseline of 0.000000 m, expected a finite positive length"),
    (numpy.diag([1.0, 1, -1, 1]), "right_from_left: found a matrix that is not a rigid transform"),
    (2 * numpy.eye(4), "right_from_left: found a matrix that is not a rigid transform"),
    (numpy.eye(3), "right_from_left: found 3 x 3 numbers, expected 4 x 4"),
])  # fmt: skip
def test_invalid_rigs_are_refused(transform, words):
    camera = quadedge.PinholeCamera(**CAMERA)
    with pytest.raises(quadedge.DataError, match=words):
        quadedge.Rig(camera, camera, transform)


@pytest.mark.parametrize("place", [(0, 3), (1, 3), (2, 3), (0, 0), (2, 1), (3, 0)])
def test_poses_of_a_trajectory_are_finite(place):
    poses = numpy.tile(numpy.eye(4), (3, 1, 1))
    whole = quadedge.Trajectory(numpy.arange(3), poses, numpy.array([0, 1, 1], numpy.int32))
    assert [list(part.stamps_ns) for part in whole.split()] == [[0], [1, 2]]
    poses[1][place] = numpy.nan
    with pytest.raises(quadedge.DataError, match="poses: found pose 1 that is not a rigid transform"):
        quadedge.Trajectory(numpy.arange(3), poses)


def test_the_flights_own_calibration_files(flight_folder):
    files = [flight_folder / "mav0" / camera / "sensor.yaml" for camera in ("cam0", "cam1")]
    rig, dataset = quadedge.Rig.from_file(files), quadedge.open_dataset(flight_folder)
    numpy.testing.assert_array_equal(rig.right_from_left, dataset.rig.right_from_left)
    assert rig.left.fx == dataset.rig.left.fx
    joined = quadedge.Rig.from_file(",".join(map(str, files)))
    numpy.testing.assert_array_equal(joined.right_from_left, rig.right_from_left)
    assert quadedge.Rig.from_file(files, size=(752, 480)).left.width == rig.left.width
    with pytest.raises(quadedge.DataError, match="size: found 640 x 480 pixels, expected 752 x 480, as .*sensor.yaml"):
        quadedge.Rig.from_file(files, size=(640, 480))
