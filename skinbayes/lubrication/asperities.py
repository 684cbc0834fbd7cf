"""Pressure that asperities carry at a given mean separation, as a table the film solver can afford to ask."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.separation import mean_separation
from skinbayes.contact.solid import ElasticSolid
from skinbayes.contact.variance import twice_stress_variance
from skinbayes.errors import InputError
from skinbayes.roughness.spectrum import PowerSpectrum

_COUNT = 160
_LOWEST, _HIGHEST = 1e-14, 2.0  # pressures of the table over √V; below, ū is linear in ln p
_STEEPEST = 300.0  # exponents beyond are cut, so that a wild step of the solver gives a number


class AsperityTable(NamedTuple):
    """Points of p_a against ū.

    Attributes
    ----------
    separation : ū, m, rising, shape ``(..., M)``
    log_pressure : ln p_a, p_a in Pa, falling, shape ``(..., M)``
    """

    separation: FloatArray
    log_pressure: FloatArray


@dataclass(frozen=True, eq=False)
class AsperityLaw:
    """Asperity pressure against mean separation: monotone cubics of ln p between knots, exponential beyond the last.

    Attributes
    ----------
    separation : ū of the knots, m, rising, shape ``(M,)``
    coefficients : of ln p (p in Pa) in powers of ū − knot (m), highest first, shape ``(4, M)``; the last column is the
        exponential tail
    """

    separation: FloatArray
    coefficients: FloatArray

    def __call__(self, separation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Pressure, Pa, and its derivative, Pa/m; below the first knot ln p goes on as a straight line."""
        cell = self.separation.searchsorted(separation, side="right") - 1
        cubic, square, slope, level = self.coefficients[:, np.maximum(cell, 0)]
        offset = separation - self.separation[np.maximum(cell, 0)]
        # no cubic acts beyond the last knot, where ū may be infinite
        above = np.where(cell < self.separation.size - 1, np.maximum(offset, 0.0), 0.0)
        exponent = level + slope * offset + above * above * (square + cubic * above)
        rate = slope + above * (2 * square + 3 * cubic * above)
        pressure = np.exp(np.minimum(exponent, _STEEPEST))
        return pressure, pressure * rate

    def scaled(self, height: float, pressure: float) -> AsperityLaw:
        """The same law in units of ``height`` (m) and ``pressure`` (Pa)."""
        powers = height ** np.arange(3.0, -1.0, -1.0)
        coefficients = self.coefficients * powers[:, None]
        coefficients[3] -= np.log(pressure)
        return AsperityLaw(self.separation / height, coefficients)

    @property
    def decay_length(self) -> float:
        """u0 of the exponential tail, p ∝ exp(−ū/u0), in the unit of the separations (m)."""
        return float(-1 / self.coefficients[2, -1])

    def separation_at(self, pressure: float) -> float:
        """ū, m, at which the asperities carry ``pressure`` (Pa, ≥ 0); 0 if the table ends at a smaller pressure."""
        with np.errstate(all="ignore"):
            wanted, levels = np.log(pressure), self.coefficients[3]
        if wanted <= levels[-1]:
            return float(self.separation[-1] + (wanted - levels[-1]) * -self.decay_length)
        return float(max(np.interp(-wanted, -levels, self.separation, left=0.0), 0.0))


def asperity_law(
    spectrum: PowerSpectrum, skin: ElasticSolid, *, area_correction: ArrayLike = AREA_CORRECTION
) -> AsperityLaw:
    """Asperity law of a rough layered surface, from its mean separation (Sect. 5 and Sect. 6.2 of the paper).

    Tabulates `skinbayes.contact.mean_separation` at 160 pressures from 1e-14 to 2 times √V.

    Parameters
    ----------
    spectrum : power spectrum, C in m^4, one surface
    skin : moduli in Pa, thickness in m, one skin
    area_correction : γ, dimensionless, 0 < γ ≤ 1

    Returns
    -------
    law : `AsperityLaw`, p in Pa against ū in m

    Raises
    ------
    InputError
        if a parameter is impossible, or contact so complete that nothing tells separations apart

    Notes
    -----
    The interpolated pressure differs from the inverted mean separation by less than 2e-4 of itself.

    References
    ----------
    Persson, Phys. Rev. Lett. 99 (2007) 125502, doi 10.1103/PhysRevLett.99.125502.

    Examples
    --------
    >>> import numpy as np
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> law = asperity_law(named_surface("paper_reference"), wet)
    >>> print(law(np.array([14e-6]))[0].round(0))
    [6290.]
    """
    return law_of_table(*asperity_table(spectrum, skin, area_correction=area_correction))


def asperity_table(
    spectrum: PowerSpectrum, skin: ElasticSolid, *, area_correction: ArrayLike = AREA_CORRECTION
) -> AsperityTable:
    """Mean separations and asperity pressures of many surfaces at once (Sect. 5 and Sect. 6.2 of the paper).

    Parameters
    ----------
    spectrum : power spectrum, C in m^4, batch shape
    skin : moduli in Pa, thickness in m, batch shape
    area_correction : γ, dimensionless, 0 < γ ≤ 1, batch shape

    Returns
    -------
    table : `AsperityTable`; nan where a parameter is impossible

    References
    ----------
    Persson, Phys. Rev. Lett. 99 (2007) 125502, doi 10.1103/PhysRevLett.99.125502.

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> table = asperity_table(named_surface("paper_reference"), wet)
    >>> print(table.separation.shape, f"{table.separation[-1]:.2e} m at {np.exp(table.log_pressure[-1]):.0e} Pa")
    (160,) 3.64e-04 m at 2e-07 Pa
    """
    scale = np.log(np.asarray(twice_stress_variance(spectrum, skin))) / 2
    gamma = np.asarray(area_correction, dtype=np.float64)
    batch = np.broadcast_shapes(scale.shape, gamma.shape)
    log_pressure = (
        np.linspace(np.log(_HIGHEST), np.log(_LOWEST), _COUNT) + np.broadcast_to(scale, batch)[..., None]
    )
    separation = np.asarray(mean_separation(np.exp(log_pressure), spectrum, skin=skin, area_correction=gamma))
    return AsperityTable(separation, log_pressure)


def is_lawful(separation: FloatArray, log_pressure: FloatArray) -> bool:
    """Tell whether an asperity law passes through points ū, m, and ln p, p in Pa, each of shape ``(M,)``."""
    points = np.array([separation, -log_pressure])
    return points.shape[-1] > 1 and bool(np.isfinite(points).all() and (np.diff(points) > 0).all())


def law_of_table(separation: FloatArray, log_pressure: FloatArray) -> AsperityLaw:
    """Asperity law through given points, for surfaces of which the separation was measured or computed elsewhere.

    Parameters
    ----------
    separation : ū, m, rising, > 0, shape ``(M,)``
    log_pressure : ln p, p in Pa, falling, shape ``(M,)``; beyond the last point it falls at the slope of the last interval

    Returns
    -------
    law : `AsperityLaw`, p in Pa against ū in m

    Raises
    ------
    InputError
        if there are fewer than two points, or if they are not finite, or not in this order

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 6.2).

    Examples
    --------
    >>> import numpy as np
    >>> u = np.array([1e-6, 2e-6, 4e-6])
    >>> print(law_of_table(u, 10 - u / 1e-6)(np.array([3e-6, 7e-6]))[0].round(3))
    [1096.633   20.086]
    """
    if not is_lawful(separation, log_pressure):
        raise InputError(
            "An asperity law needs at least two finite points, with separations that rise and pressures that fall."
        )
    curve = PchipInterpolator(separation, log_pressure)
    last = (log_pressure[-1] - log_pressure[-2]) / (separation[-1] - separation[-2])
    tail = np.array([[0.0], [0.0], [last], [log_pressure[-1]]])
    return AsperityLaw(np.asarray(separation, dtype=np.float64), np.hstack([curve.c, tail]))
