"""Formats numbers for tables and axes: units by magnitude, few digits, a dash for missing values."""

import math
from collections.abc import Iterable
from typing import NamedTuple

DASH = "\u2013"
PLUS_MINUS = "\u2009\u00b1\u2009"
_THIN_SPACE = "\u202f"
_MOST_DECIMALS = 9


class Unit(NamedTuple):
    """A unit and the factor that converts SI units (degrees for angles) to it."""

    name: str
    factor: float


METRE, MILLIMETRE, DEGREE = Unit("m", 1.0), Unit("mm", 1000.0), Unit("deg", 1.0)


def exists(value: float | None) -> bool:
    """True for a finite value; missing values are null in JSON and NaN in tables."""
    return value is not None and math.isfinite(value)


def length_unit(metres: Iterable[float | None]) -> Unit:
    """The unit of a column or axis: millimetres if all lengths are below 10 cm, otherwise metres."""
    sizes = [abs(value) for value in metres if exists(value)]
    return MILLIMETRE if sizes and max(sizes) < 0.1 else METRE


def decimals_of(value: float, digits: int) -> int:
    """The number of decimals that shows `digits` significant digits."""
    magnitude = 0 if value == 0 else math.floor(math.log10(abs(value)))
    return min(max(digits - 1 - magnitude, 0), _MOST_DECIMALS)


def significant(value: float | None, digits: int = 4) -> str:
    """The value with significant digits and without an exponent; "0" below nine decimals."""
    if not exists(value):
        return DASH
    text = f"{value:.{decimals_of(value, digits)}f}"
    return text if text.strip("-0.") else "0"


def percent(share: float | None, decimals: int = 2) -> str:
    """Formats 0.9342 as "93.42"."""
    return f"{100 * share:.{decimals}f}" if exists(share) else DASH


def count(value: float | None) -> str:
    """Formats 48299 as "48 299"."""
    return f"{round(value):,}".replace(",", _THIN_SPACE) if exists(value) else DASH


def share_of(part: float, whole: float) -> str:
    """Formats a share as "58 of 86 (67.4 %)"; a dash if the whole is zero."""
    return f"{part} of {whole} ({100 * part / whole:.1f} %)" if whole else DASH


def length_text(metres: float | None) -> str:
    """Formats a length as "42.1 m" or "3.20 mm"."""
    unit = length_unit([metres])
    return f"{significant(metres * unit.factor, 3)} {unit.name}" if exists(metres) else DASH
