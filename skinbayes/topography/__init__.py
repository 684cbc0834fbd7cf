"""Measured surfaces: height maps and line profiles, and the power spectra that they have; synthetic surfaces."""

from skinbayes.topography.analysis import SurfaceAnalysis, analyse_surface
from skinbayes.topography.area_spectrum import area_spectrum
from skinbayes.topography.artefacts import (
    Plateau,
    find_plateaus,
    find_spikes,
    invert_replica,
    remove_spikes,
)
from skinbayes.topography.band import Band, reliable_band
from skinbayes.topography.collection import MeasuredSurface, SurfaceCollection
from skinbayes.topography.directional_spectrum import DirectionalSpectrum, directional_spectrum
from skinbayes.topography.height_map import HeightMap, LineProfile
from skinbayes.topography.line_spectrum import ProfileSpectrum, isotropic_spectrum, line_spectrum
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.merging import MergedSpectrum, merge_spectra
from skinbayes.topography.numbers import SurfaceNumbers, surface_numbers
from skinbayes.topography.ridges import MeasuredRidges, measure_ridges
from skinbayes.topography.synthesis import Anisotropy, Ridges, random_surface
from skinbayes.topography.trend import remove_trend
from skinbayes.topography.undefined import fill_undefined, largest_defined_rectangle

__all__ = [
    "Anisotropy",
    "Band",
    "DirectionalSpectrum",
    "HeightMap",
    "LineProfile",
    "MeasuredRidges",
    "MeasuredSpectrum",
    "MeasuredSurface",
    "MergedSpectrum",
    "Plateau",
    "ProfileSpectrum",
    "Ridges",
    "SurfaceAnalysis",
    "SurfaceCollection",
    "SurfaceNumbers",
    "analyse_surface",
    "area_spectrum",
    "directional_spectrum",
    "fill_undefined",
    "find_plateaus",
    "find_spikes",
    "invert_replica",
    "isotropic_spectrum",
    "largest_defined_rectangle",
    "line_spectrum",
    "measure_ridges",
    "merge_spectra",
    "random_surface",
    "reliable_band",
    "remove_spikes",
    "remove_trend",
    "surface_numbers",
]
