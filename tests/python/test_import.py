"""The package in the source tree, without its compiled module."""

import subprocess
import sys
from pathlib import Path

SOURCES = Path(__file__).parents[2] / "python"


def run_from_sources(program: str) -> subprocess.CompletedProcess:
    """Runs a program that sees only the package in the source tree."""
    preamble = f"import sys; sys.path.insert(0, {str(SOURCES)!r}); sys.dont_write_bytecode = True\n"
    return subprocess.run([sys.executable, "-c", preamble + program], capture_output=True, text=True)


def test_pure_parts_need_no_compiled_module():
    done = run_from_sources("import quadedge, quadedge.errors\nassert issubclass(quadedge.DataError, ValueError)")
    assert done.returncode == 0, done.stderr


def test_exit_codes_agree_with_the_command():
    done = run_from_sources(
        "import quadedge as q\nprint([e.exit_code for e in (q.UsageError, q.DataError, q.DeviceError)])")
    assert done.stdout.strip() == "[2, 3, 4]", done.stderr


def test_unknown_names_are_attribute_errors():
    done = run_from_sources("import quadedge\nassert not hasattr(quadedge, 'no_such_name')")
    assert done.returncode == 0, done.stderr


def test_the_version_agrees_with_the_program(command):
    import quadedge

    assert quadedge.__version__ in command("--version").stdout
