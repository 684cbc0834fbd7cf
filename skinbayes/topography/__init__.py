"""Measured surfaces: height maps and line profiles, and the power spectra that they have; synthetic surfaces."""

from skinbayes.topography.height_map import HeightMap, LineProfile
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.ridges import MeasuredRidges, measure_ridges
from skinbayes.topography.synthesis import Anisotropy, Ridges, random_surface

__all__ = ["Anisotropy", "HeightMap", "LineProfile", "MeasuredRidges", "MeasuredSpectrum", "Ridges", "measure_ridges",
           "random_surface"]  # fmt: skip
