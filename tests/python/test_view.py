"""Results in rerun: files that pass `rerun rrd verify` and hold the shown data."""

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


@pytest.fixture(scope="module")
def results(command, room_folder, tmp_path_factory):
    folder = tmp_path_factory.mktemp("results") / "room"
    done = command("run", room_folder, "-o", folder, "--quiet")
    assert done.returncode == 0, done.stderr
    return folder


def test_results_from_the_shell(results, tmp_path):
    file = tmp_path / "room.rrd"
    call = [sys.executable, "-m", "quadedge.view", results, "--save", file]
    done = subprocess.run(call, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "frames     6" in done.stdout
    rerun_command("rrd", "verify", file)
    expected = {"/world/path", "/world/key_rigs", "/world/edges", "/world/key_edges", "/world/camera/left/image",
                "/world/camera/right/image", "/world/camera/left/edges", "/world/camera/left/quads", "/counts/inliers",
                "/times/latency"}  # fmt: skip
    assert expected <= entities(file)
    again = subprocess.run(call, capture_output=True, text=True)
    assert again.returncode == 2 and "the file exists" in again.stderr


def test_results_without_their_recording(results, tmp_path):
    viewer = quadedge.view.Viewer("room", save=tmp_path / "room.rrd")
    assert quadedge.view.show_results(results, viewer, images=False) == 6
    with pytest.raises(quadedge.DataError):
        quadedge.view.show_results(results, viewer, data=tmp_path / "elsewhere")
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
    done = subprocess.run([sys.executable, "-m", "quadedge.view", tmp_path, "--save", tmp_path / "x.rrd"],
                          capture_output=True, text=True)
    assert done.returncode == 3 and "expected the results of `quadedge run`" in done.stderr
    assert not (tmp_path / "x.rrd").exists()
    import shutil

    damaged = shutil.copytree(results, tmp_path / "damaged")
    text = (damaged / "poses.csv").read_text()
    (damaged / "poses.csv").write_text(text[: text.rfind("tracked")] + "tracked,0,oops\n")
    viewer = quadedge.view.Viewer("damaged", save=tmp_path / "damaged.rrd")
    with pytest.raises(quadedge.DataError, match="row 5 of frames.csv or poses.csv is damaged"):
        quadedge.view.show_results(damaged, viewer)
    viewer.close()
