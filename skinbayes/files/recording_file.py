"""Recordings from files or data frames, by a recipe."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.recipe import RECORDED, Column, Recipe
from skinbayes.files.recipe_schema import LabelColumn
from skinbayes.files.recording_text import Layout, column_number, layout_of, read_numbers
from skinbayes.files.table import quoted
from skinbayes.recordings import Recording
from skinbayes.units import convert_array
from skinbayes.vocabulary import suggestions

if TYPE_CHECKING:
    from pandas import DataFrame

FEWEST_SAMPLES = 32
"""A shorter recording is none."""


def read_recording(path: str | Path, recipe: Recipe) -> Recording:
    """Read a file as a recipe says.

    Raises
    ------
    InputError
        naming file, line and column of what is missing, no number, in another unit than stated, or not increasing in time
    """
    path = Path(path)
    layout = layout_of(path, recipe.file)
    numeric = {key: _number(layout, column) for key, column in recipe.columns.items() if column.value is None}
    labelled = {key: _number(layout, column) for key, column in recipe.label_columns.items()}
    values, codes, lines = read_numbers(
        layout, set(numeric.values()), set(labelled.values()), recipe.file.footer_lines
    )
    units = {key: layout.units[number] for key, number in numeric.items()}
    recording = _recording(
        str(path), recipe, {key: values[number] for key, number in numeric.items()}, units, lines
    )
    return replace(
        recording,
        name=path.name,
        labels=_labels(path, recipe),
        changing={key: codes[number] for key, number in labelled.items()},
    )


def recording_of_frame(frame: DataFrame, name: str, recipe: Recipe) -> Recording:
    """A data frame whose columns a recipe names, as if it stood in a file; rows take the place of lines."""
    known = [str(column) for column in frame.columns]
    values, changing = {}, {}
    named: dict[str, Column | LabelColumn] = {**recipe.columns, **recipe.label_columns}
    for key, column in named.items():
        if isinstance(column, Column) and column.value is not None:
            continue
        place = (
            (column.number or 0) - 1
            if column.name is None
            else known.index(column.name)
            if column.name in known
            else -1
        )
        if not 0 <= place < len(known):
            raise _no_column(name, column.name or f"number {column.number}", known)
        cells = frame.iloc[:, place]
        if key in recipe.columns:
            values[key] = cells.to_numpy(dtype=np.float64)
        else:
            codes, names = cells.map(str).factorize()
            changing[key] = tuple(names), codes.astype(np.int32)
    recording = _recording(name, recipe, values, {}, np.arange(1, len(frame) + 1))
    return replace(recording, name=name, labels=_labels(Path(name), recipe), changing=changing)


def _number(layout: Layout, column: Any) -> int:
    if column.number is not None:
        if column.number > layout.width:
            raise InputError(
                f"{layout.path}, line {layout.header_lines + 1}: {layout.width} columns; the recipe names number {column.number}"
            )
        return int(column.number) - 1
    found = column_number(layout, column.name)
    if found is None:
        where = f"{layout.path}, line {layout.names_line}" if layout.names_line else str(layout.path)
        raise _no_column(where, column.name, [name for name in layout.names if name])
    return found


def _no_column(where: str, name: str, known: list[str]) -> InputError:
    has = (
        ", ".join(quoted(one) for one in known[:20])
        or "no names above the numbers: give a number in place of a name"
    )
    return InputError(
        f"{where}: no column {quoted(name)} (or more than one); found {has}.{suggestions(name, known)}"
    )


def _recording(
    where: str, recipe: Recipe, raw: Mapping[str, FloatArray], units: Mapping[str, str], lines: Any
) -> Recording:
    found: dict[str, FloatArray] = {}
    outside = None
    for key, column in recipe.columns.items():
        if column.value is not None:
            found[key] = np.array(column.value)
            continue
        unit = _stated_unit(where, column, units.get(key, ""))
        values = column.sign * column.factor * (raw[key] - column.offset)
        found[key] = convert_array(
            values, unit, column.si, f"{where}, column '{column.name or column.number}'"
        )
        if column.range is not None:
            beyond = (found[key] <= column.range[0]) | (found[key] >= column.range[1])
            outside = beyond if outside is None else outside | beyond
    size = next(iter(raw.values())).size
    if size < FEWEST_SAMPLES:
        raise InputError(f"{where}: {size} samples; expected a recording of at least {FEWEST_SAMPLES}")
    time: FloatArray = (
        found["time"] if "time" in found else np.arange(size, dtype=np.float64) * (recipe.interval or 1.0)
    )
    _check_time(where, time, lines)
    for key in ("tangential_force", "normal_force"):
        if np.isnan(found[key]).all():
            raise InputError(
                f"{where}, column '{recipe.columns[key].name}': no value at all; expected the {key}"
            )
    one_a_line = lines[-1] - lines[0] == size - 1
    return Recording(
        name=where,
        time=time,
        tangential_force=found["tangential_force"],
        normal_force=found["normal_force"],
        position=found.get("position"),
        sliding_speed=found["sliding_speed"] if np.ndim(found.get("sliding_speed", 0.0)) else None,
        quantities={
            key: values
            for key, values in found.items()
            if key not in RECORDED or (key == "sliding_speed" and not values.ndim)
        },
        saturated=outside,
        lines=np.array(lines[0]) if one_a_line else lines,
    )


def _stated_unit(where: str, column: Column, written: str) -> str:
    """The unit of a column: stated in the recipe or written in the file; InputError if they differ, or there is none."""
    place = f"{where}, column '{column.name or column.number}'"
    if column.unit is None:
        if not written:
            raise InputError(
                f'{place}: no unit; expected one in the recipe: {column.key} = {{ …, unit = "{column.si}" }}'
            )
        return written
    if written and column.factor == 1.0:
        try:
            same = np.isclose(
                convert_array(1.0, written, column.si, place),
                convert_array(1.0, column.unit, column.si, place),
            )
        except InputError:
            raise InputError(
                f"{place}: the file writes the unit [{written}], the recipe {column.unit} as {column.key}; is it the "
                "right column?"
            ) from None
        if not same:
            raise InputError(
                f"{place}: the file writes the unit [{written}], the recipe {column.unit}; expected one of them"
            )
    return column.unit


def _check_time(where: str, time: FloatArray, lines: Any) -> None:
    missing = np.flatnonzero(np.isnan(time))
    if missing.size:
        raise InputError(f"{where}, line {lines[missing[0]]}: no time; expected one for each sample")
    back = np.flatnonzero(np.diff(time) <= 0)
    if back.size:
        i = int(back[0])
        raise InputError(
            f"{where}, line {lines[i + 1]}: time goes from {time[i]:.9g} s to {time[i + 1]:.9g} s ({back.size} such places); "
            "expected it to increase. If it is rounded, state sampling_rate under [file] of the recipe in place of a "
            "column of time"
        )


def _labels(path: Path, recipe: Recipe) -> dict[str, str]:
    found = dict(recipe.constant_labels)
    if recipe.pattern is None:
        return found
    match = recipe.pattern.fullmatch(path.stem) or recipe.pattern.fullmatch(path.name)
    if match is None:
        written = recipe.block.labels["file_name"]
        raise InputError(
            f"{path}: the name does not fit the pattern {written!r} of file_name under [labels] of the recipe"
        )
    return found | match.groupdict()
