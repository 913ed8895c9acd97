"""The tables that scripts/result_tables.py writes: one function per table, from the JSON of doc/results to Markdown.

`results`: part ("accuracy", "matching" ...) -> what doc/results/PART.json holds; scripts/measure.py says what that is.
"""

import statistics

import pandas
from measurements import EXTENSIONS

PRESETS = ("fast", "default", "dense")
SYSTEMS = {"default": "QuadEdge", "fast": "QuadEdge, fast", "dense": "QuadEdge, dense", "opencv": "OpenCV SIFT + PnP",
           "viso2": "libviso2", "orb_slam3": "ORB-SLAM3", "QuadEdge": "QuadEdge, calibration as given",
           "QuadEdge, learned rig": "QuadEdge, learned from the other half",
           "QuadEdge, --calibrate": "QuadEdge, `--calibrate` (in sample)", "QuadEdge, --loops": "QuadEdge, `--loops`",
           "orb_slam3, learned rig": "ORB-SLAM3, with the same", "viso2, learned rig": "libviso2, with the same"}
STEPS = "keyframes"  # evaluated step by step only, because frames are lost
WHOLE = {"street": "KITTI street, 300 m", "karlsruhe": "Karlsruhe, 226 m", "mh_01": "EuRoC MH_01, 30 s"}
# On the first page: recording, length of sub-paths [m], these, whether the rig is learned
HEADLINE = (("street", 100, "sub_paths", False), ("street", 100, "in_halves", True), ("mh_01", 1, "sub_paths", False))
SHORTEST = {"street": 50, "mh_01": 1}  # sub-paths [m] below which errors are mostly the ground truth's
MATCHED = ("terrace_2s", "rendered room")  # pairs on the page of the paper's method; the JSON has more
METHODS = {"paper": "`--preset paper`", "fitted": "with least squares", "default": "default"}
# Tables 1 to 3 of the paper: row of the program (by filter) -> recall, precision [%], ambiguity
STATED = {
    "stereo": {"epipolar proximity": (100, 3.6, 111.7), "limited disparity": (100, 52.4, 7.2),
               "orientation": (100, 67.5, 4.9), "SIFT": (100, 70.8, 4.5), "NCC": (99.7, 74.3, 4.3),
               "nearly best NCC": (99.6, 81.5, 3.5), "nearly best SIFT": (99.5, 86.6, 2.7),
               "refinement and clustering": (98.4, 96.3, 0.1), "similarity of representatives": (98.3, 96.4, 0.093),
               "best": (98, 98, 0)},
    "temporal_left": {"displacement": (100, 1.28, 463.53), "orientation": (96.07, 5.95, 174.74),
                      "NCC": (93.53, 24.53, 71.07), "SIFT": (82.66, 48.38, 26.13),
                      "nearly best NCC": (82.52, 51.38, 21.78), "nearly best SIFT": (72.25, 67.40, 2.12),
                      "refinement and clustering": (78.00, 83.56, 0.26), "quad agreement": (50.62, 90.79, 0.05)},
    "constraints": {"baseline": (100, 87.04), "\\|D\\|": (80.73, 89.77), "D . T1": (42.39, 91.60),
                    "D . T2": (22.16, 93.49), "T1 . T2": (19.40, 94.67)},
}


def table(head, rows, below=""):
    """`below`: a text under the table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines) + (below and "\n" + below)


def listed(rows, below=""):
    """Rows that are dictionaries with the same keys, the headings; what repeats the first cell above it is left out."""
    cells = [list(row.values()) for row in rows]
    return table(list(rows[0]), [[("" if index and cells[index - 1][0] == row[0] else row[0]), *row[1:]]
                                 for index, row in enumerate(cells)], below)


def crossed(corner, cells, below=""):
    """Cells by row and column, in the order in which they appear; a dash where there is none."""
    frame = pandas.Series(cells).unstack(sort=False).fillna("-")
    return table([corner, *frame.columns], [[name, *row] for name, row in zip(frame.index, frame.values)], below)


def counted(number, noun):
    return f"{number} {noun}" + ("" if number == 1 else "s")


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}" if abs(value) < 10**digits - 0.5 else f"{value:.0f}"


def spread(values, digits=3):
    """The median and, where the last digit but one differs, the range; of a row over seeds, what it says of them."""
    if values is None or any(value is None for value in values):
        return "-"
    middle, least, most = statistics.median(values), min(values), max(values)
    if any(number(least, shown) == number(most, shown) for shown in (digits - 1, digits)):
        return number(middle, digits)
    return f"{number(middle, digits)} ({number(least, digits)} to {number(most, digits)})"


def over_seeds(row, *keys, factor=1, digits=3):
    """A figure of a row of several seeds, with its range."""
    values = []
    for part in (row, row.get("least", row), row.get("most", row)):
        for key in keys:
            part = part.get(key) if isinstance(part, dict) else part[key]
        values.append(None if part is None else factor * part)
    return spread(values, digits)


def percent(value):
    return "-" if value is None else f"{100 * value:.1f} %"


def origin(result):
    return f"{result.get('commit', 'a commit not noted')}, {result['date']}"


def stamp(result):
    return f"Commit {origin(result)}.\n" if "commit" in result else "The commit was not noted.\n"


def seeds_and_stamp(result):
    seeds = max(row.get("seeds", 1) for row in result["rows"])
    return ("One seed. " if seeds == 1 else f"Medians of {seeds} seeds, and their range. ") + stamp(result)


def named(row):
    """The sequence of a row, with the number of frames that its errors are about."""
    title = row["title"].removesuffix(", flight")
    if not row["from_frame"]:
        return f"{title}, {counted(row['frames'], 'frame')}"
    frames = counted(row["frames"] - row["from_frame"], "frame")
    return f"{title.split(',')[0]}, {frames} from frame {row['from_frame']}"


def accuracy_row(row):
    """The cells of a sequence and system."""
    moves = row.get("path_length_m", 0) > 0.5  # a camera at rest has no drift in percent
    return {"sequence": named(row), "system": SYSTEMS[row["system"]],
            "tracked": f"{over_seeds(row, 'tracked')} / {row['frames']}",
            **{f"{kind.upper()} {what}": over_seeds(row, f"{kind}_{key}", factor=factor) for kind in ("ape", "rpe")
               for what, key, factor in (("rotation [deg]", "rotation_deg", 1),
                                         ("translation [mm]", "translation_m", 1e3))},
            "end drift [%]": over_seeds(row, "end_drift_percent", digits=2) if moves else "-"}


def judged_rows(results):
    """The rows but those judged step by step, of rendered scenes on other paths than the ellipse, and of sequences that
    are also evaluated from a later frame, as their ground truth is wrong before it."""
    rows = results["accuracy"]["rows"]
    later = {row["title"].split(", from frame")[0] for row in rows if row["from_frame"]}
    return [row for row in rows
            if row["sequence"] != STEPS and "-" not in row["sequence"] and row["title"] not in later]


def compared(results):
    return listed([accuracy_row(row) for row in judged_rows(results) if row["system"] in ("default", "opencv")],
                  seeds_and_stamp(results["accuracy"]))


def steps(results):
    rows = [row for row in results["accuracy"]["rows"] if row["sequence"] == STEPS]
    names = {"steps right": "right", "wrong, reported as tracked": "wrong", "reported lost": "lost"}
    return listed([{"system": SYSTEMS[row["system"]], **{name: over_seeds(row, "steps", key)
                                                         for name, key in names.items()}} for row in rows],
                  f"{named(rows[0])}. {seeds_and_stamp(results['accuracy'])}")


def normalised_errors(results):
    """Normalised squared errors of motions over 1 to 20 frames, per sequence."""
    cells = {}
    for row in judged_rows(results):
        of = {step["frames"]: index for index, step in enumerate(row.get("consistency", []))}
        for by, text, lengths in (("_by_edges", "edges alone", (1, 20)), ("", "with the calibration", (1, 5, 10, 20))):
            for frames in [length for length in lengths if length in of]:
                cells[named(row), f"{text}, {counted(frames, 'frame')}"] = over_seeds(
                    row, "consistency", of[frames], f"normalised_error_squared{by}", "pose")
    return crossed("NEES", cells, seeds_and_stamp(results["accuracy"]))


def presets(results):
    """One column per preset: time per frame, and errors from frame to frame on all sequences."""
    if "speed" not in results:
        return "*Not measured yet: `scripts/measure.py --only speed`.*\n"
    cells = {}
    for row in results["speed"]["rows"]:
        title = row["title"].rsplit(",", 1)[0].removesuffix(", flight")
        cells[f"time per frame, {title}", row["preset"]] = f"{row['median_ms']:.0f} ms, {row['frame_over_sift']:.2f} S"
    for row in judged_rows(results):
        if "rpe_translation_m" in row and row["system"] in PRESETS:
            cells[f"error per frame [deg; mm], {named(row)}", row["system"]] = (
                f"{over_seeds(row, 'rpe_rotation_deg', digits=2)}; {over_seeds(row, 'rpe_translation_m', factor=1e3)}")
    cells = {(of, f"`--preset {preset}`"): cells.get((of, preset), "-") for of, _ in cells for preset in PRESETS}
    return crossed("", cells, f"Times: commit {origin(results['speed'])}. "
                              f"Errors: commit {origin(results['accuracy'])}.\n")


def matching(results):
    def rates(row):
        return {f"{pool}: {name}": percent(row[pool][name]) for pool in ("paired", "all")
                for name in ("recall", "precision")}

    rows = results["matching"]["rows"]
    return listed([{"pair": row["title"], **rates(row),
                    "disparity error, median": f"{row['disparity_median_px']:.3f} px",
                    "across the edge": f"{row['across_median_px']:.3f} px"} for row in rows]) + "\n" + listed(
        [{"quads": row["title"], **rates(row["quads"])} for row in rows if "quads" in row], stamp(results["matching"]))


def ros2(results):
    """Latency and dropped pairs of topics of ROS 2, by preset, image size and rate."""
    part = results["ros2"]
    (first, start), (last, end) = part["memory_mb"][0], part["memory_mb"][-1]
    return table(("preset", "images [px]", "pairs/s", "dropped", "latency, median / p99 [ms]", "beyond tracking [ms]",
                  "track(), mean [ms]"),
                 [(row["preset"], f"{row['width']} x {row['height']}", row["rate_hz"],
                   f"{row['dropped']} of {row['sent']}",
                   *(" / ".join(f"{value:.1f}" for value in row[name]) for name in ("latency_ms", "beyond_track_ms")),
                   row["mean_track_ms"]) for row in part["rows"]],
                 f"Resident memory of the program after {first} pairs: {start:.0f} MB, after {last}: "
                 f"{end:.0f} MB. {part['cores']} cores, {part['note']}. {stamp(part)}")


def sub_paths(row, length, where="sub_paths"):
    """Over the sub-paths of one length [m], of the whole recording or "in_halves": t_rel [%] and r_rel [deg/100 m] of
    every run, their mean standard deviations over the sub-paths, and the number of these; None without any."""
    found = [entry for run in row["runs"] for entry in run.get(where) or () if entry["length_m"] == length]
    if not found:
        return None
    of = {name: [entry[name] for entry in found] for name in found[0]}
    return {"t_rel": of["t_rel_percent"], "r_rel": [100 * value for value in of["r_rel_deg_per_m"]],
            "t_rel_sd": statistics.mean(of["t_rel_sd_percent"]),
            "r_rel_sd": 100 * statistics.mean(of["r_rel_sd_deg_per_m"]), "count": found[0]["sub_paths"]}


def with_deviation(errors, name):
    return f"{spread(errors[name])} ± {number(errors[f'{name}_sd'], 2)}"


def poses(row):
    return f"{spread([run['poses'] for run in row['runs']])} of {row['frames']}"


def headline(results):
    """Errors of QuadEdge and of the peer with the smallest t_rel, and a sentence that says who is ahead."""
    part, rows, ahead = results["evidence"], [], []
    for name, length, where, learned in HEADLINE:
        of = {row["system"]: errors for row in part["rows"] if row["recording"] == name
              and ("learned" in row["system"]) == learned and (errors := sub_paths(row, length, where))}
        ours = "QuadEdge, learned rig" if learned else "QuadEdge"
        peer = min((system for system in of if "QuadEdge" not in system), default=None,
                   key=lambda system: statistics.median(of[system]["t_rel"]))
        title = WHOLE[name].split(",")[0] + (", in halves" if where == "in_halves" else "")
        for system in [system for system in (ours, peer) if system in of]:
            rows.append({"recording, sub-paths": f"{title}: {of[system]['count']} of {length} m",
                         "system": SYSTEMS[system], "t_rel [%]": with_deviation(of[system], "t_rel"),
                         "r_rel [deg/100 m]": with_deviation(of[system], "r_rel")})
        for error in ("t_rel", "r_rel") if ours in of and peer in of else ():
            if statistics.median(of[peer][error]) < statistics.median(of[ours][error]):
                ahead.append(f"{error} on {title}, where {SYSTEMS[peer].split(',')[0]} is ahead")
    said = "QuadEdge's errors are the smaller ones" + ", except " * bool(ahead) + "; ".join(ahead)
    return listed(rows, f"{said}. ±: deviation over the sub-paths, which overlap; in parentheses the range of "
                        f"{part['seeds']} runs. Commit {origin(part)}.\n")


def whole_row(row, lengths, where="sub_paths"):
    """The cells of a recording and system."""
    runs, cells = row["runs"], {"system": SYSTEMS.get(row["system"], row["system"])}
    if where == "sub_paths":
        cells |= {"frames with a pose": poses(row), "flagged": spread([run.get("flagged") for run in runs])}
    for length in lengths:
        errors = sub_paths(row, length, where)
        cells[f"t_rel; r_rel, {errors['count']} of {length:g} m"] = "; ".join(
            with_deviation(errors, name) for name in ("t_rel", "r_rel"))
    if where == "in_halves":
        return cells
    if row["true_length_m"]:
        longer = [100 * (run["length_m"] / row["true_length_m"] - 1) for run in runs]
        kinds = [warning["kind"].replace("_", " ") for warning in runs[0].get("warnings", [])]
        cells |= {"path too long by [%]": spread(longer, 2), "warnings": ", ".join(kinds) or "-"}
    else:
        cells["ATE [m]"] = spread([run["ate_rmse_m"] for run in runs])
    times = [[run["latency_ms"][name] for run in runs if name in (run.get("latency_ms") or {})]
             for name in ("median", "p99", "max")]
    cells["frame: median; p99; longest [ms]"] = "; ".join(spread(found, 2) for found in times if found) or "-"
    used = [1000 * run["processor_s"] / row["frames"] for run in runs if "processor_s" in run]
    return cells | {"processor [ms]": spread(used or None, 2)}


def evidence(results):
    """Every recording and system with all lengths."""
    text = []
    for name, title in WHOLE.items():
        all_rows = [row for row in results["evidence"]["rows"] if row["recording"] == name]
        whole = [row for row in all_rows if row["runs"] and "learned" not in row["system"]]
        if not whole:
            continue
        first = whole[0]
        true = f" Length by its inertial system: {first['true_length_m']:.1f} m." if first["true_length_m"] else ""
        text.append(f"### {title}\n\n{first['official']}: {counted(first['frames'], 'pair')}, stamps "
                    f"{first['first_stamp_ns']} to {first['last_stamp_ns']} ns, from <{first['source']}>.{true}\n")
        for where in ("sub_paths", "in_halves"):
            rows = [row for row in all_rows if row["runs"] and (where == "sub_paths" or row["runs"][0].get(where))
                    and (where == "in_halves" or row in whole)]
            lengths = sorted({entry["length_m"] for row in rows for run in row["runs"] for entry in run.get(where, [])
                              if entry["length_m"] >= SHORTEST.get(name, 0)})
            if rows:
                title = "Sub-paths within one half:\n\n" if where == "in_halves" else ""
                text.append(title + listed([whole_row(row, lengths, where) for row in rows]))
        text += [f"{SYSTEMS[row['system']]}: {row['left_out']}.\n" for row in all_rows if not row["runs"]]
    return "\n".join(text) + (f"\nMedians of {results['evidence']['seeds']} runs; one of libviso2, `--calibrate` and "
                              f"`--loops`. {stamp(results['evidence'])}")


def evidence_nees(results):
    """NEES of QuadEdge's poses on the whole recordings, with the calibration."""
    cells = {}
    for row in results["evidence"]["rows"]:
        found = [run["consistency"] for run in row["runs"] if run.get("consistency")]
        for frames in (1, 5, 10, 20, 50) if row["system"] == "QuadEdge" and found else ():
            cells[WHOLE[row["recording"]], counted(frames, "frame")] = spread(
                [entry["normalised_error_squared"]["pose"] for of in found for entry in of
                 if entry["frames"] == frames] or None)
    return crossed("NEES", cells)


def paper_rows(results, kind):
    return [row for row in results["paper"]["rows"] if row["kind"] == kind]


def paper_filters(name):
    """One of the paper's tables: what it states beside what was measured."""
    def cells_of(results):
        cells = {(filter, "paper"): "/".join(f"{value:g}" for value in stated)
                 for filter, stated in STATED[name].items()}
        for row in [row for row in paper_rows(results, "matching") if row[name] and row["title"] in MATCHED]:
            lines = row[name] if name != "constraints" else [
                line | {"filter": filter} for line, filter in zip(row[name], STATED[name])]
            for line in [line for line in lines if line["filter"] in STATED[name]]:
                shares = [line["recall"], line.get("precision_per_edge", line["precision"])]
                ambiguity = [f"{line['ambiguity_of_pool']:.2f}"] if "ambiguity_of_pool" in line else []
                cells[line["filter"], f"{row['title']}, {METHODS[row['method']]}"] = "/".join(
                    [*(f"{100 * share:.1f}" for share in shares), *ambiguity])
        return crossed("after", cells)
    return cells_of


def paper_trajectories(results):
    def error(found, factor, digits):
        return f"{factor * found['mean']:.{digits}f}±{factor * found['std']:.{digits}f}"

    return listed([{"sequence": row["title"], "method": METHODS[row["method"]],
                    "tracked": f"{row['tracked']} of {row['frames']}",
                    "APE [deg]": error(row["ape_rotation_deg"], 1, 3),
                    "APE [mm]": error(row["ape_translation_m"], 1000, 1),
                    "RPE [deg]": error(row["rpe_rotation_deg"], 1, 4),
                    "RPE [mm]": error(row["rpe_translation_m"], 1000, 2)} for row in paper_rows(results, "trajectory")],
                  "Means over the frames, and their standard deviations over five seeds. " + stamp(results["paper"]))


def paper_extensions(results):
    """RPE [mdeg / mm] per recording, in the order of EXTENSIONS."""
    names = {("paper", ""): "`--preset paper`", ("default", ""): "default"}
    rows = sorted(paper_rows(results, "extension"),
                  key=lambda row: (row["method"] == "default", ["", *EXTENSIONS].index(row["extension"])))
    cells = {}
    for row in rows:
        key = row["method"], row["extension"]
        extension = key[1].replace("key rig", "keyframe")
        name = names.get(key, f"{'paper with' if key[0] == 'paper' else 'default without'}: {extension}")
        lost = f", {row['frames'] - row['tracked']} lost" if row["tracked"] < row["frames"] else ""
        cells[name, row["title"]] = "-" if row["rpe_rotation_deg"] is None else (
            f"{1000 * row['rpe_rotation_deg']:.3g}/{1000 * row['rpe_translation_m']:.3g}{lost}")
    return crossed("RPE [mdeg/mm]", cells, "One seed. " + stamp(results["paper"]))


# Table -> part that it is made from, function
TABLES = {"compared": ("accuracy", compared), "steps": ("accuracy", steps), "nees": ("accuracy", normalised_errors),
          "presets": ("accuracy", presets), "matching": ("matching", matching),
          "ros2": ("ros2", ros2), "whole": ("evidence", headline), "evidence": ("evidence", evidence),
          "evidence-nees": ("evidence", evidence_nees), "paper-stereo": ("paper", paper_filters("stereo")),
          "paper-temporal": ("paper", paper_filters("temporal_left")),
          "paper-constraints": ("paper", paper_filters("constraints")),
          "paper-trajectories": ("paper", paper_trajectories), "paper-extensions": ("paper", paper_extensions)}
