"""What the axes of a figure mean: the quantity, the unit, and how well the user says they were read."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from skinbayes.errors import InputError
from skinbayes.files.table import quoted
from skinbayes.units import convert_array, describe_unit, parse_quantity, split_header
from skinbayes.vocabulary import QUANTITIES, Quantity, suggestions


@dataclass(frozen=True)
class ReadingError:
    """A reading error that the user states.

    Attributes
    ----------
    relative : standard deviation over value, or None
    absolute : standard deviation in SI, or None
    """

    relative: float | None = None
    absolute: float | None = None


@dataclass(frozen=True)
class AxisMeaning:
    """What an axis of a figure shows.

    Attributes
    ----------
    quantity : the quantity
    unit : unit of the axis
    logarithmic : True if the numbers of the export are log10 of the quantity in that unit
    error : reading error that the user states, or None to follow from the pixels
    """

    quantity: Quantity
    unit: str
    logarithmic: bool = False
    error: ReadingError | None = None


def parse_axis(text: str, where: str, *, logarithmic: bool = False, error: str | None = None) -> AxisMeaning:
    """What an axis shows, from text such as ``"speed_viscosity_product [mN/m]"``.

    Parameters
    ----------
    text : quantity with the unit of the axis in brackets, as in the header of a data set
    where : place named in messages
    logarithmic : True if the numbers of the export are log10 of the quantity in that unit
    error : stated reading error, see :func:`parse_reading_error`

    Raises
    ------
    InputError
        for an unknown quantity, or a missing unit or one of another dimension

    Examples
    --------
    >>> parse_axis("time [min]", "--abscissa").quantity.unit
    's'
    """
    name, unit = split_header(text)
    if name not in QUANTITIES:
        guess = suggestions(name[:80].replace(" ", "_").lower(), list(QUANTITIES))
        raise InputError(
            f"{where}: unknown quantity {quoted(name)}; expected a name of the vocabulary with the unit of the axis, such as "
            f"'friction_coefficient [1]'.{guess}"
        )
    quantity = QUANTITIES[name]
    if not unit:
        raise InputError(
            f"{where}: '{name}' has no unit; expected that of the axis: '{name} [{quantity.unit}]'"
        )
    convert_array(1.0, unit, quantity.unit, where)
    stated = None if error is None else parse_reading_error(error, quantity, f"{where}-error")
    return AxisMeaning(quantity, unit, logarithmic, stated)


def parse_reading_error(text: str, quantity: Quantity, where: str) -> ReadingError:
    """A stated reading error: ``"2 %"`` of the value, or an absolute one in a unit of the quantity.

    Parameters
    ----------
    text : as typed; a percentage is always relative to the value, also for quantities without dimension
    quantity : the quantity it belongs to
    where : place named in messages

    Raises
    ------
    InputError
        for anything that is not a positive number with ``%`` or a unit of the quantity

    Examples
    --------
    >>> parse_reading_error("2 %", QUANTITIES["time"], "--abscissa-error")
    ReadingError(relative=0.02, absolute=None)
    >>> parse_reading_error("0.5 degC", QUANTITIES["temperature"], "--abscissa-error")
    ReadingError(relative=None, absolute=0.5)
    """
    relative = text.strip().endswith("%")
    value = parse_quantity(text, "1" if relative else quantity.unit, where=where, difference=True)
    if not 0.0 < value < inf:
        raise InputError(
            f"{where}: found {quoted(text)}; expected '2 %' of the value, or an absolute error > 0: "
            f"{describe_unit(quantity.unit)}"
        )
    return ReadingError(relative=value) if relative else ReadingError(absolute=value)
