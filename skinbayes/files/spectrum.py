"""A measured roughness power spectrum from a CSV of the user's own."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.columns import read_quantity
from skinbayes.files.table import CsvTable, Problems, quoted, read_table
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.units import describe_unit, split_header
from skinbayes.vocabulary import Quantity, suggestions

# Ranges far wider than any surface, from kilometres to below atoms; they keep powers of the values finite.
_QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("wavevector", "q", "1/m", "roughness wavevector, 2π/wavelength", 1e-3, 1e12, False),
        Quantity("power_spectrum_2d", "C", "m^4", "two-dimensional", 1e-80, 1e10, False),
        Quantity("power_spectrum_1d", "C1D", "m^3", "of line profiles", 1e-80, 1e10, False),
    )
}
MAX_ROWS = {"power_spectrum_2d": 10_000, "power_spectrum_1d": 500}
"""Rows of a spectrum: the cost of a likelihood grows with the rows of a two-dimensional spectrum, that of the
conversion from line profiles with their square."""
_EXPECTED = (
    "expected the columns 'wavevector [1/m]' and 'power_spectrum_2d [m^4]' or 'power_spectrum_1d [m^3]'"
)


def read_spectrum(path: str | Path) -> TabulatedSpectrum:
    """Read a tabulated roughness power spectrum.

    The CSV has a column ``wavevector`` (``[1/m]`` or a unit that converts to it, 2π over the wavelength) and
    either ``power_spectrum_2d [m^4]``, in the convention of the paper (Eq. 1), whose mean square height is
    ``2π ∫ q C(q) dq``, or ``power_spectrum_1d [m^3]`` of line profiles, whose mean square height is
    ``2 ∫ C1D(q) dq`` over q > 0, which is converted. The name of the column decides: a number cannot tell which
    of the two it is.

    Parameters
    ----------
    path : the CSV

    Returns
    -------
    TabulatedSpectrum
        two-dimensional spectrum in SI

    Raises
    ------
    InputError
        naming line and column, for a missing or unknown column, a unit of another dimension, cells that are
        not positive finite numbers, wavevectors that do not increase, fewer than two or too many rows, or
        profiles that no isotropic surface has
    """
    path = Path(path)
    table = read_table(path, max_rows=max(MAX_ROWS.values()))
    named = _columns(table)
    problems = Problems(path)
    (power_name,) = named.keys() - {"wavevector"}
    if len(table.rows) > MAX_ROWS[power_name]:
        raise InputError(
            f"{path}: {len(table.rows)} rows of {power_name}; expected at most {MAX_ROWS[power_name]}: average "
            "the spectrum over bands of wavevectors"
        )
    wavevector, power = (
        read_quantity(table, named[name][0], _QUANTITIES[name], named[name][1], problems)
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
            return TabulatedSpectrum(wavevector, power)
        with np.errstate(all="ignore"):  # the result is checked
            return TabulatedSpectrum.from_profile(wavevector, power)
    except InputError as error:
        raise InputError(f"{path}, column '{power_name}': {error}") from None


def _columns(table: CsvTable) -> dict[str, tuple[int, str]]:
    """Position and unit of each column; InputError for anything but one wavevector and one spectrum."""
    where = f"{table.path}, line {table.header_line}"
    named: dict[str, tuple[int, str]] = {}
    known = list(_QUANTITIES)
    names = [split_header(header)[0] for header in table.header]
    if not any(name in known or suggestions(name, known) for name in names):
        # nothing of a file that is no spectrum is quoted: a model may name any file there is
        raise InputError(f"{where}: no column of a spectrum; {_EXPECTED}")
    for position, header in enumerate(table.header):
        name, unit = split_header(header)
        quantity = _QUANTITIES.get(name)
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
    if "wavevector" not in named or len(named) != 2:
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
    return "\n".join(("wavevector [1/m],power_spectrum_2d [m^4]", *rows, ""))
