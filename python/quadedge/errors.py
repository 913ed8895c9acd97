"""The errors of the package: those of the C++ library under the same names.

Their messages are those of the ``quadedge`` command, which name what was found and what was expected.
"""


class Error(Exception):
    """Base of everything that QuadEdge raises on purpose; ``exit_code`` is the command's (doc/reference.md)."""

    exit_code = 1


class UsageError(Error, ValueError):
    """A configuration value or an option that makes no sense; names the key and the allowed range."""

    exit_code = 2


class DataError(Error, ValueError):
    """Missing, unreadable or contradictory data: images, calibrations, recordings, files of results."""

    exit_code = 3


class DeviceError(Error, RuntimeError):
    """No OpenCL device, a kernel that does not build, or a failing OpenCL call."""

    exit_code = 4
