"""The spectrum of measured surfaces: averages over bins of wavevectors, and how well each is known."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray, floats
from skinbayes.errors import InputError
from skinbayes.roughness import TabulatedSpectrum


@dataclass(frozen=True, eq=False)
class MeasuredSpectrum:
    """An isotropic two-dimensional power spectrum C(q) as it was measured, in the convention of the paper (Eq. 1).

    ``⟨h²⟩ = 2π ∫ q C dq``. Each value is an average of periodogram ordinates, so that it scatters about the true one as a gamma
    variable of shape ``independent_modes`` does: relative standard deviation ``1/sqrt(independent_modes)``.

    Attributes
    ----------
    wavevector : of each bin, 1/m, shape ``(K,)``, strictly increasing
    power_spectral_density : C, m^4, shape ``(K,)``, > 0
    independent_modes : independent ordinates averaged in each bin, dimensionless, shape ``(K,)``; half the degrees of freedom
    wavevector_min : lower end of the reliable band, 1/m
    wavevector_max : upper end of the reliable band, 1/m
    source : where it is from, for people

    Raises
    ------
    InputError
        if the three lists differ in length, values are not finite and > 0, or wavevectors do not increase

    Examples
    --------
    >>> found = MeasuredSpectrum([1e4, 2e4], power_spectral_density=[4e-20, 1e-20], independent_modes=[4.0, 16.0],
    ...     wavevector_min=1e4, wavevector_max=2e4)
    >>> found.relative_standard_error.tolist()
    [0.5, 0.25]
    """

    wavevector: FloatArray
    _: KW_ONLY
    power_spectral_density: FloatArray
    independent_modes: FloatArray
    wavevector_min: float
    wavevector_max: float
    source: str = ""

    def __post_init__(self) -> None:
        names = ("wavevector", "power_spectral_density", "independent_modes")
        for name, values in zip(names, floats(*(getattr(self, name) for name in names)), strict=True):
            if values.ndim != 1 or values.shape != np.shape(self.wavevector) or values.size == 0:
                raise InputError(f"{name} has shape {values.shape}; expected one list as long as wavevector")
            if not (np.isfinite(values) & (values > 0)).all():
                raise InputError(f"{name} holds a value that is not finite and > 0")
            object.__setattr__(self, name, values)
        if (np.diff(self.wavevector) <= 0).any():
            raise InputError("wavevector does not increase from entry to entry")

    @property
    def relative_standard_error(self) -> FloatArray:
        """Standard deviation of C over C from the finite number of modes, dimensionless, shape ``(K,)``."""
        return np.asarray(1 / np.sqrt(self.independent_modes))

    @property
    def reliable(self) -> BoolArray:
        """Which bins lie in the reliable band, shape ``(K,)``."""
        return (self.wavevector >= self.wavevector_min) & (self.wavevector <= self.wavevector_max)

    def tabulated(self) -> TabulatedSpectrum:
        """The reliable bins as a spectrum for contact mechanics, a power law between them, C in m^4.

        Raises
        ------
        InputError
            if fewer than two bins are reliable
        """
        used = self.reliable
        if np.count_nonzero(used) < 2:
            raise InputError(
                f"{self.source + ': ' if self.source else ''}{np.count_nonzero(used)} bins between {self.wavevector_min:.3g} and "
                f"{self.wavevector_max:.3g} 1/m; expected at least 2 of those from {self.wavevector[0]:.3g} to "
                f"{self.wavevector[-1]:.3g} 1/m"
            )
        return TabulatedSpectrum(self.wavevector[used], self.power_spectral_density[used])
