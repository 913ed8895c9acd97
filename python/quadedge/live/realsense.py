"""The infrared pair of a RealSense camera, with pyrealsense2."""

import time
from collections.abc import Iterator

import numpy

from ..errors import DataError

try:
    import pyrealsense2
except ImportError as error:
    raise ImportError("quadedge.live needs pyrealsense2 for a RealSense camera; `pip install pyrealsense2` "
                      "installs it") from error

_WAIT_MS, _SILENCE_S = 500, 5.0


def _stereo_sensor(device):
    """The sensor of a device that has both infrared cameras. Raises DataError if none has."""
    for sensor in device.query_sensors():
        infrared = {profile.stream_index() for profile in sensor.get_stream_profiles()
                    if profile.stream_type() == pyrealsense2.stream.infrared}
        if {1, 2} <= infrared:
            return sensor
    name = device.get_info(pyrealsense2.camera_info.name)
    raise DataError(f"{name}: found no pair of infrared cameras, expected a camera of the D400 family")


def _profiles(sensor, width: int, height: int, fps: int) -> list:
    """The stream profiles of infrared 1 and 2. Raises DataError if the camera does not have this mode."""
    modes = set()
    found: dict[int, object] = {}
    for profile in sensor.get_stream_profiles():
        if profile.stream_type() == pyrealsense2.stream.infrared and profile.format() == pyrealsense2.format.y8:
            video = profile.as_video_stream_profile()
            modes.add((video.width(), video.height(), video.fps()))
            if (video.width(), video.height(), video.fps()) == (width, height, fps):
                found[profile.stream_index()] = video
    if not {1, 2} <= found.keys():
        listing = ", ".join(f"{w}x{h} at {f}" for w, h, f in sorted(modes))
        raise DataError(f"infrared: found no mode {width}x{height} at {fps} frames/s, expected one of {listing}")
    return [found[1], found[2]]


class Camera:
    """A RealSense camera: the first one, or that with this serial number.

    Its projector of dots is switched off, because dots move with the camera. Stamps are those of the camera, which
    librealsense converts to the computer's clock where it can. device: an open device instead, for tests.
    """

    def __init__(self, width: int = 848, height: int = 480, fps: int = 30, serial: str = "", device=None):
        from .. import PinholeCamera, Rig

        if device is None:
            devices = [one for one in pyrealsense2.context().query_devices()
                       if serial in ("", one.get_info(pyrealsense2.camera_info.serial_number))]
            if not devices:
                raise DataError(f"RealSense: found no camera{serial and f' {serial}'}, expected one on USB")
            device = devices[0]
        self.name = device.get_info(pyrealsense2.camera_info.name)
        self._sensor = _stereo_sensor(device)
        profiles = _profiles(self._sensor, width, height, fps)
        cameras = []
        for profile in profiles:
            lens = profile.get_intrinsics()
            if any(lens.coeffs):
                raise DataError(f"{self.name}: found distortion {list(lens.coeffs)}, expected rectified images")
            cameras.append(PinholeCamera(lens.fx, lens.fy, lens.ppx, lens.ppy, lens.width, lens.height))
        extrinsics = profiles[0].get_extrinsics_to(profiles[1])
        right_from_left = numpy.eye(4)
        right_from_left[:3, :3] = numpy.reshape(extrinsics.rotation, (3, 3)).T  # by columns
        right_from_left[:3, 3] = extrinsics.translation
        self.rig = Rig(*cameras, right_from_left)
        self.notes = []
        if self._sensor.supports(pyrealsense2.option.emitter_enabled):
            self._sensor.set_option(pyrealsense2.option.emitter_enabled, 0)
            self.notes.append("the projector of dots is off")
        self._pairs = pyrealsense2.syncer(1)
        self._sensor.open(profiles)
        self._sensor.start(self._pairs)

    def __iter__(self) -> Iterator[tuple[int, numpy.ndarray, numpy.ndarray]]:
        """Ends when no pair has come for five seconds."""
        last_s = time.monotonic()
        while time.monotonic() - last_s < _SILENCE_S:
            arrived, frames = self._pairs.try_wait_for_frames(_WAIT_MS)
            pair = [frames.get_infrared_frame(1), frames.get_infrared_frame(2)] if arrived else [None]
            if all(pair):
                last_s = time.monotonic()
                yield round(pair[0].get_timestamp() * 1e6), *(numpy.asanyarray(one.get_data()) for one in pair)

    def close(self) -> None:
        """Stops the camera."""
        self._sensor.stop()
        self._sensor.close()
