"""Drawings of the final stereo edges of a frame over its image pair, as the paper's Figures 8 and 9 show them."""

import base64
import io

import numpy as np
import PIL.Image

from ..report.figure import GREY, Figure, every
from .counts import Tolerance
from .observer import CLASSES, MatchingResult

SYMBOLS = {"correct": "circle", "inaccurate": "triangle-up", "wrong": "x", "occluded": "square"}
BRIGHTNESS = 0.6
MOST_EDGES = 4000  # of a drawing


def _picture(left: np.ndarray, right: np.ndarray) -> str:
    """Both images side by side, darkened, as the address of a JPEG."""
    height = max(len(left), len(right))
    both = np.hstack([np.pad(image, ((0, height - len(image)), (0, 0))) for image in (left, right)])
    stream = io.BytesIO()
    grey = (both * (255 * BRIGHTNESS / max(1, both.max()))).astype(np.uint8)
    PIL.Image.fromarray(grey).save(stream, "JPEG", quality=70)
    return "data:image/jpeg;base64," + base64.b64encode(stream.getvalue()).decode()


def drawings(name: str, result: MatchingResult, tolerance: Tolerance) -> list[Figure]:
    """Correct, inaccurate and wrong stereo edges of the last frame, each in one colour in both views."""
    number, left, right, matches = result.drawn
    picture, width, height = _picture(left, right), left.shape[1], max(len(left), len(right))
    near, far = f"{tolerance.position:g} px", f"{tolerance.wrong:g} px"
    figures = []
    for kinds, text in ((["correct"], f"Correct: within {near} of their true positions"),
                        (["inaccurate"], f"Inaccurate: {near} to {far} from their true positions (rings)"),
                        (["wrong", "occluded"], f"Wrong: more than {far} from their true positions (rings), or not "
                                                "visible in the right view (squares)")):
        figure = Figure(f"{name}_{kinds[0]}", f"{text}; frame {number}", "", "", x_range=(0, width + right.shape[1]),
                        y_range=(height, 0), equal_units=True, wide=True, picture=picture)
        for kind in kinds:
            shown = np.nonzero(matches.kind == CLASSES.index(kind))[0]
            shown = shown[every(len(shown), MOST_EDGES)]
            colours = 0.618034 * shown % 1  # neighbours differ
            places = [matches.left[shown, :2], matches.right[shown, :2] + (width, 0)]
            if kind == "inaccurate" or kind == "wrong":
                places.append(matches.true[shown] + (width, 0))
                lines = np.stack([*places[1:], np.full_like(places[1], np.nan)], 1).reshape(-1, 2)
                figure.add("", *lines.T, style=GREY)
            for view, places_of in zip(("left", "right", "true position"), places):
                symbol = "circle-open" if view == "true position" else SYMBOLS[kind]
                figure.traces.append({"name": f"{kind}, {view} ({len(shown)})", "type": "scattergl", "mode": "markers",
                                      "x": places_of[:, 0], "y": places_of[:, 1], "hoverinfo": "skip",
                                      "marker": {"color": colours, "colorscale": "Rainbow", "size": 4,
                                                 "symbol": symbol}})
        figures.append(figure)
    return figures
