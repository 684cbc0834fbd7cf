"""Exports of a figure that does not exist: a curve computed from a formula, put on axes in pixels."""

from __future__ import annotations

import io
import json
import math
import tarfile
from pathlib import Path
from typing import Any

ABSCISSA = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1]
NAMES = ("young", "old")


def ordinate(abscissa: float, name: str) -> float:
    """A made-up curve that falls with the logarithm of the abscissa."""
    return (0.2 if name == "young" else 0.3) - 0.1 * math.log10(abscissa)


def pixel(abscissa: float, value: float) -> tuple[float, float]:
    """100 pixels for each decade from 1e-6 at x = 50; 200 pixels for each unit, upwards from 0 at y = 450."""
    return 50 + 100 * (math.log10(abscissa) + 6), 450 - 200 * value


def points(name: str) -> list[dict[str, Any]]:
    found = []
    for x in ABSCISSA:
        y = ordinate(x, name)
        px, py = pixel(x, y)
        found.append({"x": px, "y": py, "value": [x, y]})
    return found


def calibration() -> list[dict[str, Any]]:
    places = ((50, 450, "1e-6", "0"), (650, 450, "1", "0"), (50, 450, "1e-6", "0"), (50, 50, "1e-6", "2.0"))
    return [{"px": px, "py": py, "dx": dx, "dy": dy, "dz": None} for px, py, dx, dy in places]


def project() -> dict[str, Any]:
    """A project as version 4 writes it, with what is of no use here."""
    axes = {
        "name": "XY", "type": "XYAxes", "isLogX": True, "isLogY": False, "noRotation": False,
        "calibrationPoints": calibration(),
    }  # fmt: skip
    sets = [
        {"name": name, "axesName": "XY", "metadataKeys": [], "colorRGB": [200, 0, 0, 255], "data": points(name),
         "autoDetectionData": None}
        for name in NAMES
    ]  # fmt: skip
    empty = {"name": "Default Dataset", "axesName": "XY", "metadataKeys": [], "data": []}
    bars = {"name": "bars", "axesName": "Bar", "data": [{"x": 1, "y": 2, "value": [0.5]}]}
    bar_axes = {"name": "Bar", "type": "BarAxes", "isLog": False, "calibrationPoints": []}
    return {
        "version": [4, 2], "axesColl": [axes, bar_axes], "datasetColl": [*sets, empty, bars], "measurementColl": [],
    }  # fmt: skip


def old_project() -> dict[str, Any]:
    """The same as version 3 writes it."""
    return {
        "wpd": {
            "version": [3, 8],
            "axesType": "XYAxes",
            "axesParameters": {"isLogX": True, "isLogY": False},
            "calibration": calibration(),
            "dataSeries": [{"name": name, "data": points(name), "metadataKeys": []} for name in NAMES],
        }
    }


def write_json(path: Path, content: Any) -> Path:
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def write_archive(path: Path, files: dict[str, bytes]) -> Path:
    with tarfile.open(path, "w") as archive:
        for name, data in files.items():
            member = tarfile.TarInfo(name)
            member.size = len(data)
            archive.addfile(member, io.BytesIO(data))
    return path


def all_sets_csv(lengths: tuple[int, int] = (5, 5)) -> str:
    """All data sets beside one another, names above pairs of columns, shorter ones filled up."""
    rows = []
    for i in range(max(lengths)):
        cells: list[str] = []
        for name, length in zip(NAMES, lengths, strict=True):
            x = ABSCISSA[i]
            cells += [repr(x), repr(ordinate(x, name))] if i < length else ["", ""]
        rows.append(",".join(cells))
    return "\n".join([f"{NAMES[0]},,{NAMES[1]},", "X,Y,X,Y", *rows, ""])
