"""Numbers as people read them: the one place where figures and pages round."""

from __future__ import annotations

from math import ceil, floor, isfinite, log10

from skinbayes.phrases import number
from skinbayes.units import format_quantity, parse_quantity
from skinbayes.vocabulary import lookup


def prefix_of(typical: float, unit: str) -> tuple[float, str]:
    """SI value and name of the unit in which a typical value reads well.

    Examples
    --------
    >>> prefix_of(1.5e7, "Pa"), prefix_of(0.3, "1"), prefix_of(3.8e-4, "m^2")
    ((1000000.0, 'MPa'), (1.0, ''), (1e-06, 'mm²'))
    """
    if unit == "1" or not isfinite(typical) or typical == 0.0:
        return 1.0, "" if unit == "1" else unit_text(unit)
    shown = format_quantity(typical, unit, digits=3).partition(" ")[2]
    factor = 1.0 if shown == unit else parse_quantity(f"1 {shown}", unit, where="unit shown")
    return factor, unit_text(shown)


def unit_text(unit: str) -> str:
    """A unit with raised powers: ``"mm²"``, ``"1/m"``."""
    return unit.replace("^2", "²").replace("^3", "³").replace("^4", "⁴")


def quantity(value: float, unit: str, digits: int = 3) -> str:
    """An SI value with a unit that suits it.

    Examples
    --------
    >>> quantity(14.82e6, "Pa"), quantity(float("inf"), "Pa"), quantity(0.78, "1"), quantity(1e9, "1/m")
    ('14.8 MPa', 'infinite', '0.78', '10⁹ 1/m')
    """
    if not isfinite(value):
        return number(value)
    factor, name = prefix_of(value, unit)
    return f"{number(value / factor, digits)} {name}".strip()


def quantity_of(name: str, value: float) -> str:
    """An SI value of a quantity by its name, in the unit that the vocabulary gives it; a bare number if it has none.

    Examples
    --------
    >>> quantity_of("young_modulus_bulk", 2e4), quantity_of("friction_coefficient", 0.3)
    ('20 kPa', '0.3')
    """
    known = lookup(name)
    return quantity(value, known.unit if known else "1")


def interval(low: float, high: float, unit: str, typical: float | None = None, joint: str = " to ") -> str:
    """Two SI values in one unit, which is said once.

    Examples
    --------
    >>> interval(7.811e6, 28.32e6, "Pa"), interval(2.4e8, 2.4e9, "Pa", typical=7.7e8), interval(1e-5, 3e-4, "1")
    ('7.81 to 28.3 MPa', '240 to 2400 MPa', '10⁻⁵ to 3 × 10⁻⁴')
    """
    factor, name = prefix_of(high if typical is None else typical, unit)
    return f"{number(low / factor)}{joint}{number(high / factor)} {name}".strip()


def fraction(count: int, total: int) -> str:
    """How many of some draws, in percent; none and all of them are said as what the draws can tell.

    Examples
    --------
    >>> fraction(0, 4000), fraction(4000, 4000), fraction(2, 4000), fraction(1300, 4000)
    ('less than 0.03 %', 'more than 99.97 %', '0.05 %', '32 %')
    """
    if 0 < count < total:
        return f"{number(100.0 * count / total, 2)} %"
    # the smallest fraction that so many draws can show, rounded up to one digit
    exponent = floor(log10(100.0 / total) + 1e-12)
    least = ceil(100.0 / total / 10.0**exponent - 1e-9) * 10.0**exponent
    digits = max(0, -exponent)
    return f"less than {least:.{digits}f} %" if count <= 0 else f"more than {100.0 - least:.{digits}f} %"
