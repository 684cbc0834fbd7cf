"""Project files of WebPlotDigitizer: pixels of the points and calibration of the axes."""

from __future__ import annotations

import json
import tarfile
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
from pydantic import ValidationError

from skinbayes.errors import InputError
from skinbayes.files.digitised_schema import AxesBlock, PointBlock, ProjectBlock, SeriesBlock
from skinbayes.files.digitised_set import DigitisedSet
from skinbayes.files.pixel_axes import PixelAxes
from skinbayes.files.reading import read_file
from skinbayes.files.table import quoted

LARGEST_PROJECT = 50_000_000
"""Bytes of a project file; the masks of automatic extraction can make it megabytes long."""

_AGREEMENT = 0.02  # pixels: stored and computed values are the same but for rounding
_EXPECTED = "expected a project file of WebPlotDigitizer, format 3 or 4"


def read_project(path: Path, *, archive: bool) -> tuple[str, tuple[DigitisedSet, ...], dict[str, str]]:
    """What sort of project it is, the data sets on XY axes, and why each other data set cannot be used.

    A data set with groups of points (ends of error bars, for example) becomes one data set for each group, called
    ``NAME, GROUP``.

    Parameters
    ----------
    path : a project file (JSON) or an archive (tar) with one
    archive : True for an archive, of which only the project file is read

    Raises
    ------
    InputError
        naming the key, axes or data set that cannot be read
    """
    text, where = (
        _from_archive(path)
        if archive
        else (read_file(path, LARGEST_PROJECT, "a project file of WebPlotDigitizer"), str(path))
    )
    version, project = _parse(text, where)
    axes = {one.name: one for one in project.axesColl}
    sets: list[DigitisedSet] = []
    left_out: dict[str, str] = {}
    for series in project.datasetColl:
        reason = _unusable(series, axes)
        if reason:
            left_out[series.name] = reason
            continue
        for name, numbers in _groups(series):
            sets.append(_read_set(name, series, numbers, axes[series.axesName], where))
    sort = "project archive" if archive else "project"
    return f"{sort} of WebPlotDigitizer, file format {version}", tuple(sets), left_out


def _from_archive(path: Path) -> tuple[bytes, str]:
    try:
        with tarfile.open(path, "r:") as archive:
            found = [
                member
                for member in archive.getmembers()
                if member.isfile() and PurePosixPath(member.name).name == "wpd.json"
            ]
            if len(found) != 1:
                raise InputError(f"{path}: {len(found)} files called wpd.json in the archive; expected one")
            if found[0].size > LARGEST_PROJECT:
                raise InputError(
                    f"{path}: wpd.json has {found[0].size:,} bytes; expected at most {LARGEST_PROJECT:,}"
                )
            stream = archive.extractfile(found[0])
            return (b"" if stream is None else stream.read()), f"{path}, wpd.json"
    except (tarfile.TarError, EOFError) as error:
        raise InputError(
            f"{path}: damaged archive ({error}); expected a project archive of WebPlotDigitizer"
        ) from None


def _parse(data: bytes, where: str) -> tuple[str, ProjectBlock]:
    try:
        content = json.loads(data.decode("utf-8-sig"))
    except json.JSONDecodeError as error:
        raise InputError(
            f"{where}, line {error.lineno}, column {error.colno}: not valid JSON: {error.msg}; {_EXPECTED}"
        ) from None
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: byte {error.start + 1} is not UTF-8; {_EXPECTED}") from None
    except (RecursionError, ValueError):
        raise InputError(f"{where}: nested too deeply or a number too long; {_EXPECTED}") from None
    old = isinstance(content, dict) and isinstance(content.get("wpd"), dict)
    body = content["wpd"] if old else content
    version = body.get("version") if isinstance(body, dict) else None
    # version 5 of the program writes format 4.2; what calls itself 5 is read if it is laid out like that
    known = (3,) if old else (4, 5)
    if not (isinstance(version, list) and version and version[0] in known):
        raise InputError(f"{where}: version: found {version!r:.40}; {_EXPECTED}")
    if old:
        body = _as_version_4(body)
    try:
        project = ProjectBlock.model_validate(body)
    except ValidationError as error:
        raise InputError(_explain(error, where, old)) from None
    return ".".join(str(part) for part in version[:3]), project


def _as_version_4(body: dict[str, Any]) -> dict[str, Any]:
    """One set of axes for all data sets, as version 3 has it, in the layout of version 4."""
    parameters = body.get("axesParameters")
    axes = {
        **(parameters if isinstance(parameters, dict) else {}),
        "name": "axes",
        "type": body.get("axesType"),
        "calibrationPoints": body.get("calibration") or [],
    }
    series = body.get("dataSeries")
    if isinstance(series, list):
        series = [{**one, "axesName": "axes"} if isinstance(one, dict) else one for one in series]
    return {"axesColl": [axes], "datasetColl": series}


def _explain(error: ValidationError, where: str, old: bool) -> str:
    """One sentence for the first thing that does not fit, with the key as it stands in the file."""
    problem = error.errors()[0]
    keys = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in problem["loc"]).lstrip(
        "."
    )
    if old:
        for new, written in (
            ("axesColl[0].calibrationPoints", "wpd.calibration"),
            ("axesColl[0].type", "wpd.axesType"),
            ("axesColl[0]", "wpd.axesParameters"),
            ("datasetColl", "wpd.dataSeries"),
        ):
            if keys.startswith(new):
                keys = written + keys[len(new) :]
                break
    if problem["type"] == "missing":
        return f"{where}: {keys} is missing; {_EXPECTED}"
    message = str(problem["msg"])
    return f"{where}: {keys}: found {problem['input']!r:.60}; {message[0].lower()}{message[1:]}"


def _unusable(series: SeriesBlock, axes: dict[str, AxesBlock]) -> str:
    if not series.data:
        return "it has no points"
    if series.axesName not in axes:
        return "it belongs to no axes"
    if axes[series.axesName].type != "XYAxes":
        return f"its axes are {axes[series.axesName].type}; expected XYAxes"
    return ""


def _groups(series: SeriesBlock) -> list[tuple[str, list[int]]]:
    """Name and numbers of the points of each part of a data set that has points; points of no group keep its name."""
    parts: dict[str, list[int]] = {}
    for number, point in enumerate(series.data, 1):
        name = series.name
        if point.group is not None and 0 <= point.group < len(series.groupNames):
            name += f", {series.groupNames[point.group] or f'group {point.group + 1}'}"
        parts.setdefault(name, []).append(number)
    return list(parts.items())


def _read_set(
    name: str, series: SeriesBlock, numbers: list[int], axes: AxesBlock, where: str
) -> DigitisedSet:
    points = [series.data[number - 1] for number in numbers]
    _refuse_overrides(points, numbers, f"{where}: data set {quoted(name)}")
    pixels = np.array([(point.x, point.y) for point in points])
    # files that do not say whether a tilt was ignored were written by versions of both kinds: the values tell
    ways = (False, True) if axes.noRotation is None else (axes.noRotation,)
    calibrations = [_calibrate(axes, straight, where) for straight in ways]
    stored = [point.value for point in points]
    if any(value is not None for value in stored):
        values = _stored_values(stored, name, numbers, where)
        apart = [calibration.pixels_apart(pixels, values) for calibration in calibrations]
        best = int(np.argmin(apart))
        if not apart[best] <= _AGREEMENT:
            raise InputError(
                f"{where}: data set {quoted(name)}: the stored values lie up to {apart[best]:.3g} pixels from those that the "
                f"calibration of axes {quoted(axes.name)} gives; expected the same values: load the project in "
                "WebPlotDigitizer and save it again, or export CSV and state the reading errors"
            )
        calibrations = [calibrations[best]]
    places = tuple(f"data set {quoted(name)}, point {number}" for number in numbers)
    return DigitisedSet(name, calibrations[0].values(pixels), places, calibrations[0])


def _refuse_overrides(points: list[PointBlock], numbers: list[int], place: str) -> None:
    for number, point in zip(numbers, points, strict=True):
        noted = point.metadata.get("overrides") if isinstance(point.metadata, dict) else None
        if isinstance(noted, dict) and any(value is not None for value in noted.values()):
            raise InputError(
                f"{place}, point {number}: its value was typed over by hand, so it is not where the picture has it; "
                "expected points without overrides"
            )


def _stored_values(stored: list[list[Any] | None], name: str, numbers: list[int], where: str) -> Any:
    for number, value in zip(numbers, stored, strict=True):
        if (
            value is None
            or len(value) != 2
            or not all(type(part) in (int, float) and abs(part) < 1e300 for part in value)
        ):
            raise InputError(
                f"{where}: data set {quoted(name)}, point {number}, value: found {value!r:.60}; expected two numbers"
            )
    return np.array(stored, dtype=float)


def _calibrate(axes: AxesBlock, straight: bool, where: str) -> PixelAxes:
    place = f"{where}: axes {quoted(axes.name)}"
    points = axes.calibrationPoints
    if len(points) != 4:
        raise InputError(
            f"{place}: {len(points)} calibration points; expected four, X1, X2, Y1 and Y2, on axes without a break"
        )
    written = (points[0].dx, points[1].dx, points[2].dy, points[3].dy)
    values = [_calibration_value(value, i, place) for i, value in enumerate(written)]
    try:
        return PixelAxes.from_points(
            [(point.px, point.py) for point in points],
            (values[0], values[1], values[2], values[3]),
            (axes.isLogX, axes.isLogY),
            straight=straight,
        )
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def _calibration_value(written: float | str | None, position: int, place: str) -> float:
    point = ("X1", "X2", "Y1", "Y2")[position]
    try:
        value = float(str(written).strip())
        if abs(value) < float("inf"):
            return value
    except ValueError:
        pass
    comma = ", with a decimal point" if "," in str(written) else ""
    raise InputError(
        f"{place}: calibration point {point}: found {written!r:.40}; expected a finite number{comma}, no date"
    )
