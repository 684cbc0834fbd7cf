"""Flow factors from the statistics of the gaps between rough layered skin and a smooth body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.gaps import gap_distribution
from skinbayes.contact.solid import ElasticSolid
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.errors import InputError
from skinbayes.lubrication.flow_factors import FrictionFactors
from skinbayes.roughness import rms_height
from skinbayes.roughness.spectrum import PowerSpectrum

_GAPS = 300
_ROUNDING = 1e-9  # by which shares may exceed the whole
# over √V; ū falls by decades in the first part and rises in even steps in the second
_PRESSURES = np.concatenate([np.geomspace(0.3, 1e-9, 28), np.geomspace(1e-10, 1e-60, 24)])


class GapFactors(NamedTuple):
    """Flow and friction factors of one distribution of gaps.

    Attributes
    ----------
    pressure_flow : φ_p, dimensionless
    shear_flow : Φ_s, m
    shear_stress : φ_f + φ_fs, that of the smooth surface, dimensionless
    pressure_stress : φ_fp, dimensionless
    """

    pressure_flow: float
    shear_flow: float
    shear_stress: float
    pressure_stress: float


def gap_flow_factors(gap: ArrayLike, probability: ArrayLike) -> GapFactors:
    """Flow and friction factors of an isotropic surface from the statistics of its gaps (Appendix C, Fig. 20).

    Effective-medium theory: regions of gap u conduct like u³ and drag along like u; each is a disk in the medium of all
    others. With ``s = φ_p ū³``: ``⟨2s/(u³ + s)⟩ = 1`` (Bruggeman's condition in two dimensions, contact included),
    ``D = ⟨2s u/(u³ + s)⟩``, ``Φ_s = ū − D``, ``φ_fp = D/ū``, ``φ_f + φ_fs = ū [⟨1/u⟩ + 3⟨u(u − D)/(u³ + s)⟩]``. The drag follows
    from the flow in the frame of the rough surface, where it is steady.

    Parameters
    ----------
    gap : u where the surfaces do not touch, m, > 0, shape ``(K,)``
    probability : fraction of the nominal area with that gap, dimensionless, ≥ 0, shape ``(K,)``; what is missing to 1 is contact

    Returns
    -------
    factors : `GapFactors`; φ_p = 0 and φ_fp = 0 where contact covers half of the area or more, Φ_s = ū then; nan if an
        argument is impossible

    Notes
    -----
    ⟨1/u⟩ grows with the logarithm of the smallest gap, so that φ_f depends weakly on where the gaps are cut. For small
    variations of the gap, ``ε² = ⟨u²⟩/ū² − 1``, the factors are φ_p = 1 − (3/2)ε², Φ_s = (3/2)ε² ū, φ_fp = 1 − (3/2)ε² and
    φ_f + φ_fs = 1 + (5/2)ε², as in perturbation theory.

    References
    ----------
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9.

    Examples
    --------
    Half of the area twice as wide as the other half, by which less flows than through the mean gap:

    >>> print(*(f"{factor:.4g}" for factor in gap_flow_factors([1e-6, 2e-6], [0.5, 0.5])))
    0.8381 2.388e-07 1.279 0.8408
    """
    u, fraction = np.asarray(gap, dtype=np.float64), np.asarray(probability, dtype=np.float64)
    if not (np.isfinite(u) & (u > 0) & (fraction >= 0)).all() or fraction.sum() > 1 + _ROUNDING:
        return GapFactors(np.nan, np.nan, np.nan, np.nan)
    u, fraction = u[fraction > 0], fraction[fraction > 0]
    mean = float(fraction @ u)
    relative = u / mean
    cube, contact = relative**3, 1 - float(fraction.sum())

    def miss(log_s: float) -> float:
        s = np.exp(log_s)
        return float(fraction @ (2 * s / (cube + s))) + 2 * contact - 1

    if contact >= 0.5:
        return GapFactors(0.0, mean, float(fraction @ (1 / relative) + 3 * (fraction @ (1 / relative))), 0.0)
    low, high = np.log(cube.min()) - 40.0, np.log(cube.max()) + 40.0
    s = float(np.exp(brentq(miss, low, high, xtol=1e-13))) if miss(low) < 0 else 0.0
    drag = float(fraction @ (2 * s * relative / (cube + s)))
    stress = float(fraction @ (1 / relative) + 3 * (fraction @ (relative * (relative - drag) / (cube + s))))
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

    def scaled(self, times: float) -> TabulatedFlowFactors:
        """Those of a surface whose heights are ``times`` as large, dimensionless, and its separations with them."""
        factors = (one._replace(shear_flow=one.shear_flow * times) for one in self.factors)
        return TabulatedFlowFactors(self.separation * times, tuple(factors))

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
            shear + shear_slope,  # no slope beyond the ends, ū is the place elsewhere
        )

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""
        value = self._at(separation)[0]
        return FrictionFactors(value[..., 2], value[..., 3])


def tabulated_flow_factors(
    spectrum: PowerSpectrum,
    skin: ElasticSolid,
    *,
    area_correction: float = AREA_CORRECTION,
    smallest_gap: float | None = None,
) -> TabulatedFlowFactors:
    """Flow and friction factors of a rough layered surface at all separations (Appendix C of the paper, Fig. 20).

    Takes the gaps of `skinbayes.contact.gap_distribution` at 52 pressures through `gap_flow_factors`.

    Parameters
    ----------
    spectrum : power spectrum, C in m^4, one surface
    skin : moduli in Pa, thickness in m, one skin
    area_correction : γ, dimensionless, 0 < γ ≤ 1
    smallest_gap : gaps below count as contact, m, > 0; None for a hundredth of the rms height, as Patir and Cheng have it

    Returns
    -------
    factors : `TabulatedFlowFactors` over ū in m, from ten times the smallest gap to where the surfaces are as good as smooth

    Raises
    ------
    InputError
        if a parameter is impossible, or hardly a gap is wider than ten times the smallest

    References
    ----------
    Persson & Scaraggi, Eur. Phys. J. E 34 (2011) 113, doi 10.1140/epje/i2011-11113-9.

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> factors = tabulated_flow_factors(named_surface("paper_reference"),
    ...     LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6))
    >>> print(factors.flow(np.array([14e-6]))[0].round(2))
    [0.73]
    """
    least = float(rms_height(spectrum)) / 100 if smallest_gap is None else smallest_gap
    scale = float(np.sqrt(twice_stress_variance(spectrum, skin)))
    gaps = gap_distribution(_PRESSURES * scale, spectrum, skin=skin, area_correction=area_correction)
    mean = np.asarray(gaps.mean)
    widest = float((gaps.location + 6 * gaps.width).max())
    kept = np.flatnonzero((mean > 10 * least) & np.isfinite(mean))
    if not least > 0 or kept.size < 2:
        raise InputError(
            f"Flow factors need skin and roughness that are possible, and gaps wider than ten times the smallest, {least:g} m."
        )
    edges = np.geomspace(least, widest, _GAPS)
    fraction, volume = (np.diff(part, axis=-1) for part in (gaps.cumulative(edges), gaps.film(edges)))
    factors = [_of_cells(fraction[place], volume[place]) for place in kept]
    return TabulatedFlowFactors(mean[kept], tuple(factors))


def _of_cells(fraction: FloatArray, volume: FloatArray) -> GapFactors:
    """Factors of gaps given as area and volume of narrow classes."""
    filled = fraction > 1e-14
    return gap_flow_factors(volume[filled] / fraction[filled], fraction[filled])
