#!/usr/bin/env python3
"""Reads the map of a run with other libraries: the PLY file with plyfile, the COLMAP model with pycolmap.

    test_map_files.py QUADEDGE
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
import pycolmap
from plyfile import PlyData


def run(*call) -> None:
    subprocess.run([str(part) for part in call], check=True, stdout=subprocess.DEVNULL)


def check_ply(file: Path) -> int:
    vertices = PlyData.read(file)["vertex"]
    for name in "x y z tangent_x tangent_y tangent_z grey sigma views red green blue".split():
        assert numpy.isfinite(vertices[name]).all(), name
    tangents = numpy.stack([vertices[f"tangent_{axis}"] for axis in "xyz"])
    assert numpy.allclose(numpy.linalg.norm(tangents, axis=0), 1, atol=1e-5)
    assert vertices["views"].min() >= 2, "seen by fewer key rigs than required"
    assert (numpy.rint(vertices["grey"]) == vertices["red"]).all()
    # The room's first view shows depths of 1.3 to 5 m; few points may be wrong.
    low, high = numpy.percentile(vertices["z"], [1, 99])
    assert 1.2 < low and high < 7, (low, high)
    return len(vertices)


def check_colmap(folder: Path, points: int) -> None:
    model = pycolmap.Reconstruction(folder / "sparse/0")
    assert model.num_points3D() == points, (model.num_points3D(), points)
    assert model.num_cameras() == 2
    images = sorted(path.name for path in (folder / "images").iterdir())
    assert sorted(image.name for image in model.images.values()) == images
    errors = []
    for point in model.points3D.values():
        assert 2 <= point.track.length() <= 8
        for element in point.track.elements:
            image = model.images[element.image_id]
            place = image.points2D[element.point2D_idx]
            assert place.point3D_id in model.points3D
            projected = image.project_point(point.xyz)
            assert projected is not None, "a point behind a camera that saw it"
            errors.append(numpy.linalg.norm(projected - place.xy))
    assert numpy.median(errors) < 1, numpy.median(errors)
    # Both cameras see the same points, the right one through the calibration.
    left = next(image for image in model.images.values() if image.name.startswith("left"))
    right = next(image for image in model.images.values() if image.name == left.name.replace("left", "right"))
    point = next(iter(model.points3D.values())).xyz
    disparity = left.project_point(point)[0] - right.project_point(point)[0]
    assert disparity > 0, disparity


def main() -> None:
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(program, "synth", folder / "room", "--frames", 8, "--size", "320x200", "--quiet")
        run(program, "run", folder / "room", "-o", folder / "out", "--quiet", "--odometry.key_rig", "false", "--points",
            folder / "map.ply", "--points-colmap", folder / "colmap", "--points-min-views", 2)
        points = check_ply(folder / "map.ply")
        assert points > 300, points
        check_colmap(folder / "colmap", points)
        again = subprocess.run([program, "run", folder / "room", "-o", folder / "again", "--points",
                                folder / "map.ply"], capture_output=True, text=True)
        assert again.returncode == 2 and "map.ply" in again.stderr, again.stderr


main()
