"""Pairs and sequences with ground truth of every frame."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import PIL.Image

from .. import Dataset, Synthetic, read_grey_image
from ..errors import DataError
from .surfaces import FrameTruth, from_depth, nearness, right_from_left

MASK_UNKNOWN, MASK_OCCLUDED = 0, 128
"""Values of mask0nocc.png, whose third, 255, means visible in both views."""
COMPANIONS = {"disp0GT.pfm": ("disp1GT.pfm", "mask0nocc.png"), "disp0.pfm": ("disp1.pfm", "mask0nocc.png"),
              "disp1.png": ("disp5.png", None), "disp2.png": ("disp6.png", None)}
"""Disparities of the left view in the published layouts: those of the right view, and the mask, beside them."""


@dataclass
class TrueFrame:
    """One frame with its ground truth."""

    stamp_ns: int
    left: np.ndarray
    right: np.ndarray
    truth: FrameTruth


def read_float_map(file: Path) -> np.ndarray:
    """A PFM file, (height, width) float32, top row first. The size of its scale is left alone, as published maps hold
    pixels or metres whatever it is. Raises DataError."""
    try:
        with PIL.Image.open(file, formats=["PPM"]) as opened:
            if opened.mode != "F":
                raise ValueError(f"its pixels are of the mode {opened.mode}")
            return np.array(opened, np.float32)
    except (OSError, SyntaxError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or problem
        raise DataError(f"{file}: {reason}, expected a PFM file of one float per pixel") from problem


def _check_size(values: np.ndarray, camera, file: Path) -> np.ndarray:
    if values.shape != (camera.height, camera.width):
        raise DataError(f"{file}: found {values.shape[1]} x {values.shape[0]} values, expected {camera.width} x "
                        f"{camera.height} as in the image")
    return values


def _depth_file(image: str) -> Path | None:
    """depth/NAME.pfm for rgb/NAME.png, depth2/NAME.pfm for rgb2/NAME.png."""
    path = Path(image)
    if not path.parent.name.startswith("rgb"):
        return None
    return path.parent.parent / f"depth{path.parent.name[3:]}" / f"{path.stem}.pfm"


class RecordedSource:
    """A Dataset whose frames have disparities, or depths and poses (the layout written by `quadedge synth`).

    Raises DataError if it has neither, or if its images are distorted."""

    def __init__(self, dataset):
        depths = [_depth_file(image) for image in (dataset.frames[0].left, dataset.frames[0].right)]
        if not dataset.disparity_file and not all(file and file.is_file() for file in depths):
            raise DataError(f"{dataset.path}: found no ground truth of edges, expected disparities (pairs), or depths "
                            "and poses as written by `quadedge synth`")
        if not dataset.rig.is_pinhole:
            raise DataError(f"{dataset.path}: found distorted images, expected pinhole images, to which the ground "
                            "truth refers")
        self._dataset, self.rig, self.name, self.frames = dataset, dataset.rig, dataset.name, len(dataset)
        self.tracked = dataset
        poses = dataset.truth
        self._poses = dict(zip(poses.stamps_ns.tolist(), poses.poses))

    def load(self, number: int) -> TrueFrame:
        files = self._dataset.frames[number]
        scale = self.rig.left.fx * self.rig.baseline
        if self._dataset.disparity_file:
            file = Path(self._dataset.disparity_file)
            if self.frames > 1:  # a file of the same name beside every left image
                file = Path(files.left).parent / file.name
            truth = self._read_pair(file)
            if self.frames > 1 and self.rig.left.cx == self.rig.right.cx:
                truth.depth_scale = scale
        else:
            left, right = (from_depth(_check_size(read_float_map(file), camera, file), scale)
                           for file, camera in ((_depth_file(files.left), self.rig.left),
                                                (_depth_file(files.right), self.rig.right)))
            truth = FrameTruth(left, right, depth_scale=scale)
        truth.world_from_left = self._poses.get(files.stamp_ns)
        return TrueFrame(files.stamp_ns, read_grey_image(files.left), read_grey_image(files.right), truth)

    def _disparity(self, file: Path, camera) -> np.ndarray:
        values = read_float_map(file) if file.suffix == ".pfm" else read_grey_image(file)
        return nearness(_check_size(values, camera, file).astype(float) * self._dataset.disparity_scale)

    def _read_pair(self, file: Path) -> FrameTruth:
        left, right, occluded = self._disparity(file, self.rig.left), None, None
        right_name, mask_name = COMPANIONS.get(file.name, (None, None))
        if right_name and (file.parent / right_name).is_file():
            right = self._disparity(file.parent / right_name, self.rig.right)
        if mask_name and (file.parent / mask_name).is_file():
            mask = _check_size(read_grey_image(file.parent / mask_name), self.rig.left, file.parent / mask_name)
            occluded, left[mask == MASK_UNKNOWN] = mask == MASK_OCCLUDED, np.nan
        measured = right is not None
        return FrameTruth(left, right if measured else right_from_left(left, self.rig.right.width), measured, occluded)


class RenderedSource:
    """A Synthetic sequence."""

    def __init__(self, sequence):
        self._sequence, self.rig, self.name, self.frames = sequence, sequence.rig, sequence.name, len(sequence)
        self.tracked = sequence

    def load(self, number: int) -> TrueFrame:
        frame, scale = self._sequence[number], self.rig.left.fx * self.rig.baseline
        left, right = (from_depth(self._sequence.depth(number, side), scale) for side in ("left", "right"))
        pose = self._sequence.truth.poses[number]
        return TrueFrame(frame.stamp_ns, frame.left, frame.right,
                         FrameTruth(left, right, depth_scale=scale, world_from_left=pose))


def open_source(source):
    """A source from a Dataset or a Synthetic. Raises TypeError for anything else, and DataError."""
    if isinstance(source, Dataset):
        return RecordedSource(source)
    if isinstance(source, Synthetic):
        return RenderedSource(source)
    raise TypeError("expected a Dataset or a Synthetic")
