"""From a surface as it was read to its spectrum: all steps, and what is to be said about them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.errors import InputError
from skinbayes.roughness import rms_height, rms_slope, total_area_ratio
from skinbayes.topography.area_spectrum import SpectrumNumbers, spectrum_numbers, spectrum_of, usual_window
from skinbayes.topography.artefacts import (
    Plateau,
    find_plateaus,
    find_spikes,
    invert_replica,
    refuse_marks,
    remove_spikes,
    undefined_at,
)
from skinbayes.topography.band import Band, reliable_band
from skinbayes.topography.bins import BINS_PER_DECADE
from skinbayes.topography.directional_spectrum import DirectionalSpectrum, directional_spectrum_of
from skinbayes.topography.height_map import HeightMap, LineProfile
from skinbayes.topography.line_spectrum import LINE_BINS_PER_DECADE, isotropic_spectrum, line_spectrum
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.numbers import SurfaceNumbers, surface_numbers
from skinbayes.topography.periodogram import map_periodogram
from skinbayes.topography.trend import Trend, remove_trend, trend_share
from skinbayes.topography.undefined import fill_undefined, largest_defined_part, undefined_share
from skinbayes.topography.windows import Window

Undefined = Literal["fill", "rectangle"]


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceAnalysis:
    """A prepared surface with its spectrum.

    Attributes
    ----------
    surface : as prepared; its steps say how
    undefined : share of pixels that had no height, dimensionless
    spikes : number of pixels that stand out of their neighbours, and were removed if that was asked for, dimensionless
    spike_share : share of the mean square slope that steps to and from these pixels make, dimensionless
    plateaus : saturated areas
    own : rms height, slope and more of the prepared surface itself
    window : its name
    spectrum : `MeasuredSpectrum`
    whole : rms height (m) and slope of the whole spectrum, nan of a line
    in_band : the same from the first to the last reliable bin
    band : reliable wavevectors and by which rule
    trend_share : share of the waves of each bin that removing the trend took, dimensionless, shape ``(K,)``
    anisotropy : by direction; None of a line
    """

    surface: HeightMap | LineProfile
    undefined: float
    spikes: int
    spike_share: float
    plateaus: tuple[Plateau, ...]
    own: SurfaceNumbers
    window: Window
    spectrum: MeasuredSpectrum
    whole: SpectrumNumbers
    in_band: SpectrumNumbers
    band: Band
    trend_share: FloatArray
    anisotropy: DirectionalSpectrum | None

    @property
    def area_ratio_in_band(self) -> float:
        """True over nominal area of a Gaussian surface with the slope in the band, dimensionless."""
        return float(total_area_ratio(self.in_band.rms_slope))


def analyse_surface(
    surface: HeightMap | LineProfile,
    *,
    negative_replica: bool = False,
    trend: Trend | None = None,
    undefined: Undefined = "fill",
    undefined_height: float | None = None,
    without_spikes: bool = False,
    window: Window | None = None,
    bins_per_decade: int | None = None,
    tip_radius: float | None = None,
    resolution: float | None = None,
    band: tuple[float, float] | None = None,
    source: str = "",
) -> SurfaceAnalysis:
    """Prepare a surface and compute its isotropic spectrum, its own numbers beside those of the spectrum, and its anisotropy.

    In this order: saturated areas looked for, replica inverted, rectangle without undefined pixels (or they are filled after the
    trend is gone), spikes looked for, trend removed, window, spectrum (Eq. 1 of the paper), band. Each step is one function of
    `skinbayes.topography`.

    Parameters
    ----------
    surface : map or line as it was read, heights in m
    negative_replica : whether heights are those of a negative cast
    trend : ``"none"``, ``"tilt"`` or ``"curvature"``; tilt and curvature if omitted, none of a periodic surface
    undefined : ``"fill"`` fills up to 10 % of the pixels, ``"rectangle"`` keeps the largest rectangle, or longest part of
        a line, without them
    undefined_height : height that marks undefined pixels in the file, m; none if omitted
    without_spikes : whether spikes become undefined pixels
    window : ``"hann"``, ``"blackman"`` or ``"none"``; Hann's if omitted, none of a periodic surface
    bins_per_decade : of wavevectors, dimensionless; 16 of a map and 10 of a line if omitted
    tip_radius : of a stylus or probe, m
    resolution : shortest wavelength that the instrument passes, m
    band : wavevectors between which the spectrum is used, 1/m; `reliable_band` if omitted
    source : where the surface is from, for people

    Returns
    -------
    analysis : `SurfaceAnalysis`

    Raises
    ------
    InputError
        if there is no roughness, a height that seems to mark undefined pixels, more of these than can be filled, or no reliable
        wavevector

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, Sect. 3, doi 10.1007/s11249-012-0053-2;
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> import numpy as np
    >>> x, y = np.arange(200.0), np.arange(100.0)[:, None]
    >>> wavy = HeightMap(1e-6 * (np.sin(x / 2) + np.sin(y / 2) + x), pixel_size_x=1e-6, pixel_size_y=1e-6)
    >>> found = analyse_surface(wavy)
    >>> found.surface.steps
    ('tilt and curvature removed by least squares: 100 % of the variance',)
    >>> print(f"{1e6 * found.own.rms_height:.2f} µm, of the spectrum {1e6 * found.whole.rms_height:.2f} µm")
    1.00 µm, of the spectrum 1.00 µm
    """
    extent = float(np.nanmax(surface.height) - np.nanmin(surface.height))
    if extent == 0:
        raise InputError("all heights are the same: there is no roughness")
    if undefined_height is not None:
        surface = undefined_at(surface, undefined_height)
    plateaus = find_plateaus(surface)
    refuse_marks(surface, plateaus)
    lacking = undefined_share(surface)
    if negative_replica:
        surface = invert_replica(surface)
    if undefined == "rectangle" and lacking:
        surface = largest_defined_part(surface)
    spiky = find_spikes(surface)
    if without_spikes:
        surface = remove_spikes(surface)
    trend = ("none" if surface.periodic else "curvature") if trend is None else trend
    surface = remove_trend(surface, trend)
    own = surface_numbers(surface)
    spike_share = _share_of_slope(surface, spiky, own)
    if not own.rms_height > 1e-9 * extent or not own.rms_slope:
        raise InputError("nothing is left when the trend is gone: there is no roughness")
    surface = fill_undefined(surface)
    limits = reliable_band(surface, tip_radius=tip_radius, resolution=resolution)
    if band is not None:
        limits = _asked_band(band)
    if window is None:
        window = (
            usual_window(surface)
            if isinstance(surface, HeightMap)
            else "none"
            if surface.periodic
            else "hann"
        )
    if isinstance(surface, HeightMap):
        per_decade = bins_per_decade or BINS_PER_DECADE
        periodogram = map_periodogram(surface, window)
        spectrum = spectrum_of(periodogram, limits, per_decade, source)
        used = spectrum.wavevector[spectrum.reliable]
        low, high = (used[0], used[-1]) if used.size else (limits.wavevector_min, limits.wavevector_max)
        whole = spectrum_numbers(periodogram)
        inside = spectrum_numbers(periodogram, wavevector_min=low, wavevector_max=high)
        directions = directional_spectrum_of(periodogram, per_decade, low, high)
        angles = (np.arange(48) + 0.5) * np.pi / 96
        q = spectrum.wavevector[:, None]
        waves = trend_share(
            q * np.cos(angles), q * np.sin(angles), size_x=surface.size_x, size_y=surface.size_y, trend=trend
        )
        share = np.broadcast_to(waves, (q.size, angles.size)).mean(axis=1)
    else:
        profile = line_spectrum(
            surface, window=window, bins_per_decade=bins_per_decade or LINE_BINS_PER_DECADE, band=limits
        )
        spectrum = isotropic_spectrum(profile, source)
        if spectrum.wavevector_min > limits.wavevector_min:
            limits = limits._replace(
                wavevector_min=spectrum.wavevector_min, lower="where a line begins to tell C"
            )
        whole, directions = SpectrumNumbers(float("nan"), float("nan")), None
        table = spectrum.tabulated()
        inside = SpectrumNumbers(float(rms_height(table)), float(rms_slope(table)))
        share = trend_share(spectrum.wavevector, size_x=surface.size, trend=trend)
    return SurfaceAnalysis(
        surface=surface,
        undefined=lacking,
        spikes=int(spiky.sum()),
        spike_share=spike_share,
        plateaus=plateaus,
        own=own,
        window=window,
        spectrum=spectrum,
        whole=whole,
        in_band=inside,
        band=limits,
        trend_share=np.asarray(share),
        anisotropy=directions,
    )


def _share_of_slope(surface: HeightMap | LineProfile, spiky: BoolArray, own: SurfaceNumbers) -> float:
    """Share of the mean square slope beside pixels that stand out."""
    spiky = spiky & ~np.isnan(surface.height)
    if not spiky.any() or not own.rms_slope:
        return 0.0
    without = surface_numbers(replace(surface, height=np.where(spiky, np.nan, surface.height)))
    return float(max(0.0, 1 - (without.rms_slope / own.rms_slope) ** 2))


def _asked_band(band: tuple[float, float]) -> Band:
    if not 0 < band[0] < band[1] < np.inf:
        raise InputError(
            f"band: found {band[0]:g} to {band[1]:g} 1/m; expected two wavevectors > 0 that increase"
        )
    return Band(float(band[0]), float(band[1]), "as asked for", "as asked for")
