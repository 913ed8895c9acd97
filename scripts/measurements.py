"""The measurements of scripts/measure.py, one function per part, as rows with their commands."""

import itertools
import json
import math
import shlex
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

import disturbances
from paper_comparison import MATCHING, measure_paper

REPOSITORY = Path(__file__).resolve().parent.parent
RECORDED = {
    "kitti06": "kitti_odometry/sequences/06",
    "kitti01": "kitti_odometry/sequences/01",
    "rest": "euroc_v1_01_easy_at_rest",
    "flight": "euroc_mh_01_easy",
    "keyframes": "euroc_v1_01_easy_keyframes",
}
SCENES = disturbances.SCENES
PATHS = ("handheld", "drive", "loop")  # besides the ellipse
# Run -> scene and path; a run on the ellipse has the name of its scene.
RENDERED = {**{scene: (scene, "ellipse") for scene in SCENES},
            **{f"{scene}-{path}": (scene, path) for path in PATHS for scene in SCENES}}
# Title, run, first evaluated frame
JUDGED = (
    ("KITTI 06", "kitti06", 0),
    ("KITTI 06, from frame 10", "kitti06", 10),
    ("KITTI 01", "kitti01", 0),
    ("EuRoC MH_01, flight", "flight", 0),
    ("EuRoC V1_01 at rest", "rest", 0),
    ("EuRoC V1_01 key frames", "keyframes", 0),
    *((f"rendered {scene}" + (f", {path}" if path != "ellipse" else ""), run, 0)
      for run, (scene, path) in RENDERED.items()),
)
PRESETS = ("fast", "default", "dense")
SYSTEMS = ("default", "fast", "dense", "opencv")
ERRORS = ("ape_rotation_deg", "ape_translation_m", "rpe_rotation_deg", "rpe_translation_m")
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
MATCHED_FRAMES = 3  # per rendered scene
TIMED = {
    "built-in room": "room",
    "built-in facade": "facade",
    "KITTI 06": RECORDED["kitti06"],
    "EuRoC MH_01, flight": RECORDED["flight"],
}
COMPLETE = "complete"  # empty file in the folder of a finished run


class Problem(Exception):
    """An error to report to the user."""


class Programs:
    """Runs the programs and records the commands as a reader would type them."""

    def __init__(self, options):
        self.options = options
        self.tracked = set()  # folders of the runs of this call: two rows may evaluate the same run

    def call(self, command, allowed=(0,)):
        command = [str(part) for part in command]
        try:
            result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        except OSError as error:
            raise Problem(f"{command[0]} cannot be started: {error.strerror}") from error
        if result.returncode not in allowed:
            raise Problem(f"{shlex.join(command)}\nended with code {result.returncode}: {result.stderr.strip()}")

    def result(self, what, file, command, allowed=(0,)):
        """The JSON that a command writes to the path `file`; --keep reuses it. `what` is printed before it runs."""
        if not (self.options.keep and file.exists()):
            print(what, file=sys.stderr, flush=True)
            self.call([*command, "--quiet", "--force"], allowed)
        return json.loads(file.read_text(encoding="utf-8"))

    def text(self, command):
        """The command with DATA, OUT and plain program names instead of the paths of this machine."""
        names = {str(self.options.quadedge): "quadedge", str(self.options.baseline): "opencv_baseline",
                 sys.executable: "python"}
        parts = [names.get(str(part), str(part)) for part in command]
        short = {str(self.options.work): "OUT", str(self.options.data): "DATA", str(REPOSITORY): "."}
        for index, part in enumerate(parts):
            for folder, name in short.items():
                if part == folder or part.startswith(folder + "/"):
                    parts[index] = part = name + part[len(folder) :]
        return shlex.join(part for part in parts if part not in ("--quiet", "--force"))


def scene_of(run):
    """A rendered scene and the options of its path."""
    scene, path = RENDERED[run]
    return scene, [] if path == "ellipse" else ["--path", path]


def source_of(run, options):
    """Arguments of `quadedge run` or `demo`."""
    if run in RECORDED:
        return ["run", options.data / RECORDED[run], *(["--frames", f"0:{options.frames}"] if options.frames else [])]
    scene, path = scene_of(run)
    return ["demo", "--scene", scene, *path, *(["--frames", options.frames] if options.frames else [])]


def track(system, run, seed, programs):
    """Tracks a sequence with a system. Returns the folder of its results, the truth, and the command."""
    options = programs.options
    output = options.work / (system if seed == 1 else f"{system}_{seed}") / run
    truth = options.data / RECORDED[run] if run in RECORDED and not options.frames else output / "groundtruth.txt"
    if system == "opencv":
        scene, path = (options.data / RECORDED[run], []) if run in RECORDED else scene_of(run)
        command = [options.baseline, scene, *path, "-o", output,
                   *(["--frames", options.frames] if options.frames else [])]
    else:
        method = [] if system == "default" else ["--preset", system]
        command = [options.quadedge, *source_of(run, options), "-o", output, *method, "--seed", seed, "--quiet"]
    if output not in programs.tracked and not (options.keep and (output / COMPLETE).exists()):
        print(f"{system}: {run}", file=sys.stderr, flush=True)
        shutil.rmtree(output, ignore_errors=True)
        programs.call(command, allowed=(0, 5))  # 5: many frames lost, which is a result as well
        (output / COMPLETE).touch()
        programs.tracked.add(output)
    return output, truth, command


def judge(system, title, run, first, seed, programs):
    """One row: errors and steps of a system on a sequence, origin-aligned."""
    output, truth, command = track(system, run, seed, programs)
    estimate, judged = output / "trajectory.txt", output / f"evaluation_{first}.json"
    frames = sum(1 for _ in open(output / "trajectory_kitti.txt", encoding="utf-8"))
    tracked = sum(1 for line in open(estimate, encoding="utf-8") if not line.startswith("#"))
    steps = disturbances.STEP_OF_RENDERED if run in RENDERED else ()
    evaluate = [programs.options.quadedge, "evaluate", "trajectory", estimate, truth, "--steps", *steps,
                *(["--from-frame", first] if first else [])]
    row = {"system": system, "title": title, "sequence": run, "frames": frames, "tracked": tracked, "from_frame": first,
           "commands": [programs.text(command), programs.text(evaluate)]}
    if tracked - first < 3:
        return row  # nothing to compare
    programs.call([*evaluate, "--force", "--json", judged])
    evaluation = json.loads(judged.read_text(encoding="utf-8"))
    accuracy = evaluation["accuracy"]
    row.update({name: accuracy["origin_aligned"][name]["mean"] for name in ERRORS})
    row["se3_ape_translation_m"] = accuracy["se3_aligned"]["ape_translation_m"]["mean"]
    row.update(path_length_m=accuracy["path_length_m"], end_drift_percent=accuracy["end_drift_percent"])
    row["steps"] = {name: evaluation["steps"][name] for name in ("right", "wrong", "lost")}
    if system == "default" and first == 0:
        report = json.loads((output / "report.json").read_text(encoding="utf-8"))
        row["consistency"] = report.get("accuracy", {}).get("consistency", [])
    return row


def combined(values, how):
    """`how` (a median, min or max) of figures, which may be in dictionaries and lists; texts are those of the first."""
    first = values[0]
    if isinstance(first, dict):
        return {name: combined([value[name] for value in values], how) for name in first}
    if isinstance(first, list):
        return [combined(list(each), how) for each in zip(*values)]
    return first if first is None or isinstance(first, str) else how(values)


def over_seeds(rows):
    """One row for the runs with several seeds: medians, and the least and the greatest figures as rows of their own."""
    if any(row.keys() != rows[0].keys() for row in rows):
        raise Problem(f"{rows[0]['title']}: with some seeds, too few poses to compare")
    least, most = ({name: value for name, value in combined(rows, how).items() if name != "commands"}
                   for how in (min, max))
    return {**combined(rows, statistics.median_low), "seeds": len(rows), "least": least, "most": most}


def measure_accuracy(programs):
    options = programs.options
    return [over_seeds([judge(system, *entry, seed, programs)
                        for seed in range(1, 2 if system == "opencv" else options.seeds + 1)])
            for entry in JUDGED if entry[1] in options.sequences for system in options.systems
            if system in ("default", "opencv") or entry[1] in RECORDED or entry[1] in SCENES]


def matching_row(title, places, programs):
    """Both pools of the last row of Table 1, and of the quads if there are poses."""
    options = programs.options
    frames = ["--frames", min(MATCHED_FRAMES, options.frames or MATCHED_FRAMES)] if isinstance(places, str) else []
    paths = [places] if isinstance(places, str) else [options.data / place for place in places]
    command = [*MATCHING, *paths, *frames]
    file = options.work / f"matching_{title.replace(' ', '_').replace(',', '')}.json"
    pooled = programs.result(f"matching: {title}", file, [*command, "--json", file])["pooled"]

    def figures(table):
        return {name: table[name] for name in ("recall", "precision")}

    row = {"title": title, "commands": [programs.text(command)], "paired": figures(pooled["stereo"][-1]),
           "all": figures(pooled["stereo_all"][-1]), "disparity_median_px": pooled["disparity_error_px"]["median"],
           "across_median_px": pooled["across_error_px"]["median"]}
    if "quads" in pooled:
        row["quads"] = {"paired": figures(pooled["quads"]), "all": figures(pooled["quads_all"])}
    return row


def measure_matching(programs):
    options = programs.options
    return [matching_row(title, places, programs) for title, places in MATCHED.items()
            if (places in options.sequences if isinstance(places, str) else options.data)]


def measure_speed(programs):
    options = programs.options
    rows = []
    for (title, place), preset in itertools.product(TIMED.items(), PRESETS):
        if place not in SCENES and not options.data:
            continue
        print(f"speed: {title}, {preset}", file=sys.stderr, flush=True)
        file = options.work / f"speed_{title.replace(' ', '_').replace(',', '')}_{preset}.json"
        command = [options.quadedge, "bench", *(["--scene", place] if place in SCENES else [options.data / place]),
                   "--frames", options.frames or 30, "--warm-up", 3, "--baseline",
                   *(["--preset", preset] if preset != "default" else [])]
        programs.call([*command, "--quiet", "--force", "--json", file])
        bench = json.loads(file.read_text(encoding="utf-8"))
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


def measure_disturbances(programs):
    """Every disturbance in every scene, and the plot if matplotlib is installed."""
    options = programs.options
    rows = []
    for scene in (scene for scene in SCENES if scene in options.sequences):
        for kind, (_, values, _) in disturbances.KINDS.items():
            print(f"disturbances: {scene}, {kind}", file=sys.stderr, flush=True)
            size = (options.frames or 5, "640x332")
            rows += [disturbances.measure(scene, kind, value, 0, size, programs) for value in values]
    try:
        disturbances.plot(rows, options.out)
    except ImportError:
        print("measure: matplotlib is missing; the plot of the disturbances remains unchanged", file=sys.stderr)
    return rows


def measure_light(programs):
    """Low contrast and low light in two scenes, with the former fixed edge threshold and with the automatic one."""
    options = programs.options
    rows = []
    for scene in (scene for scene in ("room", "cables") if scene in options.sequences):
        for kind, (_, values, _) in disturbances.LIGHT.items():
            print(f"light: {scene}, {kind}", file=sys.stderr, flush=True)
            size = (options.frames or 26, "480x249")
            rows += [disturbances.measure(scene, kind, value, threshold, size, programs)
                     for value in values for threshold in (2, 0)]
    return rows


def drift_of(scene, seed, programs):
    """End error and RMS error of the positions, origin-aligned [mm], parts of the end error [mm], path length [m]."""
    options = programs.options
    folder = options.work / "drift" / f"{scene}_{seed}"
    if not (options.keep and (folder / "trajectory.txt").exists()):
        print(f"drift: {scene}, texture {seed}", file=sys.stderr, flush=True)
        programs.call([options.quadedge, "demo", "--scene", scene, "--scene-seed", seed, "--frames",
                       options.frames or 480, "--size", "480x249", "-o", folder, "--quiet", "--force"], allowed=(0, 5))
    truth, found = ([[float(value) for value in line.split()] for line in (folder / name).open(encoding="utf-8")
                     if line[0] != "#"] for name in ("groundtruth.txt", "trajectory.txt"))
    true = {round(row[0], 6): row[1:4] for row in truth}
    parts = [[1e3 * (b - a) for a, b in zip(true[round(row[0], 6)], row[1:4])] for row in found]
    lengths = [math.hypot(*part) for part in parts]
    return {"end_mm": lengths[-1], "rms_mm": math.hypot(*lengths) / math.sqrt(len(lengths)), "end_parts_mm": parts[-1],
            "path_m": sum(math.dist(one[1:4], other[1:4]) for one, other in zip(found, found[1:])),
            "frames": len(found)}


def measure_drift(programs):
    """Long rendered sequences with three textures, and the part of the drift that all textures share."""
    rows = []
    for scene in (scene for scene in ("room", "cables") if scene in programs.options.sequences):
        runs = [drift_of(scene, seed, programs) for seed in (1, 2, 3)]
        rows.append({"scene": scene, "end_mm": statistics.mean(run["end_mm"] for run in runs),
                     "rms_mm": statistics.mean(run["rms_mm"] for run in runs),
                     "end_percent": statistics.mean(run["end_mm"] / run["path_m"] for run in runs) / 10,
                     "mean_end_parts_mm": [*map(statistics.mean, zip(*(run["end_parts_mm"] for run in runs)))],
                     "runs": runs})
    return rows


PARTS = {"accuracy": measure_accuracy, "matching": measure_matching, "speed": measure_speed,
         "disturbances": measure_disturbances, "light": measure_light, "drift": measure_drift,
         "paper": measure_paper}
