"""The pages, tables and figures of quadedge.report match the result files."""

import csv
import json
import os
import re
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest
from made_up_results import ORIGIN, accuracy, statistics, write_batch, write_matching, write_rig, write_run
from parsed_page import ParsedPage

pytest.importorskip("jinja2")
PIL = pytest.importorskip("PIL.Image")

from quadedge import report  # noqa: E402
from quadedge.report import numbers, results, sequence_figures  # noqa: E402
from quadedge.report.figure import COLOURS, Figure, rounded, thinned, write_figure  # noqa: E402
from quadedge.report.page import LARGEST_PAGE  # noqa: E402
from quadedge.report.table import Cell, Table, to_csv, to_latex, to_markdown  # noqa: E402

ORIGIN_TABLE = "Errors, origin-aligned as in the paper's Table 4 (the first compared poses coincide)"
SE3_TABLE = "Errors, SE(3)-aligned as commonly reported (least squares over all positions, no scale)"
THIN = "\u2009"


def page_of(path: Path, **options) -> ParsedPage:
    file = report.make_page(path, **options)
    text = file.read_text(encoding="utf-8")
    assert len(text.encode()) < LARGEST_PAGE
    page = ParsedPage(text)
    assert page.outside == []
    assert all(re.fullmatch(r"file://.*/doc/[a-z0-9-]+\.md(#[a-z0-9-]+)?", link) for link in page.links)
    assert "default-src 'none'" in text  # so that the browser refuses network access
    for broken in ("nan", "None", "NaN", "inf", "Undefined"):
        assert broken not in page.text.split()
    return page


def save_picture(file: Path, width: int, height: int) -> None:
    noise = np.random.default_rng(1).integers(0, 255, (height, width, 3), dtype=np.uint8)
    PIL.fromarray(noise).save(file)


def png_header(width: int, height: int) -> bytes:
    """A grey PNG picture that ends after a size and a first piece of data."""
    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes(1000))))


def test_numbers_have_four_digits_and_suitable_units():
    assert numbers.significant(0.012345678) == "0.01235"
    assert numbers.significant(1234.5) == "1234"
    assert numbers.significant(-2) == "-2.000"
    assert numbers.significant(1e-15) == "0"
    assert numbers.significant(None) == numbers.significant(float("nan")) == numbers.DASH
    assert numbers.difference(0.0105, 0.0117) == "(-0.00120)"
    assert numbers.difference(2, 2.0000001) == "(=)"
    assert numbers.difference(2, None) == ""
    assert numbers.length_text(0.0032) == "3.20 mm"
    assert numbers.length_text(42.1) == "42.1 m"
    assert numbers.length_unit([0.05, None, -0.2]) is numbers.METRE
    assert numbers.count(48299) == "48\u202f299"
    assert [numbers.short_count(value) for value in (999, 1500, 27230, 12345678)] == ["999", "1.5k", "27k", "12M"]


def test_thinned_curves_keep_extremes_and_order():
    x = np.arange(1000.0)
    y = np.sin(0.01 * x)
    y[0], y[357], y[900] = np.nan, 9, -7
    thin_x, thin_y = thinned(x, y, 50)
    assert len(thin_x) <= 50 and (np.diff(thin_x) > 0).all()
    assert {9, -7} <= set(thin_y) and not np.isnan(thin_y).any()
    assert len(thinned(x, y, 1000)[0]) == 1000


def test_tables_become_csv_with_unrounded_numbers_and_latex():
    table = Table("t", "50 % & more", ["who_is", "mean", "std"], groups=[("", 1), ("APE [m]", 2)],
                  notes=["a reason"], result_rows=1)
    table.add("a_b", Cell("1.235", 1.23456789, bold=True), Cell(numbers.DASH, None))
    table.add("all", Cell("2", 2.0, beside="(+0.1)"), Cell("x"))
    assert list(csv.reader(to_csv(table).splitlines())) == [
        ["who_is", "APE [m] mean", "APE [m] std"], ["a_b", "1.23456789", ""], ["all", "2.0", "x"]]
    latex = to_latex(table)
    for part in (r"\caption{50 \% \& more}", r"\multicolumn{2}{c}{APE [m]}", r"\cmidrule(lr){2-3}", r"a\_b",
                 r"\textbf{1.235}", r"\begin{tabular}{lrr}", "a reason"):
        assert part in latex
    assert latex.count(r"\midrule") == 2
    assert to_markdown(table).splitlines() == [
        "| who_is | APE [m] mean | APE [m] std |", "|---|--:|--:|", "| a_b | 1.235 | \u2013 |",
        "| all | 2 (+0.1) | x |", "", "a reason"]
    with pytest.raises(ValueError, match="2 cells for 3 columns"):
        table.add("too", "short")


def test_page_of_a_run_shows_its_origin_and_the_files_content(tmp_path):
    content = write_run(tmp_path / "street", 12, lost=7)
    save_picture(tmp_path / "street/pictures/thumbnail_000005.jpg", 480, 300)
    save_picture(tmp_path / "street/pictures/quads_000005.png", 1280, 960)
    save_picture(tmp_path / "street/pictures/pair_000006.jpg", 960, 300)
    (tmp_path / "street/pictures/thumbnail_000007.jpg").write_text("no picture")
    (tmp_path / "street/pictures/quads_000009.png").write_bytes(png_header(60000, 60000))
    page = page_of(tmp_path / "street")
    assert page.facts["Program"] == "QuadEdge 1.2.3, commit 0123456789ab"
    assert page.facts["Date"] == "2026-05-04 03:02:01 UTC"
    assert page.facts["Device"] == "abacus (wood, none, driver 1)"
    assert page.facts["Configuration"] == "stereo.ncc_min = 0.55"
    assert page.facts["Input"] == "a/street (kitti), 12 frames of 640 x 480 px"
    assert page.facts["Command"] == ORIGIN["command"]
    assert page.facts["Frames tracked"] == "11 of 12 (91.7 %)"
    assert page.facts["Frames lost"] == "1 no consensus"
    assert page.tables["Lost frames"][1:] == [["7", "0.700", "no consensus", ""]]
    rows = page.tables["Errors against the ground truth"]
    assert rows[2] == ["", "APE translation", "mm", "50.00", "25.00", "55.00", "150.0"]
    assert rows[4] == ["", "RPE translation", "mm", "4.000", "2.000", "4.400", "12.00"]
    promises = page.tables["Motions over several frames: RMS of errors and predicted deviations, and NEES"]
    assert promises[0][1] == "position [mm]"
    assert promises[2] == ["5", "7", "20.0", "10.0", "0.100", numbers.DASH, "4.50", "1.20"]
    assert page.pictures == 3 and "frame 6: left and right image" in page.text
    assert "quads_000009.png: no picture" in page.text
    assert "thumbnail_000007.jpg: no picture" in page.text
    # The estimate drifts sideways by 10 mm per frame and is drawn aligned to the first ground-truth pose.
    estimate = next(trace for trace in page.figure("from_above")["data"] if trace["name"] == "QuadEdge")
    truth = next(trace for trace in page.figure("from_above")["data"] if trace["name"] == "ground truth")
    assert len(estimate["x"]) == 11 and truth["x"][0] == 0
    assert estimate["x"][-1] - truth["x"][-1] == pytest.approx(0.11)
    error = page.figure("ape_translation")
    assert error["data"][0]["y"][-1] == pytest.approx(0.11)
    assert error["layout"]["yaxis"]["title"]["text"] == "APE translation [m]"
    assert page.figure("rpe_translation")["layout"]["yaxis"]["title"]["text"] == "RPE translation [mm]"
    predicted = next(trace for trace in error["data"] if trace["name"] == "predicted standard deviation")
    assert predicted["y"][-1] / error["data"][0]["y"][-1] == pytest.approx(np.sqrt(4e-4 * 11) / 0.11, rel=1e-4)
    assert predicted["fill"] == "tozeroy" and "range" not in error["layout"]["yaxis"]
    lost = next(trace for trace in page.figure("quads")["data"] if trace["name"] == "lost frame")
    assert lost["x"] == [pytest.approx(0.7)]
    spatial = page.figure("_trajectory")
    assert spatial["data"][0]["type"] == "scatter3d" and len(spatial["data"][0]["z"]) == 12
    ratio = spatial["layout"]["scene"]["aspectratio"]
    assert ratio["y"] == 1 and ratio["x"] == pytest.approx(np.ptp([2 * np.sin(0.3 * i) for i in range(12)]) / 11, 0.1)
    assert content["config_changed"]


def test_a_page_lists_reasons_of_lost_frames_and_warnings(tmp_path):
    content = write_run(tmp_path / "run", 12)
    file = tmp_path / "run/frames.csv"
    heading, *rows = file.read_text().splitlines()
    messages = {3: "12 stereo edges", 4: "9 stereo edges", 9: '"4 quads, of 20"'}
    for number, message in messages.items():
        status = "lost_too_few_quads" if number == 9 else "lost_too_few_edges"
        rows[number] = rows[number].replace("tracked", status) + "," + message
    rows = [row if number in messages else row + "," for number, row in enumerate(rows)]
    file.write_text("\n".join([heading + ",message", *rows]) + "\n")
    content["warnings"] = [{"frame": None, "text": "--fps 30 contradicts"}, {"frame": 2, "text": "dim images"}]
    content["input"]["dropped"] = 90
    (tmp_path / "run/report.json").write_text(json.dumps(content))
    page = page_of(tmp_path / "run")
    assert page.facts["Frames lost"] == "2 too few edges, 1 too few quads"
    assert page.facts["Pairs dropped"].startswith("90 of a pipe")
    assert page.tables["Lost frames"][1:] == [["3 to 4", "0.300", "too few edges", "12 stereo edges"],
                                              ["9", "0.900", "too few quads", "4 quads, of 20"]]
    assert "Frame 2: dim images" in page.text and "Frame None" not in page.text
    assert "Frames 3, 4 lost: too few edges." in page.text and page.text.count("What to do:") == 2  # reasons of losses
    assert "--fps 30 contradicts" in page.text


def test_tiles_say_what_matters_most_and_warnings_what_to_do(tmp_path):
    content = write_run(tmp_path / "street", 12)
    page = page_of(tmp_path / "street")
    assert page.title == "Tracking report: street (KITTI)"
    assert page.tiles == {"Frames tracked": "12 of 12 none lost", "Drift at the end": "1.2 % 0.250 m after 20.0 m",
                          "Time per frame": "21.0 ms median, 48 frames/s; p99 22.0 ms",
                          "Warnings": "none nothing unusual"}
    assert "What to do" not in page.text
    content["warnings"] = [{"frame": frame, "kind": "static_region", "text": "a bonnet"} for frame in range(2, 10)]
    content["frames_ambiguous"] = 3
    del content["accuracy"]
    content["path_length_m"] = 0.05
    (tmp_path / "street/report.json").write_text(json.dumps(content))
    page = page_of(tmp_path / "street")
    assert page.tiles["Warnings"] == "2 explained below"  # kinds, not frames
    assert page.tiles["Length of the path"] == "50.0 mm no ground truth to compare"
    assert "Frames 2, 3, 4, 5, 6 and 3 more: a bonnet" in page.text and "--mask: an image that is black" in page.text
    assert "In 3 frames the motion may not be" in page.text


def test_every_kind_of_warning_and_every_loss_has_advice():
    from quadedge.report import advice

    header = (Path(report.__file__).parents[3] / "include/quadedge/error.hpp").read_text()
    kinds = re.findall(r"^  (\w+),\s+///<", header.partition("enum class WarningKind {")[2].partition("};")[0], re.M)
    assert len(kinds) > 10 and set(kinds) == set(advice.OF_KIND)
    header = (Path(report.__file__).parents[3] / "include/quadedge/odometry.hpp").read_text()
    reasons = re.findall(r"^  (lost_\w+),", header.partition("enum class FrameStatus {")[2].partition("};")[0], re.M)
    assert len(reasons) > 3 and {results.reason_of(reason) for reason in reasons} == set(advice.OF_LOSS)


def test_a_band_that_would_flatten_the_errors_is_cut(tmp_path):
    write_run(tmp_path / "street", 12, drift=0.001)  # 11 mm at the end, where 66 mm are predicted
    error = page_of(tmp_path / "street").figure("ape_translation")
    assert error["layout"]["yaxis"]["range"] == [0, pytest.approx(1.5 * 11)]
    assert "predicted standard deviation, up to 66 mm" in [trace["name"] for trace in error["data"]]


def test_slow_frames_are_marked_and_explained(tmp_path):
    write_run(tmp_path / "street", 40)
    file = tmp_path / "street/frames.csv"
    rows = [row.split(",") for row in file.read_text().splitlines()]
    names = rows[0]
    for frame, milliseconds in ((1, 160), (20, 170), (30, 180)):
        rows[1 + frame][names.index("latency_ms")] = str(milliseconds)
        rows[1 + frame][names.index("temporal_ms")] = str(milliseconds - 15)
    rows[21][names.index("edges_left")] = "9000"
    file.write_text("\n".join(map(",".join, rows)) + "\n")
    page = page_of(tmp_path / "street")
    assert 'Frame 1 took 160 ms, 145 ms of it in the stage "temporal". OpenCL drivers finish compiling' in page.text
    assert "Frame 20 took 170 ms" in page.text and "It has 9000 edges; the median is 1020." in page.text
    assert "Frame 30 took 180 ms" in page.text and "another program may have used the processor" in page.text
    plot = page.figure("_latency")
    assert plot["layout"]["yaxis"]["range"] == [0, pytest.approx(1.5 * 22)]
    marks = next(trace for trace in plot["data"] if trace["name"] == "slower than the plot")
    assert marks["text"] == ["frame 1: 160 ms", "frame 20: 170 ms", "frame 30: 180 ms"]
    write_run(tmp_path / "even", 40)
    page = page_of(tmp_path / "even")
    assert "range" not in page.figure("_latency")["layout"]["yaxis"] and " took " not in page.text


def test_edges_in_space_move_with_the_path_to_the_ground_truth(tmp_path):
    write_run(tmp_path / "street", 12)
    positions = [(0.1 * i, -1.0, 2.0 + i) for i in range(200)]
    rows = [f"{i},{x:.3f},{y:.3f},{z:.3f}" for i, (x, y, z) in enumerate(positions)]
    (tmp_path / "street/edges.csv").write_text("frame,x_m,y_m,z_m\n" + "\n".join(rows) + "\n")
    turn = "0 0 0.70710678 0.70710678"  # the ground truth's world is turned about the optical axis
    truth = tmp_path / "street/groundtruth.txt"
    truth.write_text("".join(f"{0.1 * i:.9f} 3 1 {i} {turn}\n" for i in range(12)))
    run = results.read_run(tmp_path / "street")
    assert run.edges == pytest.approx(np.array(positions), abs=1e-6)  # the first pose with ground truth is the origin
    cloud = next(trace for trace in page_of(tmp_path / "street").figure("_trajectory")["data"]
                 if trace["name"].startswith("edges"))
    assert len(cloud["x"]) == 198  # without the farthest hundredth; at the near end is the path
    assert cloud["marker"]["color"] == [1.0] * 198  # by height; y points down
    (tmp_path / "street/edges.csv").write_text("frame,x_m\n1,2\n")
    with pytest.raises(report.DamagedResults, match="edges.csv"):
        report.make_page(tmp_path / "street")


def test_maps_of_the_rig_have_one_scale_before_and_after(tmp_path):
    write_run(tmp_path / "street", 12)
    content = write_rig(tmp_path / "street", 0.4)
    page = page_of(tmp_path / "street")
    before, after, columns, _ = (page.figure(name)["data"][0] for name in (
        "rows_before", "rows_after", "columns_before", "columns_after"))
    assert before["z"] == [[-0.8, 0, 0], [0, 0, None]] and after["z"][0] == [0.01] * 3
    assert before["x"] == [99.5, 299.5, 499.5] and before["y"] == [99.5, 299.5]
    assert [before["zmin"], before["zmax"]] == [after["zmin"], after["zmax"]] == [-0.8, 0.8]
    assert columns["zmax"] == 0.25  # that of a small map
    assert page.figure("rows_before")["layout"]["yaxis"]["range"] == [399.5, -0.5]  # downwards
    table = next(rows for title, rows in page.tables.items() if title.startswith("Residuals over the right image"))
    assert table[1] == ["Vertical residuals", "calibration as given", "5", "0.40", "-0.80", "0.10"]
    assert "+0.00\u2009\u00b1\u20090.30 px at the start, -0.12\u2009\u00b1\u20090.02 px at the end" in page.text
    assert "by too little or with too few points" in page.text
    assert page.text.count("No errors above the noise level") == 1
    content["rig"]["row_correction_px"] = 0.85
    (tmp_path / "street/report.json").write_text(json.dumps(content))
    page = page_of(tmp_path / "street")
    assert "The search corrects them by up to 0.85 px" in page.text
    write_rig(tmp_path / "street", 0.01)
    assert page_of(tmp_path / "street").text.count("No errors above the noise level") == 2
    rows = (tmp_path / "street/rig_maps.csv").read_text().splitlines()
    (tmp_path / "street/rig_maps.csv").write_text("\n".join(rows[:4] + rows[5:]))
    with pytest.raises(report.DamagedResults, match="rig_maps.csv: expected the maps of a run"):
        report.make_page(tmp_path / "street")


def test_a_run_without_points_at_new_key_rigs_says_nothing_of_horizontal_residuals(tmp_path):
    write_run(tmp_path / "rest", 9)
    content = write_rig(tmp_path / "rest", 0.01)
    nothing = dict.fromkeys(("rms_px", "largest_px", "scatter_px", "noise_px")) | {"cells": 0}
    content["rig"]["columns"] = {"before": nothing, "after": nothing}
    (tmp_path / "rest/report.json").write_text(json.dumps(content))
    page = page_of(tmp_path / "rest")
    assert page.text.count("No errors above the noise level") == 1
    residuals = next(title for title in page.tables if title.startswith("Residuals over"))
    assert page.row(residuals, "Horizontal residuals")[2:] == ["0", *[numbers.DASH] * 3]


def test_an_interrupted_or_killed_run_has_a_page_of_its_finished_frames(tmp_path):
    content = write_run(tmp_path / "interrupted", 12)
    content["input"]["frames"], content["ended_early"] = 60, "interrupted after 12 of 60 frames"
    (tmp_path / "interrupted/report.json").write_text(json.dumps(content))
    page = page_of(tmp_path / "interrupted")
    assert "The run ended early: interrupted after 12 of 60 frames." in page.text
    write_run(tmp_path / "killed", 12, lost=7)
    for name in ("report.json", "errors.csv", "groundtruth.txt"):  # written at the end
        (tmp_path / "killed" / name).unlink()
    for name in ("frames.csv", "poses.csv", "trajectory.txt"):  # the disk was full
        with open(tmp_path / "killed" / name, "a") as stream:
            stream.write("12,1.2")
    page = page_of(tmp_path / "killed")
    assert "The run ended early: killed after 12 frames" in page.text
    assert page.facts["Frames tracked"] == "11 of 12 (91.7 %)"
    assert page.facts["Frames lost"] == "1 no consensus"
    assert len(page.figure("from_above")["data"][0]["x"]) == 11
    (tmp_path / "killed/frames.csv").write_text((tmp_path / "killed/frames.csv").read_text().splitlines()[0] + "\n")
    with pytest.raises(report.DamagedResults, match="frames.csv: no frame"):
        report.make_page(tmp_path / "killed")


def test_segments_are_told_apart(tmp_path):
    write_run(tmp_path / "street", 14, lost=7, breaks=True)
    page = page_of(tmp_path / "street")
    assert page.facts["Segments"] == "2 segments: an unknown motion lies between frames 6 and 8"
    rows = page.tables["Mean errors of every segment by itself, origin-aligned"]
    assert rows[1][:4] == ["0", "12", "20.00", "1.250"] and rows[1][5] == "20.00"  # [mm]
    assert rows[2][:4] == ["1", "1", numbers.DASH, numbers.DASH]
    paths = {series["name"]: len(series["x"]) for series in page.figure("from_above")["data"]}
    assert paths["QuadEdge"] == 7 and paths["QuadEdge, segment 1"] == 6
    write_run(tmp_path / "whole", 14, lost=7)
    page = page_of(tmp_path / "whole")
    assert "Segments" not in page.facts
    assert "QuadEdge, segment 1" not in [series["name"] for series in page.figure("from_above")["data"]]


def test_a_straight_road_is_drawn_from_the_side_and_a_bent_one_is_not(tmp_path):
    write_run(tmp_path / "straight", 12, 0.002, straight=True)
    write_run(tmp_path / "bent", 12)
    deviation = page_of(tmp_path / "straight").figure("lateral_deviation")
    assert deviation["layout"]["yaxis"]["title"]["text"] == "deviation [mm]"
    estimate = next(trace for trace in deviation["data"] if trace["name"] == "QuadEdge")
    truth = next(trace for trace in deviation["data"] if trace["name"] == "ground truth")
    assert estimate["y"][-1] - truth["y"][-1] == pytest.approx(22, rel=0.01)  # to the right
    assert not any("deviation" in plot for plot in page_of(tmp_path / "bent").plots)


def test_a_run_with_loops_shows_the_corrected_path_and_its_closures(tmp_path):
    content = write_run(tmp_path / "street", 24, drift=0.1)
    truth = (tmp_path / "street" / "groundtruth.txt").read_text()
    (tmp_path / "street" / "trajectory_map.txt").write_text(truth)
    (tmp_path / "street" / "loops.csv").write_text("frame,other,verdict\n20,2,kept\n21,3,not_found\n23,0,kept\n")
    loops = {"compared": 3, "kept": 2, "segments": 1, "frames": 24, "key_rigs": 6, "megabytes": 3, "total_ms": 100}
    (tmp_path / "street" / "report.json").write_text(json.dumps(content | {"loops": loops}))
    run = results.read_run(tmp_path / "street")
    assert np.allclose(run.corrected.positions, run.truth.positions)
    _, above, *_ = sequence_figures.trajectory_figures(run, [], 100)
    series = {trace["name"]: trace for trace in above.traces}
    assert np.allclose(series["QuadEdge, loops closed"]["y"], series["ground truth"]["y"])
    ends = np.array(series["closures"]["y"]).reshape(2, 3)
    assert np.isnan(ends[:, 2]).all()
    assert np.allclose(sorted(ends[0, :2]), run.truth.positions[[2, 20], 2])
    assert "2 closures kept of 3 compared" in page_of(tmp_path / "street").text


def test_closures_and_the_corrected_path_have_a_colour_that_no_segment_has(tmp_path):
    assert max(sequence_figures.MAP_STYLE, sequence_figures.CLOSURE_STYLE) < len(COLOURS)
    write_run(tmp_path / "street", 24, lost=7, breaks=True)
    for path in ("trajectory_map.txt", "groundtruth.txt"):
        (tmp_path / "street" / path).write_text((tmp_path / "street" / "trajectory.txt").read_text())
    (tmp_path / "street" / "loops.csv").write_text("frame,other,verdict\n20,2,kept\n")
    run = results.read_run(tmp_path / "street")
    *_, last = run.segments()
    run.segments = lambda: [(k, last[1]) for k in range(7)]
    _, above, *_ = sequence_figures.trajectory_figures(run, [], 100)
    colours = [(trace["name"], trace["line"]["color"]) for trace in above.traces if "line" in trace]
    segments = {colour for name, colour in colours if name.startswith("QuadEdge, segment")}
    others = [colour for name, colour in colours if name in ("QuadEdge, loops closed", "closures")]
    assert len(others) == 2 and len(set(others) | segments) == 2 + len(segments)


def test_fewer_than_ten_frames_have_tables_and_no_plots(tmp_path):
    write_run(tmp_path / "short", 9)
    page = page_of(tmp_path / "short")
    assert page.plots == [] and "No plots of fewer than 10 frames." in page.text
    assert page.tables["Errors against the ground truth"]


def test_undetermined_rotation_of_an_alignment_is_a_dash_with_its_reason(tmp_path):
    reason = "the positions extend 25 mm around a straight line"
    write_run(tmp_path / "run", 12, errors=accuracy(0.05, reason))
    page = page_of(tmp_path / "run")
    assert page.row("Errors against the ground truth", "SE(3)")[3:] == [numbers.DASH] * 4
    assert reason in page.text


def comparison(tmp_path: Path, batch: Path, names: list[str]) -> Path:
    """One better peer, and a baseline with half the error."""
    entries = []
    for name in names:
        folder = batch / "sequences" / name
        system = {"name": "Other & <Co>", "file": str(folder / "groundtruth.txt"), "accuracy": accuracy(0.01),
                  "per_pose": {"stamp_s": [0, 0.1], "ape_rotation_deg": [0, 0], "ape_translation_m": [0, 0.01],
                               "rpe_rotation_deg": [None, 0], "rpe_translation_m": [None, 0.01]}}
        entries.append({"name": name, "systems": [system], "notes": ["a peer had no file"],
                        "baseline": {"frames": 12, "frames_tracked": 10, "accuracy": accuracy(0.025),
                                     "latency_ms": {"median": 20.0, "p90": 22.0, "p99": 22.0, "max": 22.0,
                                                    "first": 20.0}}})
    file = tmp_path / "comparison.json"
    file.write_text(json.dumps({"sequences": entries, "baseline": "yesterday", "peers": []}))
    return file


def test_page_of_a_batch_has_units_by_size_and_the_latency_of_all(tmp_path):
    write_batch(tmp_path / "batch", ["street", "hall", "yard"])
    page = page_of(tmp_path / "batch")
    # 5 cm and 10 cm: each sequence has the unit of its size.
    assert page.row(ORIGIN_TABLE, "street")[4:6] == [f"50.00{THIN}mm", f"25.00{THIN}mm"]
    assert page.row(ORIGIN_TABLE, "yard")[4:6] == [f"0.1500{THIN}m", f"0.07500{THIN}m"]
    assert page.tables[ORIGIN_TABLE][0][-1] == "RPE translation [mm]"
    assert page.row(ORIGIN_TABLE, "all sequences, poses weighted equally")[4] == f"0.1000{THIN}m"
    assert page.bold == []  # nothing to compare with
    assert page.row("Tracked frames and latency", "hall")[2:5] == ["12 of 12 (100.0 %)", "3", "21.00"]
    assert page.facts["Command"] and page.facts["Configuration"] == "stereo.ncc_min = 0.55"
    assert page.title == "Batch report: batch" and page.tiles["Sequences"] == "3 of 3 done"
    assert page.tiles["Drift at the end"].startswith("1.2 % median of 3 sequences")
    assert sum(plot.endswith("latency") for plot in page.plots) == 3


def test_comparison_names_the_own_row_and_prints_the_best_bold(tmp_path):
    names = ["street", "hall"]
    write_batch(tmp_path / "batch", names)
    page = page_of(tmp_path / "batch", comparison=comparison(tmp_path, tmp_path / "batch", names),
                   output=tmp_path / "page.html")
    own, other = page.tables[ORIGIN_TABLE][2:4]
    assert own[:2] == ["street", "QuadEdge"] and other[:2] == ["", "Other & <Co>"]
    assert own[5] == f"50.00{THIN}mm (+25.00)"
    assert f"10.00{THIN}mm" in page.bold and f"50.00{THIN}mm" not in page.bold
    assert len(page.bold) == 2 * 2 * 3  # APE translation, mean and std, of both alignments, each sequence and over all
    fewer = json.loads((tmp_path / "comparison.json").read_text())
    fewer["sequences"][1]["systems"] = []  # over different data than our row: neither better nor worse
    (tmp_path / "fewer.json").write_text(json.dumps(fewer))
    again = page_of(tmp_path / "batch", comparison=tmp_path / "fewer.json", output=tmp_path / "fewer.html")
    assert len(again.bold) == 2 * 2  # of the other sequence
    assert "Other & <Co>, 2 sequences" in [row[1] for row in page.tables[ORIGIN_TABLE]]
    assert "(+2)" in page.row("Tracked frames and latency", "street")[2]
    assert page.text.count("a peer had no file") == 2
    drawn = next(trace for trace in page.figure("street_from_above")["data"] if trace["name"] == "Other & <Co>")
    assert len(drawn["x"]) == 12
    assert page.facts["Baseline"].startswith("yesterday")


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


@pytest.mark.parametrize("key, value", [
    (["input"], 3), (["input", "frames"], "12"), (["frames_tracked"], None), (["key_rigs"], [1]), (["warnings"], {}),
    (["warnings"], [{"text": 1, "frame": 0}]), (["latency_ms", "p90"], "x"), (["latency_ms"], 4),
    (["device"], "abacus"), (["stages_ms"], [1]), (["stages_ms", "stereo"], {}),
    (["memory_mb", "host_peak"], None), (["config"], 1), (["accuracy"], []),
    (["accuracy", "se3_aligned", "ape_rotation_deg"], 0.1), (["accuracy", "consistency"], [3])])
def test_a_report_of_another_shape_is_named(tmp_path, key, value):
    content = write_run(tmp_path / "street", 12)
    place = content
    for name in key[:-1]:
        place = place[name]
    place[key[-1]] = value
    (tmp_path / "street/report.json").write_text(json.dumps(content))
    with pytest.raises(report.DamagedResults, match=rf"report.json: .*report.{'.'.join(key)}.*; expected the report"):
        report.make_page(tmp_path / "street")


def test_a_failed_member_has_a_reason_and_no_figures(tmp_path):
    summary = write_batch(tmp_path / "batch", ["good"])
    summary["sequences"].append({"name": "broken", "status": "failed", "exit_code": 3, "path": "b", "format": "kitti",
                                 "message": "calib.txt: <nothing> & so on", "jobs": 1})
    (tmp_path / "batch/summary.json").write_text(json.dumps(summary))
    page = page_of(tmp_path / "batch")
    assert "failed: calib.txt: <nothing> & so on" in page.facts["broken"]
    assert page.row("Tracked frames and latency", "broken")[1] == "failed"
    assert page.row(ORIGIN_TABLE, "broken")[1:] == [numbers.DASH] * 9


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


def test_page_of_a_matching_evaluation_shows_both_pools_and_filters_that_are_off(tmp_path):
    save_picture(tmp_path / "all.png", 1900, 600)
    write_matching(tmp_path / "m.json", ["room", "yard"], 6,
                   [{"name": "room", "file": str(tmp_path / "all.png"), "caption": "room: all"}])
    page = page_of(tmp_path / "m.json", output=tmp_path / "m.html")
    table = page.tables["Table 1: stereo"]
    assert table[0][1:] == ["paired: 1\u202f000 edges", "all: 1\u202f300 edges"]
    assert table[4][1:] == ["SIFT", *["off"] * 12]
    assert table[2][2] == f"100.00{THIN}\u00b1{THIN}1.00" and table[2][3] == "0.0070"
    assert page.row("What is left at the end", "pooled")[2] == "48\u202f299"
    assert page.row("What is left at the end", "room")[7:9] == ["96.00", "70.00"]
    assert [row[3].split(THIN)[0] for row in page.tables["Quads"][1:]] == ["90.00", "60.00"]
    filters = page.figure("filters_stereo")
    assert filters["data"][0]["x"] == ["baseline", "epipolar proximity", "NCC", "best"]  # names, no disabled filters
    assert [trace["name"] for trace in filters["data"]] == ["recall, paired", "precision, paired", "recall, all",
                                                            "precision, all"]
    # 250 of 300 values lie within the shown range of the cue, in bins of equal height.
    cumulative = page.figure("cue_stereo_1_cumulative")["data"]
    assert [trace["name"] for trace in cumulative] == ["veridical, paired", "other, paired", "veridical, all",
                                                       "other, all"]
    assert max(cumulative[0]["y"]) == pytest.approx(100 * 250 / 300, rel=1e-4)
    within = page.figure("disparity_error_within")["data"][0]["y"]
    assert within[0] == 0 and within[-1] == pytest.approx(100 * 250 / 300, rel=1e-4)
    motions = page.figure("motions_of_pairs_rotation")
    assert len(motions["data"]) == 3 and len(motions["data"][0]["x"]) == 12
    assert len({trace["marker"]["symbol"] for trace in motions["data"]}) == 3
    assert "rotation -0.75, translation undefined" in page.text
    assert page.pictures == 1
    counts = [plot for plot in page.plots if plot.startswith("figure-counts")]
    assert len(counts) == 8
    for plot in [plot for plot in counts if plot.endswith("_distribution")]:
        # Every image is in one bin of a histogram: heights by bins add up to the number of images.
        for trace in page.figure(plot.removeprefix("figure-"))["data"]:
            assert sum(trace["y"][1:-1:2]) == len(page.figure("counts_edges")["data"][0]["y"])


def test_few_frames_of_a_matching_evaluation_have_no_plots_per_frame(tmp_path):
    write_matching(tmp_path / "m.json", ["room"], 9)
    page = page_of(tmp_path / "m.json", output=tmp_path / "m.html")
    assert not [plot for plot in page.plots if "counts" in plot or "motions" in plot]
    assert "(Figure 2): needs at least 10 frames" in page.text and "(Figure 7): needs at least 10 frames" in page.text
    assert page.row("Counts of a frame", "edges, left")[1] == "9"


def test_every_table_and_figure_becomes_a_file(tmp_path):
    write_run(tmp_path / "street", 12)
    write_rig(tmp_path / "street", 0.4)
    page = page_of(tmp_path / "street", csv=tmp_path / "csv", latex=tmp_path / "tex", figures=tmp_path / "svg")
    assert len(list((tmp_path / "csv").glob("*.csv"))) == len(page.tables)
    assert len(list((tmp_path / "tex").glob("*.tex"))) == len(page.tables)
    rows = list(csv.DictReader((tmp_path / "csv/errors.csv").read_text().splitlines()))
    assert float(rows[0]["mean"]) == statistics(0.5)["mean"] and rows[0]["alignment"] == "origin"
    names = sorted(plot.removeprefix("figure-") for plot in page.plots)
    assert sorted(file.stem for file in (tmp_path / "svg").glob("*.svg")) == names
    assert sorted(file.stem for file in (tmp_path / "svg").glob("*.pdf")) == names
    assert all(file.read_bytes()[:5] == b"%PDF-" for file in (tmp_path / "svg").glob("*.pdf"))


def test_the_same_figure_gives_the_same_bytes(tmp_path):
    figure = Figure("f", "t", "x", "y")
    figure.add("a", [0, 1], [1, 2])
    figure.add("b", [0], [1], points=True)
    first = [file.read_bytes() for file in write_figure(figure, tmp_path)]
    assert [file.read_bytes() for file in write_figure(figure, tmp_path)] == first
    assert b"<text" in first[0]  # text stays text


def test_curves_are_interrupted_where_there_is_no_value():
    figure = Figure("f", "t", "x", "y")
    figure.add("a", [0, 1, 2], [1, np.nan, 3])
    assert rounded(figure.plotly()["data"][0]["y"]) == [1, None, 3]


def test_trajectories_are_aligned_at_the_first_time_that_both_know(tmp_path):
    turned = "0 0 0.70710678 0.70710678"
    (tmp_path / "a.txt").write_text(f"0 9 9 9 0 0 0 1\n1 1 0 0 {turned}\n2 1 1 0 {turned}\n")
    (tmp_path / "b.txt").write_text("1.001 0 0 5 0 0 0 1\n2.001 0 0 6 0 0 0 1\n")
    moved = results.aligned(results.read_tum(tmp_path / "a.txt"), results.read_tum(tmp_path / "b.txt"))
    assert moved.positions[1] == pytest.approx([0, 0, 5])
    assert moved.positions[2] == pytest.approx([1, 0, 5])  # forward along x in its own frame


def test_command_ends_with_the_codes_of_the_program(tmp_path):
    def run(*arguments):
        return subprocess.run([sys.executable, "-m", "quadedge.report", *arguments], capture_output=True, text=True,
                              env=os.environ | {"PYTHONPATH": str(Path(report.__file__).parents[2])})

    write_run(tmp_path / "street", 3)
    done = run(tmp_path / "street")
    assert done.returncode == 0 and done.stdout.strip() == str(tmp_path / "street/report.html")
    (tmp_path / "empty").mkdir()
    missing = run(tmp_path / "empty")
    assert missing.returncode == 3 and "report.json" in missing.stderr and missing.stderr.count("\n") == 1
    unwritable = run(tmp_path / "street", "--output", tmp_path / "absent/page.html")
    assert unwritable.returncode == 3 and "absent" in unwritable.stderr
    assert run().returncode == 2


PROGRAM = os.environ.get("QUADEDGE_PROGRAM")


@pytest.mark.skipif(not PROGRAM, reason="QUADEDGE_PROGRAM names the program")
def test_pages_of_the_program(tmp_path):
    environment = os.environ | {"QUADEDGE_PYTHON": sys.executable, "XDG_CACHE_HOME": str(tmp_path / "cache"),
                                "PYTHONPATH": str(Path(report.__file__).parents[2])}

    def run(*arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], check=True, env=environment, capture_output=True)

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
    assert numbers.significant(1000 * mean) in page.row(ORIGIN_TABLE, "room")[4]
    assert len(page.plots) >= 10
    run("report", tmp_path / "batch", "--baseline", tmp_path / "batch", "-o", tmp_path / "c.html", "--csv",
        tmp_path / "c")
    compared = ParsedPage((tmp_path / "c.html").read_text())
    assert "(=)" in compared.row(ORIGIN_TABLE, "room")[5] and (tmp_path / "c/errors_se3_aligned.csv").is_file()
    run("report", tmp_path / "batch/sequences/room")
    assert ParsedPage((tmp_path / "batch/sequences/room/report.html").read_text()).facts["Device"]
    installed = {name: value for name, value in environment.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-m", "quadedge.matching", tmp_path / "data/room", "--frames", "2", "--quiet",
                    "--html", tmp_path / "m.html"], check=True, env=installed)
    matching = ParsedPage((tmp_path / "m.html").read_text())
    assert matching.tables["Table 1: stereo"][6][2] == "off" and matching.pictures == 3
    assert "Table 3" in " ".join(matching.tables)
