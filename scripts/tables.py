"""The tables that scripts/result_tables.py writes: one function per table, from the JSON of doc/results to Markdown.

`results`: part ("accuracy", "matching" ...) -> what doc/results/PART.json holds; scripts/measure.py says what that is.
"""

import statistics

import disturbances as sweeps
import paper_comparison

PRESETS = ("fast", "default", "dense")
SYSTEMS = {"default": "QuadEdge", "fast": "QuadEdge, fast", "dense": "QuadEdge, dense",
           "opencv": "OpenCV SIFT + PnP"}
STEPS = "keyframes"  # evaluated step by step only, because frames are lost


def counted(number, noun):
    return f"{number} {noun}" + ("" if number == 1 else "s")


def named(row):
    """The sequence of a row, with the number of frames that its errors are about."""
    title = row["title"].removesuffix(", flight")
    if not row["from_frame"]:
        return f"{title}, {counted(row['frames'], 'frame')}"
    frames = counted(row["frames"] - row["from_frame"], "frame")
    return f"{title.split(',')[0]}, {frames} from frame {row['from_frame']}"


def table(head, rows, below=""):
    """`below`: a text under the table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines) + (below and "\n" + below)


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}" if abs(value) < 10**digits - 0.5 else f"{value:.0f}"


def spread(middle, least, most, digits=3):
    """A median and, where the last digit but one differs, the range."""
    if middle is None or any(number(least, shown) == number(most, shown) for shown in (digits - 1, digits)):
        return number(middle, digits)
    return f"{number(middle, digits)} ({number(least, digits)} to {number(most, digits)})"


def over_seeds(row, *keys, factor=1, digits=3):
    """A figure of a row of several seeds, with its range."""
    values = []
    for part in (row, row.get("least", row), row.get("most", row)):
        for key in keys:
            part = part.get(key) if isinstance(part, dict) else part[key]
        values.append(None if part is None else factor * part)
    return spread(*values, digits)


def mm(row, name, digits=3):
    """A length of a row of several seeds, in millimetres."""
    return over_seeds(row, name, factor=1e3, digits=digits)


def percent(value):
    return "-" if value is None else f"{100 * value:.1f} %"


def drift(row):
    """In percent of the path length; a dash for a camera at rest."""
    return over_seeds(row, "end_drift_percent", digits=2) if row.get("path_length_m", 0) > 0.5 else "-"


def origin(result):
    return f"{result.get('commit', 'a commit not noted')}, {result['date']}"


def stamp(result):
    return f"Commit {origin(result)}.\n" if "commit" in result else "The commit was not noted.\n"


def command_list(rows):
    """The commands behind each row."""
    lines = [f"| {row['title']} | " + "<br>".join(f"`{command}`" for command in row["commands"]) + " |" for row in rows]
    return "\n".join(["| what | commands |", "|---|---|", *lines]) + "\n"


def judged_rows(results):
    """The rows but those judged step by step, and of rendered scenes on other paths than the ellipse, which have tables
    of their own."""
    return [row for row in results["accuracy"]["rows"] if row["sequence"] != STEPS and "-" not in row["sequence"]]


def errors(results, systems):
    """One row per sequence and system."""
    rows, shown = [], None
    for row in judged_rows(results):
        if row["system"] not in systems:
            continue
        cells = ["" if named(row) == shown else named(row), SYSTEMS[row["system"]],
                 f"{over_seeds(row, 'tracked')} / {row['frames']}"]
        for kind in ("ape", "rpe"):
            cells += [over_seeds(row, f"{kind}_rotation_deg"), mm(row, f"{kind}_translation_m")]
        rows.append([*cells, drift(row)])
        shown = named(row)
    head = ["sequence", "system", "tracked", "APE rotation [deg]", "APE translation [mm]", "RPE rotation [deg]",
            "RPE translation [mm]", "end drift [%]"]
    return table(head, rows, seeds_and_stamp(results["accuracy"]))


def seeds_and_stamp(result):
    seeds = max(row.get("seeds", 1) for row in result["rows"])
    return ("One seed. " if seeds == 1 else f"Medians of {seeds} seeds, and their range. ") + stamp(result)


def compared(results):
    return errors(results, ("default", "opencv"))


def systems(results):
    return errors(results, tuple(SYSTEMS))


def steps(results):
    judged = [row for row in results["accuracy"]["rows"] if row["sequence"] == STEPS and "steps" in row]
    rows = [[SYSTEMS[row["system"]], *(over_seeds(row, "steps", name) for name in ("right", "wrong", "lost"))]
            for row in judged]
    head = [named(judged[0]) if judged else "", "steps right", "wrong, reported as tracked", "reported lost"]
    return table(head, rows, seeds_and_stamp(results["accuracy"]))


def paths(results):
    """One row per rendered scene and path."""
    rows = []
    for row in results["accuracy"]["rows"]:
        if row["sequence"] == STEPS or not row["title"].startswith("rendered"):
            continue
        rows.append([row["title"].removeprefix("rendered "), SYSTEMS[row["system"]],
                     f"{over_seeds(row, 'tracked')} / {row['frames']}",
                     *(over_seeds(row, "steps", name) if "steps" in row else "-"
                       for name in ("right", "wrong", "lost")),
                     over_seeds(row, "rpe_rotation_deg"), mm(row, "rpe_translation_m"),
                     number(row.get("path_length_m")), drift(row) if "end_drift_percent" in row else "-"])
    head = ["scene, path", "system", "tracked", "steps right", "wrong", "lost", "RPE rotation [deg]",
            "RPE translation [mm]", "path length [m]", "end drift [%]"]
    return table(head, rows, seeds_and_stamp(results["accuracy"]))


def step_error(row):
    """Mean error in mm and the numbers of wrong and lost steps; empty where a value was not measured."""
    if row is None:
        return ""
    error = row["rpe_translation_m"]
    notes = [f", {row[what]} {what}" for what in ("wrong", "lost") if row[what]]
    return ("-" if error is None else f"{1e3 * error:.2f}") + "".join(notes)


def disturbances(results):
    """Mean error of a step, a block of rows per disturbance."""
    rows, kept = [], results["disturbances"]["rows"]
    width = max(len(values) for _, values, _ in sweeps.KINDS.values())
    for kind, (label, values, _) in sweeps.KINDS.items():
        if not any(row["kind"] == kind for row in kept):
            continue
        rows.append([label, "", *values, *[""] * (width - len(values))])
        for scene in dict.fromkeys(row["scene"] for row in kept):
            found = {row["value"]: row for row in kept if row["kind"] == kind and row["scene"] == scene}
            cells = [step_error(found.get(value)) for value in values]
            rows.append(["", scene, *cells, *[""] * (width - len(cells))])
    head = ["error per step [mm]", f"{counted(kept[0]['frames'], 'frame')} each", *[""] * width]
    return table(head, rows, stamp(results["disturbances"]))


def pace(results):
    """Frames per second, and beside libviso2 where both ran in turn, for the README."""
    others, rows = results["peers"], []
    for title, timed in others["frames_per_second"].items():
        own = {row.get("preset", "default"): row for row in results["speed"]["rows"] if row["title"].startswith(title)}
        both = [own[preset] for preset in ("default", "fast")]
        rows.append([title.removesuffix(", flight"), *(f"{1000 / row['median_ms']:.0f}" for row in both), "-",
                     timed.get("OpenCV", "-"), ", ".join(f"{row['processor_ms']:.0f}" for row in both),
                     origin(results["speed"])])
    for title, timed in others["libviso2"]["in_turn"].items():
        rates = [f"{1000 / statistics.median(timed[name]):.0f}" if name in timed else "-"
                 for name in ("quadedge_ms", "fast_ms", "libviso2_ms")]
        rows.append([f"{title}, alternating runs", *rates, "-", "-", origin(timed)])
    return table(["frames per second", "QuadEdge", "`fast`", "libviso2", "OpenCV SIFT + PnP",
                  "processor time per frame: QuadEdge, `fast` [ms]", "QuadEdge commit"], rows,
                 others["timed"] + "\n")


POOL_RATES = ["paired: recall", "precision", "all: recall", "precision"]


def pool_rates(row):
    """Cells under POOL_RATES."""
    return [percent(row[pool][name]) for pool in ("paired", "all") for name in ("recall", "precision")]


def matching(results):
    rows = [[row["title"], *pool_rates(row), f"{row['disparity_median_px']:.3f} px",
             f"{row['across_median_px']:.3f} px"] for row in results["matching"]["rows"]]
    head = ["pair", *POOL_RATES, "disparity error, median", "across the edge"]
    return table(head, rows, stamp(results["matching"]))


def quads(results):
    rows = [[row["title"], *pool_rates(row["quads"])] for row in results["matching"]["rows"] if "quads" in row]
    return table(["quads", *POOL_RATES], rows, stamp(results["matching"]))


def speed(results):
    # Heading, key in speed.json, format
    columns = (("sequence", "title", "{}"), ("preset", "preset", "{}"),
               ("edges per image", "edges_per_image", "{:.0f}"), ("frame, median", "median_ms", "{:.0f} ms"),
               ("p90", "p90_ms", "{:.0f} ms"), ("p99", "p99_ms", "{:.0f} ms"),
               ("processor time", "processor_ms", "{:.0f} ms"), ("frames/s", "frames_per_second", "{:.1f}"),
               ("frame / S", "frame_over_sift", "{:.2f}"),
               ("edges of one image", "edges_ms", "{:.1f} ms"),
               ("host memory", "host_peak_mb", "{:.0f} MB"))
    rows = [{"preset": "default", "frames_per_second": 1000 / row["median_ms"]} | row
            for row in results["speed"]["rows"]]
    cells = [[form.format(row[key]) if key in row else "-" for _, key, form in columns] for row in rows]
    machine = f"{rows[0]['platform']}, {rows[0]['device']}, {rows[0]['threads']} threads. "
    return table([name for name, _, _ in columns], cells, machine + stamp(results["speed"]))


def presets(results):
    """One column per preset: time per frame, and errors from frame to frame on all sequences."""
    if "speed" not in results:
        return "*Not measured yet: `scripts/measure.py --only speed`.*\n"
    times = {(row.get("preset", "default"), row["title"].rsplit(",", 1)[0]): row for row in results["speed"]["rows"]}
    timed = list(dict.fromkeys(title for _, title in times))
    errors_of = {}
    for row in judged_rows(results):
        if "rpe_translation_m" in row:
            errors_of.setdefault(named(row), {})[row["system"]] = row
    rows = []
    for title in timed:
        found = [times.get((preset, title)) for preset in PRESETS]
        cells = [f"{row['median_ms']:.0f} ms, {row['frame_over_sift']:.2f} S" if row else "-" for row in found]
        rows.append([f"time per frame, {title.removesuffix(', flight')}", *cells])
    for title, found in errors_of.items():
        cells = [f"{over_seeds(row, 'rpe_rotation_deg', digits=2)}; {mm(row, 'rpe_translation_m')}" if row else "-"
                 for row in map(found.get, PRESETS)]
        rows.append([f"error per frame [deg; mm], {title}", *cells])
    speed_at, accuracy_at = (stamp(results[part]).replace("Commit", "commit") for part in ("speed", "accuracy"))
    return table(["", *(f"`--preset {preset}`" for preset in PRESETS)], rows,
                 f"Times: {speed_at.rstrip()} Errors: {accuracy_at}")


def light(results):
    """Steps over contrast, light and gamma, with the fixed edge threshold and the automatic one."""
    kept = results["light"]["rows"]
    runs = {(row["scene"], row["kind"], row["value"], row["threshold"] == 0): row for row in kept}
    lines = []
    for scene, kind, value, automatic in runs:
        if not automatic:
            continue
        fixed, found = runs[scene, kind, value, False], runs[scene, kind, value, True]
        cells = [f"{sweeps.LIGHT[kind][0]} {value:g}", scene]
        for row in (fixed, found):
            cells += [f"{row['right']}, {row['wrong']}, {row['lost']}", f"{row['edges']:.0f}"]
        lines.append([*cells, number(found["edge_threshold"])])
    head = ["", "scene", "fixed: right, wrong, lost", "edges", "automatic: right, wrong, lost", "edges", "threshold"]
    return table(head, lines, f"{counted(kept[0]['frames'], 'frame')} each. " + stamp(results["light"]))


def peers(results):
    """Other systems; QuadEdge's time and drift come from the measurements."""
    kept = results["peers"]
    rows = [list(row) for row in kept["rows"]]
    own = [row for row in results.get("speed", {}).get("rows", [])
           if row["title"].startswith("KITTI 06") and row.get("preset", "default") == "default"]
    for row in rows:
        if row[1] == "measured":
            row[1] = f"{own[0]['median_ms']:.0f} ms" if own else "-"
        if row[2] == "measured":
            drifts = {found["scene"]: f"{found['end_percent']:.2f} %" for found in results["drift"]["rows"]}
            row[2] = f"{drifts['room']}, {drifts['cables']}"
    return table(kept["head"], rows)


def drift_over_scenes(results):
    """End errors of long rendered sequences."""
    rows = []
    for row in results["drift"]["rows"]:
        ends = " ".join(number(run["end_mm"], 2) for run in row["runs"])
        parts = ", ".join(f"{part:+.1f}" for part in row["mean_end_parts_mm"])
        rows.append([row["scene"], f"{ends} mm", f"{row['end_percent']:.3f} %", f"({parts}) mm",
                     f"{number(row['rms_mm'], 2)} mm"])
    head = ["scene", "end error of each texture", "mean, of the path length", "mean vector", "rms along the path"]
    return table(head, rows, stamp(results["drift"]))


def consistency(results):
    """Errors of motions over several lengths beside the deviations that their covariances predict."""
    rows, shown = [], None
    for row in judged_rows(results):
        for index, step in enumerate(row.get("consistency", [])):
            if step["frames"] not in (1, 10, 20, 40, 100):
                continue
            rows.append(["" if named(row) == shown else named(row), step["frames"],
                         *(over_seeds(row, "consistency", index, name, factor=1e3)
                           for name in ("error_m", "promised_m")),
                         *(over_seeds(row, "consistency", index, name) for name in ("error_deg", "promised_deg")),
                         *(normalised(row, index, by) for by in ("_by_edges", ""))])
            shown = named(row)
    head = ["sequence", "frames apart", "translation: error, rms [mm]", "predicted [mm]", "rotation: error [deg]",
            "predicted [deg]", "NEES, edges alone", "NEES, with the calibration"]
    return table(head, rows, seeds_and_stamp(results["accuracy"]))


def normalised(row, index, by):
    """The NEES of the poses of a row, `by` "_by_edges" alone or with the calibration ("")."""
    return over_seeds(row, "consistency", index, f"normalised_error_squared{by}", "pose")


def normalised_errors(results):
    """Normalised squared errors of motions over 1 to 20 frames, per sequence."""
    rows = []
    for row in judged_rows(results):
        wanted = [index for index, step in enumerate(row.get("consistency", [])) if step["frames"] in (1, 5, 10, 20)]
        if wanted:
            rows.append([named(row), *(normalised(row, index, "_by_edges") for index in (wanted[0], wanted[-1])),
                         *(normalised(row, index, "") for index in wanted)])
    head = ["NEES", "edges alone, 1 frame", "20 frames", "with the calibration, 1 frame", "5", "10", "20"]
    return table(head, rows, seeds_and_stamp(results["accuracy"]))


def ros2(results):
    """Latency and dropped pairs of topics of ROS 2, by preset, image size and rate."""
    part = results["ros2"]
    rows = [(row["preset"], f"{row['width']} x {row['height']}", row["rate_hz"], f"{row['dropped']} of {row['sent']}",
             *(" / ".join(f"{value:.1f}" for value in row[name]) for name in ("latency_ms", "beyond_track_ms")),
             row["mean_track_ms"]) for row in part["rows"]]
    head = ("preset", "images [px]", "pairs/s", "dropped", "latency, median / p99 [ms]", "beyond tracking [ms]",
            "track(), mean [ms]")
    (first, start), (last, end) = part["memory_mb"][0], part["memory_mb"][-1]
    return table(head, rows, f"Resident memory of the program after {first} pairs: {start:.0f} MB, after {last}: "
                             f"{end:.0f} MB. {part['cores']} cores, {part['note']}. {stamp(part)}")


PEERS = {"viso2": "libviso2", "orb_slam3": "ORB-SLAM3", "toy_vo": "toy-vo"}
WHOLE = {"street": "KITTI street, 300 m", "karlsruhe": "Karlsruhe, 226 m", "mh_01": "EuRoC MH_01, 30 s"}
HEADLINE = {"street": (100, 200), "mh_01": (1, 5)}  # lengths of sub-paths on the first page [m]


def spread_of(values, digits=3):
    return spread(statistics.median(values), min(values), max(values), digits)


def sub_paths(run, length):
    """t_rel [%] and r_rel [deg/100 m] of a run over sub-paths of one length; nothing without such."""
    for entry in run.get("errors", {}).get("accuracy", {}).get("sub_paths", {}).get("by_length", []):
        if entry["length_m"] == length:
            return entry["t_rel_percent"], 100 * entry["r_rel_deg_per_m"]
    return None


def whole_row(row, lengths):
    """One recording and system: frames with a pose, errors over sub-paths, absolute error, times per frame."""
    runs, cells = row["runs"], []
    for length in lengths:
        found = [sub_paths(run, length) for run in runs]
        cells += [spread_of(values) for values in zip(*found)] if all(found) else ["-", "-"]
    errors = [run["errors"]["accuracy"] for run in runs if "errors" in run]
    ate = spread_of([of["ate_rmse_m"] for of in errors]) if errors else "-"
    times = []
    for name in ("median", "p99", "max", "first"):
        values = [run["latency_ms"][name] for run in runs if name in (run.get("latency_ms") or {})]
        times.append(spread_of(values, 2) if values else "-")
    used = [1000 * run["processor_s"] / row["frames"] for run in runs if "processor_s" in run]
    return (PEERS.get(row["system"], row["system"]), f"{spread_of([run['poses'] for run in runs])} of {row['frames']}",
            *cells, ate, *times, spread_of(used, 2) if used else "-")


def commits_of(rows, date=""):
    """The commit of most rows with its date, and the rows of others."""
    commits = [row["commit"] for row in rows]
    most = max(commits, key=commits.count)
    others = {}
    for row in rows:
        if row["commit"] != most:
            others.setdefault((row["system"], row["commit"], len(row["runs"])), []).append(WHOLE[row["recording"]])
    recordings = {row["recording"] for row in rows}
    return f"Commit {most}{date}" + "".join(
        f"; {PEERS.get(system, system)}{'' if len(titles) == len(recordings) else ' (' + '; '.join(titles) + ')'}: "
        f"commit {commit}, {counted(seeds, 'seed')}" for (system, commit, seeds), titles in others.items())


def whole_recordings(results):
    """The headline: errors of five rows over two lengths of sub-paths."""
    part, rows = results["evidence"], []
    shown = [row for row in part["rows"] if row["system"] not in ("QuadEdge, fast", "toy_vo") and row["runs"]]
    for row in shown:
        if row["recording"] not in HEADLINE:
            if not row["true_length_m"]:
                continue
            longer = [100 * (run["length_m"] / row["true_length_m"] - 1) for run in row["runs"]]
            rows.append((f"{WHOLE[row['recording']]}: whole path", *whole_row(row, ())[:2],
                         f"{spread_of(longer, 2)} longer", "-"))
            continue
        cells = whole_row(row, HEADLINE[row["recording"]])
        short, long = HEADLINE[row["recording"]]
        rows.append((f"{WHOLE[row['recording']]}: {short} m; {long} m", cells[0], cells[1], f"{cells[2]}; {cells[4]}",
                     f"{cells[3]}; {cells[5]}"))
    head = ("recording: length of sub-paths", "system", "frames with a pose", "t_rel [%]", "r_rel [deg/100 m]")
    seeds = "One seed." if part["seeds"] == 1 else f"Medians of {part['seeds']} seeds, and their range."
    rows = [row if index == 0 or row[0] != rows[index - 1][0] else ("", *row[1:]) for index, row in enumerate(rows)]
    return table(head, rows, f"{seeds} {commits_of(shown, ', ' + part['date'])}.\n")


def evidence(results):
    """Every recording and system with all lengths."""
    part, text = results["evidence"], []
    for name, title in WHOLE.items():
        all_rows = [row for row in part["rows"] if row["recording"] == name]
        rows = [row for row in all_rows if row["runs"]]
        if not rows:
            continue
        lengths = sorted({entry["length_m"] for row in rows for run in row["runs"] for entry in
                          run.get("errors", {}).get("accuracy", {}).get("sub_paths", {}).get("by_length", [])})
        kinds = ("t_rel [%]", "r_rel [deg/100 m]")
        head = ("system", "frames with a pose", *(f"{kind}, {length:g} m" for length in lengths for kind in kinds),
                "ATE RMSE [m]", "time of a frame: median [ms]", "p99 [ms]", "longest [ms]",
                "first frame [ms]", "processor time per frame [ms]")
        first = rows[0]
        text.append(f"## {title}\n\n{first['official']}: {counted(first['frames'], 'pair')}, stamps "
                    f"{first['first_stamp_ns']} to {first['last_stamp_ns']} ns, from <{first['source']}>. "
                    f"{commits_of(rows)}. Times of different commits do not compare.\n\n"
                    + table(head, [whole_row(row, lengths) for row in rows]))
        text += [f"{PEERS[row['system']]}: {row['left_out']}.\n" for row in all_rows if not row["runs"]]
        text.append("Commands: " + ", ".join(f"`{row['command']}`" for row in rows if row["command"]) + ".\n")
        if not lengths:
            true = f", inertial system: {first['true_length_m']:.1f}" if first["true_length_m"] else ""
            text.append(table(("system", f"length of the path [m]{true}"), [
                (PEERS.get(row["system"], row["system"]), spread_of([run["length_m"] for run in row["runs"]], 5))
                for row in rows]))
    return "\n".join(text)


def evidence_nees(results):
    """NEES of QuadEdge's poses on the whole recordings, with the calibration."""
    rows = []
    for row in results["evidence"]["rows"]:
        found = [run["consistency"] for run in row["runs"] if run.get("consistency")]
        if row["system"] != "QuadEdge" or not found:
            continue
        cells = []
        for frames in (1, 5, 10, 20, 50):
            values = [entry["normalised_error_squared"]["pose"] for of in found for entry in of
                      if entry["frames"] == frames]
            cells.append(spread_of(values) if values else "-")
        rows.append((WHOLE[row["recording"]], *cells))
    return table(("NEES", "1 frame", "5", "10", "20", "50"), rows)


def gpu_latency(results):
    """Time of a frame on each GPU."""
    rows = [(device["name"], row["sequence"], row["preset"], *(f"{row[name]:.1f}" for name in
             ("median_ms", "p90_ms", "p99_ms", "host_ms")))
            for device in results["nvidia"]["devices"] for row in device["latency"]]
    hosts = "; ".join(f"{device['name']}: {device['host']}, driver {device['driver']}"
                      for device in results["nvidia"]["devices"])
    head = ("device", "sequence", "preset", "median [ms]", "p90 [ms]", "p99 [ms]", "host's part [ms]")
    return table(head, rows, f"Hosts: {hosts}. {stamp(results['nvidia'])}")


def gpu_poses(results):
    """Largest difference from the poses of PoCL."""
    rows = [(device["name"], row["sequence"], row["poses"], row["missing"], number(row["largest_difference_m"]))
            for device in results["nvidia"]["devices"] for row in device["poses"]]
    return table(("device", "sequence", "poses", "missing", "largest difference [m]"), rows)


def gpu_variants(results):
    """Time of each kernel variant on each GPU, over that of the default."""
    devices = results["nvidia"]["devices"]
    rows = [(row["stage"], row["variant"] + (" (default)" if row["default"] else ""),
             *(f"{of['median_ms']:.3f}, {of['ratio']:.2f}" for device in devices for of in device["variants"]
               if (of["stage"], of["variant"]) == (row["stage"], row["variant"])))
            for row in devices[0]["variants"]]
    return table(("stage", "variant", *(f"{device['name']} [ms, ratio]" for device in devices)), rows)


TABLES = {"compared": compared, "systems": systems, "steps": steps, "pace": pace,
          "paths": paths, "disturbances": disturbances, "matching": matching, "quads": quads, "speed": speed,
          "presets": presets, "light": light, "peers": peers, "consistency": consistency, "nees": normalised_errors,
          "drift": drift_over_scenes, "ros2": ros2, "gpu-latency": gpu_latency, "gpu-poses": gpu_poses,
          "gpu-variants": gpu_variants,
          "whole": whole_recordings, "evidence": evidence, "evidence-nees": evidence_nees,
          "paper-stereo": lambda results: paper_comparison.stereo(results, table),
          "paper-temporal": lambda results: paper_comparison.temporal(results, table),
          "paper-constraints": lambda results: paper_comparison.constraints(results, table),
          "paper-trajectories": lambda results: paper_comparison.trajectories(results, table, stamp),
          "paper-extensions": lambda results: paper_comparison.extensions(results, table, stamp),
          "paper-commands": lambda results: paper_comparison.commands(results, command_list)}
