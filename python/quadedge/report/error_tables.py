"""Tables of pose errors: of a run, of its segments, and of the sequences of a batch."""

from .numbers import DASH, DEGREE, Unit, length_unit
from .table import Cell, Table

ERRORS = {"ape_rotation_deg": "APE rotation", "ape_translation_m": "APE translation",
          "rpe_rotation_deg": "RPE rotation", "rpe_translation_m": "RPE translation"}
ALIGNMENTS = {
    "origin_aligned": "Errors, origin-aligned as in the paper's Table 4 (the first compared poses coincide)",
    "se3_aligned": "Errors, SE(3)-aligned as commonly reported (least squares over all positions, no scale)"}
STATISTICS = ("mean", "std", "rmse", "max")


def _unit_of(key: str, accuracies: list[dict], alignment: str) -> Unit:
    """The unit of one kind of error in several rows, by the magnitude of their means."""
    return length_unit(accuracy[alignment][key]["mean"] for accuracy in accuracies) if key.endswith("_m") else DEGREE


def _open_rotation(accuracy: dict, of: str) -> list[str]:
    reason = accuracy.get("se3_open_rotation")
    return [f"{of}: no APE rotation, {reason}."] if reason else []


def accuracy_table(accuracy: dict) -> Table:
    """The errors of a run in both alignments, below one another."""
    table = Table("errors", "Errors against the ground truth", ["alignment", "error", "unit", *STATISTICS],
                  text_columns=3)
    for alignment, text in (("origin_aligned", "origin"), ("se3_aligned", "SE(3)")):
        for key, name in ERRORS.items():
            unit = _unit_of(key, [accuracy], alignment)
            table.add(text if key == "ape_rotation_deg" else Cell("", text), name, unit.name,
                      *[Cell.of(accuracy[alignment][key][statistic], factor=unit.factor) for statistic in STATISTICS])
    table.notes = ["APE: absolute pose error. RPE: relative pose error from frame to frame. Origin: the first "
                   "compared poses coincide; SE(3): least squares over all positions, without a scale.",
                   *_open_rotation(accuracy, "SE(3)")]
    return table


def error_table(first: str, rows: list[tuple[str, dict | None]], alignment: str) -> Table:
    """Path, drift and errors, a row per sequence or segment (`first`) with its accuracy, None without ground truth."""
    accuracies = [accuracy for _, accuracy in rows if accuracy and accuracy["matched_poses"] > 1]
    path = length_unit(accuracy["path_length_m"] for accuracy in accuracies)
    units = {key: _unit_of(key, accuracies, alignment) for key in ERRORS}
    table = Table(f"errors_{alignment}", ALIGNMENTS[alignment],
                  [first, "poses", f"path [{path.name}]", "drift [%]",
                   *[(f"{text} [{units[key].name}]", statistic) for key, text in ERRORS.items()
                     for statistic in ("mean", "std")]])
    for name, accuracy in rows:
        if not accuracy:
            table.add(name, *[Cell(DASH)] * (len(table.columns) - 1))
            continue
        values = [(accuracy["path_length_m"], path.factor), (accuracy["end_drift_percent"], 1)]
        values += [(accuracy[alignment][key][statistic], units[key].factor) for key in ERRORS
                   for statistic in ("mean", "std")]
        several = accuracy["matched_poses"] > 1
        table.add(name, accuracy["matched_poses"],
                  *[Cell.of(value if several else None, factor=factor) for value, factor in values])
        if alignment == "se3_aligned":
            table.notes += _open_rotation(accuracy, name)
    return table


def segment_tables(accuracy: dict) -> list[Table]:
    """The errors of every segment by itself; none for a single one."""
    if not accuracy.get("segments"):
        return []
    table = error_table("segment", [(str(segment["segment"]), segment) for segment in accuracy["segments"]],
                        "origin_aligned")
    table.name, table.title = "segments", "Errors of every segment by itself, origin-aligned"
    table.notes = ["The motions between segments are unknown; the table above includes them."]
    return [table]
