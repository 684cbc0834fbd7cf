"""What is stated about a surface beside its numbers: unit and pixel size; and how large one may be."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.topography import HeightMap, LineProfile
from skinbayes.units import convert_array, parse_quantity

LARGEST_FILE = 2_000_000_000
"""Bytes of a file of heights, also when it is unpacked."""

MOST_PIXELS = 100_000_000
"""Pixels of a map: 0.8 GB of heights."""


class Scale(NamedTuple):
    """What was stated.

    Attributes
    ----------
    unit : as it was typed; None if it was not
    factor : m of one unit of height
    pixel_x, pixel_y : m
    periodic : whether the surface is one period
    """

    unit: str | None = None
    factor: float | None = None
    pixel_x: float | None = None
    pixel_y: float | None = None
    periodic: bool = False

    def surface(self, path: Path, height: FloatArray) -> HeightMap | LineProfile:
        """Heights of an array whose file knows neither unit nor pixel size as a surface; InputError for what is not stated."""
        if self.factor is None:
            raise InputError(f"{path}: the heights have no unit; expected --unit, such as --unit um")
        if self.pixel_x is None or self.pixel_y is None:
            raise InputError(
                f"{path}: the pixels have no size; expected --pixel-size, such as --pixel-size '0.8 um'"
            )
        return made(path, height * self.factor, self.pixel_x, self.pixel_y, self.periodic)


def scale_of(unit: str | None, pixel_size: str | None, periodic: bool = False) -> Scale:
    """What unit, pixel size and periodicity mean, as a person types them."""
    factor = None
    if unit is not None:
        if unit.strip()[:1].isdigit() or unit.strip()[:1] == ".":
            factor = parse_quantity(unit, "m", where="--unit")
        else:
            factor = float(convert_array(1.0, unit, "m", "--unit"))
        if not 0 < factor < np.inf:
            raise InputError(f"--unit: found {unit[:40]}; expected a length > 0 m")
    if pixel_size is None:
        return Scale(unit, factor, periodic=periodic)
    parts = [part.strip() for part in pixel_size.replace(" x ", ",").replace("×", ",").split(",")]
    if len(parts) > 2:
        raise InputError(
            f"--pixel-size: found {pixel_size[:60]}; expected one length, or two: '0.8 um, 1.2 um'"
        )
    sizes = [parse_quantity(part, "m", where="--pixel-size") for part in parts]
    if not all(0 < size < np.inf for size in sizes):
        raise InputError(f"--pixel-size: found {pixel_size[:60]}; expected lengths > 0 m")
    return Scale(unit, factor, sizes[0], sizes[-1], periodic)


def check_pixels(path: Path, *shape: int) -> None:
    """Refuse a map that is too large, or too small to have a spectrum, before its heights are read."""
    pixels = 1
    for side in shape:
        pixels *= int(side)
    if pixels > MOST_PIXELS:
        sides = " × ".join(f"{int(side):,}" for side in shape)
        raise InputError(
            f"{path}: {sides} pixels; expected at most {MOST_PIXELS:,}: average neighbours, or cut"
        )


def made(
    path: Path, height: FloatArray, pixel_x: float, pixel_y: float, periodic: bool
) -> HeightMap | LineProfile:
    """A map or line; what is wrong with it is said with the name of the file."""
    try:
        if height.ndim == 1:
            return LineProfile(height, pixel_size=pixel_x, periodic=periodic)
        return HeightMap(height, pixel_size_x=pixel_x, pixel_size_y=pixel_y, periodic=periodic)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def first_line(error: Exception) -> str:
    """What an error of a reader says first, or its kind if it says nothing."""
    return (str(error).splitlines() or [""])[0][:200] or type(error).__name__
