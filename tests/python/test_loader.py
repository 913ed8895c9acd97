"""The wheel on a machine without an OpenCL loader, and its other content."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

# Opening the loader fails, as if none were installed.
NO_LOADER = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <string.h>
void* dlopen(const char* file, int mode) {
  static void* (*original)(const char*, int);
  if (!original) original = (void* (*)(const char*, int))dlsym(RTLD_NEXT, "dlopen");
  return file && strstr(file, "libOpenCL") ? 0 : original(file, mode);
}
"""

PROGRAM = """
import quadedge
assert quadedge.devices() == []
try:
    quadedge.Device("auto")
except quadedge.DeviceError as error:
    print("DeviceError:", error)
frames = quadedge.synthetic(frames=2, width=160, height=100)
with quadedge.Odometry(frames, device="reference") as odometry:
    print([odometry.track(frame.stamp_ns, frame.left, frame.right).status for frame in frames])
"""


def module_file() -> Path:
    import quadedge._quadedge

    return Path(quadedge._quadedge.__file__)


@pytest.mark.skipif(shutil.which("readelf") is None, reason="no readelf here")
@pytest.mark.parametrize("part", ["module", "program"])
def test_the_package_does_not_link_the_loader(part):
    file = module_file() if part == "module" else module_file().parent / "bin" / "libquadedge_program.so"
    done = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=True)
    needed = [line for line in done.stdout.splitlines() if "NEEDED" in line]
    assert needed and not [line for line in needed if "OpenCL" in line], "a function is missing in opencl_loader.cpp"


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")
def test_without_a_loader_the_reference_works(tmp_path):
    source, library = tmp_path / "no_loader.c", tmp_path / "no_loader.so"
    source.write_text(NO_LOADER)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    environment = {**os.environ, "LD_PRELOAD": str(library)}
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    assert "DeviceError: no OpenCL device" in done.stdout and "--device reference" in done.stdout
    assert "['first', 'tracked']" in done.stdout


def test_stubs_are_complete():
    import ast

    import quadedge

    folder = module_file().parent
    assert (folder / "py.typed").is_file()
    stub = ast.parse((folder / "_quadedge.pyi").read_text())
    named = {node.name for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(quadedge._COMPILED) == named


def test_every_name_has_a_docstring():
    import quadedge

    for name in quadedge.__all__:
        thing = getattr(quadedge, name)
        assert thing.__doc__ and len(thing.__doc__) > 15, name
