"""The mono cameras of an OAK, with depthai 3."""

import tempfile
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import numpy

from ..errors import DataError

try:
    import depthai
except ImportError as error:
    raise ImportError("quadedge.live needs depthai for an OAK; `pip install depthai` installs it") from error


def rig_of(calibration, size: tuple[int, int]):
    """The Rig of a depthai.CalibrationHandler for images of size (width, height) [px].

    Raises DataError for an EEPROM without the calibration of a stereo camera.
    """
    from .. import Rig

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "EEPROM of the OAK.json"
        calibration.eepromToJsonFile(file)
        try:
            return Rig.from_file(file, size=size)
        except DataError as error:
            raise DataError(str(error).replace(f"{folder}/", "")) from None


def pair_of(group) -> tuple[int, numpy.ndarray, numpy.ndarray]:
    """Stamp [ns] and images of a depthai.MessageGroup. The stamp is that of the middle of the left exposure."""
    left, right = group["left"], group["right"]
    middle = left.getTimestamp(depthai.CameraExposureOffset.MIDDLE)
    return round(middle / timedelta(microseconds=1)) * 1000, left.getFrame(), right.getFrame()


class Camera:
    """An OAK camera with two mono cameras: the first one, or that with this address or identifier."""

    def __init__(self, width: int = 640, height: int = 400, fps: float = 30, serial: str = ""):
        try:
            device = depthai.Device(serial) if serial else depthai.Device()
        except RuntimeError as error:
            raise DataError(f"OAK: found no camera{serial and f' {serial}'} ({error}), expected one on USB or "
                            "PoE") from None
        self.name, self.notes = f"OAK {device.getDeviceId()}", []
        calibration = device.readCalibration()
        self.rig = rig_of(calibration, (width, height))
        self._pipeline = depthai.Pipeline(device)
        together = self._pipeline.create(depthai.node.Sync)
        together.setSyncThreshold(timedelta(milliseconds=5))
        for side, socket in (("left", calibration.getStereoLeftCameraId()),
                             ("right", calibration.getStereoRightCameraId())):
            camera = self._pipeline.create(depthai.node.Camera).build(socket)
            camera.requestOutput((width, height), depthai.ImgFrame.Type.GRAY8, fps=fps).link(together.inputs[side])
        self._queue = together.out.createOutputQueue(maxSize=1, blocking=False)
        self._pipeline.start()

    def __iter__(self) -> Iterator[tuple[int, numpy.ndarray, numpy.ndarray]]:
        """Ends when the camera is closed or unplugged."""
        while self._pipeline.isRunning():
            try:
                group = self._queue.get()
            except depthai.MessageQueue.QueueException:  # it is closed
                return
            yield pair_of(group)

    def close(self) -> None:
        """Stops the camera."""
        self._pipeline.stop()
