"""The measurements of scripts/measure.py, one function per part, as rows with their commands."""

import itertools
import math
import statistics
import sys

from harness import STEP_OF_RENDERED, means, over_seeds, positions, report
from recordings import measure_recordings

RECORDED = {
    "kitti06": "kitti_odometry/sequences/06",
    "kitti01": "kitti_odometry/sequences/01",
    "rest": "euroc_v1_01_easy_at_rest",
    "flight": "euroc_mh_01_easy",
    "keyframes": "euroc_v1_01_easy_keyframes",
}
SCENES = ("room", "cables", "facade")
# Title, run, first evaluated frame
JUDGED = (
    ("KITTI 06", "kitti06", 0),
    ("KITTI 06, from frame 10", "kitti06", 10),
    ("KITTI 01", "kitti01", 0),
    ("EuRoC MH_01, flight", "flight", 0),
    ("EuRoC V1_01 at rest", "rest", 0),
    ("EuRoC V1_01 key frames", "keyframes", 0),
    *((f"rendered {scene}", scene, 0) for scene in SCENES),
)
PRESETS = ("fast", "default", "dense")
SYSTEMS = ("default", "fast", "dense", "opencv")
MATCHING = (sys.executable, "-m", "quadedge.matching")  # of the package that this Python has
MATCHED = {
    "ETH3D terrace_2s": ("eth3d_two_view/two_view_training/terrace_2s",),
    "Middlebury Motorcycle": ("middlebury_2014/Motorcycle-perfect-quarter",),
    "Middlebury teddy, Art, Dolls, Reindeer": ("middlebury_2003/teddy", "middlebury_2005/Art",
                                               "middlebury_2005/Dolls", "middlebury_2005/Reindeer"),
    "Middlebury Laundry": ("middlebury_2005/Laundry",),
    "rendered room": "room",
    "rendered cables": "cables",
    "rendered facade": "facade",
}
TIMED = {
    "built-in room": "room",
    "built-in facade": "facade",
    "KITTI 06": RECORDED["kitti06"],
    "EuRoC MH_01, flight": RECORDED["flight"],
}
METHODS = {"paper": ["--preset", "paper"], "fitted": ["--preset", "paper", "--pose.refine", "true"], "default": []}
OF_PAPER = ("terrace_2s", "Motorcycle", "rendered room")
# Title -> source, frames, seeds. KITTI 06 starts with frames whose ground truth jumps.
TRACKED = {
    "KITTI 06, from frame 10": ("kitti_odometry/sequences/06", "10:36"),
    "KITTI 05": ("kitti_odometry/sequences/05", "0:25"),
    "EuRoC MH_01": ("euroc_mh_01_easy", "0:25"),
    "rendered room": ("room", 25),
    "rendered cables": ("cables", 20),
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
SHOWN = ("recall", "precision", "precision_per_edge", "ambiguity_of_pool")


def judge(system, title, run, first, seed, programs):
    """One row: errors and steps of a system on a sequence, origin-aligned."""
    options = programs.options
    folder = options.work / (system if seed == 1 else f"{system}_{seed}") / run
    is_recorded = run in RECORDED
    frames = ["--frames", f"0:{options.frames}" if is_recorded and system != "opencv" else options.frames]
    frames = frames if options.frames else []
    if system == "opencv":
        source = [options.data / RECORDED[run]] if is_recorded else [run]
        command = [options.baseline, *source, *frames]
        programs.run(folder, command)
        command = programs.text([*command, "-o", folder])
    else:
        source = ["run", options.data / RECORDED[run]] if is_recorded else ["demo", "--scene", run]
        method = [] if system == "default" else ["--preset", system]
        command, _ = programs.track(folder, [*source, *frames], method, seed)
    truth = options.data / RECORDED[run] if is_recorded and not options.frames else folder / "groundtruth.txt"
    said, evaluated = programs.evaluate(folder, truth, "--steps", *(() if is_recorded else STEP_OF_RENDERED),
                                        *(["--from-frame", first] if first else []))
    row = {"system": system, "title": title, "sequence": run,
           "frames": sum(1 for _ in open(folder / "trajectory_kitti.txt", encoding="utf-8")),
           "tracked": len(positions(folder)), "from_frame": first, "commands": [command, evaluated]}
    if said:
        accuracy = said["accuracy"]
        row |= means(accuracy) | {"path_length_m": accuracy["path_length_m"],
                                  "end_drift_percent": accuracy["end_drift_percent"],
                                  "steps": {name: said["steps"][name] for name in ("right", "wrong", "lost")}}
        if system == "default" and first == 0:
            row["consistency"] = report(folder).get("accuracy", {}).get("consistency", [])
    return row


def measure_accuracy(programs):
    options = programs.options
    return [over_seeds([judge(system, *entry, seed, programs)
                        for seed in range(1, 2 if system == "opencv" else options.seeds + 1)])
            for entry in JUDGED if entry[1] in options.sequences for system in options.systems]


def evaluate_matching(title, places, frames, method, programs):
    """What quadedge.matching says of data sets or of a rendered scene, pooled, and its command."""
    paths = [places] if isinstance(places, str) else [programs.options.data / place for place in places]
    frames = ["--frames", min(frames, programs.options.frames or frames)] if isinstance(places, str) else []
    command = [*MATCHING, *paths, *frames, *METHODS[method]]
    file = programs.options.work / f"matching_{title.replace(' ', '_').replace(',', '')}_{method}.json"
    return (programs.result(f"matching: {title}, {method}", file, command)["pooled"],
            {"title": title, "commands": [programs.text(command)]})


def measure_matching(programs):
    """Both pools of the last row of Table 1, and of the quads if there are poses."""
    rows = []
    for title, places in MATCHED.items():
        if not (places in programs.options.sequences if isinstance(places, str) else programs.options.data):
            continue
        pooled, row = evaluate_matching(title, places, 3, "default", programs)
        found = {pool: {"quads": pooled.get(f"quads{suffix}"), "stereo": pooled[f"stereo{suffix}"][-1]}
                 for pool, suffix in (("paired", ""), ("all", "_all"))}
        shares = {what: {pool: {name: of[what][name] for name in ("recall", "precision")} for pool, of in found.items()}
                  for what in ("stereo", "quads") if found["all"][what]}
        rows.append({**row, **shares.pop("stereo"), "disparity_median_px": pooled["disparity_error_px"]["median"],
                     "across_median_px": pooled["across_error_px"]["median"], **shares})
    return rows


def measure_speed(programs):
    options = programs.options
    rows = []
    for (title, place), preset in itertools.product(TIMED.items(), PRESETS):
        if place not in SCENES and not options.data:
            continue
        file = options.work / f"speed_{title.replace(' ', '_').replace(',', '')}_{preset}.json"
        command = [options.quadedge, "bench", *(["--scene", place] if place in SCENES else [options.data / place]),
                   "--frames", options.frames or 30, "--warm-up", 3, "--baseline",
                   *(["--preset", preset] if preset != "default" else [])]
        file.unlink(missing_ok=True)  # times of different commits do not compare
        bench = programs.result(f"speed: {title}, {preset}", file, command)
        rows.append({"title": f"{title}, {bench['input']['width']}x{bench['input']['height']}", "preset": preset,
                     "commands": [programs.text(command)], "device": bench["device"]["name"],
                     "platform": bench["device"]["platform"], "threads": bench["threads"],
                     "edges_per_image": bench["counts"]["edges_left"], "frames": bench["frames_measured"],
                     "median_ms": bench["latency_ms"]["median"], "p90_ms": bench["latency_ms"]["p90"],
                     "p99_ms": bench["latency_ms"]["p99"], "processor_ms": bench["processor_ms"]["median"],
                     "frame_over_sift": bench["baseline"]["frame_ratio"],
                     "edges_ms": bench["edge_detection_ms"]["median"],
                     "edges_over_filters": bench["baseline"]["edges_ratio"],
                     "host_peak_mb": bench["memory_mb"]["host_peak"]})
    return rows


def tracked(title, label, method, seeds, programs):
    """Errors of Table 4 of every seed, and the row with frames tracked and the command of the last seed."""
    place, frames = TRACKED[title]
    source = ["demo", "--scene", place] if isinstance(frames, int) else ["run", programs.options.data / place]
    errors, row = [], {"title": title, "tracked": 0, "frames": 0}
    for seed in range(1, seeds + 1):
        folder = programs.options.work / "paper" / f"{place.replace('/', '_')}_{label}_{seed}"
        command, _ = programs.track(folder, [*source, "--frames", frames], method, seed)
        found = report(folder)
        row |= {"tracked": row["tracked"] + found["frames_tracked"], "commands": [command],
                "frames": row["frames"] + found["frames_tracked"] + found["frames_lost"]}
        errors += [means(found["accuracy"])] if found.get("accuracy") else []
    return errors, row


def measure_paper(programs):
    """The matching and trajectories of the paper's method beside the default, and, with the first seed, the default
    without each extension and the paper's method with it."""
    data, rows = programs.options.data, []
    titles = [title for title, (_, frames) in TRACKED.items() if data or isinstance(frames, int)]
    for title, method in itertools.product(OF_PAPER, ("paper", "default")):
        places = next(places for name, places in MATCHED.items() if name.endswith(title))
        if isinstance(places, str) or data:
            pooled, row = evaluate_matching(title, places, 2, method, programs)
            rows.append({"kind": "matching", **row, "method": method, "quads": pooled.get("quads"),
                         **{table: [{"filter": line["filter"], **{name: line[name] for name in SHOWN}}
                                    for line in pooled.get(table, [])] for table in ("stereo", "temporal_left")},
                         "constraints": [{name: line[name] for name in ("recall", "precision")}
                                         for line in pooled.get("constraints", [])]})
    for title, method in itertools.product(titles, METHODS):
        errors, row = tracked(title, method, METHODS[method], 5, programs)
        rows.append({"kind": "trajectory", **row, "method": method, "seeds": 5, **{
            name: {"mean": statistics.mean(each[name] for each in errors),
                   "std": statistics.pstdev(each[name] for each in errors)} for name in errors[0]}})
    runs = [("paper", "", METHODS["paper"]), ("default", "", [])]
    for name, (without, alone) in EXTENSIONS.items():
        runs += [("default", name, without), *([("paper", name, [*METHODS["paper"], *alone])] if alone else [])]
    for method, name, arguments in runs:
        label = "_".join([method, *"".join(letter for letter in name if letter not in ",()").split()])
        for title in titles:
            errors, row = tracked(title, label, arguments, 1, programs)
            rows.append({**row, "kind": "extension", "method": method, "extension": name,
                         **(errors[0] if errors else {"rpe_rotation_deg": None})})
    return rows


def measure_live(programs):
    from measure_ros2 import measure_topics  # which needs cyclonedds and rosbags

    return measure_topics(programs)


PARTS = {"accuracy": measure_accuracy, "matching": measure_matching, "speed": measure_speed,
         "paper": measure_paper, "evidence": measure_recordings, "ros2": measure_live}
