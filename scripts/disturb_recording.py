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
import shutil
from pathlib import Path

import numpy as np
import quadedge
from PIL import Image

NOISE = 2.0  # grey levels
DISPARITY = 25.0  # of a board [px]


def files(recording, side):
    return sorted((recording.root / recording.parts[side]).iterdir())


def transform(numbers):
    matrix = np.eye(4)
    matrix[:3, :4] = np.reshape(numbers, (-1, 4))[:3]
    return matrix


class Kitti:
    """A sequence in KITTI's layout: rectified images."""

    def __init__(self, root, sequence):
        self.parts = [Path("sequences") / sequence / f"image_{side}" for side in (0, 1)]
        self.root, self.folder = root, Path("sequences") / sequence
        text = (root / self.folder / "calib.txt").read_text().splitlines()
        projections = [np.reshape([float(x) for x in line.split()[1:]], (3, 4)) for line in text[:2]]
        self.focal = projections[0][0, 0]
        self.right_from_left = np.eye(4)
        self.right_from_left[0, 3] = projections[1][0, 3] / self.focal
        self.intrinsics = projections[0]

    def rays(self, side, shape):
        v, u = np.mgrid[:shape[0], :shape[1]]
        k = self.intrinsics
        return (u - k[0, 2]) / k[0, 0], (v - k[1, 2]) / k[1, 1]

    def start(self, out, frames):
        for part in self.parts:
            (out / part).mkdir(parents=True)
        shutil.copy(self.root / self.folder / "calib.txt", out / self.folder)
        times = (self.root / self.folder / "times.txt").read_text().splitlines()[frames]
        (out / self.folder / "times.txt").write_text("\n".join(times) + "\n")


class Euroc:
    """A sequence in EuRoC's layout: images with radial and tangential distortion."""

    def __init__(self, root, _):
        self.root = root
        self.parts = [Path(f"mav0/cam{side}/data") for side in (0, 1)]
        numbers = [{key: [float(x) for x in re.findall(r"[-+.\deE]+", value)] for key, value in re.findall(
            r"(?m)^ *(data|intrinsics|distortion_coefficients): *\[([^\]]*)\]",
            (root / part.parent / "sensor.yaml").read_text())} for part in self.parts]
        self.lens = [(each["intrinsics"], each["distortion_coefficients"]) for each in numbers]
        self.focal = numbers[0]["intrinsics"][0]
        body = [transform(each["data"]) for each in numbers]
        self.right_from_left = np.linalg.inv(body[1]) @ body[0]

    def rays(self, side, shape):
        v, u = np.mgrid[:shape[0], :shape[1]]
        (fu, fv, cu, cv), (k1, k2, p1, p2) = self.lens[side]
        recorded = (u - cu) / fu, (v - cv) / fv
        x, y = recorded
        for _ in range(20):
            r2 = x * x + y * y
            radial = 1 + k1 * r2 + k2 * r2 * r2
            x, y = ((recorded[0] - 2 * p1 * x * y - p2 * (r2 + 2 * x * x)) / radial,
                    (recorded[1] - p1 * (r2 + 2 * y * y) - 2 * p2 * x * y) / radial)
        return x, y

    def start(self, out, frames):
        for part in self.parts:
            (out / part).mkdir(parents=True)
            shutil.copy(self.root / part.parent / "sensor.yaml", out / part.parent)
            rows = (self.root / part.parent / "data.csv").read_text().splitlines()
            (out / part.parent / "data.csv").write_text("\n".join(rows[:1] + rows[1:][frames]) + "\n")


def on_board(recording, side, shape):
    """Where the pixels' rays meet the plane of the board, in pixels of the left camera at the plane's depth."""
    x, y = recording.rays(side, shape)
    depth = recording.focal * np.linalg.norm(recording.right_from_left[:3, 3]) / DISPARITY
    left_from_camera = np.eye(4) if side == 0 else np.linalg.inv(recording.right_from_left)
    rays = np.stack([x, y, np.ones_like(x)])
    rays = np.tensordot(left_from_camera[:3, :3], rays, 1)
    origin = left_from_camera[:3, 3]
    times = (depth - origin[2]) / rays[2]
    return [recording.focal * (origin[i] + times * rays[i]) / depth for i in (0, 1)]


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
    recording = (Kitti if (args.recording / "sequences").exists() else Euroc)(args.recording, args.sequence)
    frames = slice(*(int(x) if x else None for x in args.frames.split(":")))
    chosen = range(len(files(recording, 0)))[frames]
    frames = slice(chosen.start, chosen.stop - abs(args.late))
    photo = np.asarray(Image.open(args.photo).convert("L"), float) if args.board else None
    recording.start(args.out, frames)
    random = np.random.default_rng(args.seed)
    for side, part in enumerate(recording.parts):
        still = places = None
        taken = files(recording, side)
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
            name = file.name if isinstance(recording, Euroc) else f"{number:06d}.png"
            stored = np.clip(np.rint(image), 0, 255).astype(np.uint8)
            Image.fromarray(stored).save(args.out / part / name)


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
