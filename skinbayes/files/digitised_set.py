"""Points of one data set of a digitised figure."""

from __future__ import annotations

from dataclasses import dataclass

from skinbayes.arrays import FloatArray
from skinbayes.files.pixel_axes import PixelAxes


@dataclass(frozen=True, eq=False)
class DigitisedSet:
    """One data set of an export.

    Attributes
    ----------
    name : as in the export
    values : abscissa and ordinate of each point in the units of the axes, shape ``(N, 2)``
    places : where in the file each point stands, for messages
    axes : calibration of the axes, or None for a CSV, which has none
    """

    name: str
    values: FloatArray
    places: tuple[str, ...]
    axes: PixelAxes | None = None
