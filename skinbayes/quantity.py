"""What is known of a physical quantity: its name, symbol, unit and range."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class Quantity:
    """A named physical quantity.

    Attributes
    ----------
    name : the name used everywhere
    symbol : the symbol in equations and plots (plain text)
    unit : SI unit, as written in headers; ``"1"`` for dimensionless numbers
    meaning : a short description
    lower, upper : physical range, SI
    lower_open, upper_open : True if the bound itself is impossible
    infinite_allowed : True if ``inf`` is a meaningful value (yield stress of an elastic body)
    none_means : the value that stands for "absent", if absence is meaningful

    Examples
    --------
    Examples of methods go on from this one.

    >>> quantity = Quantity("hurst_exponent", "H", "1", "Hurst exponent", 0.0, 1.0, upper_open=True)
    >>> quantity.symbol
    'H'
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    lower: float = 0.0
    upper: float = inf
    lower_open: bool = True
    upper_open: bool = False
    infinite_allowed: bool = False
    none_means: float | None = None

    def admits(self, value: float) -> bool:
        """Tell whether a value is physically possible.

        Parameters
        ----------
        value : SI

        Returns
        -------
        bool
            False also for NaN.

        Examples
        --------
        >>> quantity.admits(0.8), quantity.admits(1.0)
        (True, False)
        """
        if value != value:
            return False
        if value in (inf, -inf):
            return self.infinite_allowed and value > 0
        above = value > self.lower if self.lower_open else value >= self.lower
        below = value < self.upper if self.upper_open else value <= self.upper
        return above and below

    def range_text(self) -> str:
        """The admissible range as text, for messages.

        Returns
        -------
        str
            With the SI unit.

        Examples
        --------
        >>> quantity.range_text()
        'between 0, excluded, and 1 (excluded)'
        """
        unit = "" if self.unit == "1" else f" {self.unit}"
        if self.lower == -inf and self.upper == inf:
            return "any finite number"
        if self.upper == inf:
            return f"{'>' if self.lower_open else '>='} {self.lower:g}{unit}"
        left = ", excluded," if self.lower_open else ""
        right = " (excluded)" if self.upper_open else ""
        return f"between {self.lower:g}{left} and {self.upper:g}{right}{unit}"
