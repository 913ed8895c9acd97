#!/usr/bin/env python3
"""Alters a small recording with scripts/disturb_recording.py and judges made-up trajectories with it.

test_disturb_recording.py SCRIPTS
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

SCRIPT = Path(sys.argv[1]) / "disturb_recording.py"
SIZE = (60, 160)  # rows, columns


def run(*options):
    command = [sys.executable, SCRIPT, *map(str, options)]
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout


def grey(path):
    return np.asarray(Image.open(path), float)


def make_recording(root):
    folder = root / "sequences" / "00"
    random = np.random.default_rng(3)
    for side in (0, 1):
        (folder / f"image_{side}").mkdir(parents=True)
        for frame in range(3):
            pixels = random.integers(0, 256, SIZE).astype(np.uint8)
            Image.fromarray(pixels).save(folder / f"image_{side}" / f"{frame:06d}.png")
    rows = [f"P{side}: 100 0 80 {shift} 0 100 30 0 0 0 1 0" for side, shift in ((0, 0), (1, -50))]
    (folder / "calib.txt").write_text("\n".join(rows) + "\n")
    (folder / "times.txt").write_text("0\n0.1\n0.2\n")


def check_board(root, photo):
    run("alter", root / "plain", root / "board", "--board", 0.25, "--speed", 4, "--photo", photo)
    images = [[grey(root / kind / f"sequences/00/image_{side}/{frame:06d}.png") for side in (0, 1) for frame in (0, 2)]
              for kind in ("plain", "board")]
    for plain, board in zip(*images):
        assert abs(np.mean(plain != board) - 0.25) < 0.03
    first, last, right, _ = images[1]
    # A quarter of the image in its middle; the right camera sees it 25 px farther left. It moves by 8 px in two frames.
    middle = slice(25, 35)
    assert np.abs(first[middle, 75:105] - right[middle, 50:80]).mean() < 4
    assert np.abs(first[middle, 75:105] - last[middle, 67:97]).mean() < 4
    assert np.abs(first[middle, 75:105] - last[middle, 75:105]).mean() > 10


def check_late_board(root, photo):
    run("alter", root / "plain", root / "late", "--board", 0.25, "--begin", 2, "--photo", photo)
    for frame, changes in enumerate((False, False, True)):
        file = f"sequences/00/image_1/{frame:06d}.png"
        assert np.any(grey(root / "late" / file) != grey(root / "plain" / file)) == changes


def check_bonnet(root):
    run("alter", root / "plain", root / "bonnet", "--bonnet", "--frames", "1:")
    still, later = (grey(root / f"bonnet/sequences/00/image_0/{frame:06d}.png") for frame in (0, 1))
    assert np.abs(still[30:] - later[30:]).mean() < 4
    assert np.array_equal(later[:30], grey(root / "plain/sequences/00/image_0/000002.png")[:30])


def check_late_camera(root):
    """The right images are those of one frame earlier than the left ones."""
    run("alter", root / "plain", root / "delayed", "--late", 1)
    for side, shift in ((0, 1), (1, 0)):
        for frame in (0, 1):
            assert np.array_equal(grey(root / f"delayed/sequences/00/image_{side}/{frame:06d}.png"),
                                  grey(root / f"plain/sequences/00/image_{side}/{frame + shift:06d}.png"))
    assert len(list((root / "delayed/sequences/00/image_0").iterdir())) == 2


def check_judge(root):
    def trajectory(name, positions):
        (root / name).mkdir(exist_ok=True)
        rows = [f"{frame} {x} 0 0 0 0 0 1" for frame, x in enumerate(positions)]
        (root / name / "trajectory.txt").write_text("\n".join(["# a comment", *rows]) + "\n")

    trajectory("truth", [0, 1, 2, 3, 4])
    trajectory("run", [0, 1.05, 1.5, 2, 3])
    states = [("first", 0), ("tracked", 0), ("tracked", 0), ("tracked", 1), ("lost_no_consensus", 0)]
    rows = [f"{frame},{status},{flag}" for frame, (status, flag) in enumerate(states)]
    (root / "run" / "frames.csv").write_text("\n".join(["stamp_s,status,ambiguous_motion", *rows]) + "\n")
    judged = run("judge", root / "run", root / "truth" / "trajectory.txt")
    assert judged.split() == "right 1 lost 1 flagged 1 unflagged 1".split(), judged
    rows = [f"{frame},lost_rig_mismatch,0" for frame in range(5)]
    (root / "run" / "frames.csv").write_text("\n".join(["stamp_s,status,ambiguous_motion", *rows]) + "\n")
    (root / "run" / "trajectory.txt").write_text("# no pose\n")
    judged = run("judge", root / "run", root / "truth" / "trajectory.txt")
    assert judged.split() == "right 0 lost 4 flagged 0 unflagged 0".split(), judged


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    make_recording(folder / "plain")
    ramp = np.add.outer(8 * np.sin(np.arange(90) / 3), 110 + 90 * np.sin(np.arange(120) / 4))
    Image.fromarray(ramp.astype(np.uint8)).save(folder / "photo.png")
    check_board(folder, folder / "photo.png")
    check_late_board(folder, folder / "photo.png")
    check_bonnet(folder)
    check_late_camera(folder)
    check_judge(folder)
print("fine")
