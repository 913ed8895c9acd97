#!/usr/bin/env python3
"""Loads the results of `quadedge batch` into pandas tables and plots them: an example to build on.

    load_batch.py OUT PLOT.png

Needs pandas and matplotlib. The functions can be imported:

    from load_batch import load_summary, load_frames, load_errors, load_trajectory
    errors = load_errors("results").groupby("sequence")["ape_translation_m"].describe()
"""

import sys
from pathlib import Path

import pandas

TUM_COLUMNS = ["stamp_s", "tx", "ty", "tz", "qx", "qy", "qz", "qw"]


def load_summary(output):
    """One row per sequence, including failed ones; columns as in summary.csv (degrees, metres, milliseconds)."""
    table = pandas.read_csv(Path(output) / "summary.csv")
    return table[table["kind"] == "sequence"].drop(columns="kind").set_index("sequence")


def load_per_sequence(output, name):
    """The CSV files NAME of all sequences concatenated, with the sequence in the first column."""
    tables = {file.parent.name: pandas.read_csv(file) for file in sorted(Path(output).glob(f"sequences/*/{name}"))}
    return pandas.concat(tables, names=["sequence", "row"]).reset_index("row", drop=True).reset_index()


def load_frames(output):
    """One row per input frame of all sequences: status, counts, times in milliseconds."""
    return load_per_sequence(output, "frames.csv")


def load_errors(output):
    """One row per pose that has ground truth: absolute and relative errors, origin-aligned, in degrees and metres."""
    return load_per_sequence(output, "errors.csv")


def load_trajectory(output, sequence, name="trajectory.txt"):
    """The poses of the left camera, one per row; "groundtruth.txt" for the true poses."""
    return pandas.read_csv(Path(output) / "sequences" / sequence / name, sep=" ", comment="#", names=TUM_COLUMNS)


def plot(output, file):
    """Errors and latencies of all sequences in one plot."""
    import matplotlib

    matplotlib.use("Agg")  # no window
    from matplotlib import pyplot

    errors, frames = load_errors(output), load_frames(output)
    errors = errors.dropna(subset="rpe_translation_m")  # the first pose, whose errors the alignment makes zero
    columns = [(errors, "ape_translation_m", "APE translation [m]"), (errors, "ape_rotation_deg", "APE rotation [deg]"),
               (frames, "latency_ms", "latency [ms]")]
    figure, axes = pyplot.subplots(1, len(columns), figsize=(5 * len(columns), 4.5), layout="constrained")
    for axis, (table, column, label) in zip(axes, columns):
        groups = table.dropna(subset=column).groupby("sequence")[column]
        axis.boxplot([values for _, values in groups], tick_labels=[name for name, _ in groups])
        axis.set_ylabel(label)
        axis.set_yscale("log" if (groups.max() > 0).all() and groups.max().max() > 20 * groups.max().min()
                        else "linear")
        axis.tick_params(axis="x", rotation=40)
        for tick in axis.get_xticklabels():
            tick.set_horizontalalignment("right")
    figure.savefig(file, dpi=120)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    output, file = sys.argv[1:]
    summary = load_summary(output)
    print(summary[["status", "frames", "tracked", "origin_aligned_ape_rotation_deg_mean",
                   "origin_aligned_ape_translation_m_mean",
                   "latency_ms_median"]].to_string())
    plot(output, file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
