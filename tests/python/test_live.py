"""Cameras live: librealsense's software device, an OAK's EEPROM, a video that ffmpeg plays."""

import json
import signal
import subprocess
import sys
import threading
import time
import types
from datetime import timedelta

import numpy
import pytest

import quadedge
import quadedge.live
from quadedge.live.__main__ import main

rs = pytest.importorskip("pyrealsense2", reason="pyrealsense2 is not installed: RealSense cameras cannot be tested")
depthai = pytest.importorskip("depthai", reason="depthai is not installed: OAK cameras cannot be tested")


class SoftwareCamera:
    """A device of librealsense with the infrared pair of a rig, which plays frames."""

    def __init__(self, rig, coefficient: float = 0.0, streams: int = 2):
        self.device = rs.software_device()
        self.device.register_info(rs.camera_info.name, "Software D435")
        self.sensor = self.device.add_sensor("Stereo Module")
        self.sensor.add_option(rs.option.emitter_enabled, rs.option_range(), True)
        self.profiles = []
        for index in range(1, streams + 1):
            lens = rs.intrinsics()
            lens.width, lens.height, lens.ppx, lens.ppy = 320, 200, rig.left.cx, rig.left.cy
            lens.fx, lens.fy, lens.model, lens.coeffs = rig.left.fx, rig.left.fy, rs.distortion.none, [coefficient] * 5
            stream = rs.video_stream()
            stream.type, stream.index, stream.uid, stream.fmt = rs.stream.infrared, index, index, rs.format.y8
            stream.width, stream.height, stream.fps, stream.bpp, stream.intrinsics = 320, 200, 30, 1, lens
            self.profiles.append(self.sensor.add_video_stream(stream))
        shift = rs.extrinsics()
        shift.rotation, shift.translation = [1, 0, 0, 0, 1, 0, 0, 0, 1], [-rig.baseline, 0, 0]
        if streams == 2:
            self.profiles[0].register_extrinsics_to(self.profiles[1], shift)

    def play(self, frames, cameras: int = 2) -> None:
        for number, one in enumerate(frames):
            for profile, pixels in zip(self.profiles[:cameras], (one.left, one.right)):
                frame = rs.software_video_frame()
                frame.pixels, frame.stride, frame.bpp = numpy.ascontiguousarray(pixels).reshape(-1), 320, 1
                frame.timestamp, frame.domain = 1000.0 + 50.0 * number, rs.timestamp_domain.hardware_clock
                frame.frame_number, frame.profile = number, profile.as_video_stream_profile()
                self.sensor.on_video_frame(frame)
            time.sleep(0.2)


def test_the_infrared_pair_of_a_realsense(room, frames):
    software = SoftwareCamera(room.rig)
    camera = quadedge.live.open_camera("realsense", width=320, height=200, device=software.device)
    assert camera.rig.baseline == pytest.approx(room.rig.baseline) and camera.rig.right_from_left[0, 3] < 0
    assert camera.rig.left.fx == pytest.approx(room.rig.left.fx) and camera.name == "Software D435"
    assert camera.notes == ["the projector of dots is off"]
    assert software.sensor.get_option(rs.option.emitter_enabled) == 0
    threading.Thread(target=software.play, args=(frames,), daemon=True).start()
    came = [(stamp, left.copy(), right.copy()) for (stamp, left, right), _ in zip(camera, range(4))]
    camera.close()
    for stamp, left, right in came:
        number = (stamp - 1_000_000_000) // 50_000_000
        assert stamp == 1_000_000_000 + number * 50_000_000
        numpy.testing.assert_array_equal(left, frames[number].left)
        numpy.testing.assert_array_equal(right, frames[number].right)


def test_a_realsense_whose_right_camera_is_silent_ends(room, frames, monkeypatch):
    monkeypatch.setattr("quadedge.live.realsense._SILENCE_S", 0.5)
    software = SoftwareCamera(room.rig)
    camera = quadedge.live.open_camera("realsense", width=320, height=200, device=software.device)
    playing = threading.Event()
    playing.set()

    def play():
        while playing.is_set():
            software.play(frames[:1], cameras=1)

    player = threading.Thread(target=play)
    player.start()
    taking = threading.Thread(target=lambda: list(camera), daemon=True)
    taking.start()
    taking.join(10)
    playing.clear()
    player.join()
    assert not taking.is_alive()
    camera.close()


@pytest.mark.parametrize("make, options, words", [
    ({}, {"width": 640}, "found no mode 640x200 at 30 frames/s, expected one of 320x200 at 30"),
    ({"coefficient": 0.1}, {}, "Software D435: found distortion"),
    ({"streams": 1}, {}, "Software D435: found no pair of infrared cameras"),
])  # fmt: skip
def test_a_realsense_that_does_not_fit(room, make, options, words):
    device = SoftwareCamera(room.rig, **make).device
    with pytest.raises(quadedge.DataError, match=words):
        quadedge.live.open_camera("realsense", **{"width": 320, "height": 200, "device": device, **options})


def oak_calibration():
    """That of an OAK-D with a baseline of 75 mm."""
    calibration = depthai.CalibrationHandler()
    left, right = depthai.CameraBoardSocket.CAM_B, depthai.CameraBoardSocket.CAM_C
    for socket in (left, right):
        calibration.setCameraIntrinsics(socket, [[800.0, 0, 640], [0, 800, 400], [0, 0, 1]], 1280, 800)
        calibration.setDistortionCoefficients(socket, [0.0] * 14)
    eye = [[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]
    calibration.setCameraExtrinsics(left, right, eye, [-7.5, 0.0, 0.0])
    calibration.setStereoLeft(left, eye)
    calibration.setStereoRight(right, eye)
    return calibration


def test_the_calibration_and_frames_of_an_oak():
    from quadedge.live.oak import pair_of, rig_of

    rig = rig_of(oak_calibration(), (640, 400))
    assert rig.baseline == pytest.approx(0.075) and rig.right_from_left[0, 3] < 0
    assert (rig.left.width, rig.left.height, rig.left.fx) == (640, 400, pytest.approx(400))
    with pytest.raises(quadedge.DataError, match="^EEPROM of the OAK.json"):
        rig_of(depthai.CalibrationHandler(), (640, 400))
    group, pixels = depthai.MessageGroup(), numpy.arange(12, dtype=numpy.uint8).reshape(3, 4)
    for side in ("left", "right"):
        image = depthai.ImgFrame()
        image.setCvFrame(pixels if side == "left" else pixels + 1, depthai.ImgFrame.Type.GRAY8)
        image.setTimestamp(timedelta(seconds=3, microseconds=7))
        group[side] = image
    stamp, left, right = pair_of(group)
    assert stamp == 3_000_007_000
    numpy.testing.assert_array_equal(left, pixels)
    numpy.testing.assert_array_equal(right, pixels + 1)


class Exposed:
    """An image of an OAK, whose stamp is at the end of an exposure of 8 ms."""

    def getTimestamp(self, moment=depthai.CameraExposureOffset.END):  # noqa: N802
        ends = {depthai.CameraExposureOffset.END: 0, depthai.CameraExposureOffset.MIDDLE: 4}
        return timedelta(seconds=3) - timedelta(milliseconds=ends[moment])

    def getFrame(self):  # noqa: N802
        return numpy.zeros((2, 2), numpy.uint8)


def test_an_oak_is_stamped_in_the_middle_of_its_exposure_and_ends_when_it_is_closed():
    from quadedge.live import oak

    assert oak.pair_of({"left": Exposed(), "right": Exposed()})[0] == 2_996_000_000

    def closed():
        raise depthai.MessageQueue.QueueException("MessageQueue was closed")

    camera = oak.Camera.__new__(oak.Camera)
    camera._pipeline = types.SimpleNamespace(isRunning=lambda: True)
    camera._queue = types.SimpleNamespace(get=closed)
    assert list(camera) == []


@pytest.mark.parametrize("kind, words", [("realsense", "RealSense: found no camera"), ("oak", "OAK: found no camera")])
def test_a_camera_that_is_not_there(kind, words, capsys):
    assert main([kind]) == 3 and words in capsys.readouterr().err


def test_both_views_side_by_side(side_by_side, tmp_path, capsys):
    video, calibration, played = side_by_side
    out = tmp_path / "out"
    assert main(["v4l2", str(video), "--calibration", str(calibration), "--preset", "fast", "-o", str(out), "--save",
                 str(tmp_path / "live.rrd")]) == 0
    printed = capsys.readouterr()
    lines = printed.out.splitlines()
    assert lines[0].startswith("first") and 3 <= len(lines) <= played
    assert "320 x 200 px; timestamps are times of arrival" in printed.err
    assert len((out / "frames.csv").read_text().splitlines()) == len(lines) + 1 and (out / "report.json").is_file()
    assert (tmp_path / "live.rrd").stat().st_size > 10_000
    assert main(["v4l2", str(tmp_path / "none"), "--calibration", str(calibration)]) == 3
    assert "found no video" in capsys.readouterr().err


def test_many_errors_of_ffmpeg_stop_no_camera(side_by_side, tmp_path, monkeypatch):
    """A pipe holds 64 KiB: whoever writes more waits until somebody reads."""
    _, calibration, _ = side_by_side
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\nsys.stdout.write('YUV4MPEG2 W640 H200 F30:1\\n')\n"
                       "sys.stdout.flush()\nsys.stderr.write('x' * 200000)\n"
                       "sys.stdout.write('FRAME\\n' + 'y' * 640 * 200)\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    camera = quadedge.live.open_camera("v4l2", source="any", calibration=calibration)
    assert len(list(camera)) == 1
    camera.close()


def test_result_files_are_those_of_a_run(command, room_folder, tmp_path):
    ran, own = tmp_path / "ran", tmp_path / "own"
    command("run", room_folder, "-o", ran, "--preset", "fast", "--quiet")
    dataset = quadedge.open_dataset(room_folder)
    with quadedge.Odometry(dataset, preset="fast") as odometry:
        files = quadedge.ResultFiles(own, odometry, "room", "a test")
        with pytest.raises(quadedge.UsageError, match="another run or batch is writing to this folder"):
            quadedge.ResultFiles(own, odometry, "room")
        for frame in dataset:
            files.add(odometry.track(frame.stamp_ns, frame.left, frame.right))
        files.finish("stopped")
        del files
        with pytest.raises(quadedge.UsageError, match="the folder holds results"):
            quadedge.ResultFiles(own, odometry, "room")
    for name in ("trajectory.txt", "trajectory_kitti.txt", "poses.csv"):
        assert (own / name).read_bytes() == (ran / name).read_bytes()
    report, of_run = (json.loads((folder / "report.json").read_text()) for folder in (own, ran))
    same = ("schema", "variants", "device", "frames_tracked", "key_rigs", "path_length_m", "counts", "config")
    assert all(report[name] == of_run[name] for name in same) and report["ended_early"] == "stopped"
    assert report["input"]["name"] == "room" and report["command"] == "a test"


def test_ctrl_c_keeps_the_results(side_by_side, tmp_path):
    video, calibration, _ = side_by_side
    call = [sys.executable, "-m", "quadedge.live", "v4l2", video, "--calibration", calibration, "-o", tmp_path / "out"]
    process = subprocess.Popen([*map(str, call)], stdout=subprocess.PIPE, text=True)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 0 and (tmp_path / "out" / "report.json").is_file()
