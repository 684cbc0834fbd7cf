"""The roughness between two surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.roughness._fields import Floats
from skinbayes.roughness.spectrum import PowerSpectrum, SlopeQuadrature


@dataclass(frozen=True, eq=False)
class SummedSpectrum:
    """The spectrum of the gap between two rough surfaces that know nothing of each other, ``C(q) = C1(q) + C2(q)``.

    A contact depends on the difference of heights alone, whose spectrum (Eq. 1 of the paper for each) is the sum where
    heights of one surface are not correlated with those of the other. Holds for surfaces that were made independently; not
    for one pressed into, cast from, or worn against the other.

    Attributes
    ----------
    first, second : power spectra, C in m^4; they broadcast

    References
    ----------
    Greenwood & Tripp, Proc. Inst. Mech. Eng. 185 (1970) 625, doi 10.1243/PIME_PROC_1970_185_069_02.

    Examples
    --------
    >>> from skinbayes.roughness import named_surface, rms_height
    >>> skin = named_surface("paper_reference")
    >>> print(f"{rms_height(SummedSpectrum(skin, skin)) / rms_height(skin):.4f}")
    1.4142
    """

    first: PowerSpectrum
    second: PowerSpectrum

    @property
    def wavevector_min(self) -> Floats:
        """Smallest wavevector of either, 1/m."""
        return np.minimum(self.first.wavevector_min, self.second.wavevector_min)

    @property
    def wavevector_max(self) -> Floats:
        """Largest wavevector of either, 1/m."""
        return np.maximum(self.first.wavevector_max, self.second.wavevector_max)

    def power(self, wavevector: ArrayLike) -> FloatArray:
        """C1 + C2, m^4, at ``wavevector`` (1/m), shape ``(K,)`` or ``(..., K)``; zero outside both bands."""
        return np.asarray(self.first.power(wavevector) + self.second.power(wavevector))[()]

    def partial_moment(self, exponent: float) -> FloatArray:
        """``∫ q^exponent C(q) dq`` over both bands, m^(3 − exponent), batch shape."""
        return np.asarray(self.first.partial_moment(exponent) + self.second.partial_moment(exponent))[()]

    def slope_quadrature(self, saturation: Floats, wavevector: FloatArray | None = None) -> SlopeQuadrature:
        """A rule for ``∫ q³ C f dq``: the nodes of one spectrum after those of the other.

        Parameters
        ----------
        saturation : 1/m, broadcasts with the batch; f = 1 above it
        wavevector : upper ends, 1/m, shape ``(..., K)``; None for the full band

        Returns
        -------
        rule : see `SlopeQuadrature`
        """
        rules = [one.slope_quadrature(saturation, wavevector) for one in (self.first, self.second)]
        shapes = [np.broadcast_shapes(rule.nodes.shape[:-1], rule.weights.shape[:-1]) for rule in rules]
        shape = np.broadcast_shapes(*shapes)

        def joined(which: int) -> FloatArray:
            parts = (np.broadcast_to(rule[which], (*shape, rule[which].shape[-1])) for rule in rules)
            return np.concatenate(list(parts), axis=-1)

        return SlopeQuadrature(joined(0), joined(1), rules[0].remainder + rules[1].remainder)
