"""When a computed value agrees with what is printed: one rule for each way of printing and each word, none for a single row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite, log, sqrt
from types import MappingProxyType

from skinbayes.reproduce.printed import Printed

HALF_A_DIGIT = 0.5
"""Units of the last digit by which a number printed without a sign may be off: rounding."""

ONE_DIGIT, AT_MOST = 1.0, 0.5
"""Units of the last digit by which a number printed as approximate may be off, and the largest part of its value."""

ORDER = sqrt(10.0)
"""Factor within which a number of the printed order of magnitude lies."""

SAME_EQUATION = 1e-3
"""Relative difference of an equation and the package: the quadrature over the spectrum is good to 7e-5."""

QUARTER, TENTH, MUCH = 1.25, 0.1, 3.0
"""Ratio up to which two values are similar, fraction up to which something is small, ratio from which it is much larger."""

NOTHING = 0.01
"""Change of a ratio that does not count as growing or falling."""


@dataclass(frozen=True)
class Rule:
    """How rows of one kind are judged.

    Attributes
    ----------
    name : the reading of a row
    sentence : the rule in words
    agrees : whether a computed value agrees, given what is printed (None where nothing is)
    """

    name: str
    sentence: str
    agrees: Callable[[float, Printed | None], bool]


def _number(within: Callable[[float, Printed], bool]) -> Callable[[float, Printed | None], bool]:
    return lambda value, printed: printed is not None and isfinite(value) and within(value, printed)


def _word(holds: Callable[[float], bool]) -> Callable[[float, Printed | None], bool]:
    return lambda value, printed: isfinite(value) and holds(value)


def _rounds(value: float, printed: Printed) -> bool:
    return abs(value - printed.low) <= HALF_A_DIGIT * printed.step * (1 + 1e-9)


def _about(value: float, printed: Printed) -> bool:
    allowed = min(ONE_DIGIT * printed.step, AT_MOST * abs(printed.low))
    return abs(value - printed.low) <= allowed * (1 + 1e-9)


def _order(value: float, printed: Printed) -> bool:
    return value * printed.low > 0 and abs(log(value / printed.low)) <= log(ORDER) * (1 + 1e-9)


def _range(value: float, printed: Printed) -> bool:
    margin = HALF_A_DIGIT * printed.step
    return printed.low - min(margin, printed.low / 2) <= value <= printed.high + margin


def _similar(ratio: float) -> bool:
    return ratio > 0 and abs(log(ratio)) <= log(QUARTER)


_ALL = (
    Rule("digits", "a number: within half a unit of its last printed digit", _number(_rounds)),
    Rule("about", "a number with ≈, or ∼ and more than one digit: within one unit of its last digit other than zero, and within "
         "half of its value", _number(_about)),
    Rule("order", "a number of an order of magnitude (∼ and one digit, 'of order'): within a factor √10 = 3.16", _number(_order)),
    Rule("range", "a range: between its ends, which half a unit of the last digit widens; 'a few' is 2 to 9", _number(_range)),
    Rule("formula", "an equation: the package and the formula as printed within 1e-3 of each other",
         lambda value, printed: isfinite(value) and abs(value) <= SAME_EQUATION),
    Rule("complete", "complete: at least 0.99", _word(lambda x: x >= 1 - NOTHING)),
    Rule("nearly complete", "nearly complete: at least 0.8, a quarter less than complete", _word(lambda x: x >= 1 / QUARTER)),
    Rule("similar", "similar, nearly the same, nearly independent: a ratio between 0.8 and 1.25 everywhere", _word(_similar)),
    Rule("negligible", "negligible, does not depend: a change below 10 % everywhere", _word(lambda x: abs(x) <= TENTH)),
    Rule("small", "small: at most 0.1", _word(lambda x: 0 <= x <= TENTH)),
    Rule("much larger", "much larger, strong: a ratio of at least 3", _word(lambda x: x >= MUCH)),
    Rule("much smaller", "much smaller: a ratio of at most 1/3", _word(lambda x: 0 <= x <= 1 / MUCH)),
    Rule("grows", "grows, increases: a ratio above 1.01; of a series last over first, and no step back",
         _word(lambda x: x > 1 + NOTHING)),
    Rule("falls", "falls, lower: a ratio below 0.99; of a series last over first, and no step up",
         _word(lambda x: 0 <= x < 1 - NOTHING)),
    Rule("proportional", "proportional: an exponent between 0.9 and 1.1", _word(lambda x: abs(x - 1) <= TENTH)),
    Rule("positive", "on the exit side: a distance above 0", _word(lambda x: x > 0)),
)  # fmt: skip

RULES: Mapping[str, Rule] = MappingProxyType({rule.name: rule for rule in _ALL})
"""Every rule by the reading that asks for it."""


def relative_difference(value: float, printed: Printed) -> float:
    """Computed over printed, less 1; of a range 0 inside, and the distance to the nearer end outside.

    Examples
    --------
    >>> from skinbayes.reproduce.printed import read_printed
    >>> round(relative_difference(78e-6, read_printed("≈ 90 um", "m", where="here")), 3)
    -0.133
    """
    if printed.low <= value <= printed.high:
        return 0.0
    end = printed.low if value < printed.low else printed.high
    return (value - end) / abs(end) if end else value
