"""Relative contact area of bodies that yield at a fixed contact stress."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import erf, erfc

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.contact.area import without_load
from skinbayes.contact.correction import AREA_CORRECTION, corrected
from skinbayes.roughness._rules import gauss_unit

_SWITCH = 0.75  # √V/σ_Y from which the Fourier series is used instead of the image sources
_FULLY_PLASTIC = 17.5  # √V/σ_Y from which all terms of the Fourier series are 0 in floating point
_HARMONICS = np.arange(1.0, 9.0)
_ODD_HARMONICS = _HARMONICS[::2]
_IMAGES = np.arange(1.0, 8.0)
_NO_IMAGE = 6.3  # distance of the nearest image, in s, beyond which images are below 1e-16 of erf(r/s)
_SIGNS = (-1.0) ** _IMAGES
_POINTS, _POINT_WEIGHTS = gauss_unit(8)
_HALF_POINTS = 2 * _POINTS[4:] - 1  # the positive half of the symmetric rule
_HALF_WEIGHTS = 2 * _POINT_WEIGHTS[4:]


class ContactArea(NamedTuple):
    """How the nominal area divides into elastic contact, plastic contact and no contact; the three sum to 1.

    Attributes
    ----------
    elastic : A_el/A0, dimensionless
    plastic : A_pl/A0, dimensionless
    non_contact : A_non/A0, dimensionless
    """

    elastic: FloatArray
    plastic: FloatArray
    non_contact: FloatArray

    @property
    def total(self) -> FloatArray:
        """Relative contact area (A_el + A_pl)/A0, dimensionless."""
        return self.elastic + self.plastic

    @property
    def plastic_fraction(self) -> FloatArray:
        """A_pl/(A_el + A_pl), dimensionless; nan where there is no contact."""
        with np.errstate(all="ignore"):
            return np.asarray(self.plastic / self.total)[()]


def elastoplastic_contact_area(
    nominal_pressure: ArrayLike,
    twice_stress_variance: ArrayLike,
    *,
    yield_stress: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
) -> ContactArea:
    """Elastic and plastic contact area of a body that yields at the contact stress σ_Y (Sect. 4 of the paper).

    The stress distribution obeys ``∂P/∂V = ¼ ∂²P/∂σ²``, starts as δ(σ − p0), and is absorbed at 0 (contact
    lost) and at σ_Y (contact that has yielded). With r = p0/σ_Y and s = √V_eff/σ_Y, for s ≥ 0.75 in the
    eigenfunctions of the strip, ``A_el = (2/π) Σ (1 − (−1)^n)/n sin(nπr) exp(−(nπs)²/4)``,
    ``A_pl = r + (2/π) Σ (−1)^n/n sin(nπr) exp(−(nπs)²/4)``; below in image sources,
    ``A_el = erf(r/s) + Σ_k (−1)^k D_k``, ``A_pl = Σ_{k odd} D_k``,
    ``D_k = erfc((k − r)/s) − erfc((k + r)/s)``. For σ_Y = inf it is Eq. 2.

    Parameters
    ----------
    nominal_pressure : p0, Pa, ≥ 0, any shape
    twice_stress_variance : V of `twice_stress_variance`, Pa², ≥ 0, broadcasts
    yield_stress : σ_Y, Pa, > 0, broadcasts; inf is purely elastic. A nominal pressure that reaches σ_Y gives
        full plastic contact, A_pl = A0: the body cannot carry more (and then σ_Y A0 falls short of the load).
    area_correction : γ of `corrected_twice_stress_variance`, dimensionless, 0 < γ ≤ 1, broadcasts; 1 is plain
        theory, which is what the paper has. The corrected V_eff(p0) is that of the elastic problem, so that
        both agree as σ_Y → inf.

    Returns
    -------
    area : `ContactArea`, dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    The elastic and the plastic part each have a relative error below 1e-12 for p0/σ_Y from 1e-12 to 1, as
    long as they are above 1e-280. With γ = 0.42 yielding begins at wavevectors about 20 % larger than in
    plain theory.

    References
    ----------
    Persson, Phys. Rev. Lett. 87 (2001) 116101, doi 10.1103/PhysRevLett.87.116101.

    Examples
    --------
    >>> dry = elastoplastic_contact_area(6830.0, 6.87e18, yield_stress=50e6)
    >>> print(f"{dry.total:.4e} {dry.plastic_fraction:.4f}")
    1.3660e-04 1.0000
    """
    with np.errstate(all="ignore"):
        ratio, spread, reach, shape = _dimensionless(
            *floats(nominal_pressure, twice_stress_variance, yield_stress, area_correction)
        )
        elastic, plastic, non_contact = np.full((3, ratio.size), np.nan)
        yielded = (ratio >= 1) & ~np.isnan(spread)
        # without a yield stress the image sources are at infinity; most skin of interest is of this kind
        unlimited = (ratio == 0) & (spread == 0)
        wide = (ratio < 1) & (spread >= _SWITCH)
        narrow = (ratio < 1) & (spread < _SWITCH) & ~unlimited
        elastic[yielded], plastic[yielded], non_contact[yielded] = 0.0, 1.0, 0.0
        elastic[unlimited], plastic[unlimited], non_contact[unlimited] = (
            erf(reach[unlimited]),
            0.0,
            erfc(reach[unlimited]),
        )
        for mask, parts in ((wide, _fourier), (narrow, _images)):
            if mask.any():
                elastic[mask], plastic[mask], non_contact[mask] = parts(
                    ratio[mask], spread[mask], reach[mask]
                )
        return ContactArea(*(part.reshape(shape)[()] for part in (elastic, plastic, non_contact)))


def total_contact_area(
    nominal_pressure: ArrayLike,
    twice_stress_variance: ArrayLike,
    *,
    yield_stress: ArrayLike,
    area_correction: ArrayLike = AREA_CORRECTION,
) -> FloatArray:
    """Contact area of a body that yields, elastic and plastic together, ``(A_el + A_pl)/A0`` (Sect. 4 of the paper).

    What `elastoplastic_contact_area` gives as ``total``, in a fraction of its time. With r and s as there the two parts
    together are ``r + (2/π) Σ sin(nπr)/n exp(−(nπs)²/4)`` for s ≥ 0.75, and ``erf(r/s) + Σ_{k even} D_k`` below.

    Parameters
    ----------
    nominal_pressure : p0, Pa, ≥ 0, any shape
    twice_stress_variance : V of `twice_stress_variance`, Pa², ≥ 0, broadcasts
    yield_stress : σ_Y, Pa, > 0, broadcasts; inf is purely elastic
    area_correction : γ of `corrected_twice_stress_variance`, dimensionless, 0 < γ ≤ 1, broadcasts

    Returns
    -------
    area : (A_el + A_pl)/A0, dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    Relative error below 1e-12, as that of `elastoplastic_contact_area`.

    References
    ----------
    Persson, Phys. Rev. Lett. 87 (2001) 116101, doi 10.1103/PhysRevLett.87.116101.

    Examples
    --------
    >>> dry, wet = total_contact_area(6830.0, [6.87e18, 3.366e14], yield_stress=50e6)
    >>> print(f"{dry:.4e} {wet:.4e}")
    1.3660e-04 6.4817e-04
    """
    with np.errstate(all="ignore"):
        return total_area(*floats(nominal_pressure, twice_stress_variance, yield_stress, area_correction))


def total_area(pressure: FloatArray, width: FloatArray, limit: FloatArray, gamma: FloatArray) -> FloatArray:
    """`total_contact_area` of arrays; silences no warnings."""
    ratio, spread, reach, shape = _dimensionless(pressure, width, limit, gamma)
    partly, yielded = ratio < 1.0, ratio >= 1.0
    total = np.where(partly, np.where(spread >= _FULLY_PLASTIC, ratio, erf(reach)), np.nan)
    if np.count_nonzero(yielded):
        total[yielded] = np.where(np.isnan(spread[yielded]), np.nan, 1.0)
    # contact of which some yields
    near = partly & (spread < _FULLY_PLASTIC) & (2.0 - ratio < _NO_IMAGE * spread)
    if not np.count_nonzero(near):
        return total.reshape(shape)[()]
    wide = near & (spread >= _SWITCH)
    if np.count_nonzero(wide):
        r, s = ratio[wide], spread[wide]
        decay = np.exp(-np.square(_HARMONICS * (np.pi / 2 * s)[:, None])) / _HARMONICS
        waves = np.sin(np.pi * _HARMONICS * r[:, None]) * decay
        total[wide] = r + 2 / np.pi * waves.sum(axis=-1)
    imaged = near & ~wide
    if np.count_nonzero(imaged):
        r, s, c = ratio[imaged], spread[imaged], reach[imaged]
        total[imaged] += _difference(_IMAGES[1::2], r, s, c, (2 - r) / s).sum(axis=-1)
    return total.reshape(shape)[()]


def _dimensionless(
    pressure: FloatArray, width: FloatArray, limit: FloatArray, gamma: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, tuple[int, ...]]:
    """p0/σ_Y, √V_eff/σ_Y and p0/√V_eff, dimensionless, flat, and the shape they had; silences no warnings."""
    limit = np.where(limit > 0.0, limit, np.nan)
    root = np.sqrt(corrected(pressure, width, gamma))
    spread = root / limit
    flat = [
        (x if x.shape == spread.shape else np.broadcast_to(x, spread.shape)).reshape(-1)
        for x in (pressure / limit, spread, without_load(pressure / root, pressure, root))
    ]
    return flat[0], flat[1], flat[2], spread.shape


def _fourier(
    ratio: FloatArray, spread: FloatArray, reach: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Elastic, plastic, no contact for ``s ≥ 0.75``, each shape ``(M,)``."""
    decay = np.exp(-np.square(_HARMONICS * (np.pi / 2 * spread)[:, None])) / _HARMONICS
    rest = 1 - ratio
    # sin(nπr) for odd n is symmetric about r = 1/2; the smaller argument keeps its relative accuracy
    near = np.minimum(ratio, rest)
    elastic = 4 / np.pi * (np.sin(np.pi * _ODD_HARMONICS * near[:, None]) * decay[:, ::2]).sum(axis=-1)
    plastic = ratio + 2 / np.pi * (_SIGNED * np.sin(np.pi * _HARMONICS * ratio[:, None]) * decay).sum(axis=-1)
    non_contact = rest + 2 / np.pi * (_SIGNED * np.sin(np.pi * _HARMONICS * rest[:, None]) * decay).sum(
        axis=-1
    )
    return elastic, plastic, non_contact


_SIGNED = (-1.0) ** _HARMONICS


def _images(
    ratio: FloatArray, spread: FloatArray, reach: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Elastic, plastic, no contact for ``s < 0.75``, each shape ``(M,)``; ``reach`` is r/s."""
    rest, gap = 1 - ratio, (1 - ratio) / spread
    plastic = _difference(_IMAGES[::2], ratio, spread, reach, gap).sum(axis=-1)
    non_contact = _difference(_IMAGES[::2], rest, spread, gap, reach).sum(axis=-1)
    # staying between the walls is symmetric about r = 1/2; the smaller distance avoids cancellation
    low = ratio <= rest
    near, near_reach, far_gap = np.minimum(ratio, rest), np.where(low, reach, gap), np.where(low, gap, reach)
    terms = _SIGNS * _difference(_IMAGES, near, spread, near_reach, far_gap)
    return erf(near_reach) + terms.sum(axis=-1), plastic, non_contact


def _difference(
    order: FloatArray, ratio: FloatArray, spread: FloatArray, reach: FloatArray, gap: FloatArray
) -> FloatArray:
    """``D_k = erfc((k − r)/s) − erfc((k + r)/s)`` to full relative accuracy, shape ``(M, len(order))``.

    ``reach`` = r/s and ``gap`` = (k − r)/s of the first k are given, as they keep their meaning where s vanishes.
    """
    r, s, half_width = ratio[:, None], spread[:, None], reach[:, None]
    near_end = (order - r) / s
    near_end[:, 0] = gap
    direct = erfc(near_end) - erfc((order + r) / s)
    growth = 2 * (order / s) * half_width
    small = np.flatnonzero(growth <= 1)
    if small.size:
        # D_k = (4/√π) e^(−c²) ∫_0^δ cosh(2cv) e^(−v²) dv with c = k/s, δ = r/s: no difference of nearly equal
        # numbers
        row, column = np.divmod(small, order.size)
        delta, centre = reach[row], order[column] / spread[row]
        v = delta[:, None] * _HALF_POINTS
        integrand = np.cosh(2 * centre[:, None] * v) * np.exp(-np.square(v)) * _HALF_WEIGHTS
        direct[row, column] = 4 / np.sqrt(np.pi) * np.exp(-np.square(centre)) * delta * integrand.sum(axis=-1)
    return direct
