"""The rig described by the ``camera_info`` messages of two cameras."""

import json
import tempfile
from pathlib import Path

from .. import DataError, Rig


def _field(message, name: str) -> list[float]:
    """A matrix of a CameraInfo, whose fields are lower case in ROS 2 and upper case in ROS 1."""
    return [float(value) for value in getattr(message, name, getattr(message, name.upper(), ()))]


def _matrix(rows: int, columns: int, data: list[float]) -> dict:
    return {"rows": rows, "cols": columns, "data": data}


def _as_file(message, rectified: bool) -> str:
    """A CameraInfo in the format of ROS's calibration files (JSON is valid YAML)."""
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
        "binning_x": int(message.binning_x), "binning_y": int(message.binning_y),
        "roi": {name: int(getattr(message.roi, name)) for name in ("x_offset", "y_offset", "width", "height")},
    })  # fmt: skip


def write_calibration(folder: Path, infos: tuple, rectified: bool) -> tuple[Path, Path]:
    """Writes the CameraInfo messages of the left and right camera as two calibration files of ROS.

    rectified: True if the images are those of the projection matrix, not those recorded by the camera.
    """
    files = (folder / "left camera_info.yaml", folder / "right camera_info.yaml")
    for file, message in zip(files, infos):
        file.write_text(_as_file(message, rectified))
    return files


def given_rig(calibration: str, max_value: int = 255) -> Rig:
    """The rig of --calibration FILE[,FILE]. max_value: of a saturated pixel. Raises DataError."""
    return Rig.from_file(tuple(calibration.split(",")) if "," in calibration else calibration, max_value=max_value)


def rig_of(infos: tuple, names: list[str], rectified: bool, max_value: int) -> Rig:
    """The rig described by two CameraInfo messages. max_value: of a saturated pixel.

    names: of the messages, for error messages. Raises DataError for a rig that a stereo camera cannot be.
    """
    with tempfile.TemporaryDirectory() as folder:
        files = write_calibration(Path(folder), infos, rectified)
        try:
            return Rig.from_file(files, max_value=max_value)
        except DataError as error:
            text = str(error)
            for file, name in zip(files, names):
                text = text.replace(str(file), name)
            raise DataError(text) from None
