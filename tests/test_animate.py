#!/usr/bin/env python3
"""Makes an animation of a small run with scripts/animate.py.

    test_animate.py SCRIPT QUADEDGE
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

script, quadedge = sys.argv[1:]


def animate(*options):
    return subprocess.run(
        [sys.executable, script, *map(str, options)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        check=False
    )


with tempfile.TemporaryDirectory() as folder:
    run, picture = Path(folder) / "run", Path(folder) / "demo.webp"
    demo = [quadedge, "demo", "-o", run, "--frames", "3", "--size", "320x200", "--draw", "1", "--quiet"]
    subprocess.run(demo, check=True, stdout=subprocess.DEVNULL)
    done = animate(run, picture, "--width", 160)
    assert done.returncode == 0, done.stderr
    with Image.open(picture) as animation:
        # The view keeps its aspect ratio; the path is drawn in a square of three quarters of the height.
        assert (animation.n_frames, animation.size) == (3, (160 + 75, 100)), (animation.n_frames, animation.size)
        frames = []
        for index in range(3):
            animation.seek(index)
            frames.append(animation.convert("RGB").crop((160, 0, 235, 75)).tobytes())
        assert len(set(frames)) == 3, "the path does not move"

    (run / "pictures/quads_000001.png").unlink()
    failed = animate(run, picture)
    assert failed.returncode == 1 and "quads_000001.png" in failed.stderr, failed
    assert animate(Path(folder) / "absent", picture).returncode == 1
