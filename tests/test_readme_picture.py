#!/usr/bin/env python3
"""Draws the picture of the README from a small rendered sequence with scripts/readme_picture.py.

    test_readme_picture.py SCRIPT QUADEDGE
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

script, quadedge = sys.argv[1:]


def call(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)


with tempfile.TemporaryDirectory() as folder:
    yard, picture = Path(folder) / "yard", Path(folder) / "yard.webp"
    stamps = ("0.000000000", "0.050000000")
    points = ("--points", yard / "edges.ply", "--points-min-views", "1")
    for arguments in (
        ("synth", yard, "--scene", "yard", "--path", "drive", "--frames", "3", "--size", "480x249", "--quiet"),
        ("run", yard, *points, "-o", yard / "results", "--quiet"),
        *(("match", yard / f"rgb/{stamp}.png", yard / f"rgb2/{stamp}.png", "--csv", yard / f"edges_{stamp}.csv")
          for stamp in stamps),
    ):
        done = call(quadedge, *arguments)
        assert done.returncode == 0, done.stderr
    done = call(sys.executable, script, yard, picture, *stamps)
    assert done.returncode == 0, done.stderr
    animation = Image.open(picture)
    for number in range(2):
        animation.seek(number)
        pixels = np.asarray(animation.convert("RGB")).astype(int)
        assert pixels.shape == (400, 1200, 3), pixels.shape
        coloured = np.ptp(pixels, axis=2) > 60  # edges and points; the image itself is grey
        seam = round(480 / 249 * 400)
        assert coloured[:, :seam].mean() > 0.01 and coloured[:, seam:].mean() > 0.001, "no edges or no points"
        assert (pixels[:, seam:].min(axis=2) > 240).sum() > 20, "no path"

    (yard / f"edges_{stamps[1]}.csv").write_text("left_x,left_y,right_x\n")
    failed = call(sys.executable, script, yard, picture, *stamps)
    assert failed.returncode == 1 and "edges_" in failed.stderr, failed
    assert call(sys.executable, script, Path(folder) / "absent", picture, *stamps).returncode == 1
