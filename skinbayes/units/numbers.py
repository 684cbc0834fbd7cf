"""Numbers as people write them that are not read: commas, and marks between thousands."""

from __future__ import annotations

import re
from math import isnan
from numbers import Real

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
"""A number as it is read: with a decimal point."""

_THOUSANDS = re.compile(
    r"(?P<whole>[+-]?[1-9][0-9]{0,2}(?P<mark>[.,'’  \u00a0\u2009\u202f])[0-9]{3}(?:(?P=mark)[0-9]{3})*)"
    r"(?P<decimals>(?!(?P=mark))[.,][0-9]+)?(?P<power>[eE][+-]?[0-9]+)?"
)
_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")


def comma_advice(number: str) -> str:
    """What to write instead of a number with a comma or with separated thousands; empty if there is neither.

    Examples
    --------
    >>> comma_advice("0,5"), comma_advice("1.234,5")
    ('a decimal comma; write 0.5', 'separated thousands; write 1234.5')
    >>> comma_advice("1,000")
    "a comma that may stand before decimals or between thousands; write 1.000 if it is decimal, 1000 if it is a thousand's"
    >>> comma_advice("1 000"), comma_advice("1.5")
    ('separated thousands; write 1000', '')
    """
    if len(number) > 40:
        return ""
    if found := _THOUSANDS.fullmatch(number):
        mark, decimals, power = found["mark"], found["decimals"] or "", found["power"] or ""
        joined = re.sub("[^0-9+-]", "", found["whole"])
        if decimals or mark not in ",." or number.count(mark) > 1:
            return f"separated thousands; write {joined}{decimals.replace(',', '.')}{power}"
        if mark == "," and not power:
            return (
                "a comma that may stand before decimals or between thousands; "
                f"write {number.replace(',', '.')} if it is decimal, {joined} if it is a thousand's"
            )
    return f"a decimal comma; write {number.replace(',', '.')}" if _COMMA.fullmatch(number) else ""


def number_text(value: Real) -> str:
    """A number of Python as a person would type it; ``1e999`` if it is too large."""
    try:
        number = float(value)
    except OverflowError:
        return "1e999"
    return "nan" if isnan(number) else repr(int(number)) if isinstance(value, int) else repr(number)
