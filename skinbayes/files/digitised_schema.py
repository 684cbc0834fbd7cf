"""The parts of a project file of WebPlotDigitizer that are used; everything else in it is left alone."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from skinbayes.files.table import MAX_ROWS

MOST_SERIES = 1000
"""Data sets, and axes, of a project; a figure has a handful."""


class _Lenient(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)


class PointBlock(_Lenient):
    """A point: its pixel, the values it had when the file was written, its group, and what the user noted at it."""

    x: FiniteFloat
    y: FiniteFloat
    value: list[Any] | None = None
    group: int | None = None
    metadata: Any = None


class CalibrationBlock(_Lenient):
    """A calibration point: its pixel and the values of abscissa and ordinate there."""

    px: FiniteFloat
    py: FiniteFloat
    dx: float | str | None = None
    dy: float | str | None = None


class AxesBlock(_Lenient):
    """Axes: their kind, whether they are logarithmic, whether a tilt is ignored, and the points X1, X2, Y1, Y2."""

    name: str = ""
    type: str
    isLogX: bool = False
    isLogY: bool = False
    noRotation: bool | None = None
    calibrationPoints: list[CalibrationBlock] = Field(default_factory=list)


class SeriesBlock(_Lenient):
    """A data set and the name of its axes."""

    name: str = ""
    axesName: str = ""
    groupNames: list[str | None] = Field(default_factory=list)
    data: list[PointBlock] = Field(max_length=MAX_ROWS)


class ProjectBlock(_Lenient):
    """A project file, from version 4 on."""

    axesColl: list[AxesBlock] = Field(max_length=MOST_SERIES)
    datasetColl: list[SeriesBlock] = Field(max_length=MOST_SERIES)
