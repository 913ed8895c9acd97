"""``python -m quadedge.matching`` and ``quadedge.evaluate_matching`` on rendered scenes."""

import json
import os
import subprocess
import sys

import numpy
import pytest
import quadedge
from parsed_page import ParsedPage
from quadedge.matching.counts import Tolerance
from quadedge.matching.observer import observe
from quadedge.matching.sources import RenderedSource

SMALL = ("--size", "320x200", "--quiet")


def evaluate(*arguments, code: int = 0, **environment) -> subprocess.CompletedProcess:
    """Runs python -m quadedge.matching, which has to end with a code."""
    done = subprocess.run([sys.executable, "-m", "quadedge.matching", *map(str, arguments)], capture_output=True,
                          text=True, env=os.environ | environment)
    assert done.returncode == code, done.stderr
    return done


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory):
    """The small room, evaluated with all outputs: the completed process, its folder and its JSON."""
    folder = tmp_path_factory.mktemp("matching")
    outputs = ("--html", folder / "m.html", "--json", folder / "m.json", "--csv", folder / "csv")
    done = evaluate("room", "--frames", 3, *SMALL, *outputs)
    return done, folder, json.loads((folder / "m.json").read_text())


def test_tables_are_printed_and_written(evaluated):
    done, folder, content = evaluated
    assert "=== room: 3 stereo frames ===" in done.stdout
    for title in ("Table 1: stereo", "Table 2: in time, left images", "Quads", "Table 3: pairs of quads"):
        assert title in done.stdout
    pooled = content["pooled"]
    (last,) = [line for line in done.stdout.splitlines() if line.split()[:2] == ["12", "best"]][:1]
    assert f"{100 * pooled['stereo'][-1]['recall']:.2f}" in last
    assert content["pairs"][0]["name"] == "room" and len(content["pairs"][0]["counts"]) == 3
    assert content["input"] == ["room"] and content["config_changed"] == {}
    assert content["command"].startswith("python -m quadedge.matching room --frames 3")
    assert content["device"]["name"] and content["version"] == quadedge.__version__
    assert "stereo" in {file.stem for file in (folder / "csv").iterdir()}
    page = ParsedPage((folder / "m.html").read_text())
    assert "Table 1: stereo" in page.tables and page.outside == []


def test_most_final_edges_are_true_and_tables_begin_with_every_edge(evaluated):
    pooled = evaluated[2]["pooled"]
    for table in ("stereo", "temporal_left", "temporal_right"):
        assert pooled[table][0]["recall"] == 1 and pooled[table][0]["precision"] < 0.02
        recall = [row["recall"] for row in pooled[table] if row["filter"] != "(strictly one-to-one)"]
        assert recall == sorted(recall, reverse=True)
    assert pooled["stereo"][-1]["recall"] > 0.9 and pooled["stereo"][-1]["precision"] > 0.95
    assert pooled["disparity_error_px"]["median"] < 0.1
    assert pooled["quads"]["recall"] > 0.8 and pooled["quads"]["precision"] > 0.9
    pairs = [row["pairs"] for row in pooled["constraints"]]
    assert pairs == sorted(pairs, reverse=True) and pairs[0] > 390_000  # of two frames
    # SIFT is off by default, and its rows say so.
    assert pooled["stereo"][4]["off"] and "off" not in pooled["stereo"][5]


def test_files_are_not_replaced_without_force(evaluated):
    folder = evaluated[1]
    done = evaluate("room", "--frames", 1, *SMALL, "--html", folder / "m.html", code=2)
    assert "m.html exists; use --force to replace it" in done.stderr


def test_a_recording_gives_what_its_scene_gives(evaluated, command, tmp_path):
    command("synth", tmp_path / "room", "--frames", 2, "--size", "320x200", "--quiet")
    evaluate(tmp_path / "room", "--quiet", "--json", tmp_path / "m.json", "--stereo.max_disparity", 60)
    content = json.loads((tmp_path / "m.json").read_text())
    assert [pair["name"] for pair in content["pairs"]] == ["room"]
    # Depths of both files are the rendered ones; only the noise of the poses' text differs.
    limit = {"stereo.max_disparity": 60}  # a recording and a scene suggest different ones
    rendered = quadedge.evaluate_matching(quadedge.synthetic("room", frames=2, width=320, height=200), config=limit)
    for table in ("stereo", "stereo_all"):
        assert content["pooled"][table] == rendered["pooled"][table]
    recorded = quadedge.evaluate_matching(quadedge.open_dataset(tmp_path / "room"), config=limit)
    assert recorded["pooled"] == content["pooled"]


def test_a_stricter_threshold_keeps_less_and_constants_are_checked():
    loose, strict = (quadedge.evaluate_matching(quadedge.synthetic("room", frames=1, width=320, height=200),
                                                config={"stereo.ncc_min": value})["pooled"] for value in (0.3, 0.9))
    assert strict["stereo"][5]["kept"] < loose["stereo"][5]["kept"]
    for words, message in ((("--stereo.ncc_min", "high"), 'stereo.ncc_min: expected a number, found "high"'),
                           (("--stereo.ncc_mim", "0.5"), "did you mean 'stereo.ncc_min'"),
                           (("--pose.refine", "1"), "pose.refine: expected true or false, found 1"),
                           (("--seed",), "--seed: expected --CONSTANT VALUE"),
                           (("--frames", "-1"), "--frames -1: expected 0 or more"),
                           (("--tolerance", "0"), "--tolerance: expected more than 0"),
                           (("--size", "320"), "--size 320: expected WIDTHxHEIGHT")):
        assert message in evaluate("room", *words, code=2).stderr


def test_options_and_files_set_constants(tmp_path):
    (tmp_path / "c.toml").write_text("stereo.ncc_min = 0.6\nedges.budget = 900\n")
    evaluate("room", "--frames", 1, *SMALL, "--config", tmp_path / "c.toml", "--stereo.ncc_min=0.7",
             "--json", tmp_path / "m.json", QUADEDGE_DEVICE="cpu")
    content = json.loads((tmp_path / "m.json").read_text())
    assert content["config_changed"] == {"edges.budget": "900", "stereo.ncc_min": "0.7"}
    assert content["config"]["edges"]["budget"] == 900


class Changed:
    """A source with a change to its frames."""

    def __init__(self, change):
        self._source = RenderedSource(quadedge.synthetic("room", frames=1, width=320, height=200))
        self.rig, self.tracked, self.name, self.frames = self._source.rig, self._source.tracked, "changed", 1
        self._change = change

    def load(self, number):
        frame = self._source.load(number)
        self._change(frame)
        return frame


def last_precision(change):
    result, _ = observe(Changed(change), "auto", "default", {}, 0, Tolerance())
    last = result.frames[0].stereo[-1]  # of all edges
    return last["veridical"] / last["kept"]


def test_truth_that_is_off_by_two_pixels_leaves_almost_no_true_edges():
    def shift(frame):
        frame.truth.left = frame.truth.left + numpy.float32(2)
        frame.truth.right = frame.truth.right + numpy.float32(2)

    assert last_precision(lambda frame: None) > 0.9
    assert last_precision(shift) < 0.05


def test_the_papers_method_has_the_papers_rows(room_folder):
    pooled = quadedge.evaluate_matching(quadedge.open_dataset(room_folder), preset="paper", frames=2)["pooled"]
    assert [row["filter"] for row in pooled["stereo"]] == [
        "baseline", "epipolar proximity", "limited disparity", "orientation", "SIFT", "NCC", "nearly best NCC",
        "nearly best SIFT", "refinement and clustering", "similarity of representatives", "best"]
    assert [row["filter"] for row in pooled["temporal_left"]] == [
        "baseline", "displacement", "orientation", "NCC", "SIFT", "nearly best NCC", "nearly best SIFT",
        "refinement and clustering", "quad agreement", "best"]
    last, (refined, agreed) = pooled["stereo"][-1], pooled["temporal_left"][7:9]
    assert last["recall"] > 0.95 and last["precision_per_edge"] > 0.95
    assert last["ambiguity_of_pool"] < 0  # edges without a match count, too
    assert refined["recall"] > 0.5 and agreed["precision_per_edge"] > max(0.8, refined["precision_per_edge"])


def test_a_tap_sees_what_the_odometry_reports_and_changes_nothing(room, frames):
    class Counter(quadedge.Tap):
        def edges(self, left, right):
            self.left, self.right, self.filters, self.found = len(left), len(right), [], []

        def stereo_filter(self, filter, candidates):
            assert len(candidates.first) == self.left + 1 and candidates.first[-1] == len(candidates)
            assert not len(candidates) or candidates.target.max() < self.right
            self.filters.append(filter)

        def stereo(self, edges):
            self.stereo_edges = edges

        def quads(self, quads):
            self.found.append(quads)

    with quadedge.Odometry(room) as odometry, quadedge.Odometry(room) as plain:
        odometry.set_tap(tap := Counter())
        for frame in frames[:3]:
            seen = odometry.track(frame.stamp_ns, frame.left, frame.right)
            unseen = plain.track(frame.stamp_ns, frame.left, frame.right)
            numpy.testing.assert_array_equal(seen.world_from_left, unseen.world_from_left)
            assert (tap.left, tap.right) == (seen.counts.edges_left, seen.counts.edges_right)
            assert len(tap.stereo_edges) == seen.counts.stereo_edges
            assert [int(one) for one in tap.filters] == list(range(1, 12))
        assert tap.filters[0].title == "epipolar proximity"
        found = tap.found[seen.diagnostics.search]
        assert len(found) == seen.counts.quads and (found.previous == odometry.details().quads.previous).all()
        odometry.set_tap(None)
        tap.filters = None
        odometry.track(frames[3].stamp_ns, frames[3].left, frames[3].right)
        assert tap.filters is None


def test_an_exception_of_a_tap_ends_the_frame(room, frames):
    class Broken(quadedge.Tap):
        def stereo(self, edges):
            raise KeyError("no such edge")

    with quadedge.Odometry(room) as odometry:
        odometry.set_tap(Broken())
        with pytest.raises(KeyError, match="no such edge"):
            odometry.track(frames[0].stamp_ns, frames[0].left, frames[0].right)
        odometry.set_tap(None)
        odometry.restart()
        assert odometry.track(frames[1].stamp_ns, frames[1].left, frames[1].right).is_tracked


def test_sources_and_numbers_of_frames_are_checked(room):
    with pytest.raises(TypeError, match="expected a Dataset or a Synthetic"):
        quadedge.evaluate_matching(None)
    with pytest.raises(quadedge.UsageError, match="frames is -1"):
        quadedge.evaluate_matching(room, frames=-1)
