"""The package's `quadedge` command and its OpenCL runtime."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import quadedge
from quadedge import opencl_runtime

PROGRAM = Path(quadedge.__file__).parent / "bin" / "quadedge"


def output(*words) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def test_the_command_and_the_module_run_the_program():
    version = output(PROGRAM, "--version")
    assert version == f"quadedge {quadedge.__version__}\n"
    assert output(sys.executable, "-m", "quadedge", "--version") == version
    assert output(Path(sys.executable).with_name("quadedge"), "--version") == version


def test_pages_are_created_with_the_packages_python(tmp_path):
    output(PROGRAM, "demo", "--frames", "2", "--size", "160x100", "--quiet", "-o", tmp_path / "run")
    environment = {name: value for name, value in os.environ.items() if name != "QUADEDGE_PYTHON"}
    environment["PATH"] = "/nowhere"  # no other Python
    subprocess.run([sys.executable, "-m", "quadedge", "report", tmp_path / "run"], env=environment, check=True)
    assert (tmp_path / "run" / "report.html").is_file()


def test_the_runtime_is_found_in_the_environment(monkeypatch):
    class Distribution:
        name = "libintelocl.so"

        def locate(self):
            return Path("/environment/lib/libintelocl.so")

    asked = []
    monkeypatch.setattr(opencl_runtime.importlib.metadata, "files",
                        lambda name: asked.append(name) or [Distribution()])
    monkeypatch.setenv("QUADEDGE_OPENCL_RUNTIME", "")  # so that it is restored after the test
    monkeypatch.delenv("QUADEDGE_OPENCL_RUNTIME")
    opencl_runtime.announce()
    assert asked == ["intel-opencl-rt"]
    assert os.environ["QUADEDGE_OPENCL_RUNTIME"] == "/environment/lib/libintelocl.so"


@pytest.mark.parametrize("value", ["", "/chosen/by/hand.so"])
def test_a_given_runtime_stays_unchanged(monkeypatch, value):
    monkeypatch.setenv("QUADEDGE_OPENCL_RUNTIME", value)
    opencl_runtime.announce()
    assert os.environ["QUADEDGE_OPENCL_RUNTIME"] == value
