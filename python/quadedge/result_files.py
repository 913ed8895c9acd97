"""Files that the program writes, read by the names of their keys and columns."""

import contextlib
import csv
import json
from pathlib import Path

import numpy as np
import pandas

from .errors import DataError


class DamagedResults(DataError):
    """A file that is missing, cut off, or of another kind; names it, what was found and what was expected."""


def read_json(file: Path, expected: str) -> dict:
    """The object in a JSON file. Raises DamagedResults."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise DamagedResults(f"{file}: {problem}; expected {expected}") from None
    if not isinstance(content, dict):
        raise DamagedResults(f"{file}: no JSON object; expected {expected}")
    return content


@contextlib.contextmanager
def expecting(expected: str, file: Path):
    """Raises DamagedResults in place of the errors that content of another shape causes."""
    try:
        yield
    except DamagedResults:
        raise
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as problem:
        text = f"no {problem}" if isinstance(problem, KeyError) else problem
        raise DamagedResults(f"{file}: {text}; expected {expected}") from problem


def whole_lines(file: Path, *, may_be_cut: bool = False) -> list[str]:
    """The lines of a text file. `may_be_cut`: a last line without a line end is left out. Raises DamagedResults."""
    try:
        with open(file, encoding="utf-8", errors="replace", newline="") as stream:
            text = stream.read()
    except OSError as problem:
        raise DamagedResults(f"{file}: {problem.strerror}") from None
    if may_be_cut:
        text = text[:text.rfind("\n") + 1]
    return text.splitlines()


def read_table(file: Path, *, may_be_cut: bool = False) -> pandas.DataFrame:
    """The texts in a CSV file with a heading. Raises DamagedResults for rows of another length.

    `may_be_cut`: as for whole_lines().
    """
    rows = list(csv.reader(whole_lines(file, may_be_cut=may_be_cut)))
    if not rows:
        raise DamagedResults(f"{file}: an empty file; expected a heading")
    for number, row in enumerate(rows, 1):
        if len(row) != len(rows[0]):
            raise DamagedResults(f"{file}:{number}: {len(row)} fields; expected {len(rows[0])} as in the heading")
    return pandas.DataFrame(rows[1:], columns=rows[0], dtype=object)


def numbers(texts: pandas.Series | pandas.DataFrame, file: Path) -> np.ndarray:
    """Texts as numbers, NaN for empty ones. Raises DamagedResults."""
    try:
        return texts.where(texts != "", "nan").to_numpy(float)
    except ValueError as problem:
        raise DamagedResults(f"{file}: {problem}") from None


def rotations(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices (n, 3, 3) of quaternions x y z w (n, 4), which are normalised first."""
    x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), -1, 0)
