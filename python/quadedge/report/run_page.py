"""The page of one run."""

from .error_tables import ERRORS, ErrorRow, unit_of
from .figure import FEWEST_FRAMES
from .numbers import DASH, count, length_text, length_unit, share_of, significant
from .origin import configuration_rows, device_text, origin
from .page import Detail, Facts, Figures, Page, Picture, Pictures, Section, Text, reduced
from .results import Run
from .rig_figures import rig_figures, rig_table
from .sequence_figures import Other, error_figures, frame_figures, trajectory_figures
from .table import Cell, Table

QUADS_CAPTION = ("Dots: stereo edges, brighter ones have larger disparities. Lines: motion of quads since the frame "
                 "that they were matched with, white for inliers, red for others, one per cell of 16 px.")
MOST_LOSSES = 30  # rows of a table
LATENCY = ("median", "p90", "p99", "max", "first")
NO_PLOTS = Text(f"No plots of fewer than {FEWEST_FRAMES} frames.")


def run_page(run: Run, detail: Detail) -> Page:
    """The page of one run."""
    report = run.report
    device = device_text(report["device"]) if "device" in report else ""
    facts = Facts(origin(report, device, recording_text(report)))
    facts.entries += facts_of(run)
    page = Page(f"QuadEdge: {run.name}", facts)
    sections = [Section("Results", [*warnings(run), latency_table(run), *accuracy_tables(run), *loss_tables(run)])]
    figures = plots(run, [], detail) or [("Plots", [NO_PLOTS])]
    page.sections += sections + [Section(name, blocks) for name, blocks in figures]
    if "rig" in report:
        maps = rig_figures(run)
        page.sections.append(Section("Rig", [rig_table(report["rig"]), *([Figures(maps)] if maps else [])]))
    pictures = picture_blocks(run, detail)
    if pictures:
        page.sections.append(Section("Pictures", pictures))
    stages = stage_table(report)
    if stages.rows:
        page.sections.append(Section("Time of the stages", [stages]))
    if "config" in report:
        page.sections.append(Section("Configuration", [configuration_table(report)], fold=True))
    return page


def recording_text(report: dict) -> str:
    given = report["input"]
    if "path" not in given:
        return ""
    return f"{given['path']} ({given['format']}), {given['frames']} frames of {given['width']} x {given['height']} px"


def facts_of(run: Run) -> list[tuple[str, str]]:
    """What matters most of a run."""
    report = run.report
    facts = [("Frames tracked", share_of(report["frames_tracked"], report["input"]["frames"])),
             ("Key rigs", str(report["key_rigs"]))]
    reasons: dict[str, int] = {}
    for frames, reason, _ in run.losses():
        reasons[reason] = reasons.get(reason, 0) + len(frames)
    if reasons:
        facts.append(("Frames lost", ", ".join(f"{number} {reason}" for reason, number in reasons.items())))
    if "segments_text" in report:
        facts.append(("Segments", report["segments_text"]))
    if report["input"].get("dropped"):
        facts.append(("Pairs dropped", f"{report['input']['dropped']} of a pipe that was faster than tracking"))
    accuracy = report.get("accuracy")
    if accuracy:
        drift = significant(accuracy["end_drift_percent"], 2)
        facts.append(("Path", f"{length_text(accuracy['path_length_m'])}, drift at its end {drift} %"))
        truth = accuracy.get("truth_file", DASH)
        facts.append(("Ground truth", f"{truth}, {accuracy['matched_poses']} poses compared"))
    elif "path_length_m" in report:
        facts.append(("Path", f"{length_text(report['path_length_m'])} (estimated)"))
    loops = report.get("loops")
    if loops:
        facts.append(("Loops", f"{loops['kept']} closures kept of {loops['compared']} compared, {loops['frames']} "
                      f"frames in the largest of {loops['segments']} segment{'s' * (loops['segments'] != 1)}"))
    memory = report.get("memory_mb")
    if memory:
        facts.append(("Memory",
                      f"{memory['host_peak']:.0f} MB on the host, {memory['device_peak']:.0f} MB on the device"))
    return facts


def warnings(run: Run) -> list[Text]:
    """Why the run ended early, and the warnings about its recording or its frames."""
    texts = [f"The run ended early: {run.report['ended_early']}."] if run.report.get("ended_early") else []
    for warning in run.report["warnings"]:
        frame = warning["frame"]
        texts.append(warning["text"] if frame is None else f"Frame {frame}: {warning['text']}")
    return [Text(text, warns=True) for text in texts]


def loss_tables(run: Run) -> list[Table]:
    """Which frames were lost, when and why; none for a run that kept all."""
    losses = list(run.losses())
    if not losses:
        return []
    table = Table("lost", "Lost frames", ["frames", "from [s]", "reason", "message"], text_columns=4)
    for frames, reason, message in losses[:MOST_LOSSES]:
        numbers = str(frames[0]) if len(frames) == 1 else f"{frames[0]} to {frames[-1]}"
        table.add(numbers, f"{run.times[frames[0]]:.3f}", reason, message)
    if len(losses) > MOST_LOSSES:
        table.notes.append(f"The first {MOST_LOSSES} of {len(losses)}; frames.csv has all.")
    return [table]


def latency_table(run: Run) -> Table:
    """Latency, and what a frame holds."""
    table = Table("latency", "Latency [ms], from both images in host memory to the pose",
                  ["median", "90 %", "99 %", "largest", "first frame"], text_columns=0)
    latency = run.report["latency_ms"]
    table.add(*[Cell.of(latency[key]) for key in LATENCY])
    return table


def accuracy_tables(run: Run) -> list[Table]:
    """Both alignments below one another, and how consistent the covariances are."""
    accuracy = run.report.get("accuracy")
    if not accuracy:
        return []
    row = ErrorRow(run.name, "QuadEdge", accuracy)
    table = Table("errors", "Errors against the ground truth", ["alignment", "error", "unit", "mean", "std", "rmse",
                                                                "max"], text_columns=3)
    for alignment, text in (("origin_aligned", "origin"), ("se3_aligned", "SE(3)")):
        for key, name in ERRORS:
            unit = unit_of(key, [row], alignment)
            table.add(text if key == ERRORS[0][0] else Cell("", text), name, unit.name,
                      *[Cell.of(accuracy[alignment][key][statistic], factor=unit.factor)
                        for statistic in ("mean", "std", "rmse", "max")])
    if accuracy.get("se3_open_rotation"):
        table.notes.append(f"SE(3): no APE rotation, {accuracy['se3_open_rotation']}.")
    tables = [table]
    tables += segment_tables(accuracy)
    tables += consistency_tables(accuracy)
    return tables


def segment_tables(accuracy: dict) -> list[Table]:
    """The errors of every segment by itself; none for a single one."""
    segments = accuracy.get("segments", [])
    if not segments:
        return []
    rows = [ErrorRow("", "", segment) for segment in segments]
    units = [unit_of(key, rows, "origin_aligned") for key, _ in ERRORS]
    path = length_unit([segment["path_length_m"] for segment in segments])
    table = Table("segments", "Mean errors of every segment by itself, origin-aligned",
                  ["segment", "poses", f"path [{path.name}]", "drift [%]",
                   *[f"{name} [{unit.name}]" for (_, name), unit in zip(ERRORS, units)]], text_columns=1)
    for segment in segments:
        values = [segment["path_length_m"], segment["end_drift_percent"]]
        values += [segment["origin_aligned"][key]["mean"] for key, _ in ERRORS]
        factors = [path.factor, 1, *[unit.factor for unit in units]]
        several = segment["matched_poses"] > 1
        table.add(str(segment["segment"]), segment["matched_poses"],
                  *[Cell.of(value if several else None, factor=factor) for value, factor in zip(values, factors)])
    table.notes.append("The motions between segments are unknown; the table above includes them.")
    return [table]


def consistency_tables(accuracy: dict) -> list[Table]:
    """The errors beside what the covariances predict, of whole poses and of motions over several frames."""
    tables = []
    squared = accuracy.get("normalised_error_squared")
    if squared:
        consistency = Table("consistency", "Errors relative to the stated covariances, squared; 1 is consistent",
                            ["poses", "pose", "rotation", "translation"], text_columns=0)
        consistency.add(Cell(count(squared["poses"]), squared["poses"]),
                        *[Cell.of(squared[key], 3) for key in ("pose", "rotation", "translation")])
        tables.append(consistency)
    steps = accuracy.get("consistency", [])
    if steps:
        unit = length_unit(step[key] for step in steps for key in ("error_m", "promised_m"))
        promises = Table("promises", "Errors of motions and what their covariances predict, root mean squares",
                         ["frames", "motions", *["error", "predicted"] * 2, "squared, edges alone",
                          "with the calibration"], text_columns=0)
        promises.groups = [("motions over", 2), (f"position [{unit.name}]", 2), ("rotation [deg]", 2),
                           ("relative to the covariances", 2)]
        for step in steps:
            promises.add(step["frames"], Cell(count(step["motions"]), step["motions"]),
                         *[Cell.of(step[key], 3, unit.factor) for key in ("error_m", "promised_m")],
                         *[Cell.of(step[key], 3) for key in ("error_deg", "promised_deg")],
                         *[Cell.of(step[key]["pose"], 3)
                           for key in ("normalised_error_squared_by_edges", "normalised_error_squared")])
        tables.append(promises)
    return tables


def stage_table(report: dict) -> Table:
    table = Table("stages", "Stages on the host, and kernels of a profiling pass where there was one [ms]",
                  ["stage", "median", "90 %"])
    for kind in ("stages_ms", "kernels_ms"):
        for name, times in report.get(kind, {}).items():
            table.add(("kernel " if kind == "kernels_ms" else "") + name,
                      *[Cell.of(times[key], 3) for key in ("median", "p90")])
    return table


def configuration_table(content: dict) -> Table:
    table = Table("configuration", "Every constant; bold: not the default", ["constant", "value"], text_columns=2)
    for key, value, changed in configuration_rows(content):
        table.add(Cell(key, bold=changed), Cell(value, bold=changed))
    return table


def plots(run: Run, others: list[Other], detail: Detail) -> list[tuple[str, list]]:
    """Trajectory with an example pair above it, errors and frames, each with its name; nothing for a run of few
    frames."""
    world = "In the left camera's first pose" + (" that has ground truth, origin-aligned." if run.truth else ".")
    blocks = [("Trajectory", trajectory_figures(run, others, detail.points), world),
              ("Errors", error_figures(run, others, detail.points), "Errors against the ground truth, origin-aligned."),
              ("Frames", frame_figures(run, detail.points), "")]
    named = [(name, [Figures(figures, caption)]) for name, figures, caption in blocks if figures]
    example = next((file for file in run.pictures if file.stem.startswith("pair_")), None)
    data = reduced(example, 2 * detail.picture_width, detail.quality) if example and detail.picture_width else None
    if named and data:
        named[0][1].insert(0, Pictures([Picture(data, f"left and right image of frame {int(example.stem[5:])}")], True))
    return named


def picture_blocks(run: Run, detail: Detail) -> list:
    """The drawings of edges and quads, and the thumbnails."""
    if detail.picture_width == 0:
        return []
    blocks, small, large = [], [], []
    for file in run.pictures:
        kind, _, number = file.stem.rpartition("_")
        if kind not in ("thumbnail", "edges", "quads"):
            continue
        is_small = kind == "thumbnail"
        data = reduced(file, detail.picture_width if is_small else 2 * detail.picture_width, detail.quality)
        if data is None:
            blocks.append(Text(f"{file}: no picture that can be read", warns=True))
            continue
        frame = int(number) if number.isdigit() else number
        (small if is_small else large).append(Picture(data, f"frame {frame}" if is_small else f"frame {frame}: {kind}"))
    if large:
        blocks.append(Pictures(large, wide=True))
    if small:
        blocks.append(Pictures(small))
    if small or any(picture.caption.endswith("quads") for picture in large):
        blocks.append(Text(QUADS_CAPTION))
    return blocks
