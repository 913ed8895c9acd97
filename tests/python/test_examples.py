"""The examples and the notebook, run as by a user."""

import subprocess
import sys
from pathlib import Path

import pytest

import quadedge

EXAMPLES = Path(__file__).parents[2] / "examples" / "python"


def run(name, *arguments, folder) -> str:
    call = [sys.executable, EXAMPLES / name, *map(str, arguments)]
    done = subprocess.run(call, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_own_images(flight_folder, tmp_path):
    cameras = [flight_folder / "mav0" / name for name in ("cam0", "cam1")]
    folders = []
    for camera in cameras:
        folders.append(tmp_path / camera.name)
        folders[-1].mkdir()
        for image in sorted((camera / "data").glob("*.png"))[:3]:
            (folders[-1] / image.name).symlink_to(image)
    files = ",".join(str(camera / "sensor.yaml") for camera in cameras)
    assert run("01_own_images.py", *folders, files, folder=tmp_path).count("tracked") == 2
    assert len(quadedge.Trajectory.from_file(tmp_path / "trajectory.txt")) == 3


def test_bag(room, frames, tmp_path):
    pytest.importorskip("rosbags", reason="rosbags is not installed: the example cannot be run")
    from bags import room_recording

    path = room_recording(tmp_path / "room", room.rig, frames[:3], "ros2")
    printed = run("02_bag.py", path, tmp_path / "odometry", folder=tmp_path)
    assert "3 of 3 tracked" in printed and list((tmp_path / "odometry").glob("*.mcap"))


def test_live_camera(side_by_side):
    video, calibration, frames = side_by_side
    printed = run("03_live_camera.py", "v4l2", video, calibration, folder=video.parent)
    assert printed.startswith("first") and 2 <= printed.count("tracked") < frames


def test_notebook(tmp_path):
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed: the notebook cannot be run")
    import nbformat

    notebook = nbformat.read(EXAMPLES / "tour.ipynb", as_version=4)
    place = {"metadata": {"path": str(tmp_path)}}
    nbclient.NotebookClient(notebook, timeout=200, startup_timeout=200, resources=place).execute()
    pictures = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
                if "image/png" in output.get("data", {})]
    assert len(pictures) == 3
