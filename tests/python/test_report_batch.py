"""The pages of batches and of matching evaluations match the result files."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from made_up_results import made_up_matching, write_batch
from parsed_page import ParsedPage, page_of, save_picture

from quadedge import report
from quadedge.report import numbers
from quadedge.report.matching_page import matching_page
from quadedge.report.page import to_html

ORIGIN_TABLE = "Errors, origin-aligned as in the paper's Table 4 (the first compared poses coincide)"
THIN = "\u2009"


def test_page_of_a_batch_has_units_by_size_and_the_latency_of_all(tmp_path):
    write_batch(tmp_path / "batch", ["street", "hall", "yard"])
    page = page_of(tmp_path / "batch")
    # 5, 10 and 15 cm: one unit for a column.
    assert page.tables[ORIGIN_TABLE][0][2:] == ["APE translation [m]", "RPE rotation [deg]", "RPE translation [mm]"]
    assert page.row(ORIGIN_TABLE, "street")[2:8] == ["20.00", "1.250", "0.5000", "0.2500", "0.05000", "0.02500"]
    assert page.row(ORIGIN_TABLE, "all, every pose counts alike")[6] == "0.1000"
    assert page.row("Tracked frames and latency", "hall")[2:5] == ["12 of 12 (100.0 %)", "3", "21.00"]
    assert page.facts["Command"] and page.facts["Configuration"] == "stereo.ncc_min = 0.55"
    assert page.title == "Batch report: batch" and page.tiles["Sequences"] == "3 of 3 done"
    assert page.tiles["Drift at the end"].startswith("1.2 % median of 3 sequences")
    assert sum(plot.endswith("latency") for plot in page.plots) == 3


@pytest.mark.parametrize("damaged", ["report.json", "frames.csv", "trajectory.txt", "groundtruth.txt", "errors.csv",
                                     "poses.csv"])
def test_one_bad_member_does_not_prevent_the_page(tmp_path, damaged):
    write_batch(tmp_path / "batch", ["bad", "good"])
    file = tmp_path / "batch/sequences/bad" / damaged
    lines = file.read_text().splitlines(keepends=True)
    file.write_text("".join(lines[: len(lines) // 2]) + lines[len(lines) // 2][:3])
    page = page_of(tmp_path / "batch")
    assert f"sequences/bad/{damaged}" in page.text and "damaged" in page.text
    assert [plot for plot in page.plots if "good_latency" in plot]
    assert not [plot for plot in page.plots if "figure-bad" in plot]


def test_a_failed_member_has_a_reason_and_no_figures(tmp_path):
    summary = write_batch(tmp_path / "batch", ["good"])
    summary["sequences"].append({"name": "broken", "status": "failed", "exit_code": 3, "path": "b", "format": "kitti",
                                 "message": "calib.txt: <nothing> & so on", "jobs": 1})
    (tmp_path / "batch/summary.json").write_text(json.dumps(summary))
    page = page_of(tmp_path / "batch")
    assert "failed: calib.txt: <nothing> & so on" in page.facts["broken"]
    assert page.row("Tracked frames and latency", "broken")[1] == "failed"
    assert page.row(ORIGIN_TABLE, "broken")[1:] == [numbers.DASH] * 11


def test_a_whole_benchmark_stays_below_six_megabytes(tmp_path):
    names = [f"sequence_{number}" for number in range(24)]
    write_batch(tmp_path / "batch", names, frames=100)
    save_picture(tmp_path / "noise.jpg", 480, 300)
    for name in names:
        for frame in (20, 40, 60, 80):
            os.link(tmp_path / "noise.jpg", tmp_path / "batch/sequences" / name / "pictures" /
                    f"thumbnail_{frame:06d}.jpg")
    page = page_of(tmp_path / "batch")
    assert sum(plot.endswith("_latency") for plot in page.plots) == 24
    assert "thinned" in page.text


def test_page_of_a_matching_evaluation_shows_both_pools_and_filters_that_are_off():
    page = ParsedPage(to_html(matching_page(made_up_matching(["room", "yard"], 6))))
    table = page.tables["Table 1: stereo"]
    assert table[0][1:] == ["paired: 1\u202f000 edges", "all: 1\u202f300 edges"]
    assert table[4][1:] == ["SIFT", *["off"] * 12]
    assert table[2][2] == f"100.00{THIN}\u00b1{THIN}1.00" and table[2][3] == "0.0070"
    assert page.row("What is left at the end", "pooled")[2] == "48\u202f299"
    assert page.row("What is left at the end", "room")[7:9] == ["96.00", "70.00"]
    assert [row[3].split(THIN)[0] for row in page.tables["Quads"][1:]] == ["90.00", "60.00"]
    names = page.figure("filters_stereo")["data"][0]["x"]
    assert names == ["baseline", "epipolar proximity", "NCC", "best"]  # no disabled filters
    assert list(page.traces("filters_stereo")) == ["recall, paired", "precision, paired", "recall, all",
                                                   "precision, all"]


def test_pages_of_the_program(program, tmp_path):
    environment = os.environ | {"QUADEDGE_PYTHON": sys.executable, "XDG_CACHE_HOME": str(tmp_path / "cache"),
                                "PYTHONPATH": str(Path(report.__file__).parents[2])}

    def run(*arguments):
        return subprocess.run([program, *map(str, arguments)], check=True, env=environment, capture_output=True)

    run("synth", tmp_path / "data/room", "--frames", 11, "--size", "240x150", "--quiet")
    run("batch", tmp_path / "data", "-o", tmp_path / "batch", "--quiet", "--stereo.ncc_min", 0.55)
    page = ParsedPage((tmp_path / "batch/report.html").read_text())
    summary = json.loads((tmp_path / "batch/summary.json").read_text())
    for source in (summary, json.loads((tmp_path / "batch/sequences/room/report.json").read_text())):
        assert source["config_changed"]["stereo.ncc_min"] == "0.55"
        assert {"version", "commit", "date", "command", "device" if source is not summary else "input"} <= set(source)
    assert summary["command"].startswith("quadedge batch")
    assert page.facts["Command"].startswith("quadedge run")  # of the sequence
    summary_tables = (tmp_path / "batch/summary.md").read_text()
    assert "SE(3)-aligned" in summary_tables and "\n| room | done | 11 of 11 (100.0 %) |" in summary_tables
    mean = summary["sequences"][0]["accuracy"]["origin_aligned"]["ape_translation_m"]["mean"]
    assert numbers.significant(1000 * mean) == page.row(ORIGIN_TABLE, "room")[6]
    assert len(page.plots) >= 10
    run("report", tmp_path / "batch", "-o", tmp_path / "c.html", "--csv", tmp_path / "c")
    assert (tmp_path / "c/errors_se3_aligned.csv").is_file()
    run("report", tmp_path / "batch/sequences/room")
    assert ParsedPage((tmp_path / "batch/sequences/room/report.html").read_text()).facts["Device"]
    installed = {name: value for name, value in environment.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-m", "quadedge.matching", tmp_path / "data/room", "--frames", "2", "--quiet",
                    "--html", tmp_path / "m.html"], check=True, env=installed)
    matching = ParsedPage((tmp_path / "m.html").read_text())
    assert matching.tables["Table 1: stereo"][6][2] == "off"
    assert matching.figure("filters_stereo")["data"] and matching.outside == []
    assert "Table 3" in " ".join(matching.tables)
