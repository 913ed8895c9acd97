"""Logs frames to rerun, live or from the results of a run."""

import contextlib
import os
import socket
import sys
import urllib.parse
from os import PathLike
from pathlib import Path

import numpy

from ..errors import UsageError

_INLIER, _OTHER, _TRAIL, _KEY = (255, 255, 255), (213, 94, 0), (0, 158, 115), (240, 228, 66)
_LEFT, _RIGHT = "world/camera/left", "world/camera/right"


def _rerun():
    try:
        import rerun
        import rerun.blueprint
    except ImportError as error:
        raise ImportError("quadedge.view needs rerun-sdk; `pip install rerun-sdk` installs it") from error
    return rerun


def _colours_of(depth: numpy.ndarray) -> numpy.ndarray:
    """(N, 3) uint8: colours from yellow (near) to blue (far) by inverse depth, grey without one. depth: (N,) [m]."""
    from plotly import colors

    inverse = 1 / numpy.where(depth > 0, depth, numpy.nan)
    if not numpy.isfinite(inverse).any():
        return numpy.full((len(depth), 3), 128, numpy.uint8)
    low, high = numpy.nanquantile(inverse, [0.02, 0.98])
    place = numpy.clip((inverse - low) / max(high - low, 1e-9), 0, 1)
    stops = numpy.array([colors.hex_to_rgb(stop) for stop in colors.sequential.Cividis])
    at = numpy.linspace(0, 1, len(stops))
    colours = numpy.stack([numpy.interp(numpy.nan_to_num(place), at, stop) for stop in stops.T], 1).astype(numpy.uint8)
    colours[~numpy.isfinite(inverse)] = 128
    return colours


def _port(usual: int) -> int:
    """The usual port if it is free, otherwise any free port."""
    for port in (usual, 0):
        with socket.socket() as test, contextlib.suppress(OSError):
            test.bind(("", port))
            return test.getsockname()[1]
    raise OSError("no port is free")


def _open_window(recording) -> None:
    """Starts rerun's viewer. Raises UsageError if it cannot be started."""
    if sys.platform == "linux" and not any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")):
        raise UsageError("found no display to open a window on; write a file instead (--save F.rrd, save=) or serve a "
                         "browser (--web, web=True)")
    path = os.environ.get("PATH", "")
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), path])  # of an environment not activated
    try:
        recording.spawn()
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[0].rstrip(".")
        raise UsageError(f"rerun's viewer cannot be started ({reason}); `pip install rerun-sdk` installs it, or write "
                         "a file instead (--save F.rrd, save=)") from error
    finally:
        os.environ["PATH"] = path


class Viewer:
    """Shows frames in rerun's viewer, or writes them to a file.

    save: path of an .rrd file to write. web: serve the viewer to a browser, at ``address``. Otherwise a window opens.

    Raises ImportError without rerun-sdk, and UsageError if no window can be opened.
    """

    address: str | None = None  #: URL of the viewer with web=True

    def __init__(self, name: str = "quadedge", *, save: str | PathLike | None = None, web: bool = False):
        self._rerun = _rerun()
        self.recording = self._rerun.RecordingStream(f"quadedge {name}")
        if save is not None:
            self.recording.save(str(save))
        elif web:
            page, source = _port(9090), self.recording.serve_grpc(grpc_port=_port(9876))
            self._rerun.serve_web_viewer(web_port=page, open_browser=False, connect_to=source)
            self.address = f"http://localhost:{page}/?url={urllib.parse.quote(source, safe='')}"
        else:
            _open_window(self.recording)
        self.recording.send_blueprint(self._blueprint())
        self.recording.log("world", self._rerun.ViewCoordinates.RDF, static=True)
        self._frame = 0
        self._last_position = None

    def _blueprint(self):
        blueprint = self._rerun.blueprint
        begin, now = blueprint.TimeRangeBoundary.infinite(), blueprint.TimeRangeBoundary.cursor_relative()
        past = blueprint.VisibleTimeRanges(timeline="frame", start=begin, end=now)
        kept = {path: [past] for path in ("world/path", "world/key_rigs", "world/key_edges")}
        return blueprint.Blueprint(blueprint.Horizontal(
            blueprint.Spatial3DView(origin="world", name="Path and edges", overrides=kept),
            blueprint.Vertical(
                blueprint.Spatial2DView(origin=_LEFT, name="Left image"),
                blueprint.Spatial2DView(origin=_RIGHT, name="Right image"),
                blueprint.Tabs(blueprint.TimeSeriesView(origin="counts", name="Counts"),
                               blueprint.TimeSeriesView(origin="times", name="Times [ms]"),
                               blueprint.TextLogView(origin="messages", name="Messages"))),
            column_shares=[3, 2]))  # fmt: skip

    def start_frame(self, stamp_ns: int, number: int | None = None) -> None:
        """Sets the time of what is logged next. number: of the frame; by default frames are counted from 0."""
        self._frame = self._frame if number is None else number
        self.recording.set_time("frame", sequence=self._frame)
        self.recording.set_time("time", duration=numpy.timedelta64(stamp_ns, "ns"))
        self._frame += 1

    def log_pose(self, world_from_left: numpy.ndarray, is_tracked: bool, new_key_rig: bool) -> None:
        """Logs the camera's pose, (4, 4) [m], the step of its path, and a keyframe if the frame becomes one."""
        rerun, position = self._rerun, world_from_left[:3, 3]
        self.recording.log("world/camera", rerun.Transform3D(translation=position, mat3x3=world_from_left[:3, :3]))
        if self._last_position is not None:
            colour = _TRAIL if is_tracked else _OTHER
            self.recording.log("world/path", rerun.LineStrips3D([[self._last_position, position]], colors=[colour]))
        self._last_position = position.copy()
        if new_key_rig:
            self.recording.log("world/key_rigs", rerun.Points3D([position], colors=[_KEY], radii=[-5.0]))

    def log_numbers(self, counts: dict[str, float], times_ms: dict[str, float], message: str = "") -> None:
        """Logs counts, stage times [ms] and, if not empty, a message."""
        for folder, values in (("counts", counts), ("times", times_ms)):
            for name, value in values.items():
                self.recording.log([folder, name], self._rerun.Scalars(float(value)))
        if message:
            self.recording.log("messages", self._rerun.TextLog(message, level="WARN"))

    def log_images(self, rig, left: numpy.ndarray, right: numpy.ndarray) -> None:
        """Logs both recorded images, (height, width). Edges coincide with them only if the lenses do not distort."""
        rerun = self._rerun
        for path, image, camera in ((_LEFT, left, rig.left), (_RIGHT, right, rig.right)):
            self.recording.log(path, rerun.Pinhole(image_from_camera=camera.matrix, width=camera.width,
                                                   height=camera.height, image_plane_distance=0.3))
            values_per_grey = max(rig.max_value, 256) // 256
            shown = image if image.dtype == numpy.uint8 else (image // values_per_grey).astype(numpy.uint8)
            self.recording.log(f"{path}/image", rerun.Image(numpy.ascontiguousarray(shown)).compress(jpeg_quality=80))
        place = numpy.linalg.inv(rig.right_from_left)
        self.recording.log(_RIGHT, rerun.Transform3D(translation=place[:3, 3], mat3x3=place[:3, :3]))

    def log_edges(self, details, world_from_left: numpy.ndarray, new_key_rig: bool) -> None:
        """Logs stereo edges in both images and in space, and the motion of quads.

        details: from Odometry.details(). world_from_left: (4, 4) [m].
        """
        rerun, stereo, quads = self._rerun, details.stereo, details.quads
        xyz, left, right = stereo.xyz, stereo.left, stereo.right
        colours = _colours_of(xyz[:, 2])
        self.recording.log(f"{_LEFT}/edges", rerun.Points2D(left, colors=colours, radii=0.7))
        self.recording.log(f"{_RIGHT}/edges", rerun.Points2D(right, colors=colours, radii=0.7))
        for path, now, before in ((_LEFT, left, details.previous_stereo.left),
                                  (_RIGHT, right, details.previous_stereo.right)):
            lines = numpy.stack([before[quads.previous], now[quads.current]], axis=1)
            chosen = numpy.where(quads.inlier[:, None], _INLIER, _OTHER).astype(numpy.uint8)
            self.recording.log(f"{path}/quads", rerun.LineStrips2D(lines, colors=chosen, radii=0.4))
        known = numpy.isfinite(xyz).all(axis=1)
        points = xyz[known] @ world_from_left[:3, :3].T + world_from_left[:3, 3]
        cloud = rerun.Points3D(points, colors=colours[known], radii=-1.0)
        self.recording.log("world/edges", cloud)
        if new_key_rig:
            self.recording.log("world/key_edges", cloud)

    def log(self, odometry, result, left: numpy.ndarray, right: numpy.ndarray) -> None:
        """Logs everything about the frame that ``odometry`` has just tracked: its FrameResult and its two images."""
        pose, counts, timing = result.pose_or_prediction, result.counts, result.timing
        warnings = "; ".join(warning.text for warning in result.warnings)
        self.start_frame(result.stamp_ns)
        self.log_pose(pose, result.is_tracked, result.new_key_rig)
        self.log_images(odometry.rig, left, right)
        self.log_edges(odometry.details(), pose, result.new_key_rig)
        self.log_numbers({"stereo_edges": counts.stereo_edges, "quads": counts.quads, "inliers": counts.inliers},
                         {"latency": timing.latency_ms, **timing.stages},
                         warnings or result.message)

    def close(self) -> None:
        """Flushes what has been logged and closes the connection or file."""
        self.recording.flush()
        self.recording.disconnect()
