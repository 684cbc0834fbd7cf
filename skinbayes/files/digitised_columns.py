"""From points of a figure to columns of quantities with their reading errors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import inf, log

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.columns import LONGEST_LABEL, refuse_quantity
from skinbayes.files.digitised_axes import AxisMeaning
from skinbayes.files.digitised_set import DigitisedSet
from skinbayes.files.table import csv_text, quoted
from skinbayes.units import convert_array, format_quantity, parse_quantity
from skinbayes.vocabulary import LABELS, QUANTITIES, STANDARD_DEVIATION_SUFFIX, lookup

PIXEL_ERROR = 1.0
"""Standard deviation of a pixel coordinate if nothing else is said, pixels."""

_AXES = ("abscissa", "ordinate")


@dataclass(frozen=True, eq=False)
class DigitisedTable:
    """Columns of a data set read off a figure.

    Attributes
    ----------
    columns : name to SI values or labels, all of the same length
    units : SI unit of each numeric column
    errors : sentences on the reading errors
    """

    columns: Mapping[str, FloatArray | list[str]]
    units: Mapping[str, str]
    errors: tuple[str, ...]

    def csv_text(self) -> str:
        """The data set as a CSV with units in its header; reading errors are rounded to 6 digits, values to 9."""
        cells = {
            name: [
                v if isinstance(v, str) else f"{v:.{6 if name.endswith(STANDARD_DEVIATION_SUFFIX) else 9}g}"
                for v in values
            ]
            for name, values in self.columns.items()
        }
        return csv_text(cells, self.units)


def digitised_table(
    sets: Mapping[str, DigitisedSet],
    meanings: tuple[AxisMeaning, AxisMeaning],
    where: str,
    *,
    pixel_error: float = PIXEL_ERROR,
    label_column: str | None = None,
    constants: Mapping[str, str] | None = None,
) -> DigitisedTable:
    """One table of the points of several data sets, with a reading error for each coordinate.

    The reading errors are standard deviations: stated by the user, or those of an uncertain pixel on calibrated axes. They
    do not hold the scatter of the measurement, nor the error of the calibration that all points share.

    Parameters
    ----------
    sets : label to data set
    meanings : of abscissa and ordinate
    where : file named in messages
    pixel_error : standard deviation of a pixel coordinate where nothing else is stated, pixels
    label_column : label column that holds the labels; required for several sets
    constants : further columns with the same value in all rows: quantity with unit, or label

    Raises
    ------
    InputError
        naming the point whose value is not possible or whose reading error is zero; for axes without calibration or stated
        error; for columns that clash
    """
    names = [meaning.quantity.name for meaning in meanings]
    if names[0] == names[1]:
        raise InputError(f"{where}: abscissa and ordinate are both '{names[0]}'; expected two quantities")
    _check_labels(sets, label_column, where)
    columns: dict[str, FloatArray | list[str]] = {}
    units: dict[str, str] = {}
    sentences: list[str] = []
    for position, meaning in enumerate(meanings):
        read = [_coordinate(one, position, meaning, pixel_error, where) for one in sets.values()]
        name = names[position]
        columns[name] = np.concatenate([values for values, _ in read])
        columns[name + STANDARD_DEVIATION_SUFFIX] = np.concatenate([spread for _, spread in read])
        units |= {name: meaning.quantity.unit, name + STANDARD_DEVIATION_SUFFIX: meaning.quantity.unit}
        sentences += _sentences(sets.values(), position, meaning, pixel_error, read)
    n_rows = len(columns[names[0]])
    for name, text in (constants or {}).items():
        if name in columns or name == label_column:
            raise InputError(f"--constant {name}: this column comes from the figure; expected another one")
        value = _constant(name, text)
        if isinstance(value, str):
            columns[name] = [value] * n_rows
        else:
            columns[name], units[name] = np.full(n_rows, value), QUANTITIES[name].unit
    if label_column is not None:
        columns[label_column] = [label for label, one in sets.items() for _ in one.places]
    # a line that starts with a label could look like a comment
    ordered = {name: columns[name] for name in (*units, *(other for other in columns if other not in units))}
    return DigitisedTable(ordered, units, tuple(sentences))


def _check_labels(sets: Mapping[str, DigitisedSet], label_column: str | None, where: str) -> None:
    if label_column is None:
        if len(sets) > 1:
            listed = ", ".join(quoted(label) for label in sets)
            raise InputError(
                f"{where}: {len(sets)} data sets ({listed}); choose one with --set-name, or say with --label-column what "
                f"tells them apart: {', '.join(LABELS)}"
            )
        return
    if not label_column.strip() or lookup(label_column) is not None:
        raise InputError(
            f"--label-column: found {quoted(label_column)}; expected a label column, such as {', '.join(LABELS)}"
        )
    refuse_quantity(label_column, list(sets))
    for label in sets:
        _check_label(label, f"{where}: data set {quoted(label)}")


def _check_label(label: str, where: str) -> None:
    if not label or label != label.strip() or len(label) > LONGEST_LABEL or not label.isprintable():
        raise InputError(
            f"{where}: found the label {quoted(label)}; expected 1 to {LONGEST_LABEL} printable characters without blanks "
            "around them"
        )


def _constant(name: str, text: str) -> float | str:
    where = f"--constant {name}"
    if lookup(name) is None:
        refuse_quantity(name, [text])
        _check_label(text, where)
        return text
    if name not in QUANTITIES:
        raise InputError(f"{where}: expected a quantity or a label, not a spread")
    value = parse_quantity(text, QUANTITIES[name].unit, where=where)
    if not QUANTITIES[name].admits(value):
        raise InputError(f"{where}: found {text[:40]}; expected {QUANTITIES[name].range_text()}")
    return value


def _coordinate(
    one: DigitisedSet, position: int, meaning: AxisMeaning, pixel_error: float, where: str
) -> tuple[FloatArray, FloatArray]:
    """Values and reading errors of one coordinate in SI, each of shape (N,)."""
    axis, quantity = _AXES[position], meaning.quantity
    numbers = one.values[:, position]
    on_log_axis = one.axes is not None and one.axes.logarithmic[position]
    if meaning.logarithmic and on_log_axis:
        raise InputError(
            f"{where}: the {axis} is calibrated as a logarithmic axis, so its values are no logarithms; leave out "
            f"--logarithmic-{axis}"
        )
    with np.errstate(over="ignore"):
        written = 10.0**numbers if meaning.logarithmic else numbers
    values = convert_array(written, meaning.unit, quantity.unit, where)
    for place, value, number in zip(one.places, values.tolist(), numbers.tolist(), strict=True):
        if not quantity.admits(value):
            found = f"10^{number:.6g}" if meaning.logarithmic else f"{number:.6g}"
            raise InputError(
                f"{where}, {place}, {axis} '{quantity.name}': found {found} {meaning.unit}; expected "
                f"{quantity.range_text()}. Move or leave out the point"
            )
    if meaning.error is not None:
        relative, absolute = meaning.error.relative, meaning.error.absolute
        spread = np.full(len(values), absolute) if relative is None else relative * np.abs(values)
    elif one.axes is None:
        raise InputError(
            f"{where}: a CSV holds no calibration from which the reading error of '{quantity.name}' could follow; state it: "
            f"--{axis}-error '2 %' of the value, or in a unit of the quantity"
        )
    else:
        error = one.axes.reading_error(one.values, pixel_error)[:, position]
        if meaning.logarithmic:
            spread = log(10.0) * error * values
        else:
            spread = convert_array(error, meaning.unit, quantity.unit, where, difference=True)
    spread = np.asarray(spread, dtype=float)
    for place, error_here in zip(one.places, spread.tolist(), strict=True):
        if not 0.0 < error_here < inf:
            raise InputError(
                f"{where}, {place}: the reading error of {axis} '{quantity.name}' is {error_here:g}; expected > 0. A fraction of "
                f"zero is zero: state an absolute error with --{axis}-error"
            )
    return values, spread


def _sentences(
    sets: Iterable[DigitisedSet],
    position: int,
    meaning: AxisMeaning,
    pixel_error: float,
    read: list[tuple[FloatArray, FloatArray]],
) -> list[str]:
    """How well one coordinate was read; once for data sets on the same axes."""
    quantity, stated = meaning.quantity, meaning.error
    pixels = f"which is {pixel_error:g} pixel{'' if pixel_error == 1 else 's'} in the picture"
    said: dict[str, None] = {}
    for one, (values, spread) in zip(sets, read, strict=True):
        relative = meaning.logarithmic or (one.axes is not None and one.axes.logarithmic[position])
        if relative if stated is None else stated.relative is not None:
            size = f"{100 * float(spread[0] / abs(values[0])):.3g} % of the value"
        else:
            size = format_quantity(float(spread[0]), quantity.unit, 3)
        said[f"{quantity.name}: {size}, {pixels if stated is None else 'as stated by the user'}."] = None
    return list(said)
