"""Edges of an image, stereo edges of a pair and their points, quads."""

import numpy
import pytest

import quadedge


def test_edges_agree_with_the_command(command, room_folder, tmp_path):
    image = sorted((room_folder / "rgb").glob("*.png"))[0]
    command("edges", image, "--csv", tmp_path / "edges.csv", "--quiet")
    expected = numpy.loadtxt(tmp_path / "edges.csv", delimiter=",", skiprows=1)
    edges = quadedge.detect_edges(quadedge.read_grey_image(image))
    found = numpy.stack([edges.x, edges.y, edges.direction, edges.strength], axis=1)
    assert len(edges) == len(expected) > 500
    numpy.testing.assert_allclose(found, expected, atol=6e-7)  # six decimals


def test_a_device_can_be_reused(frames):
    device = quadedge.Device("auto")
    first, second = (quadedge.detect_edges(frames[0].left, device) for _ in range(2))
    numpy.testing.assert_array_equal(first.x, second.x)
    assert device.info.type in ("cpu", "gpu", "accelerator")


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
