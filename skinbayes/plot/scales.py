"""Axes in units that people use, logarithmic where values span decades."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.phrases import power_of_ten
from skinbayes.plot.numbers import prefix_of

if TYPE_CHECKING:
    from matplotlib.axis import Axis

ROOM = 5
"""Characters that an axis has room for, for each tick asked for."""

WIDE = 4.0
"""Ratio of the ends of what is shown above which an axis is logarithmic."""


@dataclass(frozen=True)
class Scale:
    """How values of one quantity are shown.

    Attributes
    ----------
    factor : SI value of one unit shown
    unit : unit shown, ``""`` for numbers without dimension
    logarithmic : whether the axis is logarithmic
    """

    factor: float
    unit: str
    logarithmic: bool

    def shown(self, values: Any) -> FloatArray:
        """Values in the unit shown."""
        return np.asarray(values, dtype=float) / self.factor

    def label(self, symbol: str) -> str:
        """Axis label: symbol and unit."""
        return f"{symbol} [{self.unit}]" if self.unit else symbol


def scale_for(unit: str, *groups: FloatArray) -> Scale:
    """Choose unit and kind of axis for the central 98 % of each of the groups of values (SI)."""
    finite = [np.asarray(g)[np.isfinite(g)] for g in groups]
    finite = [g for g in finite if g.size]
    if not finite:
        return Scale(1.0, "" if unit == "1" else unit, False)
    low = min(float(np.quantile(g, 0.01)) for g in finite)
    high = max(float(np.quantile(g, 0.99)) for g in finite)
    factor, name = prefix_of(float(np.median(finite[-1])), unit)
    positive = min(float(g.min()) for g in finite) > 0.0
    return Scale(factor, name, bool(positive and low > 0.0 and high / low > WIDE))


def axis_scale(name: str, scale: Scale) -> Scale:
    """The scale of an axis that shows a quantity: time and humidity run evenly, whatever their range."""
    return replace(scale, logarithmic=False) if name in ("time", "relative_humidity") else scale


def round_values(low: float, high: float, most: int = 4) -> list[float]:
    """Round numbers inside a positive range, evenly spaced on a logarithmic axis.

    Examples
    --------
    >>> round_values(2.0, 60.0), round_values(0.5, 400.0)
    ([2.0, 5.0, 10.0, 20.0, 50.0], [1.0, 10.0, 100.0])
    """
    decades = range(int(np.floor(np.log10(low))) - 1, int(np.ceil(np.log10(high))) + 2)
    best: list[float] = []
    options = (
        (1.0,),
        (1.0, 3.0),
        (1.0, 2.0, 5.0),
        (1.0, 1.5, 2.0, 3.0, 5.0, 7.0),
        (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0),
    )
    for mantissas in options:
        values = [float(f"{m}e{d}") for d in decades for m in mantissas]
        inside = [v for v in values if low * 0.999 <= v <= high * 1.001]
        if len(inside) > most + 1 and best:
            break
        best = inside if len(inside) >= len(best) else best
    while len(best) > most + 1:
        best = best[::2]
    return best


def plain_number(value: float) -> str:
    """A tick label: ``"0.05"``, ``"200"``; powers of ten outside 1e-3 to 1e5.

    Examples
    --------
    >>> plain_number(0.05), plain_number(200.0), plain_number(1e-5)
    ('0.05', '200', '10⁻⁵')
    """
    return f"{value:g}" if value == 0.0 or 1e-3 <= abs(value) < 1e5 else power_number(value)


def power_number(value: float) -> str:
    """A tick label of an axis that spans many decades. Plain text: matplotlib takes long to set mathematics.

    Examples
    --------
    >>> power_number(1.0), power_number(10.0), power_number(1e5), power_number(3e-4)
    ('1', '10', '10⁵', '3·10⁻⁴')
    """
    if 0.5 < value < 50.0:
        return f"{value:g}"
    exponent = int(np.floor(np.log10(abs(value)) + 1e-9))
    mantissa = float(f"{value / 10.0**exponent:.3g}")
    return power_of_ten(exponent) if mantissa == 1.0 else f"{mantissa:g}·{power_of_ten(exponent)}"


def ticks(axis: Axis, scale: Scale, low: float, high: float, most: int = 4, between: bool = False) -> None:
    """Put a few round numbers on an axis whose limits are ``low`` and ``high`` in the unit shown.

    ``between`` keeps the small ticks of a logarithmic axis.
    """
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullFormatter, NullLocator

    written = plain_number
    if scale.logarithmic:
        written = power_number if high / low > 3e4 else plain_number
        fewer = most
        while True:
            values = round_values(low, high, fewer)
            if fewer <= 2 or sum(len(written(value)) for value in values) <= ROOM * most:
                break
            fewer -= 1
        axis.set_major_locator(FixedLocator(values))
        axis.set_minor_formatter(NullFormatter())
        if not between:
            axis.set_minor_locator(NullLocator())
    else:
        axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: written(value)))
