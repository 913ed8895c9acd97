"""QuadEdge: stereo images in, camera trajectory out.

    import quadedge

    rig = quadedge.Rig.from_file("camchain.yaml")
    odometry = quadedge.Odometry(rig)
    result = odometry.track(stamp_ns, left, right)     # numpy arrays, height x width
    print(result.status, result.world_from_left)       # None for a lost frame

Images, edges and poses come from the compiled module ``quadedge._quadedge``, which is loaded when the first of its
names is used; ``quadedge.report`` needs none of it. ``quadedge.bag`` reads recordings of ROS (with the extra
``bag``), ``quadedge.view`` shows results (with ``view``). Lengths are metres, angles radians, stamps nanoseconds, image
positions pixels with the centre of the top-left pixel at (0, 0). Camera frames: x right, y down, z forward.
"""

import importlib
import importlib.metadata
from typing import TYPE_CHECKING

from . import opencl_runtime
from .errors import DataError, DeviceError, Error, UsageError

if TYPE_CHECKING:
    from ._quadedge import *  # noqa: F403
    from .matching import evaluate_matching

    __version__: str

_ERRORS = ("DataError", "DeviceError", "Error", "UsageError")
_COMPILED = (
    "Calibration", "Candidates", "Dataset", "Device", "DeviceInfo", "EdgePositions", "Edges", "ErrorStatistics",
    "Frame", "FrameCounts", "FrameDetails", "FrameDiagnostics", "FrameFiles", "FrameIterator", "FrameResult",
    "FrameTiming", "FrameWarning", "LearnedNumber", "Localisation", "Map", "Odometry", "PinholeCamera", "PoseErrors",
    "Quads", "ResultFiles", "Rig", "Search", "StereoEdges", "StereoFilter", "SubPathErrors", "Synthetic",
    "Tap", "TemporalFilter", "Trajectory", "TrajectoryEvaluation", "calibrate", "configuration", "dataset_formats",
    "decode_grey_image", "detect_edges", "devices", "evaluate_trajectory", "limit_threads", "match", "open_dataset",
    "open_stereo_source", "presets", "read_grey_image", "synthetic",
)  # fmt: skip

__all__ = [*_ERRORS, *_COMPILED, "__version__", "evaluate_matching"]


def __getattr__(name: str):
    """Loads the compiled module with the first name that needs it."""
    if name == "__version__":
        return importlib.metadata.version("quadedge")
    if name == "evaluate_matching":
        return importlib.import_module(".matching", __name__).evaluate_matching
    if name in _COMPILED:
        opencl_runtime.announce()
        try:
            compiled = importlib.import_module("._quadedge", __name__)
        except ImportError as error:
            raise ImportError(
                f"quadedge.{name} needs the compiled part of the package, which cannot be loaded ({error}); "
                "`pip install .` in the repository, in a virtual environment, builds it"
            ) from error
        for known in _COMPILED:
            globals()[known] = getattr(compiled, known)
        return globals()[name]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return sorted({*globals(), *__all__})
