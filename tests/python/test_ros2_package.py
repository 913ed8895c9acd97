"""The ROS 2 package in ros2/: built by colcon, started with the parameters and remaps of a launch file."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("colcon_ros", reason="colcon-ros is not installed: the ROS 2 package cannot be built")
pytest.importorskip("cyclonedds", reason="cyclonedds is not installed: quadedge.ros2 cannot be tested")

from robot import SECOND, expected_pose, pose_of, tracked  # noqa: E402

PACKAGE = Path(__file__).parents[2] / "ros2"


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Path:
    """The folder into which colcon has installed the package."""
    work = tmp_path_factory.mktemp("colcon")
    subprocess.run([sys.executable, "-m", "colcon", "build", "--base-paths", PACKAGE], check=True, cwd=work)
    return work / "install"


def started(installed: Path, *words: object) -> list:
    """A command line that starts the node as `ros2 run` does after sourcing the workspace."""
    node = '. "$0/setup.sh" && exec "$0/quadedge_ros2/lib/quadedge_ros2/quadedge" "$@"'
    return ["sh", "-c", node, installed, "--ros-args", *words]


def test_what_ros_looks_for_is_installed(installed):
    share = installed / "quadedge_ros2/share"
    assert (share / "ament_index/resource_index/packages/quadedge_ros2").is_file()
    for file in ("package.xml", "launch/quadedge.launch.py", "config/quadedge.yaml"):
        assert (share / "quadedge_ros2" / file).read_bytes() == (PACKAGE / file).read_bytes()


def test_it_tracks_with_parameters_of_a_file_and_remaps(installed, robot, frames, tmp_path):
    parameters = tmp_path / "robot.yaml"
    parameters.write_text("quadedge:\n  ros__parameters:\n    preset: fast\n    base_frame: robot\n    no_tf: true\n"
                          "    remap: ['/diagnostics:=/health']\n")
    robot.program = started(installed, "--params-file", parameters, "-r", "__node:=quadedge", "-p",
                            "odom_frame:=start", "--")
    robot.start(tmp_path)
    robot.play(frames[:2], SECOND)
    messages = robot.poses()
    results = tracked(robot.stated_rig, frames, list(messages))
    assert [pose_of(message) for message in messages.values()] == [expected_pose(result) for result in results]
    assert {(one.header.frame_id, one.child_frame_id) for one in messages.values()} == {("start", "robot")}
    robot.listen(2)
    assert not robot.heard["/tf"] and not robot.heard["/diagnostics"]
    robot.end()


@pytest.mark.parametrize("words, message", [
    (["-r", "__ns:=/robot"], "--remap: found '__ns:=/robot', expected two topics"),
    (["-p", "no_such_option:=1"], "unrecognized arguments: --no-such-option=1"),
    (["--enclave", "/a"], "found --enclave after --ros-args"),
])  # fmt: skip
def test_what_it_does_not_know_is_refused(words, message, installed):
    done = subprocess.run(started(installed, *words), capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and message in done.stderr and "Traceback" not in done.stderr, done.stderr
