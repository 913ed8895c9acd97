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
    street, picture = Path(folder) / "street", Path(folder) / "street.webp"
    stamp = "0.050000000"
    for arguments in (
        ("synth", street, "--scene", "facade", "--path", "drive", "--frames", "3", "--size", "480x249", "--quiet"),
        ("run", street, "--points", street / "edges.ply", "--points-min-views", "1", "-o", street / "results",
         "--quiet"),
        ("match", street / f"rgb/{stamp}.png", street / f"rgb2/{stamp}.png", "--csv", street / "edges.csv"),
    ):
        done = call(quadedge, *arguments)
        assert done.returncode == 0, done.stderr
    done = call(sys.executable, script, street, stamp, picture)
    assert done.returncode == 0, done.stderr
    pixels = np.asarray(Image.open(picture).convert("RGB")).astype(int)
    assert pixels.shape == (460, 1600, 3), pixels.shape
    coloured = np.ptp(pixels, axis=2) > 60  # edges and map points; the image itself is grey
    seam = round(480 / 249 * 460)
    assert coloured[:, :seam].mean() > 0.01, "no edges on the image"
    assert coloured[:, seam:].mean() > 0.001, "no map"
    assert (pixels[:, seam:].min(axis=2) > 240).sum() > 20, "no path"

    (street / "edges.csv").write_text("left_x,left_y,right_x\n")
    failed = call(sys.executable, script, street, stamp, picture)
    assert failed.returncode == 1 and "edges.csv" in failed.stderr, failed
    assert call(sys.executable, script, Path(folder) / "absent", stamp, picture).returncode == 1
