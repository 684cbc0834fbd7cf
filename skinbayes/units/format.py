"""SI values as text for people."""

from __future__ import annotations

import re
from math import isfinite

_PREFIXES = (
    (1e9, "G"),
    (1e6, "M"),
    (1e3, "k"),
    (1.0, ""),
    (1e-3, "m"),
    (1e-6, "µ"),
    (1e-9, "n"),
    (1e-12, "p"),
)
# unit that takes a prefix: largest prefix in use (nobody here thinks in kilometres), power
_PREFIXED = {"m^2": (1.0, 2), "Pa": (1e9, 1), "N": (1e3, 1), "J": (1e3, 1), "m": (1.0, 1), "s": (1.0, 1)}


def format_quantity(value_si: float, unit: str, digits: int = 4) -> str:
    """Write an SI value for people, with a prefix where that is usual.

    Parameters
    ----------
    value_si : value in ``unit``
    unit : SI unit as in the vocabulary
    digits : significant digits

    Examples
    --------
    >>> format_quantity(15e6, "Pa"), format_quantity(2.24e-5, "m"), format_quantity(0.42, "1")
    ('15 MPa', '22.4 µm', '0.42')
    >>> format_quantity(1e9, "1/m"), format_quantity(float("inf"), "Pa"), format_quantity(3.81e-4, "m^2")
    ('1e9 1/m', 'inf', '381 mm^2')
    """
    if not isfinite(value_si):
        return str(float(value_si))
    if unit == "K":
        digits += 1  # 293.15 K and 293.1 K are not the same room
    rounded = float(f"{value_si:.{digits}g}")
    base = next((name for name in _PREFIXED if re.match(rf"{re.escape(name)}(?![\w^])", unit)), None)
    if base is None:
        return _plain(rounded, digits) + ("" if unit == "1" else f" {unit}")
    largest, power = _PREFIXED[base]
    for size, prefix in _PREFIXES:
        scale = size**power
        if size <= largest and abs(rounded) >= (0.1 if scale == 1.0 and base in ("N", "s") else scale):
            return f"{_plain(rounded / scale, digits)} {prefix}{unit}"
    return f"{_plain(rounded, digits)} {unit}"


def _plain(number: float, digits: int) -> str:
    text = f"{number:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa}e{int(exponent)}"
    return text
