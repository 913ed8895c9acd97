"""A camera that delivers both views side by side in one image, through the program ffmpeg."""

import shutil
import stat
import subprocess
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy

from ..errors import DataError, UsageError

_SILENCE_S = 5.0


def _is_device(source: str) -> bool:
    path = Path(source)
    return path.exists() and stat.S_ISCHR(path.stat().st_mode)


class Camera:
    """A device of Video4Linux, or what else ffmpeg reads: a stream's address, a file, which is played at its rate.

    calibration: as for Rig.from_file(). width, height: of both views together [px], by default what ffmpeg chooses.
    Stamps are the times at which images arrive [ns since 1970], because ffmpeg does not pass on the device's. A clock
    that is set meanwhile does not change them.
    """

    def __init__(self, source: str = "/dev/video0", calibration=None, width: int = 0, height: int = 0, fps: int = 0):
        from .. import Rig

        if calibration is None:
            raise UsageError("v4l2: found no calibration, expected --calibration FILE, because the camera has none")
        if not shutil.which("ffmpeg"):
            raise UsageError("v4l2: found no program ffmpeg, expected it on PATH")
        wanted = ["-fflags", "nobuffer", "-f", "v4l2"] if _is_device(source) else []
        wanted += ["-re"] if Path(source).is_file() else []
        wanted += ["-video_size", f"{width}x{height}"] if width else []
        wanted += ["-framerate", str(fps)] if fps else []
        call = ["ffmpeg", "-nostdin", "-loglevel", "error", *wanted, "-i", source,
                "-f", "yuv4mpegpipe", "-strict", "-1", "-pix_fmt", "gray", "-"]
        self.name, self.notes = source, ["timestamps are times of arrival"]
        errors = tempfile.TemporaryFile()  # a pipe that nobody reads would stop ffmpeg when it is full
        self._ffmpeg = subprocess.Popen(call, stdout=subprocess.PIPE, stderr=errors)
        try:
            header = self._ffmpeg.stdout.readline().split()
            if not header:
                self._ffmpeg.wait()
                errors.seek(0)
                reason = errors.read().decode(errors="replace").strip().replace("\n", "; ")
                raise DataError(f"{source}: found no video ({reason}), expected what ffmpeg reads")
            both = {word[:1]: int(word[1:]) for word in header[1:] if word[:1] in (b"W", b"H")}
            self._width, self._height = both[b"W"], both[b"H"]
            self.rig = Rig.from_file(calibration, size=(self._width // 2, self._height))
        except BaseException:
            self.close()
            raise
        self._newest, self._came, self._ended = None, threading.Condition(), False
        self._epoch_ns = time.time_ns() - time.monotonic_ns()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        """Keeps the newest image."""
        pipe, size = self._ffmpeg.stdout, self._width * self._height
        while pipe.readline() and len(data := pipe.read(size)) == size:
            with self._came:
                self._newest = self._epoch_ns + time.monotonic_ns(), data
                self._came.notify()
        with self._came:
            self._ended = True
            self._came.notify()

    def __iter__(self) -> Iterator[tuple[int, numpy.ndarray, numpy.ndarray]]:
        """Ends with the video, and when the camera has been silent for five seconds."""
        while True:
            with self._came:
                if not self._came.wait_for(lambda: self._newest or self._ended, _SILENCE_S) or not self._newest:
                    return
                (stamp_ns, data), self._newest = self._newest, None
            both = numpy.frombuffer(data, numpy.uint8).reshape(self._height, self._width)
            middle = self._width // 2
            yield stamp_ns, both[:, :middle], both[:, middle:2 * middle]

    def close(self) -> None:
        """Ends ffmpeg."""
        self._ffmpeg.terminate()
        self._ffmpeg.wait()
