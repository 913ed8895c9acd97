"""Ground truth of edges: surfaces, the positions in other views, and recordings."""

import numpy
import PIL.Image
import pytest
import quadedge
from matching_scene import floats
from quadedge.matching.sources import RecordedSource, read_float_map
from quadedge.matching.surfaces import (OCCLUDED, UNKNOWN, VISIBLE, FrameTruth, from_depth, nearest, nearness,
                                        right_from_left, surface_at, true_later_positions, true_right_positions,
                                        visibility)
from types import SimpleNamespace

VERTICAL, WIDTH, HEIGHT = numpy.pi / 2, 48, 24


def surface(width, height, value):
    rows, columns = numpy.mgrid[:height, :width]
    return (value(columns, rows) + numpy.zeros((height, width))).astype(numpy.float32)


def at(values, x, y, direction):
    found, contour = surface_at(values, *(numpy.array([number], float) for number in (x, y, direction)))
    return found[0], contour[0]


def edges(x, y, direction=VERTICAL):
    return SimpleNamespace(x=floats(x), y=floats(y), direction=floats(numpy.full(len(x), direction)))


BOARD = surface(40, 30, lambda x, y: numpy.where(x <= 15, 20, 5))
"""A board (20 px) left of column 15.5 in front of a wall (5 px)."""


def test_a_slanted_surface_is_interpolated_exactly():
    found, contour = at(surface(40, 30, lambda x, y: 10 + 0.3 * x - 0.2 * y), 12.37, 17.81, 0.4)
    assert found == pytest.approx(10 + 0.3 * 12.37 - 0.2 * 17.81, abs=1e-5) and not contour


@pytest.mark.parametrize("x", [14.6, 15.4, 16.0, 16.8])
def test_an_edge_on_a_depth_step_belongs_to_the_nearer_surface(x):
    assert at(BOARD, x, 12.3, VERTICAL) == (pytest.approx(20), True)


def test_away_from_a_depth_step_an_edge_belongs_to_its_side_and_just_beside_it_has_no_depth():
    assert at(BOARD, 13.2, 12, VERTICAL) == (20, False)
    assert numpy.isnan(at(BOARD, 17.7, 12, VERTICAL)[0])
    assert at(BOARD, 19, 12, VERTICAL) == (5, False)


def test_a_depth_step_at_the_end_of_an_edge_does_not_affect_its_depth():
    assert at(BOARD, 15.3, 12.5, 0) == (pytest.approx(20), False)
    assert at(BOARD, 15.8, 12.5, 0) == (pytest.approx(5), False)


def test_an_edge_next_to_an_unknown_pixel_has_no_depth():
    gap = surface(40, 30, lambda x, y: numpy.where(x == 20, numpy.nan, 5))
    assert numpy.isnan([at(gap, x, 12, VERTICAL)[0] for x in (20.2, 21.2)]).all()
    assert at(gap, 22.4, 12, VERTICAL)[0] == at(gap, 21.2, 12, 0)[0] == 5


def test_infinite_and_missing_values_are_unknown():
    numpy.testing.assert_array_equal(nearness(2 * floats([2.5, numpy.inf, 0, -1])), floats([5, *[numpy.nan] * 3]))
    numpy.testing.assert_array_equal(from_depth(floats([0, 4]), 30), floats([numpy.nan, 7.5]))


def test_a_point_is_visible_occluded_by_a_nearer_surface_or_contradicted():
    def state(values, x, y, value):
        return visibility(values, *(numpy.array([number], float) for number in (x, y, value)))[0]

    assert state(BOARD, 10, 10, 20.6) == VISIBLE
    assert state(BOARD, 10, 10, 5) == OCCLUDED
    assert state(BOARD, 30, 10, 20) == UNKNOWN
    assert state(BOARD, -0.5, 10, 20) == OCCLUDED
    assert state(surface(9, 9, lambda x, y: numpy.nan), 4, 4, 5) == UNKNOWN


def test_in_the_right_view_a_board_occludes_the_part_of_the_wall_beside_it():
    # Columns 20 to 29 of the left view show a board of 8 px, the rest a wall of 2 px: the board covers 12 to 21.
    left = surface(60, 9, lambda x, y: numpy.where((x >= 20) & (x < 30), 8, 2))
    right = right_from_left(left, 60)
    numpy.testing.assert_array_equal(right[4, :50], [*[2] * 12, *[8] * 10, *[numpy.nan] * 6, *[2] * 22])
    # The wall's column 16 maps to column 14, behind the board; column 10 to 8, beside it.
    truth = FrameTruth(left, right, right_is_measured=False)
    found = true_right_positions(None, truth, edges([16, 10, 35], [4] * 3, 0))
    assert found.state.tolist() == [OCCLUDED, VISIBLE, VISIBLE] and found.x[1] == 8


def test_gaps_of_a_slanted_surface_are_filled():
    # Disparity 10 - x / 2: column x maps to 1.5 x - 10, and what lies between is interpolated.
    right = right_from_left(surface(20, 3, lambda x, y: 10 - x / 2), 20)
    assert right[1, 2] == 6 and right[1, 5] == 5 and right[1, 3] == pytest.approx(6 - 1 / 3, abs=0.5)
    assert not numpy.isnan(right[1, :18]).any()


def test_a_point_of_known_depth_is_located_after_a_known_motion():
    camera, pose, moved, scale = quadedge.PinholeCamera(200, 200, 49.5, 39.5, 100, 80), numpy.eye(4), numpy.eye(4), 20
    pose[0, 3] = -0.1
    moved[:3, 3] = 0.1, 0, 0.4  # the wall, 2 m away, is 1.6 m away now
    rig, wall = quadedge.Rig(camera, camera, pose), surface(100, 80, lambda x, y: scale / 2)
    before = FrameTruth(wall, wall, depth_scale=scale, world_from_left=numpy.eye(4))
    seen = surface(100, 80, lambda x, y: numpy.where(x < 20, 2 * scale / 1.6, scale / 1.6))  # a nearer obstacle
    now = FrameTruth(seen, seen, depth_scale=scale, world_from_left=moved)
    where = edges([59.5, 36.5], [49.5, 39.5], 1.5)
    left, right = (true_later_positions(rig, before, now, side, where) for side in ("left", "right"))
    # Offsets from the principal point: X = 10 px * 2 m / 200 px = 0.1 m, minus 0.1 m; Y = 0.1 m; then the right camera
    # 0.1 m farther.
    assert (left.x[0], left.y[0], left.state[0]) == (49.5, 39.5 + 200 * 0.1 / 1.6, VISIBLE)
    assert right.x[0] == 49.5 - 200 * 0.1 / 1.6
    # X = -13 px * 2 m / 200 px - 0.1 m = -0.23 m: column 49.5 - 28.75 = 20.75 in the left view, 8.25 behind the
    # obstacle in the right.
    assert (left.x[1], left.state[1], right.state[1]) == (20.75, VISIBLE, OCCLUDED)
    stereo = true_right_positions(rig, before, where)
    assert (stereo.x[0], stereo.y[0]) == (49.5, 49.5)


def write_map(file, values):
    file.write_bytes(b"Pf\n%d %d\n-1\n" % values.shape[::-1] + values[::-1].astype("<f4").tobytes())


def write_picture(file, values):
    file.parent.mkdir(parents=True, exist_ok=True)
    PIL.Image.fromarray(numpy.asarray(values, numpy.uint8)).save(file)


@pytest.fixture
def pair(tmp_path):
    """An ETH3D pair of a wall at 6 px, with a board at 12 px in columns 30 to 39 of the left view."""
    folder = tmp_path / "two_view_training" / "scene"
    for name in ("im0.png", "im1.png"):
        write_picture(folder / name, numpy.full((HEIGHT, WIDTH), 90))
    (folder / "calib.txt").write_text(f"cam0=[100 0 24; 0 100 12; 0 0 1]\ncam1=[100 0 24; 0 100 12; 0 0 1]\n"
                                      f"baseline=60\nwidth={WIDTH}\nheight={HEIGHT}\n")
    write_map(folder / "disp0GT.pfm", surface(WIDTH, HEIGHT, lambda x, y: numpy.where((x >= 30) & (x < 40), 12, 6)))
    return folder


def positions(folder, x):
    source = RecordedSource(quadedge.open_dataset(folder))
    return true_right_positions(source.rig, source.load(0).truth, edges(x, [12] * len(x)))


def test_without_a_mask_occlusion_follows_from_the_disparities(pair):
    # Column 25 of the wall maps to column 19 of the right view, which shows the board (30 - 12 = 18 to 27).
    found = positions(pair, [20, 25, 35, 12])
    assert found.state.tolist() == [VISIBLE, OCCLUDED, VISIBLE, VISIBLE] and (found.x[0], found.x[2]) == (14, 23)


def test_a_mask_marks_occluded_and_unknown_pixels_but_not_the_contour_of_a_nearer_surface(pair):
    mask = numpy.full((HEIGHT, WIDTH), 255)
    mask[:, [20, 29]], mask[:, 12] = 128, 0  # column 29: the wall just beside the board, which occludes it
    write_picture(pair / "mask0nocc.png", mask)
    # 12: unknown; 13: next to an unknown pixel; 16: neither; 20: occluded; 29.4: the board's contour, though marked.
    found = positions(pair, [12, 13, 16, 20, 29.4])
    assert found.state.tolist() == [UNKNOWN, UNKNOWN, VISIBLE, OCCLUDED, VISIBLE]
    assert found.contour[4] and found.x[4] == pytest.approx(29.4 - 12)
    write_picture(pair / "mask0nocc.png", mask[:, 1:])
    with pytest.raises(quadedge.DataError, match="mask0nocc.png: found 47 x 24 values, expected 48 x 24"):
        positions(pair, [12])


def test_where_the_views_disagree_measured_disparities_of_the_right_view_decide(pair):
    write_map(pair / "disp1GT.pfm", surface(WIDTH, HEIGHT, lambda x, y: 20))  # neither the wall nor the board
    assert positions(pair, [16, 35]).state.tolist() == [OCCLUDED, OCCLUDED]


def test_a_sequence_of_pairs_has_disparities_of_every_frame_and_with_poses_depths(pair, tmp_path):
    for name, disparity, z in (("1000000000.0", 6, "0"), ("1000000000.1", 5, "0.2")):
        folder = tmp_path / "scene" / "stereo_pairs" / name
        for file in ("im0.png", "im1.png", "calib.txt"):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / file).write_bytes((pair / file).read_bytes())
        write_map(folder / "disp0GT.pfm", surface(WIDTH, HEIGHT, lambda x, y: disparity))
        (folder / "images.txt").write_text(f"1 1 0 0 0 0 0 {z} 1 im0.png\n")
    source = RecordedSource(quadedge.open_dataset(tmp_path / "scene"))
    first, second = (source.load(number).truth for number in (0, 1))
    assert nearest(first.left, *floats([[4], [2]])) == 6 and nearest(second.left, *floats([[4], [2]])) == 5
    # The wall at 100 x 0.06 / 6 = 1 m is seen from 0.2 m farther back, at 1.2 m: column 36 moves to 24 + 12 / 1.2.
    later = true_later_positions(source.rig, first, second, "left", edges([36], [12]))
    assert later.x[0] == pytest.approx(34) and later.state[0] == VISIBLE
    (tmp_path / "scene" / "stereo_pairs" / "1000000000.1" / "disp0GT.pfm").unlink()
    with pytest.raises(quadedge.DataError, match="1000000000.1/disp0GT.pfm: No such file"):
        source.load(1)


@pytest.mark.parametrize("content, words", [
    (b"", "cannot identify image file"),
    (b"P5\n2 1\n255\n12", "its pixels are of the mode L, expected a PFM file of one float per pixel"),
    (b"Pf\n2 1\n-1\n1234", "truncated"),
    (b"Pf\n0 1\n-1\n", "expected a PFM file"),
])  # fmt: skip
def test_damaged_maps_are_refused(tmp_path, content, words):
    (tmp_path / "m.pfm").write_bytes(content)
    with pytest.raises(quadedge.DataError, match=words):
        read_float_map(tmp_path / "m.pfm")


def test_maps_of_both_byte_orders_are_read_from_the_bottom_up(tmp_path):
    for sign, order in ((1, ">"), (-0.5, "<")):
        (tmp_path / "m.pfm").write_bytes(b"Pf\n2 2\n%g\n" % sign + numpy.array([3, 4, 1, 2], order + "f4").tobytes())
        assert read_float_map(tmp_path / "m.pfm").tolist() == [[1, 2], [3, 4]]
