"""Measured surfaces: height maps and line profiles, and the power spectra that they have."""

from skinbayes.topography.height_map import HeightMap, LineProfile
from skinbayes.topography.measured_spectrum import MeasuredSpectrum

__all__ = ["HeightMap", "LineProfile", "MeasuredSpectrum"]
