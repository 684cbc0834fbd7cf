"""Numbers, lists, counts and names of groups as people write them."""

from __future__ import annotations

from collections.abc import Sequence
from math import floor, isfinite, log10

_PLURALS = {"person": "people", "body_site": "body sites", "row_label": "rows"}

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def and_list(parts: Sequence[str]) -> str:
    """``"a, b and c"``.

    Examples
    --------
    >>> and_list(["a", "b", "c"]), and_list(["a"])
    ('a, b and c', 'a')
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def singular(column: str) -> str:
    """A level of a grouping column: ``"body site"``."""
    return column.replace("_", " ") if column != "row_label" else "row"


def plural(column: str) -> str:
    """The levels of a grouping column: ``"people"``, ``"body sites"``."""
    return _PLURALS.get(column, f"{singular(column)}s")


def row_count(count: int) -> str:
    """``"1 row"``, ``"11 rows"``."""
    return f"{count} row{'' if count == 1 else 's'}"


def sample_size(ess: float) -> str:
    """An effective sample size, or that it is unknown: the autocorrelation has not died out within the run.

    Examples
    --------
    >>> sample_size(512.3), sample_size(0.0), sample_size(float("nan"))
    ('512', 'unknown', 'unknown')
    """
    return f"{ess:.0f}" if ess > 0 else "unknown"


def number(value: float, digits: int = 3) -> str:
    """A number with a few significant digits and no computer notation; zeros at its end are kept if they were rounded to.

    Examples
    --------
    >>> number(2412.3), number(0.76543), number(1.3586e-4), number(float("inf")), number(120000.0)
    ('2410', '0.765', '1.36 × 10⁻⁴', 'infinite', '1.2 × 10⁵')
    >>> number(0.29974), number(0.3)
    ('0.300', '0.3')
    """
    if not isfinite(value):
        return "not a number" if value != value else "infinite" if value > 0 else "−infinite"
    rounded = float(f"{value:.{digits}g}")
    if rounded == 0.0:
        return "0"
    exponent = floor(log10(abs(rounded)) + 1e-12)
    small = exponent < -3 or exponent >= 5
    mantissa = rounded / 10.0**exponent if small else rounded
    text = f"{mantissa:.{max(0, digits - 1 - (0 if small else exponent))}f}"
    if "." in text and abs(value - rounded) <= 1e-9 * abs(rounded):
        text = text.rstrip("0").rstrip(".")
    if not small:
        return text
    power = power_of_ten(exponent)
    return power if text == "1" else f"{text} × {power}"


def power_of_ten(exponent: int) -> str:
    """``"10⁻⁵"``."""
    return f"10{str(exponent).translate(_RAISED)}"


def percent(fraction: float) -> str:
    """A fraction in percent: ``"45 %"``, ``"0.4 %"``, ``"less than 0.1 %"``.

    Examples
    --------
    >>> percent(0.4512), percent(0.00412), percent(0.0002), percent(0.0), percent(1.0)
    ('45 %', '0.41 %', 'less than 0.1 %', '0 %', '100 %')
    """
    if 0.0 < fraction < 1e-3:
        return "less than 0.1 %"
    return f"{number(100.0 * fraction, 2)} %"
