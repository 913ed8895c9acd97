#!/usr/bin/env python3
"""Measures the distance of map points from the surfaces they lie on: for rendered scenes against exact depth, for
recorded pairs against true disparities.

    scripts/map_accuracy.py build/quadedge [--data FOLDER] [--frames N] [--scene NAME...]

FOLDER contains eth3d_two_view/ and middlebury_2003/, _2005/, _2014/ as published. Prints a Markdown table.

Rendered scenes: distance of a point from the plane through the nearest point of a rendered depth map of a key rig.
Pairs: stereo edges of `quadedge match` compared with the true disparity at their position, in pixels and relative to
the depth. At a depth discontinuity the nearer surface counts, because an occluding edge belongs to it.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

import numpy
from plyfile import PlyData
from scipy.spatial import cKDTree

DEPTH_STEP = 1.0  # px of disparity between two surfaces
REACH = 2  # px from an edge to the surface that it belongs to


def run(*call) -> None:
    subprocess.run([str(part) for part in call], check=True, stdout=subprocess.DEVNULL)


def read_pfm(file: Path) -> numpy.ndarray:
    with open(file, "rb") as stream:
        assert stream.readline().strip() == b"Pf", file
        width, height = map(int, stream.readline().split())
        order = "<" if float(stream.readline()) < 0 else ">"
        values = numpy.frombuffer(stream.read(), order + "f4", width * height)
    return values.reshape(height, width)[::-1].astype(float)


def read_grey(file: Path) -> numpy.ndarray:
    from PIL import Image

    return numpy.asarray(Image.open(file).convert("L"), float)


def rotation(x: float, y: float, z: float, w: float) -> numpy.ndarray:
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def surface(depth: numpy.ndarray, camera: numpy.ndarray, pose: numpy.ndarray) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Points and normals in the world of a depth map; without those beside a depth step, which have no normal."""
    fx, fy, cx, cy = camera
    y, x = numpy.mgrid[0:depth.shape[0], 0:depth.shape[1]]
    points = numpy.stack([(x - cx) / fx * depth, (y - cy) / fy * depth, depth], axis=-1)
    along_x, along_y = points[1:-1, 2:] - points[1:-1, :-2], points[2:, 1:-1] - points[:-2, 1:-1]
    normals = numpy.cross(along_x, along_y)
    inner = depth[1:-1, 1:-1]
    smooth = (inner > 0) & (numpy.linalg.norm(normals, axis=-1) > 0)
    for other in (depth[1:-1, 2:], depth[1:-1, :-2], depth[2:, 1:-1], depth[:-2, 1:-1]):
        smooth &= numpy.abs(other / numpy.maximum(inner, 1e-9) - 1) < 0.02
    points, normals = points[1:-1, 1:-1][smooth], normals[smooth]
    normals /= numpy.linalg.norm(normals, axis=-1, keepdims=True)
    turn = rotation(*pose[4:8])
    return points @ turn.T + pose[1:4], normals @ turn.T


def rendered(program: str, scene: str, frames: int, folder: Path) -> tuple[int, numpy.ndarray, numpy.ndarray]:
    """Distances of map points to the rendered surfaces [m], and those distances over the depth from the nearest rig."""
    data = folder / scene
    run(program, "synth", data, "--scene", scene, "--frames", frames, "--quiet")
    run(program, "run", data, "-o", folder / f"{scene}_out", "--map", folder / f"{scene}.ply", "--quiet")
    vertices = PlyData.read(folder / f"{scene}.ply")["vertex"]
    points = numpy.stack([vertices[axis] for axis in "xyz"], axis=-1)
    camera = numpy.loadtxt(data / "calibration.txt")
    poses = numpy.loadtxt(data / "groundtruth.txt")
    stamped = sorted((data / "depth").glob("*.pfm"), key=lambda file: float(file.stem))
    parts = [surface(read_pfm(stamped[i]), camera, poses[i]) for i in range(0, len(stamped), 5)]
    cloud, normals = (numpy.concatenate([part[k] for part in parts]) for k in (0, 1))
    _, nearest = cKDTree(cloud).query(points)
    distances = numpy.abs(numpy.sum((points - cloud[nearest]) * normals[nearest], axis=-1))
    depths = numpy.linalg.norm(points - poses[0, 1:4], axis=-1)
    return len(points), distances, distances / depths


def true_disparity(truth: numpy.ndarray, x: float, y: float) -> float:
    """Of the surface that an edge belongs to; NaN: not known."""
    column, row = int(round(x)), int(round(y))
    window = truth[max(row - REACH, 0):row + REACH + 1, max(column - REACH, 0):column + REACH + 1]
    window = window[numpy.isfinite(window) & (window > 0)]
    if window.size < (2 * REACH + 1) ** 2 // 2:
        return numpy.nan
    nearer = window.max()
    if nearer - window.min() <= DEPTH_STEP:
        middle = float(truth[row, column])
        return middle if numpy.isfinite(middle) and middle > 0 else numpy.nan
    return float(numpy.median(window[window > nearer - DEPTH_STEP]))


def pair(program: str, left: Path, right: Path, truth: numpy.ndarray, offset: float, folder: Path):
    """Errors of disparity [px] and of depth (as a part of it) of the stereo edges of a pair."""
    largest = numpy.nanmax(truth[numpy.isfinite(truth)]) + 2
    table = folder / "matches.csv"
    run(program, "match", left, right, "--max-disparity", largest, "--csv", table, "--force", "--quiet")
    rows = numpy.genfromtxt(table, delimiter=",", skip_header=1)
    found = rows[:, 0] - rows[:, 3]
    expected = numpy.array([true_disparity(truth, x, y) for x, y in rows[:, :2]])
    known = numpy.isfinite(expected)
    errors = numpy.abs(found - expected)[known]
    return int(known.sum()), errors, errors / (expected[known] + offset)


def recorded_pairs(data: Path):
    """Name, images, true disparities [px] and what disparities lack of those from infinity [px]."""
    terrace = data / "eth3d_two_view/two_view_training/terrace_2s"
    if terrace.exists():
        yield ("ETH3D terrace_2s", terrace / "im0.png", terrace / "im1.png",
               read_pfm(data / "eth3d_two_view/two_view_training_gt/terrace_2s/disp0GT.pfm"), 0.0)
    motorcycle = next(iter(sorted((data / "middlebury_2014").glob("Motorcycle*"))), None)
    if motorcycle:
        yield ("Middlebury Motorcycle", motorcycle / "im0.png", motorcycle / "im1.png",
               read_pfm(motorcycle / "disp0.pfm"), 31.086)
    for name in ("Art", "Dolls", "Laundry", "Reindeer"):
        scene = data / "middlebury_2005" / name
        if scene.exists():
            offset = float((scene / "dmin.txt").read_text()) / 3
            yield (f"Middlebury {name}", scene / "view1.png", scene / "view5.png",
                   read_grey(scene / "disp1.png") / 3, offset)
    teddy = data / "middlebury_2003/teddy"
    if teddy.exists():
        yield "Middlebury teddy", teddy / "im2.png", teddy / "im6.png", read_grey(teddy / "disp2.png") / 4, 0.0


def percentiles(values: numpy.ndarray) -> tuple[float, float]:
    return float(numpy.median(values)), float(numpy.percentile(values, 95))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--data", type=Path, help="folder of recorded pairs")
    parser.add_argument("--frames", type=int, default=60, help="frames per rendered scene")
    parser.add_argument("--scene", nargs="*", default=["room", "cables", "facade"])
    parser.add_argument("--json", type=Path, help="also write the figures as JSON")
    arguments = parser.parse_args()
    figures = {}
    print("| what | points | distance: median | 95 % | of the depth: median | 95 % |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene in arguments.scene:
            count, distances, parts = rendered(arguments.program, scene, arguments.frames, folder)
            figures[f"rendered {scene}"] = {"points": count, "unit": "m", "error": percentiles(distances),
                                            "of_depth": percentiles(parts)}
        for what, left, right, truth, offset in recorded_pairs(arguments.data) if arguments.data else ():
            count, errors, parts = pair(arguments.program, left, right, truth, offset, folder)
            figures[what] = {"points": count, "unit": "px", "error": percentiles(errors),
                             "of_depth": percentiles(parts)}
    for what, row in figures.items():
        metres = row["unit"] == "m"
        errors = [f"{1000 * value:.2f} mm" if metres else f"{value:.3f} px" for value in row["error"]]
        parts = [f"{100 * value:.2f} %" for value in row["of_depth"]]
        print(f"| {what} | {row['points']} | {errors[0]} | {errors[1]} | {parts[0]} | {parts[1]} |")
    if arguments.json:
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n")


if __name__ == "__main__":
    main()
