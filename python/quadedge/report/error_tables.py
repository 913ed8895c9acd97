"""Tables of pose errors with the columns of the paper's Table 4. The best value of each sequence is bold."""

from dataclasses import dataclass

from .numbers import DASH, DEGREE, Unit, difference, exists, length_unit, significant
from .table import Cell, Table

ERRORS = (("ape_rotation_deg", "APE rotation"), ("ape_translation_m", "APE translation"),
          ("rpe_rotation_deg", "RPE rotation"), ("rpe_translation_m", "RPE translation"))
ALIGNMENTS = {
    "origin_aligned": "Errors, origin-aligned as in the paper's Table 4 (the first compared poses coincide)",
    "se3_aligned": "Errors, SE(3)-aligned as commonly reported (least squares over all positions, no scale)"}


@dataclass
class ErrorRow:
    """One system on one sequence. `accuracy` is None without ground truth."""

    sequence: str
    system: str
    accuracy: dict | None
    baseline: dict | None = None
    """Differences to it are shown beside each value."""
    ranked: bool = True
    """Whether it covers the same data as the others of its group."""


def unit_of(key: str, rows: list[ErrorRow], alignment: str) -> Unit:
    """The common unit of one kind of error in several rows, by the magnitude of their means."""
    if not key.endswith("_m"):
        return DEGREE
    return length_unit(row.accuracy[alignment][key]["mean"] for row in rows if row.accuracy)


def error_table(groups: list[list[ErrorRow]], alignment: str, statistics: tuple[str, ...] = ("mean", "std")) -> Table:
    """A table with a group of rows per sequence; the last group covers all sequences. With several systems in a group
    the best value is bold. Units depend on the sequence and appear in the heading if they are equal for all."""
    several = any(len(group) > 1 for group in groups)
    names = ["sequence", *(["system"] if several else []), "poses"]
    table = Table(f"errors_{alignment}", ALIGNMENTS[alignment], [*names], text_columns=len(names) - 1,
                  result_rows=len(groups[-1]) if len(groups) > 1 else 0)
    table.groups = [("", 1)] * len(names)
    table.exact_columns = [*names]
    shared = {}
    for key, text in ERRORS:
        units = {unit_of(key, group, alignment) for group in groups if any(row.accuracy for row in group)}
        shared[key] = units.pop() if len(units) == 1 else None
        table.groups.append((f"{text} [{shared[key].name}]" if shared[key] else text, len(statistics)))
        table.columns += statistics
        table.exact_columns += [f"{text} {statistic} [{'m' if key.endswith('_m') else 'deg'}]"
                                for statistic in statistics]
    for group in groups:
        for number, row in enumerate(group):
            cells = [Cell(row.sequence if number == 0 else "", row.sequence)]
            cells += [Cell(row.system)] if several else []
            table.add(*cells, *_row_cells(row, group, alignment, statistics, shared))
        if alignment == "se3_aligned":
            table.notes += _open_rotations(group, several)
    if table.notes and table.result_rows:
        table.notes.append("The APE rotation of all sequences covers those that have one.")
    return table


def _open_rotations(group: list[ErrorRow], several: bool) -> list[str]:
    """Why rotations are missing, in one sentence per reason."""
    systems: dict[str, list[str]] = {}
    for row in group:
        reason = row.accuracy and row.accuracy.get("se3_open_rotation")
        if reason:
            systems.setdefault(reason, []).append(row.system)
    return [f"{group[0].sequence}{', ' + ' and '.join(names) if several else ''}: no APE rotation, {reason}."
            for reason, names in systems.items()]


def _row_cells(row: ErrorRow, group: list[ErrorRow], alignment: str, statistics: tuple[str, ...],
               shared: dict[str, Unit | None]) -> list[Cell]:
    if not row.accuracy:
        return [Cell(DASH)] * (1 + len(ERRORS) * len(statistics))
    cells: list[Cell | int] = [row.accuracy["matched_poses"]]
    for key, _ in ERRORS:
        unit = unit_of(key, group, alignment)
        for statistic in statistics:
            cell = _error_cell(row, group, alignment, key, statistic, unit)
            if shared[key] is None and exists(cell.value):
                cell.text += f"\u2009{unit.name}"
            cells.append(cell)
    return cells


def _error_cell(row: ErrorRow, group: list[ErrorRow], alignment: str, key: str, statistic: str, unit: Unit) -> Cell:
    def value_of(accuracy: dict | None) -> float | None:
        value = accuracy[alignment][key][statistic] if accuracy else None
        return value * unit.factor if exists(value) else None

    value = value_of(row.accuracy)
    competitors = [value_of(other.accuracy) for other in group if other.ranked]
    competitors = [competitor for competitor in competitors if exists(competitor)]
    shown = {significant(competitor) for competitor in competitors}
    best = row.ranked and len(shown) > 1 and significant(value) == significant(min(competitors))
    return Cell(significant(value), row.accuracy[alignment][key][statistic], bold=best,
                beside=difference(value, value_of(row.baseline)))
