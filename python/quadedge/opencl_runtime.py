"""Where PyPI's OpenCL runtime for CPUs is, which the extra ``cpu`` installs."""

import importlib.metadata
import os

_VARIABLE = "QUADEDGE_OPENCL_RUNTIME"


def announce() -> None:
    """Sets QUADEDGE_OPENCL_RUNTIME to the runtime's library, for the module and the program (opencl_loader.cpp).

    They use it where the system has no OpenCL device. A value that is set already is left alone.
    """
    if _VARIABLE in os.environ:
        return
    try:
        files = importlib.metadata.files("intel-opencl-rt") or []
    except importlib.metadata.PackageNotFoundError:
        return
    for file in files:
        if file.name == "libintelocl.so":
            os.environ[_VARIABLE] = str(file.locate().resolve())
            return
