"""``python -m quadedge.batch.sequence NAME``: runs one sequence of the batch in the current folder, for Snakemake."""

import ctypes
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from ..errors import DataError, Error
from ..report.batch_summary import outcome
from ..report.page import write_atomically
from ..shell import exit_code

SCHEMA = 1
LARGEST_EXIT_CODE = 5
PR_SET_PDEATHSIG = 1


def die_with_parent() -> None:
    """The kernel ends this process when its parent ends, however that happens."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def input_state(plan: dict, sequence: dict) -> str:
    """Stands for the files of a recording: names, sizes and times of their last change."""
    state = hashlib.sha256(json.dumps(sequence).encode())
    for file in sorted(_input_files(plan, sequence)):
        if file.is_file():
            about = file.stat()
            state.update(f"{file}\n{about.st_size} {about.st_mtime_ns}\n".encode(errors="surrogateescape"))
    return state.hexdigest()


def _input_files(plan: dict, sequence: dict) -> Iterator[Path]:
    """All that the words of a sequence, its ground truth and the option --kernels name."""
    start = Path(plan["directory"])
    names = [name for word in sequence["words"] for name in word.split(",")]
    for path in [start / name for name in [*names, sequence["truth"], plan["kernels"]] if name]:
        yield path
        for folder, _, files in os.walk(path):
            yield from (Path(folder) / file for file in files)
        yield from path.parent.glob("calib_*.txt")  # of KITTI's raw recordings, beside the drives


def run(name: str) -> None:
    """Runs the sequence in a folder of its own, which becomes sequences/NAME in one step when it is over."""
    plan = json.loads(Path("batch.json").read_text(encoding="utf-8"))
    sequence = next(entry for entry in plan["sequences"] if entry["name"] == name)
    folder = Path("unfinished", f"{name}.{os.getpid()}").absolute()
    folder.mkdir(parents=True)
    command = [plan["program"], "run", "--output", str(folder), *plan["options"], *sequence["words"]]
    shared = {"POCL_AFFINITY": "0"} if plan["jobs"] > 1 else {}  # several programs need their threads moved about
    with open(folder / "log.txt", "wb") as log:
        process = subprocess.run(command, cwd=plan["directory"], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                 env=shared | os.environ, preexec_fn=die_with_parent, check=False)
    code = process.returncode if 0 <= process.returncode <= LARGEST_EXIT_CODE else Error.exit_code
    member = {"schema": SCHEMA, "name": name, "path": sequence["path"], "format": sequence["format"],
              "exit_code": code, "message": _failure(process.returncode, folder) if code else "", "jobs": plan["jobs"]}
    write_atomically(folder / "member.json", json.dumps(member, indent=2) + "\n")
    place = Path("sequences") / name
    shutil.rmtree(place, ignore_errors=True)
    try:
        folder.rename(place)
    except OSError as problem:
        raise DataError(f"{place}: the finished folder cannot be put here: {problem.strerror}") from None
    print(f"{name}: {outcome(place, name, plan)}", file=sys.stderr, flush=True)


def _failure(code: int, folder: Path) -> str:
    """Why a run failed: its error, which its log has last."""
    if code < 0:
        return (f"ended by signal {-code} ({signal.strsignal(-code)})" +
                ("; perhaps the memory ran out" if -code == signal.SIGKILL else ""))
    log = (folder / "log.txt").read_text(encoding="utf-8", errors="replace").splitlines()
    errors = [line for line in log if line.startswith("quadedge: ") and not line.startswith("quadedge: warning:")]
    return errors[-1].removeprefix("quadedge: ") if errors else f"ended with exit code {code} and no message"


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    die_with_parent()
    sys.exit(exit_code("quadedge", lambda: run(sys.argv[1])))
