"""What doc/paper.md compares: tables of the matching and errors of trajectories, measured with the paper's method, with
least squares added to it, and with the defaults (scripts/measure.py --only paper), and the tables made from them.
"""

import statistics
import sys
from pathlib import Path

MATCHING = (sys.executable, "-m", "quadedge.matching")  # of the package that this Python has
METHODS = {"paper": ["--preset", "paper"], "fitted": ["--preset", "paper", "--pose.refine", "true"], "default": []}
HEADS = {"paper": "`--preset paper`", "fitted": "with least squares", "default": "default"}
MATCHED = {
    "terrace_2s": ("eth3d_two_view/two_view_training/terrace_2s",),
    "Motorcycle": ("middlebury_2014/Motorcycle-perfect-quarter",),
    "rendered room": ("room", "--frames", 2),
}
# Title -> source, frames, seeds. KITTI 06 starts with frames whose ground truth jumps.
TRACKED = {
    "KITTI 06, from frame 10": ("kitti_odometry/sequences/06", "10:36", 5),
    "KITTI 05": ("kitti_odometry/sequences/05", "0:25", 5),
    "EuRoC MH_01": ("euroc_mh_01_easy", "0:25", 5),
    "rendered room": ("room", 25, 5),
    "rendered cables": ("cables", 20, 5),
}
# Extension -> options without it, for the default; options with it, for the paper's method, or none if it belongs to a
# step that this method has in another form
EXTENSIONS = {
    "least squares": (["--pose.refine", "false", "--pose.local_optimisation_rounds", "0"], ["--pose.refine", "true"]),
    "final fit alone": (["--pose.refine", "false"], None),
    "fit to samples alone": (["--pose.local_optimisation_rounds", "0"], None),
    "disparity offset, with least squares": (["--pose.disparity_offset_sigma", "0"],
                                             ["--pose.refine", "true", "--pose.disparity_offset_sigma", "0.3"]),
    "votes of neighbouring edges": (["--stereo.relaxation_rounds", "0"], None),
    "prior of the alignment": (["--stereo.refine_prior_sigma", "100"], None),
    "scoring by area": (["--pose.scoring_cell", "0"], None),
    "global search": (["--temporal.global_edges", "0"], None),
    "Student-t weights": (["--pose.student_dof", "1000000"], None),
    "budget of edges": (["--edges.budget", "0"], None),
    "Newton step": (["--edges.newton_max", "0"], None),
    "direction at the sub-pixel position": (["--edges.direction_at", "pixel"], None),
    "automatic threshold": (["--edges.threshold", "2"], None),
    "coarse disparity": (["--stereo.coarse_ties", "1"], None),
    "key rig (the paper's, too)": (["--odometry.key_rig", "false"], None),
}
ERRORS = ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m")
SHOWN = ("recall", "precision", "precision_per_edge", "ambiguity_of_pool")
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
    "constraints": [(100, 87.04), (80.73, 89.77), (42.39, 91.60), (22.16, 93.49), (19.40, 94.67)],
}


def source(place, options):
    """A recording below the data, or a built-in scene."""
    return place if "/" not in place and not place.startswith("euroc") else options.data / place


def matching_row(title, method, programs):
    options = programs.options
    place, *frames = MATCHED[title]
    command = [*MATCHING, source(place, options), *frames, *METHODS[method]]
    file = options.work / f"paper_{title.replace(' ', '_')}_{method}.json"
    pooled = programs.result(f"paper: {title}, {method}", file, [*command, "--json", file])["pooled"]
    row = {"title": title, "method": method, "commands": [programs.text(command)], "quads": pooled.get("quads")}
    for table in ("stereo", "temporal_left"):
        row[table] = [{"filter": line["filter"], **{name: line[name] for name in SHOWN}}
                      for line in pooled.get(table, [])]
    row["constraints"] = [{name: line[name] for name in ("recall", "precision")}
                          for line in pooled.get("constraints", [])]
    return row


def tracked(title, label, method, seeds, programs):
    """Errors of Table 4 as lists over seeds, frames tracked and all frames, and the command without the seed."""
    options = programs.options
    place, frames, _ = TRACKED[title]
    command = [options.quadedge, *(["demo", "--scene", place] if isinstance(frames, int) else
                                   ["run", options.data / place]), "--frames", frames, *method]
    errors, found, total = {name: [] for name in ERRORS}, 0, 0
    for seed in range(1, seeds + 1):
        output = options.work / f"paper_{place.replace('/', '_')}_{label}_{seed}"
        report = programs.result(f"paper: {title}, {label}, seed {seed}", output / "report.json",
                                 [*command, "--seed", seed, "-o", output], allowed=(0, 5))
        found, total = found + report["frames_tracked"], total + report["frames_tracked"] + report["frames_lost"]
        for name in ERRORS if report.get("accuracy") else ():
            errors[name].append(report["accuracy"]["origin_aligned"][name]["mean"])
    return errors, {"title": title, "tracked": found, "frames": total, "commands": [programs.text(command)]}


def trajectory_row(title, method, programs):
    """The four errors of Table 4, as mean and standard deviation over seeds of the means over frames."""
    seeds = TRACKED[title][2]
    errors, row = tracked(title, method, METHODS[method], seeds, programs)
    return {**row, "method": method, "seeds": seeds,
            **{name: {"mean": statistics.mean(values), "std": statistics.pstdev(values)}
               for name, values in errors.items()}}


def extension_rows(programs, titles):
    """Errors with the first seed: of both methods, of the default without each extension, of the paper's with it."""
    runs = [("paper", "", METHODS["paper"]), ("default", "", [])]
    for name, (without, alone) in EXTENSIONS.items():
        runs.append(("default", name, without))
        if alone:
            runs.append(("paper", name, [*METHODS["paper"], *alone]))
    for method, name, arguments in runs:
        label = "_".join([method, *(name.replace(",", "").replace("(", "").replace(")", "").split())])
        for title in titles:
            errors, row = tracked(title, label, arguments, 1, programs)
            yield {**row, "kind": "extension", "method": method, "extension": name,
                   **{key: values[0] if values else None for key, values in errors.items()}}


def measure_paper(programs):
    data = programs.options.data
    titles = [title for title, (_, frames, _) in TRACKED.items() if data or isinstance(frames, int)]
    return [*({"kind": "matching", **matching_row(title, method, programs)} for title in MATCHED
              for method in ("paper", "default") if data or "/" not in MATCHED[title][0]),
            *({"kind": "trajectory", **trajectory_row(title, method, programs)} for title in titles
              for method in METHODS),
            *extension_rows(programs, titles)]


def cell(line):
    """Recall, precision as a mean over edges, and ambiguity over all edges of the pool."""
    if not line:
        return "-"
    shares = [f"{100 * line[name]:.1f}" for name in ("recall", "precision_per_edge")]
    return " / ".join([*shares, f"{line['ambiguity_of_pool']:.2f}"])


def filters(rows, table_name, table):
    """One of Tables 1 and 2: what the paper states beside what was measured."""
    rows = [row for row in rows if row["kind"] == "matching" and row[table_name]]
    by_column = {(row["title"], row["method"]): {line["filter"]: line for line in row[table_name]} for row in rows}
    lines = []
    for name, stated in STATED[table_name].items():
        lines.append([name, " / ".join(f"{value:g}" for value in stated),
                      *(cell(found.get(name)) for found in by_column.values())])
    heads = [f"{title}, {HEADS[method]}" for title, method in by_column]
    return table(["after", "paper", *heads], lines)


def stereo(results, table):
    return filters(results["paper"]["rows"], "stereo", table)


def temporal(results, table):
    return filters(results["paper"]["rows"], "temporal_left", table)


def constraints(results, table):
    rows = [row for row in results["paper"]["rows"] if row["kind"] == "matching" and row["constraints"]]
    names = ("baseline", "\\|D\\|", "D . T1", "D . T2", "T1 . T2")
    lines = [[name, f"{recall:g} / {precision:g}",
              *(" / ".join(f"{100 * row['constraints'][order][key]:.1f}" for key in ("recall", "precision"))
                for row in rows)]
             for order, (name, (recall, precision)) in enumerate(zip(names, STATED["constraints"]))]
    return table(["after", "paper", *(f"{row['title']}, {HEADS[row['method']]}" for row in rows)], lines)


def trajectories(results, table, stamp):
    rows = [row for row in results["paper"]["rows"] if row["kind"] == "trajectory"]

    def error(row, name, factor, digits):
        found = row[name]
        spread = f" +- {factor * found['std']:.{digits}f}" if row["seeds"] > 1 else ""
        return f"{factor * found['mean']:.{digits}f}{spread}"

    lines = [[row["title"], HEADS[row["method"]], f"{row['tracked']} of {row['frames']}",
              error(row, "ape_rotation_deg", 1, 3), error(row, "ape_translation_m", 1000, 1),
              error(row, "rpe_rotation_deg", 1, 4), error(row, "rpe_translation_m", 1000, 2)] for row in rows]
    return table(["sequence", "method", "tracked", "APE [deg]", "APE [mm]", "RPE [deg]", "RPE [mm]"], lines,
                 "Means over the frames, and their standard deviations over five seeds. " + stamp(results["paper"]))


def extensions(results, table, stamp):
    """RPE [mdeg / mm] per recording; rows in the order of measurement."""
    rows = [row for row in results["paper"]["rows"] if row["kind"] == "extension"]
    titles = list(dict.fromkeys(row["title"] for row in rows))
    found = {(row["method"], row["extension"], row["title"]): row for row in rows}

    def error(row):
        if row["rpe_rotation_deg"] is None:
            return "-"
        lost = f", {row['frames'] - row['tracked']} lost" if row["tracked"] < row["frames"] else ""
        return f"{1000 * row['rpe_rotation_deg']:.3g} / {1000 * row['rpe_translation_m']:.3g}{lost}"

    names = {("paper", ""): "`--preset paper`", ("default", ""): "default"}
    lines = [[names.get(key, f"{'paper with' if key[0] == 'paper' else 'default without'}: {key[1]}"),
              *(error(found[(*key, title)]) for title in titles)]
             for key in sorted({(row["method"], row["extension"]) for row in rows},
                               key=lambda key: (key[0] == "default", [*EXTENSIONS].index(key[1]) if key[1] else -1))]
    return table(["RPE [mdeg / mm]", *titles], lines, "One seed. " + stamp(results["paper"]))


def commands(results, command_list):
    shown = [row for row in results["paper"]["rows"] if row["kind"] != "extension"]
    return command_list([{**row, "title": f"{row['title']}, {HEADS[row['method']]}"} for row in shown])
