"""Rows of the table as text: numbers in the unit in which the paper prints them."""

from __future__ import annotations

import re

from skinbayes.phrases import number, power_of_ten
from skinbayes.reproduce.table import Compared
from skinbayes.units import format_quantity

_POWER_OF_TEN = re.compile(r"(-?[0-9.]+)e(-?[0-9]+)")
_DIGITS = 3


def paper_text(row: Compared) -> str:
    """What the paper has: as printed, the formula evaluated, or the words of a claim."""
    if row.formula is not None:
        return f"formula: {_quantity(row.formula, row.statement.unit)}"
    return printed_text(row.statement.words)


def printed_text(words: str) -> str:
    """Printed text with the signs of print: ``"≈ 1.7 × 10⁻⁷ m/s"``.

    Examples
    --------
    >>> printed_text("≈ 1.7e-7 m/s"), printed_text("∼ 1e-3"), printed_text("22.4 um"), printed_text("≈ -0.04")
    ('≈ 1.7 × 10⁻⁷ m/s', '∼ 10⁻³', '22.4 µm', '≈ −0.04')
    """
    text = _POWER_OF_TEN.sub(_raised, words)
    return (
        re.sub(r"(?<![\w⁻])-(?=[0-9])", "−", text)
        .replace("um", "µm")
        .replace("^3", "³")
        .replace(" degC", " °C")
        .replace(" deg", "°")
    )


def _raised(match: re.Match[str]) -> str:
    power = power_of_ten(int(match[2]))
    return power if match[1] == "1" else f"{match[1]} × {power}"


def computed_text(row: Compared) -> str:
    """What skinbayes has, in the unit of the paper."""
    printed = row.statement.printed
    if printed is None or row.formula is not None:
        return _quantity(row.computed, row.statement.unit)
    unit = printed_text(printed.unit)
    return f"{number(row.computed / printed.scale, _DIGITS)} {unit}".strip().replace("-", "−")


def _quantity(value: float, unit: str) -> str:
    if unit == "1":
        return number(value, _DIGITS).replace("-", "−")
    return printed_text(format_quantity(value, unit, _DIGITS))


def difference_text(row: Compared) -> str:
    """Relative difference in percent; empty for claims."""
    if row.relative_difference is None:
        return ""
    percent = 100 * row.relative_difference
    if abs(percent) < 0.05:
        return "0 %"
    return f"{percent:+.{1 if abs(percent) < 10 else 0}f} %".replace("-", "−")


def verdict(row: Compared) -> str:
    """``"yes"`` or ``"NO"``: seen without colour."""
    return "yes" if row.agrees else "NO"


def count_sentence(rows: list[Compared]) -> str:
    """How many agree, of each kind."""
    kinds = {"number": "numbers", "equation": "equations", "claim": "statements in words"}
    parts = []
    for role, name in kinds.items():
        ours = [row for row in rows if row.statement.role == role]
        if ours:
            parts.append(f"{sum(row.agrees for row in ours)} of {len(ours)} {name}")
    return f"{sum(row.agrees for row in rows)} of {len(rows)} agree: {', '.join(parts)}."
