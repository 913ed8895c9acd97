"""The page of one run."""

from pathlib import Path

from .advice import notices
from .error_tables import accuracy_table, segment_tables
from .figure import FEWEST_FRAMES
from .numbers import DASH, length_text, share_of, significant
from .page import Columns, Detail, Facts, Figures, Page, Picture, Pictures, Section, Text, Tile, reduced
from .results import Run
from .run_tables import (configuration_table, consistency_tables, consistency_texts, device_text, latency_table,
                         loss_tables, origin, stage_table)
from .sequence_figures import error_figures, frame_figures, latency_figures, trajectory_figures

QUADS_CAPTION = ("Dots: stereo edges, brighter ones have larger disparities. Lines: motion of quads since the frame "
                 "that they were matched with, white for inliers, red for others, one per cell of 16 px.")
PICTURES = ("quads", "thumbnail", "pair", "edges")  # the best first
NO_PLOTS = Text(f"No plots of fewer than {FEWEST_FRAMES} frames.")
LAYOUTS = {"kitti": "KITTI", "kitti-raw": "KITTI raw", "euroc": "EuRoC", "tum-vi": "TUM-VI", "tartanair": "TartanAir",
           "eth3d-slam": "ETH3D SLAM", "images": "folders of images", "video": "video", "pipe": "pipe",
           "live": "live cameras"}


def run_page(run: Run, detail: Detail) -> Page:
    """The page of one run."""
    report = run.report
    device = device_text(report["device"]) if "device" in report else ""
    facts = Facts(origin(report, device, recording_text(report)) + facts_of(run))
    page = Page(f"Tracking report: {name_of(run)}", facts, lead=lead_of(run), tiles=tiles_of(run))
    best, picture = best_picture(run, detail)
    page.sections.append(Section("Overview", [*notices(run), *overview(run, detail, picture), *loss_tables(run)]))
    page.sections += plot_sections(run, detail)
    pictures = picture_blocks(run, detail, without=best)
    if pictures:
        page.sections.append(Section("Pictures", pictures, explained="method.md"))
    if "config" in report:
        page.sections.append(Section("Configuration", [configuration_table(report)], fold=True,
                                     explained="configuration.md"))
    return page


def name_of(run: Run) -> str:
    """What was tracked, in words."""
    kind = run.report["input"].get("format", "")
    if kind == "synthetic":
        return f"built-in {run.name.replace('-', ', ')} (rendered)"
    return f"{run.name} ({LAYOUTS.get(kind, kind)})" if kind else run.name


def lead_of(run: Run) -> str:
    """When and on what it was tracked, in a sentence."""
    given, report = run.report["input"], run.report
    text = f"{given['frames']} stereo frames"
    if "width" in given:
        text += f" of {given['width']} x {given['height']} px"
    duration = run.times[-1]
    text += f", {significant(duration, 3)} s" if duration > 0 else ""
    if "date" in report:
        text += f", tracked on {report['date'][:10]}"
    return text + (f" with {report['device']['name']} ({report['device']['platform']})." if "device" in report else ".")


def tiles_of(run: Run) -> list[Tile]:
    """Frames tracked, drift or path, time per frame, warnings."""
    report, latency = run.report, run.report["latency_ms"]
    frames, tracked = report["input"]["frames"], report["frames_tracked"]
    lost = sum(len(frames) for frames, _, _ in run.losses())
    tiles = [Tile("Frames tracked", f"{tracked} of {frames}", f"{lost} lost" if lost else "none lost",
                  warns=tracked < frames)]
    accuracy = report.get("accuracy")
    if accuracy:
        path = accuracy["path_length_m"]
        drift = accuracy["end_drift_percent"]
        end = f"{length_text(path * drift / 100)} after {length_text(path)}" if drift is not None else ""
        tiles.append(Tile("Drift at the end", f"{significant(drift, 2)} %", end))
    else:
        tiles.append(Tile("Length of the path", length_text(report.get("path_length_m")), "no ground truth to compare"))
    rate = f", {1000 / latency['median']:.0f} frames/s" if latency["median"] else ""
    tiles.append(Tile("Time per frame", f"{significant(latency['median'], 3)} ms",
                      f"median{rate}; p99 {significant(latency['p99'], 3)} ms"))
    boxes = notices(run)
    number = len(boxes[0].entries) if boxes else 0
    tiles.append(Tile("Warnings", str(number) if number else "none", "explained below" if number else "nothing unusual",
                      warns=number > 0))
    return tiles


def overview(run: Run, detail: Detail, picture: Picture | None = None) -> list:
    """The path from above beside a picture."""
    figures = [figure for figure in trajectory_figures(run, detail.points) if figure.name.endswith("_from_above")]
    both = [*([Figures(figures)] if figures else []), *([Pictures([picture], wide=True)] if picture else [])]
    if not figures:
        both.append(NO_PLOTS)
    return [Columns(both)] if len(both) > 1 else both


def best_picture(run: Run, detail: Detail) -> tuple[Path | None, Picture | None]:
    """The file with the quads of the most inliers, or without one the first of another kind, and its picture."""
    if detail.picture_width == 0:
        return None, None
    inliers = run.column("inliers")

    def rank(file: Path) -> tuple[int, float]:
        kind, _, number = file.stem.rpartition("_")
        frame = int(number) if number.isdigit() else -1
        return (PICTURES.index(kind) if kind in PICTURES else len(PICTURES),
                -inliers[frame] if 0 <= frame < len(inliers) else 0)

    for file in sorted(run.pictures, key=rank):
        kind, _, number = file.stem.rpartition("_")
        data = reduced(file, 3 * detail.picture_width, detail.quality) if kind in PICTURES else None
        if data:
            texts = {"quads": QUADS_CAPTION, "thumbnail": QUADS_CAPTION, "pair": "Left and right image.",
                     "edges": "Edges, coloured by their direction."}
            return file, Picture(data, f"Frame {int(number) if number.isdigit() else number}. {texts[kind]}")
    return None, None


def plot_sections(run: Run, detail: Detail) -> list[Section]:
    """Path, errors with their tables, time and edges of a run; its tables alone if it has few frames."""
    space = [figure for figure in trajectory_figures(run, detail.points)
             if not figure.name.endswith("_from_above")]
    world = "Shown in the frame of the first left camera" + (" that has ground truth." if run.truth else ".")
    errors = error_figures(run, detail.points)
    shown = [Figures(errors, "Origin-aligned: the first poses coincide. Grey: the standard deviation that the "
                             "covariances predict; errors should mostly lie within twice that.")] if errors else []
    sections = [Section("Path", [Figures(space, world)], explained="reference.md#points")] if space else []
    if "accuracy" in run.report:
        accuracy = run.report["accuracy"]
        sections.append(Section("Errors", [*shown, accuracy_table(accuracy), *segment_tables(accuracy)],
                                explained="accuracy.md"))
        tables = consistency_tables(accuracy)
        if tables:
            texts = [Text(text) for text in consistency_texts(accuracy)]
            sections.append(Section("Predicted uncertainty", [*texts, *tables],
                                    explained="accuracy.md#consistency-of-the-covariances"))
    time = latency_figures(run, detail.points)
    tables = [latency_table(run), *filter(lambda table: table.rows, [stage_table(run.report)])]
    sections.append(Section("Time", [*([Figures(time)] if time else []), Columns(tables)],
                            explained="performance.md"))
    counts = frame_figures(run, detail.points)
    if counts:
        sections.append(Section("Edges and quads", [Figures(counts)], explained="method.md"))
    return sections


def recording_text(report: dict) -> str:
    given = report["input"]
    if "path" not in given:
        return ""
    return f"{given['path']} ({given['format']}), {given['frames']} frames of {given['width']} x {given['height']} px"


def facts_of(run: Run) -> list[tuple[str, str]]:
    """What matters most of a run."""
    report = run.report
    facts = [("Frames tracked", share_of(report["frames_tracked"], report["input"]["frames"])),
             ("Keyframes", str(report["key_rigs"]))]
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
    if "disparity_error_px" in report:
        facts.append(("Calibration", f"leaves errors of {report['disparity_error_px']:.2f} px in disparities"))
    loops = report.get("loops")
    if loops:
        facts.append(("Loops", f"{loops['kept']} closures kept of {loops['compared']} compared, {loops['frames']} "
                      f"frames in the largest of {loops['segments']} segment{'s' * (loops['segments'] != 1)}"))
    memory = report.get("memory_mb")
    if memory:
        facts.append(("Memory",
                      f"{memory['host_peak']:.0f} MB on the host, {memory['device_peak']:.0f} MB on the device"))
    return facts


def picture_blocks(run: Run, detail: Detail, without: Path | None = None) -> list:
    """All pictures of a run but one: large drawings below one another, then thumbnails side by side."""
    if detail.picture_width == 0:
        return []
    blocks, small, large = [], [], []
    for file in run.pictures:
        kind, _, number = file.stem.rpartition("_")
        if kind not in PICTURES or file == without:
            continue
        is_small = kind == "thumbnail"
        data = reduced(file, detail.picture_width if is_small else 2 * detail.picture_width, detail.quality)
        if data is None:
            blocks.append(Text(f"{file}: no picture that can be read", warns=True))
            continue
        frame = int(number) if number.isdigit() else number
        text = "left and right image" if kind == "pair" else kind
        (small if is_small else large).append(Picture(data, f"frame {frame}" if is_small else f"frame {frame}: {text}"))
    if large:
        blocks.append(Pictures(large, wide=True))
    if small:
        blocks.append(Pictures(small))
    if small or any(picture.caption.endswith("quads") for picture in large):
        blocks.append(Text(QUADS_CAPTION))
    return blocks
