#!/usr/bin/env python3
"""Reads the points of a run with another library: the PLY file with plyfile.

    test_map_files.py QUADEDGE
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
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


def main() -> None:
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(program, "synth", folder / "room", "--frames", 8, "--size", "320x200", "--quiet")
        run(program, "run", folder / "room", "-o", folder / "out", "--quiet", "--odometry.key_rig", "false", "--points",
            folder / "map.ply", "--points-min-views", 2)
        points = check_ply(folder / "map.ply")
        assert points > 300, points
        again = subprocess.run([program, "run", folder / "room", "-o", folder / "again", "--points",
                                folder / "map.ply"], capture_output=True, text=True)
        assert again.returncode == 2 and "map.ply" in again.stderr, again.stderr


main()
