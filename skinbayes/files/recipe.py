"""Recipes: how recordings of a tribometer become friction, read from TOML and checked with errors for people."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.parameter_block import label_column
from skinbayes.files.recipe_schema import FileBlock, LabelColumn, RecipeBlock
from skinbayes.files.toml_text import read_tables, read_toml, toml_text
from skinbayes.recordings import Rules
from skinbayes.units import convert_array, parse_quantity
from skinbayes.vocabulary import QUANTITIES, lookup, spread_of, suggestions

RECORDED = {
    "time": "s",
    "tangential_force": "N",
    "normal_force": "N",
    "position": "m",
    "sliding_speed": "m/s",
}
"""What a recording may hold beside other quantities, and its SI unit."""

COMPUTED = ("friction_coefficient", "friction_force")
"""Quantities that a recipe makes, so that no column of a recording has their names."""

FILE_NAME = "file_name"
"""Key of ``[labels]`` with the pattern of file names."""


@dataclass(frozen=True)
class Column:
    """A numeric column of a recording.

    Attributes
    ----------
    key : what it is
    name, number : of the column in the file, one of them None; the number counts from 1
    unit, si : as stated (None if the file has to say), and that of the result
    offset, factor, sign : ``sign · factor · (value − offset)`` is in the stated unit
    range : ends of the sensor's range, SI, or None
    value : one value for all samples, SI, or None
    """

    key: str
    name: str | None
    number: int | None
    unit: str | None
    si: str
    offset: float
    factor: float
    sign: int
    range: tuple[float, float] | None
    value: float | None


@dataclass(frozen=True)
class Recipe:
    """A validated recipe; every number in SI.

    Attributes
    ----------
    path, text : the file (or a name for it) and what stands in it
    block : as written
    columns : numeric columns by what they are
    label_columns : labels that stand in columns of the file
    constant_labels : labels that all recordings share
    pattern : of file names, as a regular expression with a group for each label, or None
    interval : time between samples where it is stated, s
    rules : how strokes are found and friction is taken
    time_zero : time of the recording that is zero in the table, s
    each : what a row is: ``("stroke",)``, ``("pair",)``, ``("recording",)``, or labels
    """

    path: Path
    text: str
    block: RecipeBlock
    columns: Mapping[str, Column]
    label_columns: Mapping[str, LabelColumn]
    constant_labels: Mapping[str, str]
    pattern: re.Pattern[str] | None
    interval: float | None
    rules: Rules
    time_zero: float
    each: tuple[str, ...]

    @property
    def file(self) -> FileBlock:
        """How the numbers stand in a file."""
        return self.block.file


def load_recipe(recipe: str | Path | Mapping[str, Any]) -> Recipe:
    """Read and validate a recipe.

    Parameters
    ----------
    recipe : path of a TOML file, or its tables

    Raises
    ------
    InputError
        naming file, line and key of what is unknown, missing, of the wrong type, without unit or out of range
    """
    if isinstance(recipe, Mapping):
        path, content = Path("recipe"), dict(recipe)
        text = toml_text(content)
    else:
        path = Path(recipe)
        content, text = read_toml(path)
    return read_tables(RecipeBlock, content, path, text, _read)


def _read(block: RecipeBlock, path: Path, text: str, where: Callable[..., str]) -> Recipe:
    columns = {key: _column(key, block, where) for key in block.columns}
    rate = block.file.sampling_rate
    for key in ("tangential_force", "normal_force"):
        if key not in columns:
            raise InputError(
                f'{where("columns")}: {key} is missing; expected {key} = {{ name = "…", unit = "N" }}'
            )
    if ("time" in columns) == (rate is not None):
        raise InputError(
            f'{where("columns")}: expected either a column of time or, under [file], a sampling_rate such as "100 1/s"'
        )
    for key in ("time", "tangential_force", "position"):
        if key in columns and columns[key].value is not None:
            raise InputError(
                f"{where('columns', key)}: expected a column of the file, not one value for all samples"
            )
    labels = {key: label for key, label in block.labels.items() if key != FILE_NAME}
    for key in labels:
        label_column(key, where("labels", key))
    each = tuple(block.rows.each)
    frequency = None if rate is None else parse_quantity(rate, "1/s", where=where("file", "sampling_rate"))
    if frequency is not None and not 0 < frequency < 1e9:
        raise InputError(f"{where('file', 'sampling_rate')}: found {rate}; expected a rate > 0 1/s")
    zero = block.rows.time_zero
    return Recipe(
        path=path,
        text=text,
        block=block,
        columns=columns,
        label_columns={key: label for key, label in labels.items() if isinstance(label, LabelColumn)},
        constant_labels={key: label for key, label in labels.items() if isinstance(label, str)},
        pattern=_pattern(block.labels.get(FILE_NAME), where),
        interval=None if frequency is None else 1.0 / frequency,
        rules=_rules(block, where),
        time_zero=0.0 if zero is None else parse_quantity(zero, "s", where=where("rows", "time_zero")),
        each=_each(each, labels, block, where),
    )


def _each(
    each: tuple[str, ...], labels: Mapping[str, Any], block: RecipeBlock, where: Callable[..., str]
) -> tuple[str, ...]:
    kinds = ("stroke", "pair", "recording")
    pattern = block.labels.get(FILE_NAME)
    known = [*labels, *re.findall(r"\{(\w+)\}", pattern if isinstance(pattern, str) else "")]
    if len(each) == 1 and each[0] in kinds:
        return each
    for name in each:
        if name not in known:
            raise InputError(
                f"{where('rows', 'each')}: found '{name:.60}'.{suggestions(name, [*kinds, *known])} Expected "
                f"{', '.join(repr(kind) for kind in kinds)}, or labels of the recordings"
            )
    return each


def _column(key: str, block: RecipeBlock, where: Callable[..., str]) -> Column:
    entry, place = block.columns[key], where("columns", key)
    quantity = lookup(key)
    if key in COMPUTED or (key not in RECORDED and (quantity is None or spread_of(key))):
        known = [*RECORDED, *(name for name in QUANTITIES if name not in COMPUTED)]
        advice = " Did you mean 'tangential_force'?" if key in COMPUTED else suggestions(key, known)
        raise InputError(
            f"{place}: no quantity that a recording has.{advice} Expected {', '.join(RECORDED)}, or a quantity that skinbayes "
            "knows; labels belong under [labels]"
        )
    si = RECORDED.get(key) or (quantity.unit if quantity else "1")
    if entry.unit is not None:
        convert_array(1.0, entry.unit, si, place)
    value = None if entry.value is None else parse_quantity(entry.value, si, where=place)
    if value is not None and quantity is not None and not quantity.admits(value):
        raise InputError(f"{place}: found {entry.value}; expected {quantity.range_text()}")
    ends = None
    if entry.range is not None:
        low, high = (parse_quantity(end, si, where=f"{place}.range") for end in entry.range)
        if not low < high:
            raise InputError(f"{place}.range: found {entry.range}; expected the lower end first")
        ends = low, high
    return Column(
        key,
        entry.name,
        entry.number,
        entry.unit,
        si,
        float(entry.offset),
        float(entry.factor),
        entry.sign,
        ends,
        value,
    )


def _pattern(text: str | LabelColumn | None, where: Callable[..., str]) -> re.Pattern[str] | None:
    """``"{person}-{session}"`` as a regular expression that the whole name without its ending has to match."""
    if text is None:
        return None
    place = where("labels", FILE_NAME)
    if not isinstance(text, str) or not (names := re.findall(r"\{(\w+)\}", text)):
        raise InputError(
            f'{place}: expected a pattern with labels in braces, such as "{{person}}-{{session}}"'
        )
    for name in names:
        if name != "_":
            label_column(name, place)
    if len({name for name in names if name != "_"}) < sum(name != "_" for name in names):
        raise InputError(f"{place}: a label appears twice in {text!r:.80}")
    parts = re.split(r"\{(\w+)\}", text)
    joined = "".join(
        re.escape(part) if i % 2 == 0 else "[^/]+?" if part == "_" else f"(?P<{part}>[^/]+?)"
        for i, part in enumerate(parts)
    )
    return re.compile(joined)


def _rules(block: RecipeBlock, where: Callable[..., str]) -> Rules:
    def value(raw: str | None, unit: str, *keys: str) -> float | None:
        if raw is None:
            return None
        found = parse_quantity(raw, unit, where=where(*keys))
        if not found >= 0:
            raise InputError(f"{where(*keys)}: found {raw}; expected a value >= 0 {unit}")
        return found

    rest = block.zero.rest
    times = (
        None if rest is None else tuple(parse_quantity(end, "s", where=where("zero", "rest")) for end in rest)
    )
    if times is not None and not times[0] < times[1]:
        raise InputError(f"{where('zero', 'rest')}: found {rest}; expected the earlier time first")
    edges = (
        ()
        if block.ramp is None
        else tuple(value(edge, "N", "ramp", "edges") or 0.0 for edge in block.ramp.edges)
    )
    if any(not a < b for a, b in itertools.pairwise(edges)):
        raise InputError(f"{where('ramp', 'edges')}: expected loads that increase")
    return Rules(
        strokes_from=block.strokes.origin,
        minimum_length=value(block.strokes.minimum_length, "m", "strokes", "minimum_length"),
        minimum_duration=value(block.strokes.minimum_duration, "s", "strokes", "minimum_duration") or 0.0,
        directions=block.strokes.directions,
        skip_first=block.strokes.skip_first,
        steady=block.steady.rule,
        share=float(block.steady.share),
        tangential_zero=block.zero.tangential_force,
        normal_zero=block.zero.normal_force,
        rest=None if times is None else (times[0], times[1]),
        friction=block.friction.coefficient,
        ramp_edges=edges,
        minimum_normal_force=value(
            block.friction.minimum_normal_force, "N", "friction", "minimum_normal_force"
        )
        or 0.0,
    )
