"""The page of a run matches its result files."""

import csv
import struct
import zlib

import numpy as np
import pytest
from made_up_results import ORIGIN, accuracy, statistics, write_report, write_run
from parsed_page import page_of, save_picture

from quadedge import report
from quadedge.report import numbers, results, sequence_figures
from quadedge.report.figure import COLOURS


def png_header(width: int, height: int) -> bytes:
    """A grey PNG picture that ends after a size and a first piece of data."""
    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes(1000))))


def test_page_of_a_run_shows_its_origin_and_the_files_content(tmp_path):
    write_run(tmp_path / "street", 12, lost=7)
    save_picture(tmp_path / "street/pictures/thumbnail_000005.jpg", 480, 300)
    save_picture(tmp_path / "street/pictures/quads_000005.png", 1280, 960)
    save_picture(tmp_path / "street/pictures/pair_000006.jpg", 960, 300)
    (tmp_path / "street/pictures/thumbnail_000007.jpg").write_text("no picture")
    (tmp_path / "street/pictures/quads_000009.png").write_bytes(png_header(60000, 60000))
    page = page_of(tmp_path / "street")
    assert page.facts.items() >= {
        "Program": "QuadEdge 1.2.3, commit 0123456789ab", "Date": "2026-05-04 03:02:01 UTC",
        "Device": "abacus (wood, none, driver 1)", "Configuration": "stereo.ncc_min = 0.55",
        "Input": "a/street (kitti), 12 frames of 640 x 480 px", "Command": ORIGIN["command"],
        "Frames tracked": "11 of 12 (91.7 %)", "Frames lost": "1 no consensus"}.items()
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
    above = page.traces("from_above")
    estimate, truth = above["QuadEdge"], above["ground truth"]
    assert len(estimate["x"]) == 11 and truth["x"][0] == 0
    assert estimate["x"][-1] - truth["x"][-1] == pytest.approx(0.11)
    error = page.figure("ape_translation")
    assert error["data"][0]["y"][-1] == pytest.approx(0.11)
    assert error["layout"]["yaxis"]["title"]["text"] == "APE translation [m]"
    assert page.figure("rpe_translation")["layout"]["yaxis"]["title"]["text"] == "RPE translation [mm]"
    predicted = page.traces("ape_translation")["predicted standard deviation"]
    assert predicted["y"][-1] / error["data"][0]["y"][-1] == pytest.approx(np.sqrt(4e-4 * 11) / 0.11, rel=1e-4)
    assert predicted["fill"] == "tozeroy" and "range" not in error["layout"]["yaxis"]
    assert page.traces("quads")["lost frame"]["x"] == [pytest.approx(0.7)]
    spatial = page.figure("_trajectory")
    assert spatial["data"][0]["type"] == "scatter3d" and len(spatial["data"][0]["z"]) == 12
    ratio = spatial["layout"]["scene"]["aspectratio"]
    assert ratio["y"] == 1 and ratio["x"] == pytest.approx(np.ptp([2 * np.sin(0.3 * i) for i in range(12)]) / 11, 0.1)


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
    write_report(tmp_path / "run", content)
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
    write_report(tmp_path / "street", content)
    page = page_of(tmp_path / "street")
    assert page.tiles["Warnings"] == "2 explained below"  # kinds, not frames
    assert page.tiles["Length of the path"] == "50.0 mm no ground truth to compare"
    assert "Frames 2, 3, 4, 5, 6 and 3 more: a bonnet" in page.text and "--mask: an image that is black" in page.text
    assert "In 3 frames the motion may not be" in page.text


def test_a_band_that_would_flatten_the_errors_is_cut(tmp_path):
    write_run(tmp_path / "street", 12, drift=0.001)  # 11 mm at the end, where 66 mm are predicted
    error = page_of(tmp_path / "street").figure("ape_translation")
    assert error["layout"]["yaxis"]["range"] == [0, pytest.approx(1.5 * 11)]
    assert "predicted standard deviation, up to 66 mm" in [trace["name"] for trace in error["data"]]


def test_slow_frames_are_marked(tmp_path):
    write_run(tmp_path / "street", 40)
    file = tmp_path / "street/frames.csv"
    rows = [row.split(",") for row in file.read_text().splitlines()]
    names = rows[0]
    for frame, milliseconds in ((1, 160), (20, 170), (30, 180)):
        rows[1 + frame][names.index("latency_ms")] = str(milliseconds)
        rows[1 + frame][names.index("temporal_ms")] = str(milliseconds - 15)
    file.write_text("\n".join(map(",".join, rows)) + "\n")
    page = page_of(tmp_path / "street")
    assert page.figure("_latency")["layout"]["yaxis"]["range"] == [0, pytest.approx(1.5 * 22)]
    marks = page.traces("_latency")["slower than the plot"]
    assert marks["text"] == ["frame 1: 160 ms", "frame 20: 170 ms", "frame 30: 180 ms"]
    write_run(tmp_path / "even", 40)
    page = page_of(tmp_path / "even")
    assert "range" not in page.figure("_latency")["layout"]["yaxis"]


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
    traces = page_of(tmp_path / "street").traces("_trajectory")
    cloud = next(trace for name, trace in traces.items() if name.startswith("edges"))
    assert len(cloud["x"]) == 198  # without the farthest hundredth; at the near end is the path
    assert cloud["marker"]["color"] == [1.0] * 198  # by height; y points down
    (tmp_path / "street/edges.csv").write_text("frame,x_m\n1,2\n")
    with pytest.raises(report.DamagedResults, match="edges.csv"):
        report.make_page(tmp_path / "street")


def test_an_interrupted_or_killed_run_has_a_page_of_its_finished_frames(tmp_path):
    content = write_run(tmp_path / "interrupted", 12)
    content["input"]["frames"], content["ended_early"] = 60, "interrupted after 12 of 60 frames"
    write_report(tmp_path / "interrupted", content)
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
    rows = page.tables["Errors of every segment by itself, origin-aligned"]
    assert rows[2][:4] == ["0", "12", "20.00", "1.250"] and rows[2][6:8] == ["20.00", "10.00"]  # [mm]
    assert rows[3][:4] == ["1", "1", numbers.DASH, numbers.DASH]
    paths = page.traces("from_above")
    assert len(paths["QuadEdge"]["x"]) == 7 and len(paths["QuadEdge, segment 1"]["x"]) == 6
    write_run(tmp_path / "whole", 14, lost=7)
    page = page_of(tmp_path / "whole")
    assert "Segments" not in page.facts
    assert "QuadEdge, segment 1" not in page.traces("from_above")


def test_a_run_with_loops_shows_the_corrected_path_and_its_closures(tmp_path):
    content = write_run(tmp_path / "street", 24, drift=0.1)
    truth = (tmp_path / "street" / "groundtruth.txt").read_text()
    (tmp_path / "street" / "trajectory_map.txt").write_text(truth)
    (tmp_path / "street" / "loops.csv").write_text("frame,other,verdict\n20,2,kept\n21,3,not_found\n23,0,kept\n")
    loops = {"compared": 3, "kept": 2, "segments": 1, "frames": 24, "key_rigs": 6, "megabytes": 3, "total_ms": 100}
    write_report(tmp_path / "street", content, loops=loops)
    run = results.read_run(tmp_path / "street")
    assert np.allclose(run.corrected.positions, run.truth.positions)
    _, above, *_ = sequence_figures.trajectory_figures(run, 100)
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
    _, above, *_ = sequence_figures.trajectory_figures(run, 100)
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


@pytest.mark.parametrize("key, value", [
    (["input"], 3), (["frames_tracked"], None), (["warnings"], 4), (["warnings"], [3]), (["latency_ms", "p90"], "x"),
    (["latency_ms"], {}), (["device"], "abacus"), (["stages_ms"], [1]), (["memory_mb", "host_peak"], None),
    (["config"], 1), (["accuracy"], [1]), (["accuracy", "se3_aligned", "ape_rotation_deg"], 0.1),
    (["accuracy", "consistency"], [3])])
def test_a_report_of_another_shape_is_named(tmp_path, key, value):
    content = write_run(tmp_path / "street", 12)
    place = content
    for name in key[:-1]:
        place = place[name]
    place[key[-1]] = value
    write_report(tmp_path / "street", content)
    with pytest.raises(report.DamagedResults, match=r"street/report.json: .*; expected "):
        report.make_page(tmp_path / "street")


def test_every_table_becomes_a_file(tmp_path):
    write_run(tmp_path / "street", 12)
    page = page_of(tmp_path / "street", csv=tmp_path / "csv")
    assert len(list((tmp_path / "csv").glob("*.csv"))) == len(page.tables)
    rows = list(csv.DictReader((tmp_path / "csv/errors.csv").read_text().splitlines()))
    assert float(rows[0]["mean"]) == statistics(0.5)["mean"] and rows[0]["alignment"] == "origin"
