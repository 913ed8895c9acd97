#!/usr/bin/env python3
"""Writes altered copies of a recording, and judges the odometry's results on them.

    disturb_recording.py alter RECORDING OUT --board 0.4 --photo IMAGE [--speed 4] [--sequence 06] [--frames 40:100]
    disturb_recording.py alter RECORDING OUT --bonnet
    disturb_recording.py alter RECORDING OUT --late 1
    disturb_recording.py judge RUN TRUTH [--translation 0.01 0.1] [--rotation 0.3]

`alter` takes recordings in KITTI's and EuRoC's layout. A board shows a photograph with camera noise and covers a part
of both images, as a plane at one depth in front of the left camera does: --speed moves it by so many pixels per frame
to the left, 0 fixes it to the camera. With --bonnet the lower half of both images is the first frame's, with noise.
--late takes right images of that many frames earlier, as a camera does that is late (the left one's if negative).
`quadedge synth` renders other exposures.
`judge` compares the steps of RUN/trajectory.txt with those of TRUTH, a trajectory in TUM's format, such as that of the
undisturbed recording, and prints the numbers of steps that are right, lost, wrong and flagged (a frame of the step is
marked ambiguous), and wrong and not flagged. A step is wrong beyond a length plus a ratio of its length, or an angle.
Needs NumPy, Pillow and the package quadedge. Exit code: 0 done, 2 wrong usage.
"""

import argparse
import csv
import re
from pathlib import Path

import numpy as np
import quadedge
from PIL import Image

NOISE = 2.0  # grey levels
DISPARITY = 25.0  # of a board [px]


class Recording:
    """A recording in KITTI's layout, of rectified images, or in EuRoC's, with radial and tangential distortion."""

    def __init__(self, root, sequence):
        self.root, self.is_kitti = root, (root / "sequences").exists()
        dataset = quadedge.open_dataset(root, sequence if self.is_kitti else "")
        self.rig = dataset.rig
        self.files = [[Path(getattr(frame, side)) for frame in dataset.frames] for side in ("left", "right")]
        self.distortion = [(0, 0, 0, 0)] * 2
        if not self.is_kitti:
            texts = [(files[0].parent.parent / "sensor.yaml").read_text() for files in self.files]
            self.distortion = [[float(x) for x in re.search(r"distortion_coefficients: *\[([^]]*)", text)[1].split(",")]
                               for text in texts]

    def rays(self, side, shape):
        v, u = np.mgrid[:shape[0], :shape[1]]
        camera, (k1, k2, p1, p2) = (self.rig.left, self.rig.right)[side], self.distortion[side]
        recorded = (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy
        x, y = recorded
        for _ in range(20):
            r2 = x * x + y * y
            radial = 1 + k1 * r2 + k2 * r2 * r2
            x, y = ((recorded[0] - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial,
                    (recorded[1] - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial)
        return x, y

    def start(self, out, frames):
        """Makes the folders of both cameras, with the calibration and the times of these frames."""
        for files in self.files:
            folder, kept = files[0].parent.parent, {file.name for file in files[frames]}
            (out / files[0].parent.relative_to(self.root)).mkdir(parents=True)
            for name in ("calib.txt", "times.txt", "sensor.yaml", "data.csv"):
                if not (folder / name).exists():
                    continue
                lines = (folder / name).read_text().splitlines()
                if name == "times.txt":
                    lines = lines[frames]
                elif name == "data.csv":
                    lines = lines[:1] + [line for line in lines[1:] if line.split(",")[-1] in kept]
                (out / folder.relative_to(self.root) / name).write_text("\n".join(lines) + "\n")


def on_board(recording, side, shape):
    """Where the pixels' rays meet the plane of the board, in pixels of the left camera at the plane's depth."""
    x, y = recording.rays(side, shape)
    rig = recording.rig
    depth = rig.left.fx * rig.baseline / DISPARITY
    left_from_camera = np.eye(4) if side == 0 else np.linalg.inv(rig.right_from_left)
    rays = np.stack([x, y, np.ones_like(x)])
    rays = np.tensordot(left_from_camera[:3, :3], rays, 1)
    origin = left_from_camera[:3, 3]
    times = (depth - origin[2]) / rays[2]
    return [rig.left.fx * (origin[i] + times * rays[i]) / depth for i in (0, 1)]


def sample(photo, u, v):
    """The photograph, mirrored endlessly, by bilinear interpolation."""
    height, width = photo.shape
    fold = lambda x, size: np.abs((x % (2 * size - 2)) - (size - 1))
    u, v = fold(u, width), fold(v, height)
    c, r = np.minimum(u.astype(int), width - 2), np.minimum(v.astype(int), height - 2)
    a, b = u - c, v - r
    return ((1 - b) * ((1 - a) * photo[r, c] + a * photo[r, c + 1]) +
            b * ((1 - a) * photo[r + 1, c] + a * photo[r + 1, c + 1]))


def alter(args):
    recording = Recording(args.recording, args.sequence)
    frames = slice(*(int(x) if x else None for x in args.frames.split(":")))
    chosen = range(len(recording.files[0]))[frames]
    frames = slice(chosen.start, chosen.stop - abs(args.late))
    photo = np.asarray(Image.open(args.photo).convert("L"), float) if args.board else None
    recording.start(args.out, frames)
    random = np.random.default_rng(args.seed)
    for side, taken in enumerate(recording.files):
        still = places = None
        for number, file in enumerate(taken[frames]):
            source = taken[frames.start + number + max(args.late if side == 0 else -args.late, 0)]
            image = np.asarray(Image.open(source).convert("L"), float).copy()
            if still is None:
                still = image.copy()
                places = on_board(recording, side, image.shape) if args.board else None
            if args.board:
                reach = np.sqrt(args.board) / 2
                shown = ((number >= args.begin) &
                         (np.abs(places[0] - args.centre * image.shape[1]) < reach * image.shape[1]) &
                         (np.abs(places[1]) < reach * image.shape[0]))
                over = sample(photo, places[0] + args.speed * number + 50, places[1] + 70)
            else:
                shown, over = np.zeros(image.shape, bool), still
                shown[image.shape[0] // 2:] = args.bonnet
            noisy = over + random.normal(0, NOISE, image.shape)
            image[shown] = noisy[shown]
            name = f"{number:06d}.png" if recording.is_kitti else file.name
            stored = np.clip(np.rint(image), 0, 255).astype(np.uint8)
            Image.fromarray(stored).save(args.out / file.parent.relative_to(args.recording) / name)


def poses(path):
    """Time [ms] -> world_from_left of a trajectory in TUM's format."""
    trajectory = quadedge.Trajectory.from_file(path)
    return dict(zip(np.rint(trajectory.stamps_ns / 1e6), trajectory.poses))


def judge(args):
    with (args.run / "frames.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    is_tracked = any(row["status"] in ("first", "tracked") for row in rows)
    truth, found = poses(args.truth), poses(args.run / "trajectory.txt") if is_tracked else {}
    count = dict.fromkeys(("right", "lost", "flagged", "unflagged"), 0)
    for before, row in zip(rows, rows[1:]):
        times = [round(1e3 * float(each["stamp_s"])) for each in (before, row)]
        if any(time not in truth for time in times):
            continue
        if any(each["status"] not in ("first", "tracked") for each in (before, row)):
            count["lost"] += 1
            continue
        steps = [np.linalg.inv(poses_[times[0]]) @ poses_[times[1]] for poses_ in (truth, found)]
        error = np.linalg.inv(steps[0]) @ steps[1]
        limit = args.translation[0] + args.translation[1] * np.linalg.norm(steps[0][:3, 3])
        angle = np.degrees(np.arccos(np.clip((np.trace(error[:3, :3]) - 1) / 2, -1, 1)))
        is_right = np.linalg.norm(error[:3, 3]) <= limit and angle <= args.rotation
        flagged = any(each["ambiguous_motion"] == "1" for each in (before, row))
        count["right" if is_right else "flagged" if flagged else "unflagged"] += 1
    print(" ".join(f"{name} {number}" for name, number in count.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("alter")
    command.add_argument("recording", type=Path)
    command.add_argument("out", type=Path)
    kind = command.add_mutually_exclusive_group(required=True)
    kind.add_argument("--board", type=float, help="ratio of the image that it covers")
    kind.add_argument("--bonnet", action="store_true")
    kind.add_argument("--late", type=int, default=0, help="frames by which the right camera is late")
    command.add_argument("--photo", type=Path, help="shown by the board")
    command.add_argument("--speed", type=float, default=0, help="of the board [px per frame]")
    command.add_argument("--centre", type=float, default=0, help="of the board, from the optical axis [image widths]")
    command.add_argument("--begin", type=int, default=0, help="frame in which the board appears")
    command.add_argument("--sequence", default="00", help="of a KITTI recording")
    command.add_argument("--frames", default=":", help="BEGIN:END")
    command.add_argument("--seed", type=int, default=1)
    command.set_defaults(do=alter)
    command = commands.add_parser("judge")
    command.add_argument("run", type=Path)
    command.add_argument("truth", type=Path)
    command.add_argument("--translation", type=float, nargs=2, default=(0.01, 0.1), metavar=("METRES", "RATIO"))
    command.add_argument("--rotation", type=float, default=0.3, help="degrees")
    command.set_defaults(do=judge)
    args = parser.parse_args()
    args.do(args)


if __name__ == "__main__":
    main()
