"""Shows the results of a run."""

from os import PathLike
from pathlib import Path

from ..errors import DataError, UsageError
from ..result_files import read_json
from ..run_frames import read_frames
from .viewer import Viewer


# Why the images of a run are not in files, by the format in report.json.
_NOT_STORED = {"pipe": "the images came from a pipe", "synthetic": "the images were rendered",
               "live": "the images came from a camera or another program"}  # fmt: skip


class Run:
    """The results folder of ``quadedge run``: run.show(viewer, run.open_recording()) shows it.

    Raises DataError for a folder without results, and for damaged ones.
    """

    def __init__(self, folder: str | PathLike):
        self.folder = Path(folder)
        self.frames = read_frames(self.folder)  #: a RunFrame per frame
        self.why_no_recording = ""  #: why open_recording() returned None

    def _input(self) -> dict:
        report = self.folder / "report.json"
        content = read_json(report, "the report of `quadedge run`")
        if not isinstance(content.get("input"), dict):
            raise DataError(f"{report}: found no input, expected the report of `quadedge run`")
        return content["input"]

    def open_recording(self, data: str | PathLike | None = None):
        """The Dataset that was tracked; None if it cannot be read again (a pipe, a camera, rendered
        images).

        data: the recording, if it has moved since the run. Raises DataError for a recording that cannot be read.
        """
        from .. import open_dataset, open_stereo_source

        source = self._input()
        kind, options = source["format"], dict(source.get("options", {}))
        for name in ("fps", "fov"):
            if name in options:
                options[name] = float(options[name])
        if data is None and kind in _NOT_STORED:
            self.why_no_recording = _NOT_STORED[kind]
            return None
        if kind not in ("images", "video"):
            format = "auto" if kind in _NOT_STORED else kind
            cameras = {name: options[name] for name in ("calibration", "fov", "mask") if name in options}
            return open_dataset(source["path"] if data is None else data, format=format, **cameras)
        if data is not None:
            raise UsageError("--data replaces the folder of a recording in a published layout; this run was made of "
                             "images or videos of your own")
        if not options:
            raise DataError(f"{self.folder / 'report.json'}: found no options of the images, expected the report of a "
                            "newer `quadedge run`; --no-images shows the rest")
        return open_stereo_source(**options)

    def show(self, viewer: Viewer, recording=None, device: str = "auto") -> None:
        """Logs path, keyframes, counts and times to a viewer.

        recording: the Dataset that was tracked. It is tracked again, with the configuration of the run, to show edges
        and quads, which are not among the results. device: as in Odometry.
        """
        for number, row in enumerate(self.frames):
            viewer.start_frame(row.stamp_ns, number)
            viewer.log_pose(row.pose_or_prediction, row.is_tracked, row.new_key_rig)
            viewer.log_numbers(row.counts, row.times_ms, row.message)
        if recording is not None:
            self._show_edges(viewer, recording, device)

    def _show_edges(self, viewer: Viewer, recording, device: str) -> None:
        from .. import Odometry

        odometry = Odometry(recording, device, config=self.folder / "config.toml")
        numbers = {row.stamp_ns: number for number, row in enumerate(self.frames)}
        for frame in recording:
            if frame.stamp_ns not in numbers:
                continue
            number = numbers[frame.stamp_ns]
            row = self.frames[number]
            odometry.track(frame.stamp_ns, frame.left, frame.right)
            viewer.start_frame(row.stamp_ns, number)
            viewer.log_images(odometry.rig, frame.left, frame.right)
            viewer.log_edges(odometry.details(), row.pose_or_prediction, row.new_key_rig)
