"""Drawings of the final stereo edges of a frame over its image pair, as the paper's Figures 8 and 9 show them."""

import re
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from .counts import Tolerance
from .observer import CLASSES, FinalMatches, MatchingResult

DRAWINGS = (("correct", "correct stereo edges, each in one colour in both views, and three regions enlarged"),
            ("inaccurate", "inaccurate stereo edges and their true positions"),
            ("wrong", "wrong stereo edges and their true positions"))
MARKERS = {"inaccurate": "^", "wrong": "x", "occluded": "s"}
BRIGHTNESS, HALF_STROKE = 0.5, 0.6
"""HALF_STROKE: px of the image to either side of an edge."""
REGIONS, REGION_SHARE = 3, 6
"""Enlarged are three regions of a sixth of the image's width and height."""
WIDTH, DPI = 1900, 100
"""Of a drawing [px]; larger for larger images."""


def _colours(numbers: np.ndarray) -> np.ndarray:
    """Neighbours differ: a golden turn of the colour wheel from one match to the next."""
    return matplotlib.colormaps["hsv"](0.618034 * numbers % 1)


def _described(kind: str, tolerance: Tolerance) -> str:
    near, far = f"{tolerance.position:g} px", f"{tolerance.wrong:g} px"
    return {"correct": f"within {near} of their true positions",
            "inaccurate": f"{near} to {far} from their true positions (rings)",
            "wrong": f"more than {far} from their true positions (rings), or not visible in the right view "
                     "(squares)"}[kind]


def _busiest_regions(left: np.ndarray, shape: tuple[int, int]) -> list[tuple[int, int, int, int]]:
    """x, y, width, height of the regions of the left image with the most matches, apart from one another."""
    height, width = (max(1, size // REGION_SHARE) for size in shape)
    counted = [(int(_inside(left, (x, y, width, height)).sum()), x, y)
               for y in range(0, shape[0] - height + 1, max(1, height // 2))
               for x in range(0, shape[1] - width + 1, max(1, width // 2))]
    chosen = []
    for count, x, y in sorted(counted, key=lambda entry: -entry[0]):
        apart = all(abs(x - other[0]) >= width or abs(y - other[1]) >= height for other in chosen)
        if count and apart and len(chosen) < REGIONS:
            chosen.append((x, y, width, height))
    return chosen


def _inside(edges: np.ndarray, region) -> np.ndarray:
    x, y, width, height = region
    return (edges[:, 0] >= x) & (edges[:, 0] < x + width) & (edges[:, 1] >= y) & (edges[:, 1] < y + height)


def _show(axes, image: np.ndarray, region) -> None:
    x, y, width, height = region
    axes.imshow(image * BRIGHTNESS, cmap="gray", vmin=0, vmax=max(1, image.max()))
    axes.set(xlim=(x - 0.5, x + width - 0.5), ylim=(y + height - 0.5, y - 0.5))
    axes.set_axis_off()


def _draw(axes, edges: np.ndarray, kinds: np.ndarray, colours: np.ndarray, true: np.ndarray | None) -> None:
    """Strokes of correct edges (N, 3), markers of others, and lines to rings at their true positions (N, 2)."""
    strokes = kinds == CLASSES.index("correct")
    reach = HALF_STROKE * np.stack([np.cos(edges[:, 2]), np.sin(edges[:, 2])], axis=1)
    ends = np.stack([edges[:, :2] - reach, edges[:, :2] + reach], axis=1)
    axes.add_collection(LineCollection(ends[strokes], colors=colours[strokes], linewidths=1))
    for kind, marker in MARKERS.items():
        chosen = kinds == CLASSES.index(kind)
        axes.scatter(*edges[chosen, :2].T, c=colours[chosen], marker=marker, s=30, linewidths=1.5)
        if true is not None and kind != "correct":
            known = chosen & np.isfinite(true[:, 0])
            axes.add_collection(LineCollection(np.stack([edges[known, :2], true[known]], axis=1),
                                               colors=colours[known], linewidths=1))
            axes.scatter(*true[known].T, edgecolors=colours[known], facecolors="none", s=30)


def _draw_class(file: Path, images, matches: FinalMatches, kind: str, caption: str) -> None:
    colours = _colours(np.arange(len(matches.kind)))
    names = (kind, "occluded") if kind == "wrong" else (kind,)
    shown = np.isin(matches.kind, [CLASSES.index(name) for name in names])
    left, right, true, kinds, colours = (values[shown] for values in (matches.left, matches.right, matches.true,
                                                                      matches.kind, colours))
    regions = _busiest_regions(left, images[0].shape) if kind == "correct" else []
    width = max(WIDTH, sum(image.shape[1] for image in images)) / DPI
    scale = width / sum(image.shape[1] for image in images)
    heights = [scale * max(image.shape[0] for image in images)]
    if regions:
        heights.append(width / 6 * images[0].shape[0] / images[0].shape[1])
    figure = Figure(figsize=(width, sum(heights) + 0.3), dpi=DPI, facecolor="black", layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(len(heights), 6, height_ratios=heights)
    for part, image, edges, places in ((slice(0, 3), images[0], left, None), (slice(3, 6), images[1], right, true)):
        axes = figure.add_subplot(grid[0, part])
        _show(axes, image, (0, 0, image.shape[1], image.shape[0]))
        _draw(axes, edges, kinds, colours, places)
    for number, region in enumerate(regions):
        inside = _inside(left, region)
        moved = np.rint(np.median(right[inside, :2] - left[inside, :2], axis=0)).astype(int)
        for side, (image, edges, shift) in enumerate(((images[0], left, (0, 0)), (images[1], right, moved))):
            axes = figure.add_subplot(grid[1, 2 * number + side])
            _show(axes, image, (region[0] + shift[0], region[1] + shift[1], *region[2:]))
            _draw(axes, edges[inside], kinds[inside], colours[inside], None)
            figure.axes[side].add_patch(matplotlib.patches.Rectangle(
                (region[0] + shift[0], region[1] + shift[1]), *region[2:], fill=False, edgecolor="white"))
    figure.supxlabel(f"{caption}: {shown.sum()} stereo edges", color="white", fontsize=9)
    figure.savefig(file, facecolor="black")


def write_drawings(folder: Path, results: list[MatchingResult], tolerance: Tolerance) -> list[dict]:
    """Writes FOLDER/NAME_{correct,inaccurate,wrong}.png of the last frame of every result; the second result of one
    name gets a "_2". Returns name, file and caption of each."""
    folder.mkdir(parents=True, exist_ok=True)
    written, used = [], {}
    for result in results:
        name = re.sub(r"[^\w.-]", "_", result.name)
        used[name] = used.get(name, 0) + 1
        name += f"_{used[name]}" if used[name] > 1 else ""
        number, *images, matches = result.drawn
        for kind, caption in DRAWINGS:
            file = (folder / f"{name}_{kind}.png").resolve()
            _draw_class(file, images, matches, kind, f"{result.name}, frame {number}, {_described(kind, tolerance)}")
            written.append({"name": result.name, "file": str(file), "caption": f"{result.name}: {caption}"})
    return written
