"""A measured roughness power spectrum from a CSV of the user's own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.columns import read_quantity
from skinbayes.files.stated_surface import MEASURED, StatedSurface, stated_surface
from skinbayes.files.table import CsvTable, Problems, quoted, read_table
from skinbayes.roughness import CONVENTIONS, TabulatedSpectrum, rms_height, rms_slope, total_area_ratio
from skinbayes.units import describe_unit, format_quantity, split_header
from skinbayes.vocabulary import Quantity, suggestions

# Ranges far wider than any surface, from kilometres to below atoms; they keep powers of the values finite.
QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("wavevector", "q", "1/m", "roughness wavevector, 2π/wavelength", 1e-3, 1e12, False),
        Quantity("power_spectrum_2d", "C", "m^4", "two-dimensional", 1e-80, 1e10, False),
        Quantity("power_spectrum_1d", "C1D", "m^3", "of line profiles", 1e-80, 1e10, False),
        Quantity(
            "independent_modes", "n", "1", "independent ordinates averaged in the row", 1e-3, 1e15, False
        ),
    )
}
MAX_ROWS = {"power_spectrum_2d": 10_000, "power_spectrum_1d": 500}
"""Rows of a spectrum: the cost of a likelihood grows with the rows of a two-dimensional spectrum, that of the
conversion from line profiles with their square."""
MODES = "independent_modes"
"""Column that a spectrum may have beside its values: they scatter as a mean of so many exponential variables does."""
_EXPECTED = (
    "expected the columns 'wavevector [1/m]' and 'power_spectrum_2d [m^4]' or 'power_spectrum_1d [m^3]'"
)


MOST_APART = 0.1
"""Relative difference of a measured rms height, slope or area beyond the nominal one from that of the spectrum, beyond which
the spectrum is refused; conventions differ by a factor of 1.4 in height or more."""


def read_spectrum(path: str | Path, stated: StatedSurface | None = None) -> TabulatedSpectrum:
    """Read a tabulated roughness power spectrum.

    The CSV has a column ``wavevector`` (``[1/m]`` or a unit that converts to it, 2π over the wavelength) and
    either ``power_spectrum_2d [m^4]``, of an area, or ``power_spectrum_1d [m^3]``, of line profiles, which is converted. The
    numbers cannot tell in which of the `CONVENTIONS` they are: comments above the header say it, ``# convention: paper``, or
    ``stated`` does. A measured rms height, slope or area, ``# rms_height_measured: 22 um``, must be that of the spectrum. A
    column ``independent_modes [1]`` says how well each value is known, and is not used here.

    Parameters
    ----------
    path : the CSV
    stated : what is known from elsewhere: a convention that comments do not contradict, measured values in place of theirs

    Returns
    -------
    TabulatedSpectrum
        two-dimensional spectrum in SI, in the convention of the paper

    Raises
    ------
    InputError
        naming line and column, for a missing or unknown column, a unit of another dimension, cells that are
        not positive finite numbers, wavevectors that do not increase, fewer than two or too many rows, or
        profiles that no isotropic surface has; if no convention is stated, one of the other kind of spectrum is, or the
        spectrum does not give what was measured
    """
    return spectrum_and_columns(path, stated).spectrum


class ReadSpectrum(NamedTuple):
    """A spectrum with the table that it was read from.

    Attributes
    ----------
    spectrum : in the convention of the paper
    table : the CSV
    columns : name of each column to its position and the text of its unit
    """

    spectrum: TabulatedSpectrum
    table: CsvTable
    columns: dict[str, tuple[int, str]]


def spectrum_and_columns(path: str | Path, stated: StatedSurface | None = None) -> ReadSpectrum:
    """What `read_spectrum` reads, and what else stands in its table."""
    path = Path(path)
    table = read_table(path, max_rows=max(MAX_ROWS.values()))
    named = _columns(table)
    problems = Problems(path)
    (power_name,) = named.keys() - {"wavevector", MODES}
    if len(table.rows) > MAX_ROWS[power_name]:
        raise InputError(
            f"{path}: {len(table.rows)} rows of {power_name}; expected at most {MAX_ROWS[power_name]}: average "
            "the spectrum over bands of wavevectors"
        )
    wavevector, power = (
        read_quantity(table, named[name][0], QUANTITIES[name], named[name][1], problems)
        for name in ("wavevector", power_name)
    )
    _check_increasing(table, *named["wavevector"], wavevector, problems)
    problems.raise_if_any()
    if len(wavevector) < 2:
        raise InputError(
            f"{path}, line {table.lines[0]}: a single row; expected a spectrum of at least two rows"
        )
    try:
        if power_name == "power_spectrum_2d":
            spectrum = TabulatedSpectrum(wavevector, power)
        else:
            with np.errstate(all="ignore"):  # the result is checked
                spectrum = TabulatedSpectrum.from_profile(wavevector, power)
    except InputError as error:
        raise InputError(f"{path}, column '{power_name}': {error}") from None
    spectrum = _normalised(
        path, spectrum, power_name, _merged(path, _comments(table), stated or StatedSurface())
    )
    return ReadSpectrum(spectrum, table, named)


def _comments(table: CsvTable) -> StatedSurface:
    """What comments above the header state."""
    given: dict[str, str] = {}
    lines: dict[str, int] = {}
    for number, line in table.comments:
        key, mark, value = line.lstrip("# \t").replace("=", ":", 1).partition(":")
        if mark and key.strip() in StatedSurface._fields:
            given[key.strip()], lines[key.strip()] = value.strip().strip("\"'"), number
    return stated_surface(given, lambda key: f"{table.path}, line {lines[key]}: {key}")


def _merged(path: Path, comments: StatedSurface, stated: StatedSurface) -> StatedSurface:
    if None not in (comments.convention, stated.convention) and comments.convention != stated.convention:
        raise InputError(
            f"{path}: the file states the convention '{comments.convention}', but '{stated.convention}' is asked for; expected "
            "one of them: drop it, or correct the comment in the file"
        )
    return comments._replace(**{key: value for key, value in stated._asdict().items() if value is not None})


def _normalised(
    path: Path, spectrum: TabulatedSpectrum, power_name: str, stated: StatedSurface
) -> TabulatedSpectrum:
    """The spectrum in the convention of the paper, if it has what was measured."""
    possible = {
        name: TabulatedSpectrum(spectrum.wavevector, spectrum.node_power / convention.times)
        for name, convention in CONVENTIONS.items()
        if f"power_spectrum_{convention.dimensions}d" == power_name
    }
    if stated.convention is None:
        raise InputError(
            f"{path}: the file does not say in which convention {power_name} is; expected '# convention: NAME' above the header, "
            f'or convention = "NAME" under [surface], of {_meanings(possible)}'
        )
    if stated.convention not in possible:
        raise InputError(
            f"{path}: the convention '{stated.convention}' is not one of {power_name}; expected {_meanings(possible)}"
        )
    found = possible[stated.convention]
    for key, value in (
        ("rms_height_measured", rms_height(found)),
        ("rms_slope_measured", rms_slope(found)),
        ("total_area_ratio_measured", total_area_ratio(rms_slope(found))),
    ):
        measured, beyond = getattr(stated, key), float(key == "total_area_ratio_measured")
        if measured is not None and not abs(value - measured) <= MOST_APART * (measured - beyond):
            has, was = (format_quantity(float(x), MEASURED[key], 3) for x in (value, measured))
            raise InputError(
                f"{path}: {key} is {was}, but the spectrum in the convention '{stated.convention}' has {has}; expected them to "
                f"agree to {MOST_APART:.0%}. Possible are {_meanings(possible)}"
            )
    return found


def _meanings(possible: Mapping[str, TabulatedSpectrum]) -> str:
    """Each convention with the surface that it would mean."""
    return "; ".join(
        f"'{name}' ({CONVENTIONS[name].variance}: rms height {format_quantity(float(rms_height(one)), 'm', 3)}, "
        f"rms slope {float(rms_slope(one)):.3g})"
        for name, one in possible.items()
    )


def _columns(table: CsvTable) -> dict[str, tuple[int, str]]:
    """Position and unit of each column; InputError for anything but one wavevector and one spectrum."""
    where = f"{table.path}, line {table.header_line}"
    named: dict[str, tuple[int, str]] = {}
    known = list(QUANTITIES)
    names = [split_header(header)[0] for header in table.header]
    if not any(name in known or suggestions(name, known) for name in names):
        # nothing of a file that is no spectrum is quoted: a model may name any file there is
        raise InputError(f"{where}: no column of a spectrum; {_EXPECTED}")
    for position, header in enumerate(table.header):
        name, unit = split_header(header)
        quantity = QUANTITIES.get(name)
        if quantity is None:
            guess = suggestions(name, known)
            raise InputError(
                f"{where}: unknown column {quoted(header.strip())}; {_EXPECTED}.{guess}".rstrip(".")
            )
        if name in named:
            raise InputError(f"{where}: column '{name}' appears twice; {_EXPECTED}")
        if not unit:
            raise InputError(f"{where}: column '{name}' has no unit; expected {describe_unit(quantity.unit)}")
        named[name] = position, unit
    if "wavevector" not in named or len(named.keys() - {MODES}) != 2:
        raise InputError(f"{where}: found the columns {', '.join(named)}; {_EXPECTED}")
    return named


def _check_increasing(
    table: CsvTable, position: int, unit: str, values: FloatArray, problems: Problems
) -> None:
    cells = table.column(position)
    for row in np.flatnonzero(values[1:] <= values[:-1]).tolist():
        problems.add(
            table.lines[row + 1],
            position,
            f", column 'wavevector': found {cells[row + 1][:30]} {unit} after {cells[row][:30]} {unit}; "
            "expected wavevectors that increase from row to row",
        )


def spectrum_text(spectrum: TabulatedSpectrum) -> str:
    """A spectrum as the CSV that `read_spectrum` reads, every number with all its digits."""
    power = spectrum.node_power * np.asarray(spectrum.scale)
    rows = (f"{q!r},{c!r}" for q, c in zip(spectrum.wavevector.tolist(), power.tolist(), strict=True))
    return "\n".join(("# convention: paper", "wavevector [1/m],power_spectrum_2d [m^4]", *rows, ""))
