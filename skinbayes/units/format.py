"""SI values as text for people."""

from __future__ import annotations

import re
from math import isfinite

from skinbayes.units.conversion import converts, unit_conversion

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


def format_quantity(value_si: float, unit: str, digits: int = 4, written: str | None = None) -> str:
    """Write an SI value for people, with a prefix where that is usual.

    Parameters
    ----------
    value_si : value in ``unit``
    unit : SI unit as in the vocabulary
    digits : significant digits
    written : text that the value was given as (``"80 deg"``, ``"lognormal(20 degC, 0.1)"``); angles and temperatures are
        shown in its unit, other quantities as always. An angle without it is shown in degrees

    Examples
    --------
    >>> format_quantity(15e6, "Pa"), format_quantity(2.24e-5, "m"), format_quantity(0.42, "1")
    ('15 MPa', '22.4 µm', '0.42')
    >>> format_quantity(1e9, "1/m"), format_quantity(float("inf"), "Pa"), format_quantity(3.81e-4, "m^2")
    ('1e9 1/m', 'inf', '381 mm^2')
    >>> format_quantity(1.3962634, "rad"), format_quantity(293.15, "K"), format_quantity(293.15, "K", written="20 °C")
    ('80 deg', '293.15 K', '20 °C')
    """
    if not isfinite(value_si):
        return str(float(value_si))
    if unit == "K":
        digits += 1  # 293.15 K and 293.1 K are not the same room
    if unit in ("K", "rad") and (shown := _written_unit(written or "", unit)):
        multiplier, divisor, offset = unit_conversion(shown, unit)
        number = (value_si - offset) * divisor / multiplier
        return f"{_plain(float(f'{number:.{digits}g}'), digits)} {shown}"
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


def _written_unit(written: str, unit: str) -> str:
    """The last unit in a text that ``unit`` converts to; degrees for an angle of which nothing is known."""
    found = [text for text in re.findall(r"[0-9.]\s*([°º]?\s?[A-Za-z°º]+)", written) if converts(text, unit)]
    return found[-1] if found else "deg" if unit == "rad" else ""


def _plain(number: float, digits: int) -> str:
    text = f"{number:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa}e{int(exponent)}"
    return text
