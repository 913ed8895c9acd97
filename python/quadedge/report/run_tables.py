"""The tables of a run's page, and where its figures come from."""

from .numbers import DASH, count, length_unit, significant
from .results import Run
from .table import Cell, Table

MOST_LOSSES = 30  # rows of a table
LATENCY = ("median", "p90", "p99", "max", "first")
LATENCY_TITLES = ("median", "p90", "p99", "largest", "first frame")
CONSISTENT = (0.5, 2)  # NEES between these is called consistent


def device_text(device: dict) -> str:
    return f"{device['name']} ({device['platform']}, {device['opencl']}, driver {device['driver']})"


def origin(content: dict, device: str, recording: str) -> list[tuple[str, str]]:
    """Input, program, date, device, configuration and command of a JSON result, as terms and texts."""
    commit, changed = content.get("commit"), content.get("config_changed", {})
    constants = ", ".join(f"{key} = {value}" for key, value in changed.items()) or "defaults"
    return [("Input", recording),
            ("Program", f"QuadEdge {content.get('version', DASH)}" + (f", commit {commit}" if commit else "")),
            ("Date", content.get("date", DASH).replace("T", " ").replace("Z", " UTC")),
            ("Device", device or DASH),
            ("Configuration", constants if "config_changed" in content else DASH),
            ("Command", content.get("command") or DASH)]


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
    """The latency of the frames but the first, and that of the first."""
    table = Table("latency", "Latency [ms], from both images in host memory to the pose", list(LATENCY_TITLES),
                  text_columns=0)
    latency = run.report["latency_ms"]
    table.add(*[Cell.of(latency[key]) for key in LATENCY])
    return table


def consistency_texts(accuracy: dict) -> list[str]:
    """What NEES is, and what that of the run says."""
    texts = ["NEES, the normalised estimation error squared per degree of freedom, compares each error with its "
             "predicted covariance: 1 is consistent; below 1 the covariances are too large (conservative), "
             "above 1 they are too small."]
    steps = accuracy.get("consistency", [])
    value = steps[0]["normalised_error_squared"]["pose"] if steps else None
    if value is None:
        return texts
    low, high = CONSISTENT
    verdict = ("conservative: a filter that uses them trusts the poses less than it could" if value < low else
               "consistent" if value <= high else
               "too small: a filter that uses them trusts the poses too much, so scale the covariances by about "
               f"{significant(value, 2)}")
    frames = steps[0]["frames"]
    texts.append(f"Over motions of {frames} frame{'s' * (frames > 1)} it is {significant(value, 2)}: these covariances "
                 f"are {verdict}.")
    ratio = steps[0]["promised_m"] / steps[0]["error_m"] if steps[0]["promised_m"] and steps[0]["error_m"] else 0
    if value <= 1 and ratio > 3:
        texts.append(f"The predicted deviation of the position is {significant(ratio, 2)} times the error, because it "
                     "is the sum over all directions and the least certain one dominates it; NEES weighs every "
                     "direction by its own deviation.")
    return texts


def consistency_tables(accuracy: dict) -> list[Table]:
    """The errors of motions over several frames beside what the covariances predict."""
    tables = []
    steps = accuracy.get("consistency", [])
    if steps:
        unit = length_unit(step[key] for step in steps for key in ("error_m", "promised_m"))
        position = f"position [{unit.name}]"
        promises = Table("promises", "Motions over several frames: RMS of errors and predicted deviations, and NEES",
                         [("motions over", "frames"), ("motions over", "motions"), (position, "error"),
                          (position, "predicted"), ("rotation [deg]", "error"), ("rotation [deg]", "predicted"),
                          ("NEES", "edges alone"), ("NEES", "with calibration")], text_columns=0)
        for step in steps:
            promises.add(step["frames"], Cell(count(step["motions"]), step["motions"]),
                         *[Cell.of(step[key], 3, unit.factor) for key in ("error_m", "promised_m")],
                         *[Cell.of(step[key], 3) for key in ("error_deg", "promised_deg")],
                         *[Cell.of(step[key]["pose"], 3)
                           for key in ("normalised_error_squared_by_edges", "normalised_error_squared")])
        promises.notes.append("Edges alone: the covariance counts the noise of the edges; with calibration: also the "
                              "uncertainty of the rig (pose.rig_sigma_*).")
        tables.append(promises)
    return tables


def stage_table(report: dict) -> Table:
    table = Table("stages", "Stages on the host [ms]", ["stage", "median", "p90"])
    for name, times in report.get("stages_ms", {}).items():
        table.add(name, *[Cell.of(times[key], 3) for key in ("median", "p90")])
    return table


def configuration_table(content: dict) -> Table:
    table = Table("configuration", "Every constant; bold: not the default", ["constant", "value"], text_columns=2)
    changed = content.get("config_changed", {})
    for section, values in content.get("config", {}).items():
        for name, value in values.items() if isinstance(values, dict) else [("", values)]:
            key = f"{section}.{name}" if name else section
            text = str(value).lower() if isinstance(value, bool) else str(value)
            table.add(Cell(key, bold=key in changed), Cell(text, bold=key in changed))
    return table
