"""Spectra that somebody averaged already: read with what is known of their scatter, and written so that they can be read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.columns import read_quantity
from skinbayes.files.reading import open_file
from skinbayes.files.spectrum import MODES, QUANTITIES, spectrum_and_columns
from skinbayes.files.stated_surface import MEASURED, StatedSurface
from skinbayes.files.table import LARGEST_TABLE, Problems
from skinbayes.topography import MeasuredSpectrum
from skinbayes.units import format_quantity

FEWEST_ROWS = 5
"""Rows from which the scatter of a spectrum can be told from its curvature."""


_SIGNS = ("wavevector", "wavenumber", "power_spectr", "power spectr", "psd", "m^4", "m⁴", "[1/", "(1/")
"""What headers of spectra have and those of surfaces do not; whether the columns are right is said where they are read."""


def is_spectrum(path: str | Path) -> bool:
    """Whether the header of a text is that of a spectrum, and not of a surface."""
    with open_file(Path(path), LARGEST_TABLE * 100, "a file") as stream:
        head = stream.read(4096)
    lines = [
        line
        for line in head.decode("latin-1").splitlines()
        if line.strip() and not line.lstrip().startswith("#")
    ]
    return bool(lines) and any(sign in lines[0].lower() for sign in _SIGNS)


def read_measured_spectrum(path: str | Path, stated: StatedSurface | None = None) -> MeasuredSpectrum:
    """Read a spectrum as `read_spectrum` does, with the number of modes behind each value.

    That is what the column ``independent_modes [1]`` says. Without it, it is estimated from how much values scatter about the
    straight lines between their neighbours in ln C over ln q, the same for all rows: the mean of the squared distances over
    their factor 1 + w² + (1 − w)² is the relative variance. All rows are taken as reliable.

    Parameters
    ----------
    path : the CSV
    stated : what is known from elsewhere, as for `read_spectrum`

    Returns
    -------
    MeasuredSpectrum
        in the convention of the paper

    Raises
    ------
    InputError
        as `read_spectrum`, and for fewer than 5 rows without numbers of modes
    """
    path = Path(path)
    spectrum, table, columns = spectrum_and_columns(path, stated)
    if MODES in columns:
        problems = Problems(path)
        position, unit = columns[MODES]
        modes = read_quantity(table, position, QUANTITIES[MODES], unit, problems)
        problems.raise_if_any()
    else:
        modes = np.full(
            spectrum.wavevector.shape, _modes_of_scatter(path, spectrum.wavevector, spectrum.node_power)
        )
    return MeasuredSpectrum(
        spectrum.wavevector,
        power_spectral_density=spectrum.node_power,
        independent_modes=modes,
        wavevector_min=float(spectrum.wavevector[0]),
        wavevector_max=float(spectrum.wavevector[-1]),
        source=path.name,
    )


def _modes_of_scatter(path: Path, wavevector: FloatArray, power: FloatArray) -> float:
    if wavevector.size < FEWEST_ROWS:
        raise InputError(
            f"{path}: {wavevector.size} rows without a column '{MODES} [1]'; expected at least {FEWEST_ROWS}, to tell how much "
            "they scatter"
        )
    x, y = np.log(wavevector), np.log(power)
    right = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    away = y[1:-1] - right * y[2:] - (1 - right) * y[:-2]
    variance = float(np.mean(np.square(away) / (1 + np.square(right) + np.square(1 - right))))
    return float(np.clip(1 / max(variance, 1e-12), 1e-3, 1e12))


def measured_text(spectrum: MeasuredSpectrum, *comments: str, rms_height: float | None = None) -> str:
    """The reliable bins of a spectrum as a CSV that ``[surface] file`` and `read_measured_spectrum` read.

    Parameters
    ----------
    spectrum : in the convention of the paper
    comments : lines above the header
    rms_height : measured over the same wavevectors, m; None if it is not known otherwise
    """
    lines = [f"# {line}" for comment in comments for line in comment.splitlines()]
    lines.append("# convention: paper")
    if rms_height is not None:
        lines.append(
            f"# rms_height_measured: {format_quantity(rms_height, MEASURED['rms_height_measured'], 6)}"
        )
    lines.append(f"wavevector [1/m],power_spectrum_2d [m^4],{MODES} [1]")
    used = spectrum.reliable
    columns = spectrum.wavevector, spectrum.power_spectral_density, spectrum.independent_modes
    rows = zip(*(values[used].tolist() for values in columns), strict=True)
    lines += [f"{q:.9g},{c:.9g},{n:.5g}" for q, c, n in rows]
    return "\n".join((*lines, ""))
