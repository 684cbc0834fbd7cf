"""Text with a unit to an SI number and back: the only door through which units pass.

Inside skinbayes every number is in SI. What a person types (``"15 MPa"``, a header ``normal_force [mN]``) is
converted here, once, and a wrong or missing unit is an error that names the place. Pint does the dimensional
analysis.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache, lru_cache
from math import inf, isfinite, isnan
from numbers import Real
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError

_NUMBER = re.compile(
    r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[+-]?inf(?:inity)?(?![a-z])", re.IGNORECASE
)
# Names, products, quotients and one-digit powers only: Pint evaluates arithmetic in unit text, and a tower of
# powers would keep it busy for ever.
_UNIT = re.compile(
    r"(?:\s+|[*/·()]|(?:\^|\*\*)\s*-?[1-9](?!\s*(?:[0-9^]|\*\*))|1(?=\s*/)|[⁻¹²³⁴]+|[A-Za-zµμΩÅ°%_]+)+",
    re.UNICODE,
)
_LONGEST_UNIT = 40
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
}


def describe_unit(unit: str) -> str:
    """What is expected in ``unit``, for messages: ``"a pressure in Pa, for example '15 MPa'"``."""
    meaning, example = _MEANING.get(unit, ("a value", f"1 {unit}"))
    return f"{meaning}{'' if unit == '1' else f' in {unit}'}, for example '{example}'"


@cache
def _registry() -> Any:
    from pint import UnitRegistry

    return UnitRegistry(cache_folder=None)


@lru_cache(maxsize=512)
def _conversion(from_unit: str, to_unit: str) -> tuple[float, float, float]:
    """``(multiplier, divisor, offset)`` with ``to = from * multiplier / divisor + offset``.

    A factor such as 1e-6 is kept as a division by 1e6, which rounds once: "20 um" is then the number that
    2e-5 denotes. LookupError for an unknown unit, ValueError for one of another dimension.
    """
    registry = _registry()
    text = from_unit.strip()
    target = registry.parse_units("" if to_unit == "1" else to_unit)
    if text in ("", "1", "-"):
        source = registry.parse_units("")
    elif len(text) > _LONGEST_UNIT or not _UNIT.fullmatch(text) or text.startswith(("/", "*", "·", "^")):
        raise LookupError(text)
    else:
        try:
            source = registry.parse_units(text)
        except Exception as error:  # Pint's parser has many ways to fail; all mean "not a unit"
            raise LookupError(text) from error
    if source.dimensionality != target.dimensionality:
        raise ValueError(text)
    one, zero = registry.Quantity(1.0, source), registry.Quantity(0.0, source)
    # Pint takes an angle for a number; a friction coefficient in degrees is a mistake nevertheless.
    if source.dimensionless and registry.get_base_units(source)[1] != registry.get_base_units(target)[1]:
        raise ValueError(text)
    try:
        offset = float(zero.to(target).magnitude)
        factor = float(one.to(target).magnitude) - offset
    except Exception as error:  # such as a product with an offset temperature
        raise LookupError(text) from error
    if not isfinite(factor) or factor <= 0:
        raise LookupError(text)
    inverse = 1.0 / factor
    if offset != 0.0:
        return 1.0, 1.0, offset
    if factor < 1.0 and isfinite(inverse) and abs(inverse - round(inverse)) <= 1e-12 * inverse:
        return 1.0, float(f"{round(inverse):.15g}"), 0.0
    return (float(f"{factor:.15g}") if factor == round(factor) else factor), 1.0, 0.0


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
    multiplier, divisor, offset = _explained_conversion(from_unit, to_unit, where)
    numbers = np.asarray(values, dtype=float)
    if offset != 0.0 and not difference:
        return np.asarray(numbers + offset)
    with np.errstate(over="ignore"):  # a value beyond the largest number becomes inf, which readers refuse
        return np.asarray(numbers * multiplier / divisor)


def _explained_conversion(
    from_unit: str, to_unit: str, where: str, found: str | None = None
) -> tuple[float, float, float]:
    """`_conversion`, with errors that say where; ``found`` is the text around the unit, if there is any."""
    unit = f"unit {from_unit[:_LONGEST_UNIT]!r}"
    try:
        return _conversion(from_unit, to_unit)
    except LookupError:
        problem = f"{unit} is unknown" if found is None else f"{found} has an unknown unit"
    except ValueError:
        problem = f"{unit if found is None else found} has the wrong dimension"
    raise InputError(f"{where}: {problem}; expected {describe_unit(to_unit)}")


def parse_quantity(value: str | int | float, unit: str, *, where: str) -> float:
    """Read a number with its unit and return it in SI.

    Parameters
    ----------
    value : text such as ``"15 MPa"``, ``"20 µm"``, ``"20 degC"``, ``"50 %"``, ``"inf"``; or a bare number
    unit : SI unit of the result, as in the vocabulary; ``"1"`` for dimensionless numbers
    where : place named in the message (file, key, option)

    Returns
    -------
    float
        the value in ``unit``

    Raises
    ------
    InputError
        if the unit is missing, unknown or of another dimension, or the text is not a finite number. Numbers
        without a unit are taken for dimensionless quantities only; ``inf`` needs no unit.

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
    text = value.strip() if isinstance(value, str) else _number_text(value)
    match = _NUMBER.match(text)
    if match is None:
        raise InputError(f"{where}: {text[:80]!r} is not a number with a unit; {expected}")
    number, unit_text = float(match.group()), text[match.end() :].strip()
    spelled_infinite = "inf" in match.group().lower()
    if not isfinite(number) and not (spelled_infinite and number > 0):
        raise InputError(f"{where}: {text[:80]!r} is not a number that can be used; {expected}")
    if unit_text.startswith(",") and unit_text[1:2].isdigit():
        raise InputError(f"{where}: {text[:80]!r} has a decimal comma; write a decimal point; {expected}")
    if not unit_text:
        if number == inf or unit == "1":
            return number
        raise InputError(f"{where}: {text} has no unit; {expected}")
    found = repr(text[:80])
    multiplier, divisor, offset = _explained_conversion(unit_text, unit, where, found)
    result = number * multiplier / divisor + offset
    if result == inf and not spelled_infinite:
        raise InputError(f"{where}: {found} is too large for a number; {expected}")
    return result


def _number_text(value: Real) -> str:
    try:
        number = float(value)
    except OverflowError:
        return "1e999"
    return "nan" if isnan(number) else repr(int(number)) if isinstance(value, int) else repr(number)


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


def _plain(number: float, digits: int) -> str:
    text = f"{number:.{digits}g}"
    if "e" in text:
        mantissa, exponent = text.split("e")
        return f"{mantissa}e{int(exponent)}"
    return text
