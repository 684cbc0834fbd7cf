"""Heights from the files of instruments, which SurfaceTopography reads."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.height_map_text import line_of_points
from skinbayes.files.surface_scale import Scale, check_pixels, first_line, made
from skinbayes.topography import HeightMap, LineProfile
from skinbayes.units import convert_array

_MISSING = "files of instruments are read by SurfaceTopography, which is not installed: pip install 'skinbayes[topography]'"
_PLAIN = "a file of an instrument, a NumPy array (.npy), a TIFF image, or text with x, y, z, with x, z, or with rows of heights"


class InstrumentFile(NamedTuple):
    """A surface with what its file says of the instrument; lengths in m."""

    surface: HeightMap | LineProfile
    format: str
    tip_radius: float | None
    resolution: float | None


def read_instrument(path: Path, stated: Scale, channel: str | None) -> InstrumentFile:
    """A channel of heights; InputError for whatever its reader raises on a damaged or foreign file."""
    with _quiet():
        try:
            import SurfaceTopography
        except ImportError:
            raise InputError(f"{path}: {_MISSING}; expected {_PLAIN}") from None
        try:
            with SurfaceTopography.open_topography(str(path)) as reader:
                return _read(path, reader, stated, channel)
        except InputError:
            raise
        except SurfaceTopography.Exceptions.CannotDetectFileFormat:
            raise InputError(
                f"{path}: no known kind of file, or one that is cut off or damaged; expected {_PLAIN}"
            ) from None
        except MemoryError:
            raise
        except Exception as error:  # readers of damaged files fail in many ways
            raise InputError(
                f"{path}: SurfaceTopography cannot read it ({first_line(error)}); expected {_PLAIN}"
            ) from None


@contextmanager
def _quiet() -> Iterator[None]:
    """Readers that try a file in turn neither warn nor log: one message says what came of it."""
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(before)


def _read(path: Path, reader: Any, stated: Scale, asked: str | None) -> InstrumentFile:
    channel = _channel(path, reader, asked)
    if isinstance(channel.unit, tuple) or not channel.is_height_channel:
        raise InputError(
            f"{path}: the channel '{channel.name}' holds no heights; expected {_heights(reader)}"
        )
    pixels = [int(n) for n in channel.nb_grid_pts]
    check_pixels(path, *pixels)
    given: dict[str, Any] = {}
    known = channel.unit is not None
    if known and stated.unit is not None:
        raise InputError(f"{path}: the file has the unit {channel.unit}; drop --unit {stated.unit[:40]}")
    if not known and stated.factor is None:
        raise InputError(f"{path}: the file has no unit; expected --unit, such as --unit um")
    factor = float(convert_array(1.0, channel.unit, "m", str(path))) if known else float(stated.factor or 1.0)
    if channel.physical_sizes is None or any(size is None for size in channel.physical_sizes):
        if stated.pixel_x is None or stated.pixel_y is None:
            raise InputError(
                f"{path}: the file has no size; expected --pixel-size, such as --pixel-size '0.8 um'"
            )
        sides = (stated.pixel_x, stated.pixel_y)[: len(pixels)]
        given["physical_sizes"] = tuple(n * side / factor for n, side in zip(pixels, sides, strict=True))
    elif stated.pixel_x is not None:
        raise InputError(f"{path}: the file has the size of its pixels; drop --pixel-size")
    if stated.periodic:
        given["periodic"] = True
    topography = channel.topography(**given)
    surface: HeightMap | LineProfile
    periodic = bool(topography.is_periodic)
    if topography.dim == 1 and not topography.is_uniform:
        x, height = topography.positions_and_heights()
        surface = line_of_points(path, _plain(x) * factor, _plain(height) * factor, periodic)
    else:
        height = _plain(topography.heights()) * factor
        sizes = [float(s) * factor / n for s, n in zip(topography.physical_sizes, height.shape, strict=True)]
        # there the first axis is x; a copy, so that rows are rows
        surface = made(path, np.ascontiguousarray(height.T), sizes[0], sizes[-1], periodic)
    instrument = (topography.info or {}).get("instrument") or {}
    parameters = instrument.get("parameters") or {} if isinstance(instrument, dict) else {}
    return InstrumentFile(
        surface,
        str(reader.format()),
        _length(parameters.get("tip_radius")),
        _length(parameters.get("resolution")),
    )


def _channel(path: Path, reader: Any, asked: str | None) -> Any:
    if asked is None:
        return reader.default_channel
    named = [one for one in reader.channels if one.name == asked]
    if not named and asked.isdecimal() and 1 <= int(asked) <= len(reader.channels):
        named = [reader.channels[int(asked) - 1]]
    if not named:
        raise InputError(f"{path}: no channel '{asked[:40]}'; expected {_heights(reader)}")
    return named[0]


def _heights(reader: Any) -> str:
    found = [
        f"'{one.name}' (or {i})"
        for i, one in enumerate(reader.channels, 1)
        if one.is_height_channel and not isinstance(one.unit, tuple)
    ]
    return f"one of {', '.join(found)}" if found else "a file with heights"


def _plain(values: Any) -> np.ndarray:
    """An array with nan where it is masked."""
    return np.asarray(np.ma.filled(np.ma.asarray(values, dtype=np.float64), np.nan))


def _length(stated: Any) -> float | None:
    """A length in m as SurfaceTopography keeps it, ``{"value": …, "unit": …}``."""
    try:
        return float(convert_array(float(stated["value"]), str(stated["unit"]), "m", "instrument"))
    except (TypeError, KeyError, ValueError):
        return None
