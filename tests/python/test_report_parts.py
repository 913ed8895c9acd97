"""Numbers, tables, figures and advice of quadedge.report, and its command."""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from made_up_results import write_run

from quadedge import report
from quadedge.report import advice, numbers, results
from quadedge.report.figure import Figure, rounded, thinned
from quadedge.report.table import Cell, Table, to_markdown, to_text


def test_numbers_have_four_digits_and_suitable_units():
    assert numbers.significant(0.012345678) == "0.01235"
    assert numbers.significant(1234.5) == "1234"
    assert numbers.significant(-2) == "-2.000"
    assert numbers.significant(1e-15) == "0"
    assert numbers.significant(None) == numbers.significant(float("nan")) == numbers.DASH
    assert numbers.length_text(0.0032) == "3.20 mm"
    assert numbers.length_text(42.1) == "42.1 m"
    assert numbers.length_unit([0.05, None, -0.2]) is numbers.METRE
    assert numbers.count(48299) == "48\u202f299"


def test_thinned_curves_keep_extremes_and_order():
    x = np.arange(1000.0)
    y = np.sin(0.01 * x)
    y[0], y[357], y[900] = np.nan, 9, -7
    thin_x, thin_y = thinned(x, y, 50)
    assert len(thin_x) <= 50 and (np.diff(thin_x) > 0).all()
    assert {9, -7} <= set(thin_y) and not np.isnan(thin_y).any()
    assert len(thinned(x, y, 1000)[0]) == 1000


def test_tables_become_csv_with_unrounded_numbers_and_texts_with_rounded_ones():
    table = Table("t", "50 % & more", ["who_is", ("APE [m]", "mean"), ("APE [m]", "std")], notes=["a reason"],
                  has_result=True)
    table.add("a_b", Cell("1.235", 1.23456789, bold=True), Cell(numbers.DASH, None))
    table.add("all", Cell("2", 2.0), Cell("x"))
    assert list(csv.reader(table.frame("value").to_csv(index=False).splitlines())) == [
        ["who_is", "APE [m] mean", "APE [m] std"], ["a_b", "1.23456789", ""], ["all", "2.0", "x"]]
    assert to_markdown(table).splitlines() == [
        "| who_is | APE [m] mean | APE [m] std |", "|---|--:|--:|", "| a_b | 1.235 | \u2013 |",
        "| all | 2 | x |", "", "a reason"]
    lines = to_text(table).splitlines()
    assert lines[0] == "50 % & more" and "APE [m]" in lines[1] and lines[2].split() == ["who_is", "mean", "std"]
    assert lines[4].split() == ["all", "2", "x"] and lines[5] == "a reason"
    with pytest.raises(ValueError, match="2 cells for 3 columns"):
        table.add("too", "short")


def test_every_kind_of_warning_and_every_loss_has_advice():
    header = (Path(report.__file__).parents[3] / "include/quadedge/error.hpp").read_text()
    kinds = re.findall(r"^  (\w+),\s+///<", header.partition("enum class WarningKind {")[2].partition("};")[0], re.M)
    assert len(kinds) > 10 and set(kinds) == set(advice.OF_KIND)
    header = (Path(report.__file__).parents[3] / "include/quadedge/odometry.hpp").read_text()
    reasons = re.findall(r"^  (lost_\w+),", header.partition("enum class FrameStatus {")[2].partition("};")[0], re.M)
    assert len(reasons) > 3 and {results.reason_of(reason) for reason in reasons} == set(advice.OF_LOSS)


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
