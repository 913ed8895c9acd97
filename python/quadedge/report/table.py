"""Tables as data; pandas writes them as text and CSV."""

import re
from dataclasses import dataclass, field
from itertools import groupby

import pandas

from .numbers import DASH, exists, significant


@dataclass
class Cell:
    """The displayed text and the unrounded value, in the unit of the heading."""

    text: str
    value: float | str | None = None
    bold: bool = False

    def __post_init__(self):
        if self.value is None and self.text != DASH:
            self.value = self.text

    @classmethod
    def of(cls, value: float | None, digits: int = 4, factor: float = 1) -> "Cell":
        """A number times a factor, with significant digits; a dash for a missing one."""
        scaled = value * factor if exists(value) else None
        return cls(significant(scaled, digits), scaled)


@dataclass
class Table:
    """Rows of cells. The first `text_columns` columns are left-aligned text, the others numbers."""

    name: str
    """Name of its file; unique on a page."""
    title: str
    columns: list[str | tuple[str, str]]
    """Headings; a tuple has that of a group of columns in front."""
    rows: list[list[Cell]] = field(default_factory=list)
    text_columns: int = 1
    notes: list[str] = field(default_factory=list)
    has_result: bool = False
    """The last row summarises the rows above."""
    kind: str = "table"

    def add(self, *cells: Cell | str | int) -> None:
        """Adds a row. Raises ValueError if it is not as long as the heading."""
        row = [cell if isinstance(cell, Cell) else Cell(str(cell), cell) for cell in cells]
        if len(row) != len(self.columns):
            raise ValueError(f"{self.name}: {len(row)} cells for {len(self.columns)} columns")
        self.rows.append(row)

    def headings(self) -> list[tuple[str, str]]:
        """Group and heading of every column."""
        return [column if isinstance(column, tuple) else ("", column) for column in self.columns]

    def groups(self) -> list[tuple[str, int]]:
        """Headings of groups and their numbers of columns; nothing if there is no group."""
        spans = [(text, len(list(columns))) for text, columns in groupby(self.headings(), lambda column: column[0])]
        return spans if any(text for text, _ in spans) else []

    def frame(self, part: str) -> pandas.DataFrame:
        """The texts ("text") or the unrounded values ("value"), under headings of one line."""
        return pandas.DataFrame([[getattr(cell, part) for cell in row] for row in self.rows],
                                columns=[" ".join(filter(None, column)) for column in self.headings()], dtype=object)


def _markdown_row(texts) -> str:
    cells = (re.sub(r"([|*\\`<])", r"\\\1", text).replace("\n", " ") for text in texts)
    return "| " + " | ".join(cells) + " |"


def to_markdown(table: Table) -> str:
    """The table in Markdown, with rounded values."""
    texts = table.frame("text")
    rule = "|---" * table.text_columns + "|--:" * (len(table.columns) - table.text_columns) + "|"
    return "\n".join([_markdown_row(texts.columns), rule, *map(_markdown_row, texts.values)]
                     + [f"\n{note}" for note in table.notes]) + "\n"


def to_text(table: Table) -> str:
    """The table in aligned columns, with rounded values, for a terminal."""
    texts = table.frame("text")
    texts.columns = pandas.MultiIndex.from_tuples(table.headings()) if table.groups() else texts.columns
    return "\n".join([table.title, texts.to_string(index=False), *table.notes]) + "\n"
