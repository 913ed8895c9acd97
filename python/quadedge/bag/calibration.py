"""The rig that the ``camera_info`` messages of two cameras describe."""

import json
import tempfile
from pathlib import Path

from .. import Rig


def _field(message, name: str) -> list[float]:
    """A matrix of a CameraInfo, whose names ROS 2 writes small."""
    return [float(value) for value in getattr(message, name, getattr(message, name.upper(), ()))]


def _matrix(rows: int, columns: int, data: list[float]) -> dict:
    return {"rows": rows, "cols": columns, "data": data}


def _as_file(message, rectified: bool) -> str:
    """A CameraInfo as ROS writes it to a file; JSON is YAML. Rectified images are those of the projection matrix."""
    p = _field(message, "p")
    k = [p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]] if rectified else _field(message, "k")
    d = [0.0] * 5 if rectified else _field(message, "d") or [0.0] * 5
    r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0] if rectified else _field(message, "r")
    return json.dumps({
        "image_width": int(message.width), "image_height": int(message.height), "camera_name": "camera",
        "camera_matrix": _matrix(3, 3, k),
        "distortion_model": "plumb_bob" if rectified else message.distortion_model or "plumb_bob",
        "distortion_coefficients": _matrix(1, len(d), d),
        "rectification_matrix": _matrix(3, 3, r), "projection_matrix": _matrix(3, 4, p),
    })  # fmt: skip


def rig_of(left, right, rectified: bool, max_value: int) -> Rig:
    """Of the CameraInfo of both cameras, read exactly as their files are.

    rectified: do the images show what the projection matrix says, instead of what the camera recorded?
    """
    with tempfile.TemporaryDirectory() as folder:
        files = (Path(folder) / "left camera_info.yaml", Path(folder) / "right camera_info.yaml")
        for file, message in zip(files, (left, right)):
            file.write_text(_as_file(message, rectified))
        return Rig.from_file(files, max_value=max_value)
