"""Text with a unit to an SI number: the only door through which units pass.

Inside skinbayes every number is in SI. What a person types (``"15 MPa"``, a header ``normal_force [mN]``) is
converted here, once, and a wrong or missing unit is an error that names the place. `words` says which units
there are; Pint does the dimensional analysis.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache, lru_cache
from math import inf, isfinite
from numbers import Real
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.units.numbers import comma_advice, number_text
from skinbayes.units.unit_words import UnknownUnit, canonical_unit, nearest_units, why_no_unit

_NUMBER = re.compile(
    r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?inf(?:inity)?(?![a-z])", re.IGNORECASE
)
_WRITTEN = re.compile(
    r"[+-]?[0-9.,](?:[0-9.,'’\s]*[0-9])?(?:[eE][+-]?[0-9]+)?"
)  # with what may stand between digits
_HEADER = re.compile(r"(?P<name>[^\[\]]*?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")

_MEANING = {
    "Pa": ("a pressure", "15 MPa"),
    "m": ("a length", "20 um"),
    "1/m": ("a wavevector", "1e3 1/m"),
    "N/m": ("a force per length", "0.07 N/m"),
    "Pa s": ("a viscosity", "0.5 mPa s"),
    "m^2": ("an area", "3.8 cm^2"),
    "m/s": ("a speed", "8 mm/s"),
    "K": ("a temperature", "20 degC"),
    "rad": ("an angle", "80 deg"),
    "1": ("a number without dimension", "0.78"),
    "1/s": ("a rate", "500 1/s"),
    "N": ("a force", "0.5 N"),
    "s": ("a time", "30 s"),
    "m^3": ("a volume or a one-dimensional power spectrum", "5e-8 m^3"),
    "m^4": ("a two-dimensional power spectrum", "1e-22 m^4"),
    "J/kg": ("an energy per mass", "2.4 MJ/kg"),
    "kg": ("a mass", "1 kg"),
    "m^2/s": ("a kinematic viscosity, which is the viscosity over the density", "1 m^2/s"),
    "1/s^2": ("a rate of a rate", "1 1/s^2"),
}


def describe_unit(unit: str) -> str:
    """What is expected in ``unit``, for messages: ``"a pressure in Pa, for example '15 MPa'"``."""
    meaning = _MEANING[unit][0] if unit in _MEANING else "a value"
    return f"{meaning}{'' if unit == '1' else f' in {unit}'}, for example '{unit_example(unit)}'"


def unit_example(unit: str) -> str:
    """A value in ``unit`` as a person would write it."""
    return _MEANING[unit][1] if unit in _MEANING else f"1 {unit}"


@cache
def _registry() -> Any:
    from pint import UnitRegistry

    return UnitRegistry(cache_folder=None)


class OtherDimension(ValueError):
    """A unit of another dimension; ``meaning`` says of what, if that has a name."""

    def __init__(self, text: str, meaning: str) -> None:
        super().__init__(text)
        self.meaning = meaning


@lru_cache(maxsize=512)
def unit_conversion(from_unit: str, to_unit: str) -> tuple[float, float, float]:
    """``(multiplier, divisor, offset)`` with ``to = from * multiplier / divisor + offset``.

    A factor such as 1e-6 is kept as a division by 1e6, which rounds once: "20 um" is then the number that
    2e-5 denotes. UnknownUnit for an unknown unit, OtherDimension for one of another dimension.
    """
    registry = _registry()
    target = registry.parse_units("" if to_unit == "1" else to_unit)
    canonical = canonical_unit(from_unit)
    try:
        source = registry.parse_units(canonical)
    except Exception as error:  # Pint's parser has many ways to fail; all mean "not a unit"
        raise UnknownUnit(from_unit) from error
    if source.dimensionality != target.dimensionality:
        raise OtherDimension(from_unit, _meaning_of(source))
    if _counts_angles(registry, source, target):
        raise OtherDimension(from_unit, _meaning_of(source) if source.dimensionless else "an angle times it")
    try:
        offset = float(registry.Quantity(0.0, source).to(target).magnitude)
        if offset != 0.0:  # the scale of a temperature: far from its zero the difference keeps its digits
            factor = (float(registry.Quantity(1e6, source).to(target).magnitude) - offset) / 1e6
            return (1.0 if abs(factor - 1.0) < 1e-12 else factor), 1.0, offset
        factor = float(registry.Quantity(1.0, source).to(target).magnitude)
    except Exception as error:  # such as a product with an offset temperature
        raise UnknownUnit(from_unit) from error
    if not isfinite(factor) or factor <= 0:
        raise UnknownUnit(from_unit)
    inverse = 1.0 / factor
    if factor < 1.0 and isfinite(inverse) and abs(inverse - round(inverse)) <= 1e-12 * inverse:
        return 1.0, float(f"{round(inverse):.15g}"), 0.0
    return (float(f"{factor:.15g}") if factor == round(factor) else factor), 1.0, 0.0


def _counts_angles(registry: Any, source: Any, target: Any) -> bool:
    """Whether a unit holds an angle where none belongs.

    Pint takes an angle for a number; a friction coefficient in degrees is a mistake nevertheless, and so are degrees times
    anything. An angle per length or time is a wavevector or a rate.
    """
    found, wanted = (dict(registry.get_base_units(unit)[1]._units) for unit in (source, target))
    powers = found.pop("radian", 0), wanted.pop("radian", 0)
    return powers[0] != powers[1] and not (
        powers[0] == 1 and found and all(power < 0 for power in found.values())
    )


def _meaning_of(source: Any) -> str:
    registry = _registry()
    if source.dimensionless:
        return "an angle" if registry.get_base_units(source)[1] != registry.Unit("") else _MEANING["1"][0]
    same = (
        meaning
        for unit, (meaning, _) in _MEANING.items()
        if unit not in ("1", "rad") and registry.parse_units(unit).dimensionality == source.dimensionality
    )
    return next(same, "")


def convert_array(
    values: ArrayLike, from_unit: str, to_unit: str, where: str, *, difference: bool = False
) -> FloatArray:
    """Convert numbers from one unit to another.

    Parameters
    ----------
    values : array of any shape, in ``from_unit``
    from_unit : unit as written by a person, such as ``"mN"``, ``"1/um"``, ``"degC"``, ``"%"``
    to_unit : SI unit as in the vocabulary; ``"1"`` for dimensionless numbers
    where : place named in the message
    difference : True for spreads and differences: a standard deviation in degC has no offset

    Returns
    -------
    numpy.ndarray
        values in ``to_unit``, same shape

    Raises
    ------
    InputError
        for an unknown unit or one of another dimension

    Examples
    --------
    >>> convert_array([0.5, 2.0], "mN", "N", "column normal_force")
    array([0.0005, 0.002 ])
    """
    multiplier, divisor, offset = _explained_conversion(from_unit, to_unit, where, difference=difference)
    numbers = np.asarray(values, dtype=float)
    with np.errstate(over="ignore"):  # a value beyond the largest number becomes inf, which readers refuse
        scaled = np.asarray(numbers * multiplier / divisor)
    return scaled if difference or offset == 0.0 else np.asarray(scaled + offset)


def _explained_conversion(
    from_unit: str, to_unit: str, where: str, found: str | None = None, difference: bool = False
) -> tuple[float, float, float]:
    """`unit_conversion`, with errors that say where; ``found`` is the text around the unit, if there is any."""
    unit = f"unit {_shortened(from_unit)!r}"
    if "delta_" in from_unit and not difference:
        raise InputError(f"{where}: {found or unit} is a difference; expected {describe_unit(to_unit)}")
    try:
        return unit_conversion(from_unit, to_unit)
    except UnknownUnit as error:
        problem = f"{unit} is unknown" if found is None else f"{found} has an unknown unit"
        problem += _advice(error, to_unit)
    except OtherDimension as error:
        problem = f"{unit if found is None else found} has the wrong dimension"
        problem += f" ({error.meaning})" if error.meaning else ""
    raise InputError(f"{where}: {problem}; expected {describe_unit(to_unit)}")


def _advice(unknown: UnknownUnit, to_unit: str) -> str:
    """What may have been meant: units like it that have the right dimension, or why a word is no unit."""
    if why := why_no_unit(unknown.word):
        return f" ({why})"
    fitting = [text for text in nearest_units(unknown) if converts(text, to_unit)][:2]
    if not fitting and unknown.word and unknown.word != unknown.text:
        return f" (no word {_shortened(unknown.word)!r} is known in units)"
    return f" (did you mean {' or '.join(repr(text) for text in fitting)}?)" if fitting else ""


def converts(from_unit: str, to_unit: str) -> bool:
    """Whether a text is a unit of the dimension of an SI unit."""
    try:
        unit_conversion(from_unit, to_unit)
    except (UnknownUnit, OtherDimension):
        return False
    return True


def _shortened(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."


def parse_quantity(value: str | int | float, unit: str, *, where: str, difference: bool = False) -> float:
    """Read a number with its unit and return it in SI.

    Parameters
    ----------
    value : text such as ``"15 MPa"``, ``"20 µm"``, ``"20 degC"``, ``"50 %"``, ``"inf"``; or a bare number
    unit : SI unit of the result, as in the vocabulary; ``"1"`` for dimensionless numbers
    where : place named in the message (file, key, option)
    difference : True for spreads and differences: a standard deviation of "2 degC" is 2 K

    Returns
    -------
    float
        the value in ``unit``

    Raises
    ------
    InputError
        if the unit is missing, unknown or of another dimension, the text is not a finite number, or a temperature
        is below absolute zero. Numbers without a unit are taken for dimensionless quantities only; ``inf`` needs no unit.

    Examples
    --------
    >>> parse_quantity("20 um", "m", where="layer_thickness")
    2e-05
    >>> parse_quantity("1 1/mm", "1/m", where="wavevector_min")
    1000.0
    >>> parse_quantity(15, "Pa", where="yield_stress")
    Traceback (most recent call last):
    ...
    skinbayes.errors.InputError: yield_stress: 15 has no unit; expected a pressure in Pa, for example '15 MPa'
    """
    expected = f"expected {describe_unit(unit)}"
    if isinstance(value, bool) or not isinstance(value, str | Real):
        raise InputError(f"{where}: {value!r:.80} is not a number; {expected}")
    text = value.strip() if isinstance(value, str) else number_text(value)
    match = _NUMBER.match(text)
    if match is None:
        raise InputError(f"{where}: {text[:80]!r} is not a number with a unit; {expected}")
    number, unit_text = float(match.group()), text[match.end() :].strip()
    spelled_infinite = "inf" in match.group().lower()
    if not isfinite(number) and not (spelled_infinite and number > 0):
        raise InputError(f"{where}: {text[:80]!r} is not a number that can be used; {expected}")
    if (written := _WRITTEN.match(text)) and (advice := comma_advice(written[0])):
        raise InputError(f"{where}: {text[:80]!r} has {advice}; {expected}")
    if not unit_text:
        if number == inf or unit == "1":
            return number
        raise InputError(f"{where}: {text} has no unit; {expected}")
    found = repr(text[:80])
    multiplier, divisor, offset = _explained_conversion(unit_text, unit, where, found, difference)
    result = number * multiplier / divisor + (0.0 if difference else offset)
    if unit == "K" and result < 0 and not difference:
        raise InputError(f"{where}: {found} is below absolute zero; {expected}")
    if result == inf and not spelled_infinite:
        raise InputError(f"{where}: {found} is too large for a number; {expected}")
    return result


def split_header(header: str) -> tuple[str, str | None]:
    """Split a column header into its name and unit.

    Returns
    -------
    tuple
        name and unit text; the unit is None where there are no brackets or the brackets are malformed

    Examples
    --------
    >>> split_header("normal_force [N]"), split_header("person")
    (('normal_force', 'N'), ('person', None))
    """
    match = _HEADER.fullmatch(header.strip())
    if match is None:
        return header.strip(), None
    unit = match.group("unit")
    return match.group("name").strip(), None if unit is None else unit.strip()


def product_unit(factors: Iterable[tuple[str, float]]) -> str:
    """Unit of a product of powers of quantities.

    Parameters
    ----------
    factors : SI unit and power of each factor

    Returns
    -------
    the unit as text, ``"1"`` if the product is dimensionless

    Examples
    --------
    >>> product_unit([("Pa", 1), ("Pa", -1)]), product_unit([("Pa s", 1), ("m/s", 1)])
    ('1', 'N/m')
    """
    registry = _registry()
    product = registry.Quantity(1.0)
    for unit, power in factors:
        product = product * registry.Quantity(1.0, "" if unit == "1" else unit) ** power
    if product.check(""):
        return "1"
    known = ("Pa", "N/m", "N", "m", "1/m", "m/s", "s", "1/s", "Pa s", "m^2", "K")
    same = (unit for unit in known if product.check(registry.Quantity(1.0, unit).dimensionality))
    return next(same, None) or f"{product.to_base_units().units:~}"
