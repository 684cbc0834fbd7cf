"""From a map to its isotropic power spectrum."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.topography.band import Band, reliable_band
from skinbayes.topography.bins import BINS_PER_DECADE, area_bins, at_power_law, independent_area_modes
from skinbayes.topography.height_map import HeightMap
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.periodogram import Periodogram, map_periodogram
from skinbayes.topography.windows import Window, spread_of_modes


class SpectrumNumbers(NamedTuple):
    """Moments of a periodogram, summed mode by mode; no power law between bins is in them.

    Attributes
    ----------
    rms_height : m
    rms_slope : dimensionless
    """

    rms_height: float
    rms_slope: float


def usual_window(surface: HeightMap) -> Window:
    """``"hann"``, or ``"none"`` of a periodic map."""
    return "none" if surface.periodic else "hann"


def area_spectrum(
    surface: HeightMap,
    *,
    window: Window | None = None,
    bins_per_decade: int = BINS_PER_DECADE,
    band: Band | None = None,
    source: str = "",
) -> MeasuredSpectrum:
    """Isotropic power spectrum C(q) of a map, radially averaged (Eq. 1 of the paper).

    ``C(q) = |Σ w h exp(−iqx)|² (ΔxΔy)²/((2π)² A ⟨w²⟩)``, the mean over all modes of a bin. The window is a product of one
    along each axis. Bins are ten to the k/n, of all spectra alike, up to the wavevector of Nyquist. The wavevector of a bin is
    where a power law through its neighbours has its mean, and what the window smears into it from longer waves is taken off to
    second order. ``independent_modes`` counts modes of a Gaussian surface: 1/1.94 of those in a bin for each axis under Hann's
    window. Its scatter and the mean were checked against simulated maps, from `FEWEST_WAVES` = 3 waves on the field on.

    Parameters
    ----------
    surface : map without trend and undefined pixels, heights in m
    window : ``"hann"``, ``"blackman"`` or ``"none"``; Hann's if omitted, none of a periodic map
    bins_per_decade : of wavevectors, dimensionless
    band : the reliable wavevectors; `reliable_band` if omitted
    source : where the map is from, for people

    Returns
    -------
    spectrum : `MeasuredSpectrum`

    Raises
    ------
    InputError
        if there are undefined pixels, all heights are the same, or an option is none

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, Eq. 4 and following, doi 10.1088/2051-672X/aa51f8;
    Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70, doi 10.1109/TAU.1967.1161901, on the variance.

    Examples
    --------
    >>> import numpy as np
    >>> height = 1e-9 * np.random.default_rng(1).standard_normal((128, 128))  # white: C = h²ΔxΔy/(2π)²
    >>> found = area_spectrum(HeightMap(height, pixel_size_x=1e-6, pixel_size_y=1e-6, periodic=True))
    >>> c = found.power_spectral_density[-2] / (1e-30 / (2 * np.pi) ** 2)
    >>> print(f"{c:.2f} ± {found.relative_standard_error[-2]:.2f}")
    0.95 ± 0.03
    """
    periodogram = map_periodogram(surface, usual_window(surface) if window is None else window)
    return spectrum_of(periodogram, reliable_band(surface) if band is None else band, bins_per_decade, source)


def spectrum_of(periodogram: Periodogram, band: Band, bins_per_decade: int, source: str) -> MeasuredSpectrum:
    """The same of a periodogram that is there already."""
    if not 2 <= bins_per_decade <= 100:
        raise InputError(f"bins_per_decade is {bins_per_decade}; expected 2 to 100")
    bins = area_bins(periodogram, bins_per_decade)
    if not bins.power.all():
        raise InputError("all heights are the same, or a plane: there is no roughness")
    independent = independent_area_modes(periodogram, bins, bins_per_decade)
    steps = np.square(periodogram.wavevector_x[1]), np.square(periodogram.wavevector_y[1])
    smear = spread_of_modes(periodogram.window) * float(sum(steps)) / 2
    found = at_power_law(bins, independent, smear=smear, dimensions=2)
    order = np.argsort(found.wavevector)  # neighbouring bins of few modes may change places
    return MeasuredSpectrum(
        found.wavevector[order],
        power_spectral_density=found.power[order],
        independent_modes=found.independent[order],
        wavevector_min=band.wavevector_min,
        wavevector_max=band.wavevector_max,
        source=source,
    )


def spectrum_numbers(
    periodogram: Periodogram, *, wavevector_min: float = 0.0, wavevector_max: float = np.inf
) -> SpectrumNumbers:
    """Rms height and slope of the modes between two wavevectors, 1/m; those of the whole map if omitted (Parseval)."""
    height = slope = 0.0
    squares = np.square(periodogram.wavevector_x)
    low, high = np.square((wavevector_min, wavevector_max))
    block = max(1, 2**20 // squares.size)
    for start in range(0, periodogram.wavevector_y.size, block):
        rows = slice(start, start + block)
        q2: FloatArray = np.square(periodogram.wavevector_y[rows])[:, None] + squares
        power = periodogram.forward[rows] + periodogram.backward[rows]
        power *= 0.5 * periodogram.cell * periodogram.count_y[rows][:, None] * periodogram.count_x
        power *= (q2 >= low) & (q2 <= high)
        height += float(power.sum())
        power *= q2
        slope += float(power.sum())
    return SpectrumNumbers(float(np.sqrt(height)), float(np.sqrt(slope)))
