"""Heights from text: points of a grid, points of a line, or rows of heights."""

from __future__ import annotations

import re
import warnings
from contextlib import suppress
from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray
from skinbayes.errors import InputError
from skinbayes.files.reading import read_file
from skinbayes.files.separated import decoded
from skinbayes.files.surface_scale import MOST_PIXELS, Scale, check_pixels, made
from skinbayes.topography import HeightMap, LineProfile
from skinbayes.topography.height_map import LEAST_PIXELS
from skinbayes.units import convert_array, split_header

LARGEST_TEXT = 1_000_000_000
"""Bytes of a text of heights."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")
_UNDEFINED = ("nan", "NaN", "NAN", "", "-", "NA", "n/a", "bad", "BAD", "***", "No data", "no data")
_GAP = 4.0
"""Distance of neighbours on a line, in their median one, from which on nothing is interpolated between them."""
_UNEVEN = 0.01
"""Deviation of the places of a line from even ones, in their distance, up to which they are taken as they are."""


def read_text(path: Path, stated: Scale) -> tuple[HeightMap | LineProfile, str] | None:
    """A surface and what the text is; None if it is no such text, but perhaps that of an instrument."""
    data = read_file(path, LARGEST_TEXT, "a height map or line profile")
    try:
        text = decoded(data, path)
    except InputError:
        if _is_damaged(data):
            raise
        return None  # no text at all
    lines = text.splitlines()
    begin = 0
    while begin < len(lines) and (not lines[begin].strip() or lines[begin].lstrip().startswith("#")):
        begin += 1
    if begin == len(lines):
        raise InputError(f"{path}: no line of numbers; expected a height map or line profile")
    header, separator = _header(path, lines[begin])
    if header is not None:
        begin += 1
    elif not _is_numbers(lines[begin], separator):
        return None
    elif begin and lines[begin - 1].strip():  # NumPy writes headers as comments
        with suppress(InputError):  # any other comment
            header = _header(path, lines[begin - 1].lstrip("# \t"))[0]
    rest = "\n".join(lines[begin:])
    del lines
    table = _numbers(path, rest, separator)
    if header is not None and table.shape[1] != len(header):
        raise InputError(f"{path}: {table.shape[1]} columns below a header of {len(header)}")
    return _surface(path, table, header, stated)


def _is_damaged(data: bytes) -> bool:
    """Whether bytes are numbers but for some that are no text: readers of other formats would skip what is around them."""
    head = data[:2000]
    return not head.startswith((b"\xff\xfe", b"\xfe\xff")) and all(
        b in b"0123456789+-.,;eE \t\r\n" for b in head
    )


def _separator(line: str) -> str:
    return next(
        (mark for mark in ("\t", ";") if mark in line), "," if "," in line and not _decimal(line) else " "
    )


def _decimal(line: str) -> bool:
    """Whether commas in a line separated by blanks are decimal ones."""
    return " " in line.strip() and all(_NUMBER.fullmatch(word) for word in line.split())


def _cells(line: str, separator: str) -> list[str]:
    return (
        line.split() if separator == " " else [cell.strip() for cell in line.rstrip("\t;, ").split(separator)]
    )


def _is_numbers(line: str, separator: str) -> bool:
    cells = _cells(line, separator)
    return (
        bool(cells)
        and all(_NUMBER.fullmatch(c) or c in _UNDEFINED for c in cells)
        and any(map(_NUMBER.fullmatch, cells))
    )


def _header(path: Path, line: str) -> tuple[dict[str, float] | None, str]:
    """Columns x, y, z of a header with units, and m of one unit of each; None if the line is no such header."""
    separator = next((mark for mark in ("\t", ";", ",") if mark in line), " ")
    cells = line.replace("(", "[").replace(")", "]").split(separator) if set("[(") & set(line) else []
    names = [(name.lower(), unit) for name, unit in map(split_header, cells)]
    if not names or not all(name in ("x", "y", "z", "height") for name, _ in names):
        return None, _separator(line)
    found: dict[str, float] = {}
    for name, unit in names:
        where = f"{path}: column '{name}'"
        if not unit:
            raise InputError(f"{where} has no unit; expected a length, such as {name} [um]")
        key = "z" if name == "height" else name
        if key in found:
            raise InputError(f"{where} appears twice")
        found[key] = float(convert_array(1.0, unit, "m", where))
    if list(found) not in (["x", "z"], ["x", "y", "z"]):
        raise InputError(
            f"{path}: found the columns {', '.join(found)}; expected x and z of a line, or x, y and z of a map"
        )
    return found, separator


def _numbers(path: Path, text: str, separator: str) -> FloatArray:
    """All numbers, shape ``(rows, columns)``, nan where there is none; InputError for a cell that is none."""
    from io import StringIO

    import pandas as pd

    first = text.split("\n", 1)[0]
    decimal = "," if separator != "," and "," in first else "."
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            frame = pd.read_csv(
                StringIO(text),
                sep=r"\s+" if separator == " " else separator,
                header=None,
                comment="#",
                decimal=decimal,
                na_values=list(_UNDEFINED),
                skipinitialspace=True,
                low_memory=False,
            )
    except pd.errors.ParserError as error:
        said = re.search(r"Expected (\d+) fields in line (\d+), saw (\d+)", str(error))
        what = (
            f"line {said[2]} of the numbers has {said[3]} columns, those before it {said[1]}"
            if said
            else "rows differ"
        )
        raise InputError(f"{path}: {what}; expected as many in each") from None
    if frame.shape[1] > 1 and frame.iloc[:, -1].isna().all():
        frame = frame.iloc[:, :-1]  # each line ends in a separator
    if (ends := frame.iloc[:, -1].isna()).any():
        _refuse_short_rows(path, text, separator, frame.shape[1], np.flatnonzero(ends))
    wrong = [i for i in range(frame.shape[1]) if frame.iloc[:, i].dtype.kind not in "iuf"]
    if wrong:
        cells = frame.iloc[:, wrong[0]]
        place = int(np.flatnonzero(pd.to_numeric(cells, errors="coerce").isna() & cells.notna())[0])
        raise InputError(
            f"{path}: row {place + 1} of the numbers, column {wrong[0] + 1}: found '{str(cells.iloc[place])[:40]}'; "
            "expected a number"
        )
    return frame.to_numpy(dtype=np.float64)


def _refuse_short_rows(path: Path, text: str, separator: str, columns: int, rows: IndexArray) -> None:
    """Refuse rows, of those that end without a number, which have too few cells: a file that was cut off has one."""
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    mark = None if separator == " " else separator
    for row in rows.tolist():
        if (found := len(lines[row].split(mark))) < columns:
            raise InputError(
                f"{path}: row {row + 1} of the numbers has {found} columns, the first one {columns}; expected as many in each, "
                "nan where nothing was seen"
            )


def _surface(
    path: Path, table: FloatArray, header: dict[str, float] | None, stated: Scale
) -> tuple[HeightMap | LineProfile, str]:
    columns = table.shape[1]
    if columns == 1:
        return stated.surface(path, table[:, 0]), "text, heights of a line"
    if columns in (2, 3):
        if header is not None and stated.unit is not None:
            raise InputError(f"{path}: the header has units; drop --unit {stated.unit[:40]}")
        if stated.pixel_x is not None:
            raise InputError(f"{path}: the points have places; drop --pixel-size")
        if header is None and stated.factor is None:
            raise InputError(
                f"{path}: the {columns} columns have no unit; expected --unit, such as --unit um, or the header "
                f"{'x [um],z [um]' if columns == 2 else 'x [um],y [um],z [um]'}"
            )
        factors = list(header.values()) if header else [stated.factor or 1.0] * columns
        points = table * factors
        if columns == 2:
            return line_of_points(
                path, points[:, 0], points[:, 1], stated.periodic
            ), "text, x and z of a line"
        return _grid(path, points, stated.periodic), "text, x, y and z of a grid"
    if columns < LEAST_PIXELS or table.shape[0] < LEAST_PIXELS:
        raise InputError(
            f"{path}: {table.shape[0]} rows of {columns} numbers; expected 1 (heights of a line), 2 (x, z), 3 (x, y, z), or rows "
            f"of at least {LEAST_PIXELS} heights"
        )
    check_pixels(path, *table.shape)
    return stated.surface(path, table), "text, rows of heights"


def line_of_points(path: Path, x: FloatArray, height: FloatArray, periodic: bool) -> LineProfile:
    """A line from places and heights in m; places that are not even are interpolated between neighbours, linearly."""
    if np.isnan(x).any() or x.size < LEAST_PIXELS:
        raise InputError(
            f"{path}: {np.isfinite(x).sum()} points with a place; expected at least {LEAST_PIXELS}, and no other"
        )
    if x[-1] < x[0]:
        x, height = x[::-1], height[::-1]
    steps = np.diff(x)
    back = np.flatnonzero(steps <= 0)
    if back.size:
        i = int(back[0])
        raise InputError(
            f"{path}: the profile goes back from x = {x[i]:.6g} m to {x[i + 1]:.6g} m at point {i + 2}; expected places that "
            "increase, since a reentrant profile has no spectrum of heights"
        )
    pixel = float((x[-1] - x[0]) / (x.size - 1))
    even = x[0] + pixel * np.arange(x.size)
    done: tuple[str, ...] = ()
    if np.abs(x - even).max() > _UNEVEN * pixel:
        pixel = float(np.median(steps))
        count = int((x[-1] - x[0]) / pixel * (1 + 1e-12)) + 1
        check_pixels(path, count)
        even = x[0] + pixel * np.arange(count)
        after = np.clip(np.searchsorted(x, even), 1, x.size - 1)
        bridged = np.minimum(even - x[after - 1], x[after] - even) > 0.01 * pixel
        height = np.where(
            bridged & (x[after] - x[after - 1] > _GAP * pixel), np.nan, np.interp(even, x, height)
        )
        done = (f"{x.size} uneven places interpolated to {count} even ones",)
    found = made(path, np.asarray(height, dtype=np.float64), pixel, pixel, periodic)
    assert isinstance(found, LineProfile)
    return LineProfile(found.height, pixel_size=pixel, periodic=periodic, steps=done)


def _grid(path: Path, points: FloatArray, periodic: bool) -> HeightMap | LineProfile:
    """A map from x, y, z in m of the points of a regular grid, in any order; those that lack are undefined."""
    points = points[~np.isnan(points[:, :2]).any(axis=1)]
    indices, sizes = [], []
    for axis, name in ((0, "x"), (1, "y")):
        index, size = _places(path, points[:, axis], name)
        indices.append(index)
        sizes.append(size)
    columns, rows = (int(index.max()) + 1 for index in indices)
    check_pixels(path, rows, columns)
    flat = indices[1] * columns + indices[0]
    if np.unique(flat).size < flat.size:
        raise InputError(f"{path}: two points have the same place; expected one height at each, as a map has")
    if rows * columns > 4 * flat.size:
        raise InputError(
            f"{path}: {flat.size:,} points on a grid of {rows:,} × {columns:,}; expected most points of a regular grid"
        )
    height = np.full(rows * columns, np.nan)
    height[flat] = points[:, 2]
    return made(path, height.reshape(rows, columns), sizes[0], sizes[1], periodic)


def _places(path: Path, x: FloatArray, name: str) -> tuple[FloatArray, float]:
    """Number of each place on a regular axis, and the distance of its places, m."""
    distinct = np.unique(x)
    steps = np.diff(distinct)
    extent = float(distinct[-1] - distinct[0])
    steps = steps[
        steps > extent / (4 * min(MOST_PIXELS, x.size) + 1)
    ]  # others are the last digits of one place
    if not steps.size:
        raise InputError(f"{path}: all points have the same {name}; expected the points of a grid")
    index = np.round((x - distinct[0]) / np.median(steps))
    step = extent / max(float(index.max()), 1.0)
    index = np.round((x - distinct[0]) / step)
    if np.abs((x - distinct[0]) / step - index).max() > 0.1:
        raise InputError(f"{path}: {name} of the points lies on no regular grid; expected equal distances")
    return index.astype(np.intp), step
