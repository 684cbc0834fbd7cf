"""A measured surface from a file: of an instrument, an array, an image, or text."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import NamedTuple

from skinbayes.errors import InputError
from skinbayes.files.height_map_arrays import read_array, read_image
from skinbayes.files.height_map_instrument import read_instrument
from skinbayes.files.height_map_text import read_text
from skinbayes.files.reading import open_file
from skinbayes.files.surface_scale import LARGEST_FILE, Scale, scale_of
from skinbayes.topography import HeightMap, LineProfile

_EXPECTED = "a height map or line profile"
_TEXT = frozenset((".csv", ".txt", ".xyz", ".dat", ".asc", ".tsv", ".prn"))
_IMAGES = frozenset((".tif", ".tiff"))


class SurfaceFile(NamedTuple):
    """A surface as a file has it.

    Attributes
    ----------
    surface : heights in m
    path : the file
    kind : what it is, for people: ``"NumPy array"``, ``"instrument file (opdx)"``
    tip_radius : of a stylus, as the file says it, m; None if it does not
    resolution : shortest wavelength that the instrument passes, as the file says it, m; None if it does not
    """

    surface: HeightMap | LineProfile
    path: Path
    kind: str
    tip_radius: float | None = None
    resolution: float | None = None


def read_surface(
    path: str | Path,
    *,
    unit: str | None = None,
    pixel_size: str | None = None,
    channel: str | None = None,
    periodic: bool = False,
) -> SurfaceFile:
    """Read a height map or a line profile.

    ==================  ==========================================  =====================================================
    file                holds                                       to be stated
    ==================  ==========================================  =====================================================
    of an instrument    what SurfaceTopography reads                unit and pixel size where the file lacks them
    ``.npy``            array of one or two axes                    unit of heights, pixel size
    ``.tif``            image of one channel, integers or floats    unit of heights (of one count), pixel size
    text                x, y, z of the points of a grid             unit, unless the header has it: ``x [um],y [um],z [um]``
    text                x, z of the points of a line                unit, unless the header has it
    text                rows of heights, 8 or more in each          unit of heights, pixel size
    ==================  ==========================================  =====================================================

    Kind and size of the file, and the number of pixels that it announces, are looked at before heights are read.

    Parameters
    ----------
    path : the file
    unit : of the heights, and of x and y in text that has them: ``"um"``, or ``"12.5 nm"`` of one count
    pixel_size : of arrays, images and rows of heights: ``"0.8 um"``, or ``"0.8 um, 1.2 um"`` along and across the rows
    channel : name or number (from 1) of the channel of an instrument's file; the first one of heights if omitted
    periodic : whether the surface is one period of a periodic one, as simulated ones are

    Returns
    -------
    SurfaceFile
        the surface in SI

    Raises
    ------
    InputError
        naming the file: it is none of these, damaged, too large, has no unit or one that contradicts what is stated, or a
        profile that goes back
    """
    path = Path(path)
    with open_file(path, LARGEST_FILE, _EXPECTED) as stream:
        head = stream.read(4096)
    if not head:
        raise InputError(f"{path}: the file is empty; expected {_EXPECTED}")
    _refuse_inflated(path)
    stated = scale_of(unit, pixel_size, periodic)
    ending = path.suffix.lower()
    if head.startswith(b"\x93NUMPY"):
        found = SurfaceFile(read_array(path, stated), path, "NumPy array")
    elif ending in _IMAGES:
        found = SurfaceFile(read_image(path, stated), path, "TIFF image")
    elif ending in _TEXT and (read := read_text(path, stated)) is not None:
        found = SurfaceFile(read[0], path, read[1])
    else:
        instrument = read_instrument(path, stated, channel)
        return SurfaceFile(instrument.surface, path, f"instrument file ({instrument.format})", instrument.tip_radius,
                           instrument.resolution)  # fmt: skip
    if channel is not None:
        raise InputError(f"{path}: a {found.kind} has no channels; drop the channel '{channel[:40]}'")
    return found


def _refuse_inflated(path: Path) -> None:
    """Refuse an archive, as many instruments write them, that would become too large when it is unpacked."""
    if not zipfile.is_zipfile(path):
        return
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(member.file_size for member in archive.infolist())
    except (OSError, zipfile.BadZipFile):
        return  # its reader says what is wrong
    if size > LARGEST_FILE:
        raise InputError(
            f"{path}: {size:,} bytes when unpacked; expected {_EXPECTED} of at most {LARGEST_FILE:,}"
        )


__all__ = ["Scale", "SurfaceFile", "read_surface"]
