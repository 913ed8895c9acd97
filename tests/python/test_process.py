"""The package in processes that set a locale with a decimal comma, limit threads, and end while a thread tracks."""

import csv
import os
import shutil
import subprocess
import sys

import pytest

_WRITES = """
import locale, pathlib, sys
import quadedge
if sys.argv[2]:
    locale.setlocale(locale.LC_ALL, sys.argv[2])
    assert locale.localeconv()["decimal_point"] == ","
room, folder = quadedge.synthetic(frames=3, width=320, height=200), sys.argv[1]
with quadedge.Odometry(room, preset="fast") as odometry:
    files = quadedge.ResultFiles(folder, odometry, "room")
    for frame in room:
        files.add(odometry.track(frame.stamp_ns, frame.left, frame.right))
    files.finish()
try:
    quadedge.synthetic(frames=3, blur=1000.5)
except quadedge.UsageError as error:
    pathlib.Path(folder, "error.txt").write_text(str(error))
"""
_ENDS = """
import threading, time
import quadedge
room = quadedge.synthetic(frames=2, width=320, height=200)
frame, odometry, tracked = room[0], quadedge.Odometry(room, preset="fast"), threading.Event()

def track():
    stamp = 0
    while True:
        stamp += 50_000_000
        odometry.track(stamp, frame.left, frame.right)
        tracked.set()

threading.Thread(target=track, daemon=True).start()
tracked.wait()
time.sleep(0.005 * {number})
"""
_COUNTS_THREADS = """
import os, sys
import quadedge
quadedge.limit_threads(int(sys.argv[1]))
room = quadedge.synthetic(frames=3, width=320, height=200)
with quadedge.Odometry(room, "cpu", "fast") as odometry:
    poses = [odometry.track(frame.stamp_ns, frame.left, frame.right).world_from_left.tolist() for frame in room]
    tasks = os.listdir("/proc/self/task")
    print(len(tasks), sum(len(os.sched_getaffinity(int(task))) == 1 for task in tasks), poses)
"""


@pytest.fixture(scope="module")
def german(tmp_path_factory):
    """The environment in which the locale de_DE.UTF-8 is installed."""
    if not shutil.which("localedef") or not os.path.exists("/usr/share/i18n/locales/de_DE"):
        pytest.skip("localedef or the package locales is not installed: no locale with a decimal comma")
    folder = tmp_path_factory.mktemp("locales")
    subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / "de_DE.UTF-8"], check=True, capture_output=True)
    return {**os.environ, "LOCPATH": str(folder)}


def run(code: str, *arguments: object, env=None) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True, env=env,
                          timeout=300)


def columns(file) -> list[list[str]]:
    """The rows without times."""
    rows = list(csv.reader(file.read_text().splitlines()))
    kept = [number for number, name in enumerate(rows[0]) if not name.endswith("_ms")]
    assert {len(row) for row in rows} == {len(rows[0])}
    return [[row[number] for number in kept] for row in rows]


def test_a_decimal_comma_changes_no_file(german, tmp_path):
    for name, chosen in (("usual", ""), ("german", "de_DE.UTF-8")):
        done = run(_WRITES, tmp_path / name, chosen, env=german)
        assert done.returncode == 0, done.stderr
    for name in ("trajectory.txt", "trajectory_kitti.txt", "poses.csv", "config.toml", "error.txt"):
        assert (tmp_path / "german" / name).read_bytes() == (tmp_path / "usual" / name).read_bytes(), name
    assert "1000.5" in (tmp_path / "german" / "error.txt").read_text()
    assert columns(tmp_path / "german" / "frames.csv") == columns(tmp_path / "usual" / "frames.csv")
    report = "from quadedge.report.__main__ import main; import sys; sys.exit(main())"
    done = run(report, tmp_path / "german")
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(os.cpu_count() == 1, reason="one processor: there are no threads to leave out")
def test_threads_are_limited_and_change_no_pose():
    one, two, all_of_them = (run(_COUNTS_THREADS, n).stdout.split(" ", 2) for n in (1, 2, 0))
    assert int(one[0]) < int(two[0]) and one[2] == two[2] == all_of_them[2]
    assert int(all_of_them[1]) == (os.cpu_count() if len(os.sched_getaffinity(0)) == os.cpu_count() else 0)
    assert "found -1, expected 0 or more" in run(_COUNTS_THREADS, -1).stderr


def test_python_ends_while_a_thread_tracks():
    for number in range(4):
        done = run(_ENDS.replace("{number}", str(number)))
        assert done.returncode == 0, f"{done.returncode}: {done.stderr}"
