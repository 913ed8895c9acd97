"""Edges of an image, stereo edges of a pair and their points, quads."""

import numpy
import pytest

import quadedge


def test_edges_agree_with_the_command(command, room_folder, tmp_path):
    image, table = sorted((room_folder / "rgb").glob("*.png"))[0], tmp_path / "edges.csv"
    call = ("edges", image, "--csv", table, "--draw", tmp_path / "edges.png", "--quiet")
    command(*call)
    heading, *rows = table.read_text().splitlines()
    assert heading == "x,y,direction_rad,strength"
    assert {len(number.partition(".")[2]) for row in rows for number in row.split(",")} == {6}
    expected = numpy.loadtxt(table, delimiter=",", skiprows=1)
    edges = quadedge.detect_edges(quadedge.read_grey_image(image))
    found = numpy.stack([edges.x, edges.y, edges.direction, edges.strength], axis=1)
    assert len(edges) == len(expected) > 500
    numpy.testing.assert_allclose(found, expected, atol=6e-7)  # six decimals
    assert (found[:, :2] > 0).all() and (found[:, :2] < [319, 199]).all() and (abs(found[:, 2]) < 3.1416).all()
    assert (found[:, 3] > 1.9).all()  # the threshold applies at the pixel, the strength is that of the edge
    assert (tmp_path / "edges.png").stat().st_size > 1000
    command(*call, code=2)  # the files exist
    command("edges", image, "--csv", tmp_path / "absent" / "edges.csv", code=3)


def test_matches_agree_with_the_command(command, room_folder, tmp_path):
    left, right = (sorted((room_folder / side).glob("*.png"))[1] for side in ("rgb", "rgb2"))
    rig, table, cloud, picture = (tmp_path / name for name in ("rig.yaml", "m.csv", "m.ply", "m.png"))
    command("check", room_folder, "--write-calibration", rig, "--quiet")
    command("match", left, right, "--calibration", rig, "--csv", table, "--ply", cloud, "--draw", picture)
    assert table.read_text().splitlines()[0] == ("left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,"
                                                 "ncc,x_m,y_m,z_m")
    expected = numpy.genfromtxt(table, delimiter=",", skip_header=1)
    images = [quadedge.read_grey_image(file) for file in (left, right)]
    edges = quadedge.match(*images, quadedge.Rig.from_file(rig))
    found = numpy.column_stack([edges.left, edges.left_direction, edges.right, edges.right_direction, edges.ncc,
                                edges.xyz])
    numpy.testing.assert_allclose(found[:, :7], expected[:, :7], atol=6e-7)
    numpy.testing.assert_allclose(found[:, 7:], expected[:, 7:], rtol=1e-4, atol=6e-7)
    detected = quadedge.detect_edges(images[0])
    assert set(zip(edges.left[:, 0], edges.left[:, 1])) <= set(zip(detected.x, detected.y))
    points = numpy.isfinite(found[:, 9]).sum()
    assert points > len(found) / 2 and f"element vertex {points}\n".encode() in cloud.read_bytes()[:200]
    assert picture.read_bytes()[1:4] == b"PNG"
    # Rectified images without a calibration have matches but no points.
    call = ("match", left, right, "--stereo.max_disparity", 40, "--csv", tmp_path / "plain.csv")
    command(*call)
    plain = numpy.genfromtxt(tmp_path / "plain.csv", delimiter=",", skip_header=1)
    assert len(plain) > 200 and numpy.isnan(plain[:, 7:]).all()
    assert (plain[:, 0] - plain[:, 3] > -1).all() and (plain[:, 0] - plain[:, 3] < 41).all()
    command(*call, code=2)  # the file exists
    assert "--calibration" in command(*call[:-1], tmp_path / "o.csv", "--ply", tmp_path / "o.ply", code=2).stderr


@pytest.mark.parametrize("shape, depth, calibrated, words", [
    ((24, 32), "uint8", False, ("other.png", "24 rows")), ((200, 320), "uint16", False, ("other.png", "65535")),
    ((24, 32), "uint8", True, ("other.png", "32 x 24")), (None, "", False, ("other.png",))])
def test_images_that_are_no_pair_are_refused(command, room_folder, tmp_path, shape, depth, calibrated, words):
    import PIL.Image

    left, other, rig = sorted((room_folder / "rgb").glob("*.png"))[1], tmp_path / "other.png", tmp_path / "rig.yaml"
    command("check", room_folder, "--write-calibration", rig, "--quiet")
    if shape:
        PIL.Image.fromarray(numpy.zeros(shape, depth)).save(other)
    done = command("match", left, other, *(("--calibration", rig) if calibrated else ()), code=3)
    assert all(word in done.stderr for word in words)
    command("match", left, code=2)


def test_stereo_edges_agree_with_the_rendered_depth(room, frames):
    edges = quadedge.match(frames[0].left, frames[0].right, room)
    xyz, left, right = edges.xyz, edges.left, edges.right
    known = numpy.isfinite(xyz).all(axis=1)
    assert known.sum() > 300
    camera, baseline = room.rig.left, room.rig.baseline
    # The point lies on the left ray, at the depth given by the disparity.
    projected = xyz[known, :2] / xyz[known, 2:] * [camera.fx, camera.fy] + [camera.cx, camera.cy]
    numpy.testing.assert_allclose(projected, left[known], atol=1e-3)
    disparity = (left - right)[known, 0]
    numpy.testing.assert_allclose(xyz[known, 2], camera.fx * baseline / disparity, rtol=1e-4)
    depth = room.depth(0)
    columns, rows = numpy.rint(left[known]).astype(int).T
    error = numpy.abs(camera.fx * baseline / depth[rows, columns] - disparity)
    assert numpy.median(error) < 0.25  # px
    # Tangents are unit vectors that project to the edge's direction.
    tangent, angle = edges.direction[known], edges.left_direction[known]
    numpy.testing.assert_allclose(numpy.linalg.norm(tangent, axis=1), 1, atol=1e-9)
    ahead = xyz[known] + 1e-6 * tangent
    step = ahead[:, :2] / ahead[:, 2:] * [camera.fx, camera.fy] + [camera.cx, camera.cy] - projected
    numpy.testing.assert_allclose(numpy.cos(numpy.arctan2(step[:, 1], step[:, 0]) - angle), 1, atol=1e-3)


def test_quads_connect_the_edges_of_two_frames(room, frames):
    with quadedge.Odometry(room) as odometry:
        assert len(odometry.edges()) == 0
        for frame in frames[:2]:
            result = odometry.track(frame.stamp_ns, frame.left, frame.right)
        details = odometry.details()
        assert len(odometry.edges()) == len(details.stereo) == result.counts.stereo_edges
    quads = details.quads
    assert len(quads) == result.counts.quads and quads.inlier.dtype == bool
    assert quads.inlier.sum() == result.counts.inliers
    assert quads.previous.max() < len(details.previous_stereo) and quads.current.max() < len(details.stereo)
    # Inliers of the motion agree in space too.
    before = details.previous_stereo.xyz[quads.previous[quads.inlier]]
    motion = result.current_from_reference
    predicted = before @ motion[:3, :3].T + motion[:3, 3]
    away = numpy.linalg.norm(predicted - details.stereo.xyz[quads.current[quads.inlier]], axis=1)
    assert numpy.nanmedian(away / before[:, 2]) < 0.02


def test_no_edges_give_empty_results():
    edges = quadedge.detect_edges(numpy.zeros((50, 60), numpy.uint8))
    assert len(edges) == 0 and edges.x.shape == (0,)


def test_invalid_images_are_refused(frames):
    with pytest.raises(TypeError, match="the image is None"):
        quadedge.detect_edges(None)
    with pytest.raises(TypeError, match="device: expected"):
        quadedge.detect_edges(frames[0].left, device=3.5)
    with pytest.raises(quadedge.UsageError, match="the image has .* edges; edges.max_edges allows 1000"):
        quadedge.detect_edges(frames[0].left, config={"edges.max_edges": 1000, "edges.budget": 0, "edges.threshold": 1})
