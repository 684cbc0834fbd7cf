"""Distribution of the gap between rough layered skin and a smooth countersurface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.special import erf

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact._rows import as_rows, blocks
from skinbayes.contact.correction import AREA_CORRECTION
from skinbayes.contact.gap_cells import resolve_gaps
from skinbayes.contact.separation import mean_separation
from skinbayes.contact.solid import ElasticSolid
from skinbayes.errors import InputError
from skinbayes.roughness._fields import with_axes
from skinbayes.roughness.spectrum import PowerSpectrum

CLOSURES = ("gaussian", "sharp")
"""What stands for the gaps that close at one magnification, see `gap_distribution`."""

_CAP = 2.5  # largest u₁ in units of ū
_SHARPNESS = 4  # of the bend towards the cap
_NARROWEST = 1e-300  # m


@dataclass(frozen=True, eq=False, kw_only=True)
class GapDistribution:
    """Distribution of the gap u between rough solid and countersurface over the nominal area.

    Real contact has u = 0 and is part of the distribution: ``P(u) = (A/A0) δ(u) + Σ_k weight_k N_k(u)``, where
    N_k is the Gaussian of mean ``location`` and standard deviation ``width`` folded to u ≥ 0. Made by
    `gap_distribution`.

    Attributes
    ----------
    mean : ū, m, the value of `mean_separation`, shape ``S``
    contact_fraction : A/A0, dimensionless, shape ``S``
    location, width : m, shape ``S + (n,)``
    weight : fraction of the nominal area, dimensionless, shape ``S + (n,)``; sums to 1 − A/A0

    References
    ----------
    Almqvist, Campana, Prodanov & Persson, J. Mech. Phys. Solids 59 (2011) 2355, doi 10.1016/j.jmps.2011.08.004.

    Examples
    --------
    >>> one_asperity = GapDistribution(mean=np.array(1e-6), contact_fraction=np.array(0.1),
    ...     location=np.array([1e-6 / 0.9]), width=np.array([1e-9]), weight=np.array([0.9]))
    >>> print(f"{one_asperity.cumulative(1e-6):.2f} {one_asperity.cumulative(2e-6):.2f}")
    0.10 1.00
    """

    mean: FloatArray
    contact_fraction: FloatArray
    location: FloatArray
    width: FloatArray
    weight: FloatArray

    def cumulative(self, gap: ArrayLike) -> FloatArray:
        """Share F(d) of the nominal area where the gap is at most d, real contact included.

        F(0) = A/A0 and F(∞) = 1.

        Parameters
        ----------
        gap : d, m, ≥ 0, shape ``(D,)`` or ``(..., D)``, or a scalar

        Returns
        -------
        fraction : dimensionless, shape ``S``, plus the axis of ``gap`` if it has one; nan for a negative gap
        """
        return self._over(gap, _fraction) + with_axes(self.contact_fraction, min(np.ndim(gap), 1))

    def film(self, gap: ArrayLike) -> FloatArray:
        """Volume per nominal area between the surfaces where the gap is at most d, ``∫_0^d u P(u) du``.

        The mean thickness of a liquid that fills all gaps up to d; film(∞) = ū.

        Parameters
        ----------
        gap : d, m, ≥ 0, shape ``(D,)`` or ``(..., D)``, or a scalar

        Returns
        -------
        film : m, shape ``S``, plus the axis of ``gap`` if it has one; nan for a negative gap
        """
        return self._over(gap, _volume)

    def mean_below(self, gap: ArrayLike) -> FloatArray:
        """Mean gap of the region out of contact where the gap is at most d, film over area (Fig. 10 of the paper).

        Parameters
        ----------
        gap : d, m, ≥ 0, shape ``(D,)`` or ``(..., D)``, or a scalar

        Returns
        -------
        mean_gap : m, shape ``S``, plus the axis of ``gap`` if it has one; d/2 for small d, ū/(1 − A/A0) for
            d = inf; nan for a gap that is not positive
        """
        with np.errstate(all="ignore"):
            return np.asarray(self.film(gap) / self._over(gap, _fraction))[()]

    def _over(self, gap: ArrayLike, part: Callable[..., FloatArray]) -> FloatArray:
        """Σ weight · ``part`` at each gap."""
        found = np.asarray(gap, dtype=np.float64)
        with np.errstate(all="ignore"):
            gaps = np.atleast_1d(np.where(found >= 0, found, np.nan))
            batch = np.broadcast_shapes(self.location.shape[:-1], gaps.shape[:-1])
            location, width, weight = (
                as_rows(x, batch)[:, None] for x in (self.location, self.width, self.weight)
            )
            gaps = as_rows(gaps, batch)
            total = np.empty_like(gaps)
            for rows, columns in blocks(len(gaps), gaps.shape[-1], weight.shape[-1]):
                values = part(gaps[rows, columns, None], location[rows], np.sqrt(2) * width[rows])
                total[rows, columns] = (weight[rows] * values).sum(axis=-1)
            return total.reshape(*batch, gaps.shape[-1]) if found.ndim else total.reshape(batch)[()]


def _fraction(gap: FloatArray, location: FloatArray, spread: FloatArray) -> FloatArray:
    """Fraction of a folded Gaussian below ``gap``; spread is √2 times the standard deviation."""
    return (erf((gap - location) / spread) + erf((gap + location) / spread)) / 2


def _volume(gap: FloatArray | float, location: FloatArray, spread: FloatArray) -> FloatArray:
    """First moment of a folded Gaussian below ``gap``."""
    low, high, place = (gap - location) / spread, (gap + location) / spread, location / spread
    shift = location / 2 * (erf(low) - erf(high) + 2 * erf(place))
    bells = 2 * np.exp(-np.square(place)) - np.exp(-np.square(low)) - np.exp(-np.square(high))
    return shift + spread / (2 * np.sqrt(np.pi)) * bells


def gap_distribution(
    nominal_pressure: ArrayLike,
    spectrum: PowerSpectrum,
    *,
    skin: ElasticSolid,
    area_correction: ArrayLike = AREA_CORRECTION,
    closure: Literal["gaussian", "sharp"] = "gaussian",
) -> GapDistribution:
    """Distribution of the gap of rough layered skin pressed against a smooth solid (Sect. 5 of the paper).

    As the magnification ζ grows, area that looked like contact opens: between ζ and ζ + dζ the fraction −A′(ζ)dζ. Its mean
    gap follows from the separation of what still touches, ``u₁ = d(A ū)/dA``, taken as Δ(A ū)/ΔA between
    nodes. ū(ζ) is `mean_separation` under the pressure p/A(ζ) with twice the stress variance, V(q) − V(ζ) of what is
    smaller. About u₁ the gap scatters with the roughness above ζ, so that

    ``P(u) = (A/A0) δ(u) + ∫ (−A′) [N(u − u₁) + N(u + u₁)] dζ``, N of variance ``2π ∫_{ζ q0}^{q1} q C dq``.

    Gaps are finally scaled by one factor (0.84 to 1.03 in what was looked at) so that their mean is ū exactly. The
    alternative closure puts all of it at u₁, as the paper seems to do.

    Parameters
    ----------
    nominal_pressure : p, Pa, > 0, shape ``(K,)`` or ``(..., K)``, or a scalar
    spectrum : power spectrum, C in m^4, scalar or batched
    skin : moduli in Pa, thickness in m; broadcasts with the spectrum
    area_correction : γ of ū and of A(ζ), dimensionless, 0 < γ ≤ 1, batch shape; 1 is plain Persson theory
    closure : ``"gaussian"``, or ``"sharp"`` for all of the gap at u₁ (with the width of the spacing of nodes)

    Returns
    -------
    gaps : `GapDistribution`, shape ``S`` the batch shape, plus the axis of ``nominal_pressure`` if it has one; nan
        where a parameter is impossible

    Raises
    ------
    InputError
        if there is no such closure

    Notes
    -----
    At small ζ, where A ≈ 1, u₁ has no meaning: Δ(A ū) falls slower than ΔA. There u₁ bends smoothly towards
    2.5 ū, with which 2 or 3.5 agree within 0.003 in F.

    F(d) of 40 cells is within 5e-4 (median) and 6e-3 (all of 180 random states of skin) of that of 150 cells; the fraction
    out of contact below d = ū/100 within 4 %. The delta form has steps and is good to 0.01, at its steps 0.1.

    Against boundary elements (half-space, p/(E* slope) from 0.003 to 0.3; layered skin, 2 to 30 kPa, q1 = 1.3e5 1/m)
    F as a function of d/ū is within 0.025 and 0.01; the delta form is off by 0.09 to 0.29. ū itself is
    5 to 8 % too large on a half-space; for layered skin it is 2 % (30 kPa) to 21 % (2 kPa) too large.

    References
    ----------
    Almqvist, Campana, Prodanov & Persson, J. Mech. Phys. Solids 59 (2011) 2355, doi 10.1016/j.jmps.2011.08.004.
    Yang & Persson, J. Phys.: Condens. Matter 20 (2008) 215214, doi 10.1088/0953-8984/20/21/215214.

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> wet = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> gaps = gap_distribution(6830.0, named_surface("paper_reference"), skin=wet)
    >>> print(f"{gaps.cumulative(10e-6):.4f} {gaps.film(10e-6):.3e} {gaps.mean:.4e}")
    0.3423 2.076e-06 1.3524e-05
    """
    if closure not in CLOSURES:
        raise InputError(f"closure is {closure!r}, but must be one of {', '.join(map(repr, CLOSURES))}.")
    pressure = np.asarray(nominal_pressure, dtype=np.float64)
    gamma = np.asarray(area_correction, dtype=np.float64)
    with np.errstate(all="ignore"):
        possible = np.atleast_1d(np.where(pressure > 0, pressure, np.nan))
        mean = mean_separation(possible, spectrum, skin=skin, area_correction=gamma)
        cells = resolve_gaps(possible, spectrum, skin, gamma)
        weight = -np.diff(cells.area)
        volume = -np.diff(cells.area * cells.separation) / np.maximum(mean, 1e-300)[..., None]
        bent = weight**_SHARPNESS + (volume / _CAP) ** _SHARPNESS + 1e-300
        location = mean[..., None] * np.abs(volume) / bent ** (1 / _SHARPNESS)
        if closure == "gaussian":
            height = np.sqrt(cells.mean_square)[..., None, :]
            width = (height[..., 1:] + height[..., :-1]) / 2  # the average 1/h where h² falls linearly
        else:
            width = _spacing(location)
        # gaps of 0 have no width, and 0/0 no value
        width = np.maximum(np.broadcast_to(width, location.shape), _NARROWEST)
        own = _volume(np.inf, location, np.sqrt(2) * width)
        scale = (mean / np.maximum((weight * own).sum(axis=-1), 1e-300))[..., None]
        one = () if pressure.ndim else (0,)
        return GapDistribution(
            mean=mean[(..., *one)][()],
            contact_fraction=cells.area[..., -1][(..., *one)][()],
            **{
                name: value[(..., *one, slice(None))]
                for name, value in (
                    ("location", scale * location),
                    ("width", np.maximum(scale * width, _NARROWEST)),
                    ("weight", weight),
                )
            },
        )


def _spacing(location: FloatArray) -> FloatArray:
    """Width that just closes the spaces between neighbouring locations, at least 3 % of the location."""
    step = np.square(np.diff(location))
    padded = np.concatenate([step[..., :1], step, step[..., -1:]], axis=-1)
    return np.sqrt(0.08 * (padded[..., 1:] + padded[..., :-1]) + np.square(0.03 * location))
