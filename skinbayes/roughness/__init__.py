"""Surface roughness: power spectra, their moments, and the named surfaces."""

from skinbayes.roughness.conventions import CONVENTIONS, Convention
from skinbayes.roughness.moments import rms_height, rms_slope, spectral_moment, total_area_ratio
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum, SlopeQuadrature
from skinbayes.roughness.summed import SummedSpectrum
from skinbayes.roughness.surfaces import SURFACES, NamedSurface, named_surface
from skinbayes.roughness.tabulated import TabulatedSpectrum
from skinbayes.roughness.validation import validate_spectrum

__all__ = [
    "CONVENTIONS",
    "SURFACES",
    "Convention",
    "NamedSurface",
    "PowerSpectrum",
    "SelfAffineSpectrum",
    "SlopeQuadrature",
    "SummedSpectrum",
    "TabulatedSpectrum",
    "named_surface",
    "rms_height",
    "rms_slope",
    "spectral_moment",
    "total_area_ratio",
    "validate_spectrum",
]
