"""Results in rerun: files that pass `rerun rrd verify` and hold the shown data."""

import os
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

import quadedge

rerun = pytest.importorskip("rerun", reason="rerun-sdk is not installed: quadedge.view cannot be tested")

import quadedge.view  # noqa: E402


def rerun_command(*arguments) -> str:
    """Output of the rerun command; fails if the command fails."""
    call = [sys.executable, "-m", "rerun", *map(str, arguments)]
    done = subprocess.run(call, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def entities(file: Path) -> set[str]:
    """Entity paths in a recording."""
    import re

    return set(re.findall(r" - (/\S+) - data columns", rerun_command("rrd", "print", file)))


def view(*arguments, code: int = 0, python=sys.executable, env=None) -> subprocess.CompletedProcess:
    """Runs python -m quadedge.view, which has to end with a code."""
    call = [python, "-m", "quadedge.view", *map(str, arguments)]
    done = subprocess.run(call, capture_output=True, text=True, env=env)
    assert done.returncode == code, done.stdout + done.stderr
    return done


@pytest.fixture(scope="module")
def results(command, room_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "room"
    command("run", room_folder, "-o", folder, "--quiet")
    return folder


def test_results_of_a_program_that_tracks_live(room, frames, tmp_path):
    with quadedge.Odometry(room, preset="fast") as odometry:
        files = quadedge.ResultFiles(tmp_path / "live", odometry, "domain 5: /cam/left")
        for frame in frames:
            files.add(odometry.track(frame.stamp_ns, frame.left, frame.right))
        files.finish()
    done = view(tmp_path / "live", "--save", tmp_path / "live.rrd")
    assert "frames     6" in done.stdout
    assert "images and edges are not shown: the images came from a camera or another program" in done.stderr
    rerun_command("rrd", "verify", tmp_path / "live.rrd")


def test_results_from_the_shell(results, tmp_path):
    file = tmp_path / "room.rrd"
    assert "frames     6" in view(results, "--save", file).stdout
    rerun_command("rrd", "verify", file)
    expected = {"/world/path", "/world/key_rigs", "/world/edges", "/world/key_edges", "/world/camera/left/image",
                "/world/camera/right/image", "/world/camera/left/edges", "/world/camera/left/quads", "/counts/inliers",
                "/times/latency"}  # fmt: skip
    assert expected <= entities(file)
    assert "the file exists" in view(results, "--save", file, code=2).stderr


@pytest.mark.parametrize("kind", ["images", "video"])
def test_results_of_own_cameras(command, room_folder, tmp_path, kind):
    """Images in folders, and a video with both views in each frame."""
    calibration = tmp_path / "rig.yaml"
    command("check", room_folder, "--write-calibration", calibration)
    if kind == "video":
        joined = ["ffmpeg", "-loglevel", "error", "-framerate", "20", "-pattern_type", "glob", "-i",
                  room_folder / "rgb" / "*.png", "-framerate", "20", "-pattern_type", "glob", "-i",
                  room_folder / "rgb2" / "*.png", "-filter_complex", "hstack", "-c:v", "ffv1", "-pix_fmt", "gray",
                  tmp_path / "both.mkv"]  # fmt: skip
        subprocess.run(list(map(str, joined)), check=True)
        source = ["--video", tmp_path / "both.mkv", "--split", "left-right"]
    else:
        source = ["--left", room_folder / "rgb", "--right", room_folder / "rgb2", "--fps", "20"]
    command("run", *source, "--calibration", calibration, "-o", tmp_path / "out", "--quiet")
    view(tmp_path / "out", "--save", tmp_path / "own.rrd")
    assert {"/world/camera/left/image", "/world/camera/left/quads"} <= entities(tmp_path / "own.rrd")
    moved = view(tmp_path / "out", "--save", tmp_path / "moved.rrd", "--data", room_folder, code=2)
    assert "--data" in moved.stderr
    assert not list(tmp_path.glob("moved*"))


def test_rendered_images_cannot_be_shown_again(command, tmp_path):
    command("demo", "--frames", 4, "--size", "320x200", "-o", tmp_path / "out", "--quiet")
    shown = view(tmp_path / "out", "--save", tmp_path / "demo.rrd")
    assert "images and edges are not shown: the images were rendered" in shown.stderr
    assert "/world/path" in entities(tmp_path / "demo.rrd")


def test_a_failure_leaves_no_file(results, tmp_path):
    done = view(results, "--save", tmp_path / "x.rrd", "--device", "toaster", code=4)
    assert "no OpenCL device matches 'toaster'" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_no_display_and_no_viewer_are_one_sentence(results, tmp_path):
    place = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY", "CI")}
    done = view(results, "--no-images", env=place, code=2)
    assert done.stderr.count("\n") == 1
    assert "found no display" in done.stderr and "--save F.rrd" in done.stderr
    # A Python whose folder has no program rerun, and an empty PATH.
    python = tmp_path / "python"
    python.symlink_to(sys.executable)
    packages = os.pathsep.join(path for path in sys.path if path)
    done = view(results, "--no-images", python=python, code=2,
                env={**place, "DISPLAY": ":99", "PATH": "", "PYTHONPATH": packages})
    assert done.stderr.count("\n") == 1, done.stderr
    assert "rerun's viewer cannot be started" in done.stderr


def test_results_without_their_recording(results, tmp_path):
    viewer = quadedge.view.Viewer("room", save=tmp_path / "room.rrd")
    run = quadedge.view.Run(results)
    run.show(viewer)
    assert len(run.frames) == 6
    with pytest.raises(quadedge.DataError):
        run.open_recording(tmp_path / "elsewhere")
    viewer.close()
    rerun_command("rrd", "verify", tmp_path / "room.rrd")
    assert "/world/path" in entities(tmp_path / "room.rrd")


def test_a_browser_is_served_until_interrupted(results):
    call = [sys.executable, "-m", "quadedge.view", results, "--web", "--no-images"]
    with subprocess.Popen(call, stdout=subprocess.PIPE, text=True) as served:
        try:
            address = next(line.split()[1] for line in served.stdout if line.startswith("open"))
            with urllib.request.urlopen(address, timeout=20) as page:
                assert page.status == 200 and b"<html" in page.read()
            assert "url=rerun" in address
        finally:
            served.send_signal(signal.SIGINT)
        assert served.wait(20) == 0


def test_live(room, tmp_path):
    viewer = quadedge.view.Viewer("live", save=tmp_path / "live.rrd")
    with quadedge.Odometry(room) as odometry:
        for frame in room:
            viewer.log(odometry, odometry.track(frame.stamp_ns, frame.left, frame.right), frame.left, frame.right)
    viewer.close()
    rerun_command("rrd", "verify", tmp_path / "live.rrd")
    assert {"/world/edges", "/world/camera/left/quads", "/times/latency"} <= entities(tmp_path / "live.rrd")


def test_invalid_results_are_refused(tmp_path, results):
    done = view(tmp_path, "--save", tmp_path / "x.rrd", code=3)
    assert "expected a results folder of `quadedge run`" in done.stderr
    assert not (tmp_path / "x.rrd").exists()
    import shutil

    damaged = shutil.copytree(results, tmp_path / "damaged")
    text = (damaged / "poses.csv").read_text()
    (damaged / "poses.csv").write_text(text[: text.rfind("tracked")] + "tracked,0,oops\n")
    with pytest.raises(quadedge.DataError, match=r"poses.csv:7: .* fields; expected"):
        quadedge.view.Run(damaged)
