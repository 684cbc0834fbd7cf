"""Numbers as they are printed: their value, the size of their last digit, and what the signs before them say."""

from __future__ import annotations

import re
from dataclasses import dataclass

from skinbayes.errors import InputError
from skinbayes.units import NUMBER, parse_quantity

_SIGNS = {"≈": "about", "about": "about", "∼": "roughly", "of order": "order", ">": "", "a few": "few"}
_FORM = re.compile(
    rf"(?P<sign>{'|'.join(_SIGNS)})?\s*(?P<low>{NUMBER.pattern})?(?:–(?P<high>{NUMBER.pattern}))?\s*(?P<unit>.*)"
)
_FEW = (2.0, 9.0)
"""What a few may be."""


@dataclass(frozen=True, kw_only=True)
class Printed:
    """A printed number or range in SI units.

    Attributes
    ----------
    text : as printed
    reading : "digits", "about", "order" or "range": the name of a rule
    low, high : the number, the same twice, or the ends of a range
    step : size of one unit of the last printed digit
    unit : as printed; empty for a bare number
    scale : size of one such unit
    """

    text: str
    reading: str
    low: float
    high: float
    step: float
    unit: str
    scale: float

    @property
    def value(self) -> float | tuple[float, float]:
        """The number, or both ends of a range."""
        return self.low if self.low == self.high else (self.low, self.high)


def read_printed(text: str, unit: str, *, where: str) -> Printed:
    """Read a printed number with its unit and signs.

    Zeros at the end of a whole number are not digits that count. A ``∼`` before one digit means the order of magnitude,
    before more digits the same as ``≈``. "A few" is from two to nine, with "or less" down to none.

    Parameters
    ----------
    text : such as ``"≈ 14 um"``, ``"6–9 um"``, ``"of order 100 s"``
    unit : SI unit of the result
    where : place, for messages

    Raises
    ------
    InputError
        if there is no number

    Examples
    --------
    >>> found = read_printed("≈ 14 um", "m", where="here")
    >>> found.reading, found.low, found.step
    ('about', 1.4e-05, 1e-06)
    >>> read_printed("6.83 kPa", "Pa", where="here").step, read_printed("∼ 20", "1", where="here").reading
    (10.0, 'order')
    """
    form = _FORM.fullmatch(text.strip())
    sign = _SIGNS.get(form["sign"] or "", "") if form else ""
    if form is None or (form["low"] is None and sign != "few"):
        raise InputError(f"{where}: found {text!r}; expected a number, such as '≈ 14 um' or '6–9 um'")
    name = form["unit"]
    if sign == "few":
        least = 0.0 if name.endswith(" or less") else _FEW[0]
        name = name.removesuffix(" or less")
        low, high, step = (_si(f"{number}", name, unit, where) for number in (least, _FEW[1], 1.0))
        return Printed(text=text, reading="range", low=low, high=high, step=step, unit=name, scale=step)
    first, last = form["low"], form["high"] or form["low"]
    low, high = (_si(number, name, unit, where) for number in (first, last))
    step = abs(_si(repr(_last_digit(last)), name, unit, where, difference=True))
    scale = _si("1", name, unit, where, difference=True)
    reading = sign or "digits"
    if form["high"]:
        reading = "range"
    elif sign == "roughly":
        reading = "order" if len(_digits(first)) == 1 else "about"
    return Printed(text=text, reading=reading, low=low, high=high, step=step, unit=name, scale=scale)


def _si(number: str, name: str, unit: str, where: str, difference: bool = False) -> float:
    if name == unit:
        return float(number)  # the constant of a power law has a unit that no converter knows
    return parse_quantity(f"{number} {name}".strip(), unit, where=where, difference=difference)


def _digits(number: str) -> str:
    """Digits that count: without zeros before the first and, of whole numbers, after the last."""
    mantissa = re.split("[eE]", number.lstrip("+-"))[0]
    whole = mantissa.replace(".", "").lstrip("0")
    return whole if "." in mantissa else whole.rstrip("0")


def _last_digit(number: str) -> float:
    """Size of a unit of the last digit that counts."""
    mantissa, _, power = number.lower().lstrip("+-").partition("e")
    decimals = len(mantissa.partition(".")[2])
    zeros = 0 if "." in mantissa else len(mantissa) - len(mantissa.rstrip("0"))
    return float(f"1e{zeros - decimals + int(power or 0)}")
