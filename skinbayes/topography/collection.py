"""Several measured surfaces, or spectra, together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from skinbayes.roughness import TabulatedSpectrum, rms_height, rms_slope, total_area_ratio
from skinbayes.topography.analysis import SurfaceAnalysis
from skinbayes.topography.measured_spectrum import MeasuredSpectrum
from skinbayes.topography.merging import MergedSpectrum, merge_spectra


@dataclass(frozen=True, kw_only=True, eq=False)
class MeasuredSurface:
    """One file: a surface with its analysis, or a spectrum that was computed elsewhere.

    Attributes
    ----------
    name : for people
    kind : of file
    spectrum : `MeasuredSpectrum`
    analysis : None of a spectrum computed elsewhere
    """

    name: str
    kind: str
    spectrum: MeasuredSpectrum
    analysis: SurfaceAnalysis | None = None


@dataclass(frozen=True, eq=False)
class SurfaceCollection:
    """Surfaces of one kind, at several places and magnifications.

    Attributes
    ----------
    surfaces : `MeasuredSurface`, one for each file
    """

    surfaces: Sequence[MeasuredSurface]

    @cached_property
    def merged(self) -> MergedSpectrum:
        """All spectra as one; of a single one itself."""
        return merge_spectra([one.spectrum for one in self.surfaces])

    @property
    def spectrum(self) -> MeasuredSpectrum:
        """The spectrum of the only surface, bin by bin as it was measured, or that of all together."""
        return self.surfaces[0].spectrum if len(self.surfaces) == 1 else self.merged.spectrum

    @cached_property
    def tabulated(self) -> TabulatedSpectrum:
        """The same for contact mechanics."""
        return self.spectrum.tabulated()

    def numbers(self) -> dict[str, float]:
        """Rms height (m), rms slope, area ratio and band (1/m) of the spectrum, a power law between bins."""
        table = self.tabulated
        slope = float(rms_slope(table))
        return {
            "rms_height": float(rms_height(table)),
            "rms_slope": slope,
            "area_ratio": float(total_area_ratio(slope)),
            "wavevector_min": float(table.wavevector[0]),
            "wavevector_max": float(table.wavevector[-1]),
        }
