"""What roughness does to the flow between two surfaces, averaged over it: flow factors and friction factors.

The rough surface is the skin, which moves at v past the smooth body at rest. The averaged flow per width is
``q = −φ_p ū³/(12η) p′ + (v/2)(ū + Φ_s)``; the fluid drags the body with ``∫ [(φ_f − φ_fs) ηv/ū + (1 − φ_fp/2) ū p′] dx``:
shear stress of its surface, and the pressure on its slope integrated by parts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from skinbayes.arrays import ArrayLike, FloatArray


class FrictionFactors(NamedTuple):
    """Factors of the frictional shear stress, dimensionless, each of the shape of the separation.

    Attributes
    ----------
    shear : φ_f, dimensionless
    shear_difference : φ_fs, dimensionless
    pressure : φ_fp, dimensionless
    """

    shear: FloatArray
    shear_difference: FloatArray
    pressure: FloatArray


class FlowFactors(Protocol):
    """What the film solver asks about the flow between rough surfaces."""

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""


@dataclass(frozen=True)
class TrivialFlowFactors:
    """Smooth surfaces: φ_p = 1, φ_s = 0, φ_f = φ_fp = 1, φ_fs = 0 (Appendix C of the paper)."""

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""
        zero = np.zeros_like(separation)
        return np.ones_like(separation), zero, zero, zero

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""
        one = np.ones_like(separation)
        return FrictionFactors(one, np.zeros_like(separation), one)


@dataclass(frozen=True)
class PatirCheng:
    """Fits of Patir and Cheng to computed flow between isotropic Gaussian surfaces, of which one is smooth.

    With H = ū/h_rms: ``φ_p = 1 − 0.90 exp(−0.56 H)``; ``Φ_s = h_rms 1.899 H^0.98 exp(−0.92 H + 0.05 H²)`` up to H = 5 and
    ``1.126 exp(−0.25 H)`` beyond; ``φ_fs = 11.1 H^2.31 exp(−2.38 H + 0.11 H²)`` up to H = 7 and 0 beyond;
    ``φ_fp = 1 − 1.40 exp(−0.66 H)``. ū is the separation of the undeformed mean planes in the sources; here it is the mean
    gap. φ_f = 1: its closed form depends on a smallest gap that is a matter of choice.

    The two branches of Φ_s differ by 6e-5 at H = 5, those of φ_fs by 1e-2 at H = 7.

    Attributes
    ----------
    rms_height : h_rms of the undeformed surface, m, > 0

    References
    ----------
    Patir & Cheng, J. Lubr. Technol. 100 (1978) 12, doi 10.1115/1.3453177 (pressure flow).
    Patir & Cheng, J. Lubr. Technol. 101 (1979) 220, doi 10.1115/1.3453329 (shear flow and friction).

    Examples
    --------
    >>> import numpy as np
    >>> print(PatirCheng(22.4e-6).flow(np.array([14e-6]))[0].round(3))
    [0.366]
    """

    rms_height: float

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""
        ratio = np.maximum(separation / self.rms_height, 1e-12)
        lost = 0.90 * np.exp(-0.56 * ratio)
        near = np.minimum(ratio, 5.0)
        close = 1.899 * near**0.98 * np.exp(-0.92 * near + 0.05 * near * near)
        far = 1.126 * np.exp(-0.25 * ratio)
        is_close = ratio <= 5.0
        drag = np.where(is_close, close, far)
        slope = np.where(is_close, close * (0.98 / near - 0.92 + 0.1 * near), -0.25 * far)
        return 1 - lost, 0.56 * lost / self.rms_height, drag * self.rms_height, slope

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""
        ratio = np.maximum(separation / self.rms_height, 1e-12)
        near = np.minimum(ratio, 7.0)
        difference = np.where(
            ratio <= 7.0, 11.1 * near**2.31 * np.exp(-2.38 * near + 0.11 * near * near), 0.0
        )
        return FrictionFactors(np.ones_like(ratio), difference, 1 - 1.40 * np.exp(-0.66 * ratio))


class GapFactors(NamedTuple):
    """Flow and friction factors of one distribution of gaps.

    Attributes
    ----------
    pressure_flow : φ_p, dimensionless
    shear_flow : Φ_s, m
    shear_stress : φ_f − φ_fs, that of the smooth surface, dimensionless
    pressure_stress : φ_fp, dimensionless
    """

    pressure_flow: float
    shear_flow: float
    shear_stress: float
    pressure_stress: float


def gap_flow_factors(gap: ArrayLike, probability: ArrayLike) -> GapFactors:
    """Flow and friction factors of an isotropic surface from the statistics of its gaps, by effective-medium theory.

    Regions of gap u conduct like u³ and drag along like u; each is a disk in the medium of all others. With
    ``s = φ_p ū³``: ``⟨2s/(u³ + s)⟩ = 1`` (Bruggeman's condition in two dimensions), ``D = ⟨2s u/(u³ + s)⟩``,
    ``Φ_s = ū − D``, ``φ_fp = D/ū``, ``φ_f − φ_fs = ū [⟨1/u⟩ + 3⟨u(u − D)/(u³ + s)⟩]``. The drag follows from the flow in
    the frame of the rough surface, where it is steady.

    Parameters
    ----------
    gap : u where the surfaces do not touch, m, > 0, shape ``(K,)``
    probability : share of the nominal area with that gap, dimensionless, shape ``(K,)``; what is missing to 1 is contact

    Returns
    -------
    factors : `GapFactors`; φ_p = 0 and φ_fp = 0 where contact covers half of the area or more, Φ_s = ū then

    Notes
    -----
    ⟨1/u⟩ grows with the logarithm of the smallest gap, so that φ_f depends weakly on where the gaps are cut.

    References
    ----------
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9 (Sect. 3).

    Examples
    --------
    Half of the area twice as wide as the other half, by which less flows than through the mean gap:

    >>> print(*(f"{factor:.4g}" for factor in gap_flow_factors([1e-6, 2e-6], [0.5, 0.5])))
    0.8381 2.388e-07 1.279 0.8408
    """
    u, share = np.asarray(gap, dtype=np.float64), np.asarray(probability, dtype=np.float64)
    mean = float(share @ u)
    relative = u / mean
    cube = relative**3

    def miss(log_s: float) -> float:
        s = np.exp(log_s)
        return float(share @ (2 * s / (cube + s))) - 1

    if share.sum() <= 0.5:
        return GapFactors(0.0, mean, float(share @ (1 / relative) + 3 * (share @ (1 / relative))), 0.0)
    low, high = np.log(cube.min()) - 40.0, np.log(cube.max()) + 40.0
    s = float(np.exp(brentq(miss, low, high, xtol=1e-13))) if miss(low) < 0 else 0.0
    drag = float(share @ (2 * s * relative / (cube + s)))
    stress = float(share @ (1 / relative) + 3 * (share @ (relative * (relative - drag) / (cube + s))))
    return GapFactors(s, (1 - drag) * mean, stress, drag)


@dataclass(frozen=True, eq=False)
class TabulatedFlowFactors:
    """Flow factors between computed points: monotone cubics over ln ū, constant beyond the ends.

    Attributes
    ----------
    separation : ū of the points, m, rising, shape ``(M,)``
    factors : one `GapFactors` a point

    Notes
    -----
    Φ_s is interpolated as Φ_s/ū. The last point should lie where the factors are those of smooth surfaces.
    """

    separation: FloatArray
    factors: tuple[GapFactors, ...]

    def __post_init__(self) -> None:
        place = np.asarray(self.separation, dtype=np.float64)
        table = np.array(self.factors)
        table[:, 1] /= place
        object.__setattr__(self, "separation", place)
        object.__setattr__(self, "_curves", PchipInterpolator(np.log(place), table))
        object.__setattr__(self, "_slopes", PchipInterpolator(np.log(place), table).derivative())

    def _at(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        inside = (separation > self.separation[0]) & (separation < self.separation[-1])
        place = np.log(np.clip(separation, self.separation[0], self.separation[-1]))
        slopes = self._slopes(place)  # type: ignore[attr-defined]
        return self._curves(place), np.where(inside[..., None], slopes, 0.0), np.exp(place)  # type: ignore[attr-defined]

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""
        value, slope, place = self._at(separation)
        shear, shear_slope = value[..., 1], slope[..., 1]
        return (
            value[..., 0],
            slope[..., 0] / place,
            shear * separation,
            shear + shear_slope * separation / place,
        )

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m; φ_f stands for φ_f − φ_fs, the other is 0."""
        value = self._at(separation)[0]
        return FrictionFactors(value[..., 2], np.zeros_like(separation), value[..., 3])
