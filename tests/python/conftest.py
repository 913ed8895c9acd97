"""Fixtures of the package's tests: a small rendered room, the recorded flight, the program."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def program() -> Path:
    """The quadedge program, to compare with; tests/CMakeLists.txt sets QUADEDGE_PROGRAM."""
    path = Path(os.environ.get("QUADEDGE_PROGRAM", REPOSITORY / "build" / "quadedge"))
    assert path.is_file(), f"{path}: build the program first, or set QUADEDGE_PROGRAM"
    return path


@pytest.fixture(scope="session")
def command(program):
    """A function that runs the program, which has to end with a code, and returns the completed process."""

    def run(*arguments, code: int = 0) -> subprocess.CompletedProcess:
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == code, done.stderr
        return done

    return run


@pytest.fixture(scope="session")
def bag_command(program):
    """The same for python -m quadedge.bag with the program on PATH."""
    place = {**os.environ, "PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}

    def run(*arguments, code: int = 0, **options) -> subprocess.CompletedProcess:
        call = [sys.executable, "-m", "quadedge.bag", *map(str, arguments)]
        done = subprocess.run(call, **{"capture_output": True, "text": True, "env": place, **options})
        assert done.returncode == code, done.stderr
        return done

    return run


@pytest.fixture(scope="session")
def room():
    """A rendered room with small images."""
    import quadedge

    return quadedge.synthetic(frames=6, width=320, height=200)


@pytest.fixture(scope="session")
def frames(room):
    return list(room)


@pytest.fixture(scope="session")
def boarded():
    """A rendered room, and twelve of its frames as (left, right): in the fourth to the ninth a board that moves covers
    more than half of the view, like a bus.
    """
    import numpy
    import quadedge

    room, pairs = quadedge.synthetic(frames=12, width=320, height=200), []
    squares = numpy.random.default_rng(3).integers(30, 226, (30, 60)).astype(numpy.uint8)
    board, columns = numpy.kron(squares, numpy.ones((12, 12), numpy.uint8)), numpy.arange(40, 232)
    for number, frame in enumerate(room):
        images = [frame.left.copy(), frame.right.copy()]
        for image, disparity in zip(images, (0, 24)):
            if 3 <= number <= 8:
                image[:, columns] = board[:200, columns + 60 + disparity + 3 * number]
        pairs.append(tuple(images))
    return room, pairs


@pytest.fixture(scope="session")
def room_folder(command, tmp_path_factory) -> Path:
    """The same room as a recording on disk."""
    folder = tmp_path_factory.mktemp("room") / "room"
    command("synth", folder, "--frames", 6, "--size", "320x200", "--quiet")
    return folder


@pytest.fixture(scope="session")
def flight_folder() -> Path:
    """The recorded flight; skips the test if there is no recorded data."""
    data = os.environ.get("QUADEDGE_DATA")
    if not data:
        pytest.skip("QUADEDGE_DATA is not set: no recorded data")
    folder = Path(data) / "euroc_mh_01_easy"
    if not folder.is_dir():
        pytest.skip(f"{folder}: no such recording")
    return folder


@pytest.fixture
def robot(room):
    """A robot in a domain of its own whose cameras see the room."""
    from robot import Robot

    with Robot(room.rig) as made:
        yield made


@pytest.fixture(scope="session")
def side_by_side(room, frames, tmp_path_factory):
    """A video of a camera that delivers both views side by side, its calibration, and the number of its frames."""
    import numpy

    folder, played = tmp_path_factory.mktemp("side_by_side"), [*frames, *frames[::-1]] * 2
    left, rig = room.rig.left, folder / "rig.yaml"
    rig.write_text("".join(f"{side}_model: radtan\n{side}_size: [320, 200]\n{side}_coefficients: [0, 0, 0, 0]\n"
                           f"{side}_intrinsics: [{left.fx!r}, {left.fy!r}, {left.cx!r}, {left.cy!r}]\n"
                           for side in ("left", "right"))
                   + f"rotation: [0, 0, 0]\ntranslation: [{-room.rig.baseline!r}, 0, 0]\n")
    video, pixels = folder / "both.mkv", b"".join(numpy.hstack([one.left, one.right]).tobytes() for one in played)
    subprocess.run(["ffmpeg", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "gray", "-video_size", "640x200",
                    "-framerate", "4", "-i", "-", "-c:v", "ffv1", video], input=pixels, check=True)  # fmt: skip
    return video, rig, len(played)
