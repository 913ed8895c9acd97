#!/usr/bin/env python3
"""Makes an animated image of a tracked sequence: edges and quads of every frame beside the path from above.

    quadedge demo --draw 1 -o demo          any run with ground truth and a drawing of every frame
    scripts/animate.py demo doc/demo.webp   --width, --every, --ms and --quality change size and speed

Needs Pillow 10.1 or newer, which build/venv contains (scripts/test.sh). The file extension selects the format: .webp,
.gif or .png.
Exit code: 0 done, 1 results missing or incomplete, 2 wrong usage.
"""

import argparse
import csv
import json
import sys
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

BACKGROUND, TRUTH, ESTIMATE, TEXT, FAINT = (16, 18, 22), (110, 116, 128), (253, 201, 60), (232, 234, 238), (60, 64, 72)


def read_positions(file):
    """Positions of a TUM file by time stamp: (x, z) [m], as seen from above."""
    rows = [line.split() for line in file.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {row[0]: (float(row[1]), float(row[3])) for row in rows}


def read_results(folder):
    """Reads everything that is drawn."""
    with open(folder / "report.json", encoding="utf-8") as file:
        report = json.load(file)
    with open(folder / "errors.csv", encoding="utf-8", newline="") as file:
        errors = [float(row["ape_translation_m"]) for row in csv.DictReader(file)]
    estimate = list(read_positions(folder / "trajectory.txt").values())
    truth = list(read_positions(folder / "groundtruth.txt").values())
    frames = report["input"]["frames"]
    if not len(estimate) == len(truth) == len(errors) == frames:
        raise ValueError(f"{folder}: expected a run that tracked all frames, with ground truth for each")
    return report, estimate, truth, errors


def to_panel(points, left, top, side, margin):
    """Maps metres to pixels with the same scale for both axes, z upwards."""
    xs, zs = [x for x, _ in points], [z for _, z in points]
    scale = (side - 2 * margin) / max(max(xs) - min(xs), max(zs) - min(zs), 1e-9)
    middle_x, middle_z = (max(xs) + min(xs)) / 2, (max(zs) + min(zs)) / 2
    return lambda point: (
        left + side / 2 + scale * (point[0] - middle_x),
        top + side / 2 - scale * (point[1] - middle_z),
    )


def draw_frame(frame, results, folder, width):
    """One frame of the animation: the camera's view with edges and quads, the path beside it."""
    report, estimate, truth, errors = results
    source = Image.open(folder / "pictures" / f"quads_{frame:06d}.png").convert("RGB")
    size = report["input"]
    view_height = round(width * size["height"] / size["width"])
    # Without the legend below the view.
    view = source.crop((0, 0, source.width, source.width * size["height"] // size["width"])).resize(
        (width, view_height), Image.LANCZOS
    )
    side = view_height * 3 // 4
    picture = Image.new("RGB", (width + side, view_height), BACKGROUND)
    picture.paste(view, (0, 0))
    draw = ImageDraw.Draw(picture)
    place = to_panel(truth + estimate, width, 0, side, side // 8)
    draw.line([place(point) for point in truth], fill=FAINT, width=5, joint="curve")
    if frame > 0:
        draw.line([place(point) for point in estimate[: frame + 1]], fill=ESTIMATE, width=2, joint="curve")
    x, y = place(estimate[frame])
    draw.ellipse((x - 4, y - 4, x + 4, y + 4), fill=ESTIMATE)
    steps = zip(estimate[:frame], estimate[1 : frame + 1])
    path = sum(((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5 for a, b in steps)
    font = ImageFont.load_default(max(10, view_height // 24))
    line = font.size * 1.45
    for row, (text, colour) in enumerate(
        (
            ("path from above", ESTIMATE),
            ("truth", TRUTH),
            (f"frame {frame + 1} of {size['frames']}", TEXT),
            (f"{path:.2f} m, off by {1000 * errors[frame]:.2f} mm", TEXT),
        )
    ):
        draw.text((width + 12, view_height - 12 - (4 - row) * line), text, fill=colour, font=font)
    return picture


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run with drawings of every frame")
    parser.add_argument("output", type=Path, metavar="OUT")
    parser.add_argument("--width", type=int, default=560, help="width of the camera's view [px]")
    parser.add_argument("--every", type=int, default=1, help="use every N-th frame")
    parser.add_argument("--ms", type=int, default=100, help="duration of each frame [ms]")
    parser.add_argument("--quality", type=int, default=40, help="quality of WebP, 0 to 100")
    return parser.parse_args()


def main():
    options = parse()
    try:
        results = read_results(options.run)
        frames = range(0, results[0]["input"]["frames"], options.every)
        pictures = [draw_frame(frame, results, options.run, options.width) for frame in frames]
    except (OSError, ValueError, KeyError) as problem:
        print(f"animate: {problem}", file=sys.stderr)
        return 1
    # The last frame is held before the animation repeats.
    durations = [options.ms] * (len(pictures) - 1) + [20 * options.ms]
    more = {"quality": options.quality, "method": 6} if options.output.suffix == ".webp" else {}
    pictures[0].save(options.output, save_all=True, append_images=pictures[1:], duration=durations, loop=0, **more)
    print(f"{len(pictures)} pictures, {options.output.stat().st_size / 1e6:.2f} MB in {options.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
