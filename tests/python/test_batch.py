"""`quadedge batch`: Snakemake runs every sequence in its own process and repeats what has changed; a summary of all."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from made_up_results import ORIGIN, accuracy, write_run

from quadedge import report
from quadedge.report import batch_summary
from quadedge.report.batch_summary import pooled, summarise, worst

PROGRAM = os.environ["QUADEDGE_PROGRAM"]
PYTHON = {"QUADEDGE_PYTHON": sys.executable, "PYTHONPATH": str(Path(report.__file__).parents[2])}


def run(*arguments, **environment):
    return subprocess.run([PROGRAM, *map(str, arguments)], env=os.environ | PYTHON | environment, capture_output=True,
                          text=True, check=False)


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """a/first and a/second, and one without its calibration."""
    root = tmp_path_factory.mktemp("batch") / "root"
    for name, seed in (("first", 1), ("second", 2)):
        assert run("synth", root / "a" / name, "--frames", 4, "--size", "240x150", "--seed", seed,
                   "--quiet").returncode == 0
    shutil.copytree(root / "a/first", root / "broken")
    (root / "broken/calibration.txt").unlink()
    return root


def summary_of(out: Path) -> dict:
    return json.loads((out / "summary.json").read_text())


def times_of(out: Path) -> dict[str, int]:
    """When each sequence was run."""
    return {file.parent.name: file.stat().st_mtime_ns for file in out.glob("sequences/*/member.json")}


def test_all_sequences_run_and_the_broken_one_is_named(recordings, tmp_path):
    out = tmp_path / "out"
    done = run("batch", recordings, "-o", out)
    assert done.returncode == 3, done.stderr
    assert "broken (failed): " in done.stderr and "calibration.txt" in done.stderr
    assert "first: 4 of 4 frames tracked, APE" in done.stderr  # as it ends
    assert "2 of 3 sequences done" in done.stdout and "SE(3)-aligned" in done.stdout
    assert not (out / "unfinished").exists() and (out / "report.html").stat().st_size > 10_000
    summary = summary_of(out)
    assert [entry["name"] for entry in summary["sequences"]] == ["first", "second", "broken"]
    assert summary["sequences"][2]["status"] == "failed" and summary["all"]["frames_tracked"] == 8
    assert summary["command"].startswith("quadedge batch") and summary["input"] == str(recordings)
    assert run("run", recordings / "a/first", "-o", tmp_path / "alone", "--quiet").returncode == 0
    own = out / "sequences/first"
    assert (own / "trajectory.txt").read_bytes() == (tmp_path / "alone/trajectory.txt").read_bytes()
    found = json.loads((own / "report.json").read_text())
    assert summary["sequences"][0]["accuracy"]["origin_aligned"] == found["accuracy"]["origin_aligned"]
    assert summary["sequences"][0]["latency_ms"] == found["latency_ms"]
    assert (own / "pictures/thumbnail_000001.jpg").is_file()

    listed = run("batch", recordings, "--list")
    assert listed.stdout.splitlines()[0] == f"first\t{recordings}/a/first"


def test_only_what_has_changed_is_repeated(recordings, tmp_path):
    shutil.copytree(recordings / "a", tmp_path / "data")
    out, command = tmp_path / "out", ("batch", tmp_path / "data", "-o", tmp_path / "out", "--quiet")

    def repeated(*options) -> set[str]:
        before = times_of(out)
        done = run(*command, *options)
        assert done.returncode == 0, done.stderr
        return {name for name, when in times_of(out).items() if before.get(name) != when}

    assert repeated() == {"first", "second"}
    assert repeated() == set()
    image = next((tmp_path / "data/second").glob("rgb2/*"))
    image.write_bytes(image.read_bytes())
    dry = run(*command, "--dry-run")
    assert "name=second" in dry.stdout + dry.stderr and "name=first" not in dry.stdout + dry.stderr
    assert repeated() == {"second"}
    rows = out / "sequences/first/frames.csv"  # a damaged result counts as missing
    rows.write_text(rows.read_text().rsplit("\n", 2)[0] + "\n")
    assert repeated() == {"first"}
    assert repeated("--seed", 77) == {"first", "second"}
    assert "seed = 77" in (out / "sequences/first/config.toml").read_text()
    assert repeated("--seed", 77, "--force", "--jobs", 2) == {"first", "second"}
    assert summary_of(out)["sequences"][0]["jobs"] == 2  # the page says that latencies are those of two at once


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_an_interrupted_batch_keeps_finished_results_and_goes_on(tmp_path, number):
    out = tmp_path / "out"
    assert run("synth", tmp_path / "data/a", "--frames", 60, "--size", "240x150", "--quiet").returncode == 0
    shutil.copytree(tmp_path / "data/a", tmp_path / "data/b")
    command = [PROGRAM, "batch", str(tmp_path / "data"), "-o", str(out)]
    with open(tmp_path / "log", "w") as log:
        process = subprocess.Popen(command, env=os.environ | PYTHON, stdout=log, stderr=log)
    first = wait_for(lambda: next(iter(times_of(out)), None))  # Snakemake chooses which
    rows = wait_for(lambda: next((file for file in out.glob(f"unfinished/[!{first}]*/trajectory_kitti.txt")
                                  if file.read_text().count("\n") > 2), None))
    locked = run(*command[1:])
    assert locked.returncode == 2 and "is writing to this folder" in locked.stderr
    process.send_signal(number)
    assert process.wait(timeout=60) == -number
    wait_for(lambda: not running_in(rows.parent))  # its child dies with it
    assert set(times_of(out)) == {first} and not (out / "summary.json").exists()
    if number == signal.SIGTERM:
        assert "interrupted; 1 of 2 sequences finished" in (tmp_path / "log").read_text()
        assert not (out / "unfinished").exists()
    before = times_of(out)
    assert run(*command[1:]).returncode == 0
    assert times_of(out)[first] == before[first]
    assert summary_of(out)["all"]["frames_tracked"] == 120 and not (out / "unfinished").exists()


def wait_for(condition, seconds=300):
    end = time.monotonic() + seconds
    while not (found := condition()):
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.05)
    return found


def running_in(folder: Path) -> bool:
    """Whether a process has the folder among its arguments."""
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if str(folder).encode() in file.read_bytes():
                return True
        except OSError:
            continue
    return False


def test_a_list_may_name_own_cameras(recordings, tmp_path):
    first = recordings / "a/first"
    assert run("check", first, "--write-calibration", tmp_path / "rig.yaml", "--quiet").returncode == 0
    (tmp_path / "list.txt").write_text(
        f"--left {first}/rgb --right {first}/rgb2 --calibration rig.yaml --fps 20\nabsent\n")
    done = run("batch", tmp_path / "list.txt", "-o", tmp_path / "out", "--quiet")
    assert done.returncode == 3 and "absent (failed)" in done.stderr, done.stderr
    assert summary_of(tmp_path / "out")["sequences"][0]["frames_tracked"] == 4


def test_usage_and_places(recordings, tmp_path):
    absent = run("batch", recordings, "-o", tmp_path / "out", QUADEDGE_PYTHON="/absent/python")
    assert absent.returncode == 2 and "scripts/run.sh in a clone of QuadEdge installs both" in absent.stderr
    assert not (tmp_path / "out").exists()
    assert run("batch", recordings, "other", "-o", tmp_path / "out").returncode == 2
    unknown = run("batch", recordings, "-o", tmp_path / "out", "--", "--colour", "red")
    assert unknown.returncode == 2 and "--colour" in unknown.stderr and not (tmp_path / "out/summary.json").exists()
    assert run("batch", tmp_path / "no_list", "-o", tmp_path / "out").returncode == 3
    device = run("batch", recordings, "-o", tmp_path / "none", "--device", "abacus")
    assert device.returncode == 4 and "abacus" in device.stderr and not (tmp_path / "none").exists()
    (tmp_path / "file").write_text("in the way")
    full = run("batch", recordings, "-o", tmp_path / "file/out", "--device", "reference")
    assert full.returncode == 3 and str(tmp_path / "file/out") in full.stderr


PLAN = ORIGIN | {"input": "a", "min_tracked_percent": 50.0}


def made_up_batch(out: Path, **members: dict) -> dict:
    """The summary of made-up runs, each with these keys of its member.json changed."""
    for name, changes in members.items():
        if "exit_code" not in changes:
            write_run(out / "sequences" / name, 12, errors=changes.pop("errors", None))
        member = {"name": name, "path": f"a/{name}", "format": "kitti", "exit_code": 0, "message": "", "jobs": 1}
        (out / "sequences" / name).mkdir(parents=True, exist_ok=True)
        (out / "sequences" / name / "member.json").write_text(json.dumps(member | changes))
    return summarise(out, PLAN | {"sequences": [{"name": name} for name in [*members, "absent"]]})


def test_the_summary_names_failed_damaged_and_missing_sequences(tmp_path):
    made_up_batch(tmp_path, good={}, bad={"exit_code": 4, "message": "a,\"b\"\n"}, cut={})
    report_file = tmp_path / "sequences/cut/report.json"
    report_file.write_text(report_file.read_text()[:200])
    summary = summarise(tmp_path, PLAN | {"sequences": [{"name": name} for name in ("good", "bad", "cut", "absent")]})
    good, bad, cut, absent = summary["sequences"]
    assert [entry["status"] for entry in summary["sequences"]] == ["done", "failed", "failed", "not run"]
    assert bad["message"] == "a,\"b\"\n" and "report.json" in cut["message"] and "accuracy" not in cut
    assert absent["exit_code"] == 3 and summary["exit_code"] == 4 and summary["all"]["frames"] == 12
    assert good["accuracy"]["se3_aligned"] == accuracy(0.05)["se3_aligned"]
    few = summarise(tmp_path, PLAN | {"min_tracked_percent": 101, "sequences": [{"name": "good"}]})
    assert few["sequences"][0]["status"] == "too few tracked" and few["exit_code"] == 5
    assert [worst(codes) for codes in ([], [5, 0], [5, 3], [4, 3], [1, 4])] == [0, 5, 3, 4, 1]
    assert not batch_summary.is_finished(tmp_path / "sequences/cut")


def test_figures_over_all_are_those_of_all_poses_together():
    errors = [np.array([1.0, 2, 6]), np.array([0.5, 0.25, 4, 8, 1])]

    def statistics(values: np.ndarray) -> dict:
        return {"mean": values.mean(), "std": values.std(), "rmse": np.sqrt((values**2).mean()), "max": values.max()}

    parts = [{alignment: dict.fromkeys(batch_summary.ERRORS, statistics(values))
              for alignment in ("origin_aligned", "se3_aligned")} |
             {"matched_poses": len(values), "rpe_steps": len(values), "path_length_m": 10.0 * len(values),
              "end_drift_percent": float(len(values))} for values in errors]
    parts[1]["se3_aligned"]["ape_rotation_deg"] = dict.fromkeys(("mean", "std", "rmse", "max"))  # undetermined
    together = pooled(parts)
    expected = statistics(np.concatenate(errors))
    assert together["origin_aligned"]["rpe_translation_m"] == pytest.approx(expected)
    assert together["se3_aligned"]["ape_rotation_deg"] == pytest.approx(statistics(errors[0]))
    assert together["matched_poses"] == 8 and together["path_length_m"] == 80
    assert together["end_drift_percent"] == pytest.approx((3 * 30 + 5 * 50) / 80)
