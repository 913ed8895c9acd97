"""What to do about what a run reports: its warnings by kind, and its lost frames by reason."""

from .page import Notice
from .results import Run

MOST_FRAMES = 5  # of one kind of warning that are listed
OF_KIND = {
    "device_memory": "Use a device with more memory, a smaller --edges.max_edges, or --preset fast.",
    "implausible_calibration": "Compare the calibration file with the camera's data sheet: units (metres, not "
                               "millimetres) and the order of the cameras are the usual causes.",
    "doubtful_calibration": "Run quadedge check on the recording: it lists the residuals and can write a corrected "
                            "calibration (--write-calibration). If the images are rectified, pass --rectified.",
    "small_disparity_range": "Nearby objects are not matched: raise --stereo.max_disparity.",
    "unsynchronised_cameras": "Trigger both cameras in hardware, or pair the images by better timestamps (--times, "
                              "--tolerance). Positions are off while the camera turns.",
    "unknown_motion": "Evaluate every segment by itself (trajectory_segment_N.txt). Loop closure (--loops) can join "
                      "segments that see the same place.",
    "repeated_images": "The recorder wrote images twice: remove the copies, or correct the timestamps.",
    "large_disparity_offset": "Distances are off by this disparity: calibrate the rig again if they matter.",
    "static_region": "Exclude this part of the image with --mask: an image that is black there.",
    "displaced_images": "Switch off image stabilisation and the cropping of single images, and fasten both cameras to "
                        "one bar.",
    "poor_images": "Shorten the exposure, light both cameras alike, or exchange black and white in the masks: what is "
                   "hidden cannot be matched, and says nothing about the calibration.",
    "doubtful_lenses": "Use the calibration of these images: crops, scaled images and other sensor modes need their "
                       "own, and so does water.",
    "changed_rig": "Fasten the cameras and calibrate again; earlier and later frames have different calibrations."}
OF_LOSS = {
    "too few edges": "The images are dark, blurred or without contours there: more light, a shorter exposure, or a "
                     "lower --edges.threshold (0: automatic).",
    "too few quads": "Too little is common to two frames: a higher frame rate or slower turns help.",
    "no consensus": "Something else may fill the image, or the motion is too fast: a higher frame rate, or --mask for "
                    "parts of the vehicle in view.",
    "rig mismatch": "The images do not fit the calibration: run quadedge check on the recording."}
AMBIGUOUS = ("Do not rely on these poses alone: an object that moves may fill the view. In frames.csv they have "
             "ambiguous_motion 1; --mask excludes parts of the vehicle in view.")


def _frames_text(frames: list[int]) -> str:
    """"Frame 3", "Frames 3, 5, 9", "Frames 3, 4, 5, 6, 7 and 12 more"."""
    shown = ", ".join(map(str, frames[:MOST_FRAMES]))
    more = f" and {len(frames) - MOST_FRAMES} more" if len(frames) > MOST_FRAMES else ""
    return f"Frame{'s' * (len(frames) > 1)} {shown}{more}"


def _of_warnings(run: Run) -> list[tuple[str, str]]:
    """One entry per kind and text, in the order of the frames."""
    found: dict[tuple[str, str], list[int]] = {}
    for warning in run.report["warnings"]:
        frames = found.setdefault((warning.get("kind", ""), warning["text"]), [])
        if warning["frame"] is not None:
            frames.append(warning["frame"])
    return [((f"{_frames_text(frames)}: " if frames else "") + text, OF_KIND.get(kind, ""))
            for (kind, text), frames in found.items()]


def notices(run: Run) -> list[Notice]:
    """The box of a run with everything that a reader has to know; none for a sound run."""
    entries = []
    if run.report.get("ended_early"):
        entries.append((f"The run ended early: {run.report['ended_early']}.", "The page shows the frames until then."))
    entries += _of_warnings(run)
    lost: dict[str, list[int]] = {}
    for frames, reason, _ in run.losses():
        lost.setdefault(reason, []).extend(frames)
    entries += [(f"{_frames_text(frames)} lost: {reason}.", OF_LOSS.get(reason, "")) for reason, frames in lost.items()]
    ambiguous = run.report.get("frames_ambiguous", 0)
    if ambiguous:
        entries.append((f"In {ambiguous} frame{'s' * (ambiguous > 1)} the motion may not be that of the static scene.",
                        AMBIGUOUS))
    return [Notice("Warnings", entries)] if entries else []
