#!/usr/bin/env python3
"""Draws the picture of the README: stereo edges of a frame beside edges in space and the path so far; animated if there
are several frames.

    quadedge synth yard --scene yard --path drive --frames 103
    quadedge run yard --points yard/edges.ply -o yard/results
    stamps="$(seq -f %.9f 0.25 0.3 4.9)"
    for stamp in $stamps; do
      quadedge match yard/rgb/$stamp.png yard/rgb2/$stamp.png --stereo.max_disparity 120 --csv yard/edges_$stamp.csv
    done
    scripts/readme_picture.py yard doc/yard.webp $stamps

Needs matplotlib, Pillow and plyfile (tests/requirements.txt).
Exit code: 0 done, 1 a file is missing or empty, 2 wrong usage.
"""

import argparse
import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image
from plyfile import PlyData

BACKGROUND, PATH = "#0d1117", "#ffffff"
WIDTH, HEIGHT, DPI = 16.0, 16 / 3, 75  # of the picture [inch], pixels per inch
EYE, TARGET = np.array([10.0, -10.0, -9.0]), np.array([-0.3, -0.5, 11.0])  # of the view on the points [m]
FARTHEST = 14  # beside the path [m] that points are shown
STEP_MS, LAST_MS = 250, 2000  # how long frames of the animation are shown


def read_stereo_edges(file):
    """(n, 3): x and y in the left image, disparity [px]."""
    with open(file, encoding="utf-8", newline="") as rows:
        edges = [[float(row[name]) for name in ("left_x", "left_y", "right_x")] for row in csv.DictReader(rows)]
    if not edges:
        raise ValueError(f"{file}: expected at least one stereo edge")
    return np.array(edges) @ np.array([[1, 0, 1], [0, 1, 0], [0, 0, -1]])


def project(points):
    """Perspective view from EYE towards TARGET: (n, 2) in units of the focal length, y down; y of `points` is down."""
    forward = (TARGET - EYE) / np.linalg.norm(TARGET - EYE)
    right = np.cross(forward, [0, -1, 0])
    right /= np.linalg.norm(right)
    seen = (points - EYE) @ np.stack([right, np.cross(forward, right), forward]).T
    return seen[:, :2] / seen[:, 2:], seen[:, 2]


def draw_view(figure, image, edges):
    """The left image with its stereo edges coloured by disparity. Returns the part of the width that it takes."""
    height, width = image.shape
    share = width / height * HEIGHT / WIDTH
    axes = figure.add_axes((0, 0, share, 1))
    axes.axis("off")
    axes.imshow(image, cmap="gray", vmin=-60, vmax=255)
    low, high = np.percentile(edges[:, 2], (2, 98))
    axes.scatter(edges[:, 0], edges[:, 1], s=4, c=edges[:, 2], cmap="turbo", linewidths=0, vmin=low, vmax=high)
    axes.set(xlim=(0, width - 1), ylim=(height - 1, 0))
    return share


def draw_points(figure, share, points, path, done):
    """The points in space coloured by the distance from the start, and the first `done` poses of the path."""
    axes = figure.add_axes((share, 0, 1 - share, 1))
    axes.axis("off")
    points = points[np.abs(points[:, 0]) < FARTHEST]
    places, depth = project(points)
    order = np.argsort(-depth)[: np.count_nonzero(depth > 1)]
    axes.scatter(*places[order].T, s=2, c=points[order, 2], cmap="turbo_r", linewidths=0, alpha=0.9)
    track, _ = project(path)
    axes.plot(*track[:done].T, color=PATH, lw=4)
    axes.plot(*track[done - 1], "o", color=PATH, ms=11)
    shown = np.concatenate([np.percentile(places[order], (1, 99), axis=0), track])
    (left, top), (right, bottom) = shown.min(axis=0), shown.max(axis=0)
    half_width = max((right - left) / 2, (bottom - top) / 2 * (1 - share) * WIDTH / HEIGHT)  # with one scale for both
    half_height = half_width * HEIGHT / WIDTH / (1 - share)
    x, y = (left + right) / 2, (top + bottom) / 2
    axes.set(xlim=(x - half_width, x + half_width), ylim=(y + half_height, y - half_height))


def draw(sequence, stamp, points, poses):
    """One frame of the animation. `points`: (n, 3); `poses`: rows of trajectory.txt."""
    image = np.asarray(Image.open(sequence / "rgb" / f"{stamp}.png").convert("L"))
    figure = plt.figure(figsize=(WIDTH, HEIGHT), dpi=DPI, facecolor=BACKGROUND)
    share = draw_view(figure, image, read_stereo_edges(sequence / f"edges_{stamp}.csv"))
    draw_points(figure, share, points, poses[:, 1:4], max(np.count_nonzero(poses[:, 0] < float(stamp) + 1e-6), 1))
    figure.canvas.draw()
    picture = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    plt.close(figure)
    return picture


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sequence", type=Path, help="rendered sequence, with results/, edges.ply and edges_STAMP.csv")
    parser.add_argument("output", type=Path, help="picture to write; its suffix is the format")
    parser.add_argument("stamps", nargs="+", help="stamps of the frames shown, as in their file names")
    options = parser.parse_args()
    try:
        vertices = PlyData.read(options.sequence / "edges.ply")["vertex"]
        points = np.stack([vertices[axis] for axis in "xyz"], 1)
        poses = np.loadtxt(options.sequence / "results" / "trajectory.txt", ndmin=2)
        pictures = [draw(options.sequence, stamp, points, poses) for stamp in options.stamps]
    except (OSError, ValueError, KeyError) as problem:
        print(f"readme_picture: {problem}", file=sys.stderr)
        return 1
    durations = [STEP_MS] * (len(pictures) - 1) + [LAST_MS]
    pictures[0].save(options.output, quality=75, method=6, save_all=True, append_images=pictures[1:], loop=0,
                     duration=durations)
    return 0


if __name__ == "__main__":
    sys.exit(main())
