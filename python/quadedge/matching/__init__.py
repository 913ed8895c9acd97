"""Evaluates every filter of the matching against ground truth of the edges: the paper's Tables 1 to 3.

``python -m quadedge.matching PATH`` prints the tables; doc/matching.md defines their terms. The candidates that a
filter leaves are seen through a Tap; the pipeline never sees the ground truth.
"""

import os

from .. import Device, configuration
from ..errors import UsageError
from .counts import Tolerance
from .document import document
from .observer import observe
from .sources import open_source

__all__ = ["evaluate_matching"]


def evaluate_matching(source, device: str | int | Device = "auto", preset: str = "default",
                      config: dict | str | os.PathLike | None = None, frames: int = 0) -> dict:
    """Measures recall, precision and ambiguity after every filter of the matching.

    source: a Dataset with disparities, or with depths and poses, or a Synthetic.
    frames: number of frames to evaluate, from the first one; 0: all.
    device, preset, config: as in Odometry; device may also be a Device, which names the one to open.

    Returns the document that ``python -m quadedge.matching --json`` writes. Raises TypeError for another source,
    DataError for a recording without ground truth of edges, and what Odometry raises.
    """
    if frames < 0:
        raise UsageError(f"frames is {frames}: expected 0 or more")
    if isinstance(device, Device):
        device = device.info.index if device.info.index >= 0 else "reference"
    values = configuration(preset, config)
    result, info = observe(open_source(source), device, preset, values, frames, Tolerance())
    return document([result], info, values, [result.name])
