"""Tables as data, and their export to text, CSV, Markdown and LaTeX."""

import csv
import io
import math
import re
from dataclasses import dataclass, field

from .numbers import DASH, exists, significant


@dataclass
class Cell:
    """The displayed text and the unrounded value, in the unit of Table.exact_columns or else of the heading."""

    text: str
    value: float | str | None = None
    bold: bool = False
    beside: str = ""
    """A difference or remark in small print."""

    @classmethod
    def of(cls, value: float | None, digits: int = 4, factor: float = 1, beside: str = "") -> "Cell":
        """A number times a factor, with significant digits; a dash for a missing one."""
        scaled = value * factor if exists(value) else None
        return cls(significant(scaled, digits), scaled, beside=beside)

    def exact(self) -> str:
        """The unrounded value, or the text; empty if the value is missing."""
        if self.value is None:
            return "" if self.text == DASH else self.text
        if isinstance(self.value, float):
            return repr(self.value) if math.isfinite(self.value) else ""
        return str(self.value)


@dataclass
class Table:
    """Rows of cells. The first `text_columns` columns are left-aligned text, the others numbers."""

    name: str
    """Name of its files; unique on a page."""
    title: str
    columns: list[str]
    rows: list[list[Cell]] = field(default_factory=list)
    groups: list[tuple[str, int]] = field(default_factory=list)
    """The upper row of the heading: texts and the number of columns that they span."""
    text_columns: int = 1
    exact_columns: list[str] | None = None
    """Column names of the CSV file, if the unrounded values have other units than the heading."""
    notes: list[str] = field(default_factory=list)
    result_rows: int = 0
    """Number of rows at the end that summarise the rows above."""
    kind: str = "table"

    def add(self, *cells: Cell | str | int) -> None:
        """Adds a row. Raises ValueError if it is not as long as the heading."""
        row = [cell if isinstance(cell, Cell) else Cell(str(cell), cell if isinstance(cell, int) else None)
               for cell in cells]
        if len(row) != len(self.columns):
            raise ValueError(f"{self.name}: {len(row)} cells for {len(self.columns)} columns")
        self.rows.append(row)

    def full_columns(self) -> list[str]:
        """Column names, prefixed with those of their groups."""
        above = [text for text, span in self.groups for _ in range(span)] or [""] * len(self.columns)
        return [" ".join(filter(None, (group, column))) for group, column in zip(above, self.columns)]


def to_csv(table: Table) -> str:
    """The table as CSV (RFC 4180) with unrounded values."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.exact_columns or table.full_columns())
    for row in table.rows:
        writer.writerow([cell.exact() for cell in row])
    return stream.getvalue()


def _markdown_row(texts: list[str]) -> str:
    cells = (re.sub(r"([|*\\`<])", r"\\\1", text).replace("\n", " ") for text in texts)
    return "| " + " | ".join(cells) + " |"


def to_markdown(table: Table) -> str:
    """The table in Markdown, with rounded values."""
    rows = [[" ".join(filter(None, (cell.text, cell.beside))) for cell in row] for row in table.rows]
    rule = "|---" * table.text_columns + "|--:" * (len(table.columns) - table.text_columns) + "|"
    return "\n".join([_markdown_row(table.full_columns()), rule, *map(_markdown_row, rows)]
                     + [f"\n{note}" for note in table.notes]) + "\n"


def to_text(table: Table) -> str:
    """The table in aligned columns, with rounded values, for a terminal."""
    rows = [table.columns, *([" ".join(filter(None, (cell.text, cell.beside))) for cell in row] for row in table.rows)]
    widths, above, column = [max(map(len, column)) for column in zip(*rows)], [], 0
    for text, span in table.groups:
        last, width = column + span - 1, sum(widths[column:column + span]) + 2 * (span - 1)
        widths[last] += max(0, len(text) - width)
        above.append(text.ljust(width))
        column += span
    lines = [table.title, "  ".join(above), *(
        "  ".join(text.ljust(width) if number < table.text_columns else text.rjust(width)
                  for number, (text, width) in enumerate(zip(row, widths))) for row in rows), *table.notes]
    return "".join(f"{line.rstrip()}\n" for line in lines if line.strip())


_LATEX = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
          "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "\u2009": r"\,", "\u202f": r"\,",
          "\u00b1": r"$\pm$", "\u2013": "--", "\u2265": r"$\geq$", "\u2264": r"$\leq$", "\u2003": r"\quad ",
          "\u2212": "$-$"}


def _latex_text(text: str) -> str:
    return "".join(_LATEX.get(letter, letter) for letter in text)


def _latex_cell(cell: Cell) -> str:
    text = _latex_text(cell.text)
    text = rf"\textbf{{{text}}}" if cell.bold else text
    return f"{text} {{\\footnotesize {_latex_text(cell.beside)}}}" if cell.beside else text


def to_latex(table: Table) -> str:
    """The table as a LaTeX `table` environment; needs the package booktabs."""
    letters = "l" * table.text_columns + "r" * (len(table.columns) - table.text_columns)
    lines = [r"\begin{table}", r"  \centering", rf"  \caption{{{_latex_text(table.title)}}}",
             rf"  \label{{tab:{table.name}}}", rf"  \begin{{tabular}}{{{letters}}}", r"    \toprule"]
    if table.groups:
        cells, rules, column = [], [], 1
        for text, span in table.groups:
            cells.append(rf"\multicolumn{{{span}}}{{c}}{{{_latex_text(text)}}}")
            if text and span > 1:
                rules.append(rf"\cmidrule(lr){{{column}-{column + span - 1}}}")
            column += span
        lines += ["    " + " & ".join(cells) + r" \\", "    " + " ".join(rules)]
    lines += ["    " + " & ".join(_latex_text(column) for column in table.columns) + r" \\", r"    \midrule"]
    for number, row in enumerate(table.rows):
        if table.result_rows and number + table.result_rows == len(table.rows):
            lines.append(r"    \midrule")
        lines.append("    " + " & ".join(_latex_cell(cell) for cell in row) + r" \\")
    lines += [r"    \bottomrule", r"  \end{tabular}"]
    lines += [rf"  \par\footnotesize {_latex_text(note)}" for note in table.notes]
    return "\n".join(line for line in lines if line.strip()) + "\n" + "\\end{table}\n"
