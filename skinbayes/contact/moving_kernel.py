"""Deflection of a viscoelastic half-space by a line pressure that moves over it, in the frame of the pressure.

The solid passes at v towards positive x. It remembers where it was pressed: with the creep compliance
``J(t) = J_0 + Σ J_k (1 − exp(−t/θ_k))`` of the plane-strain modulus, the logarithm in the deflection
``−(2/π) ∫p ln|x − x′| dx′`` of an elastic solid of unit modulus becomes ``J_0 ln|x| + Σ J_k L(x; vθ_k)`` with
``L(x; ℓ) = ∫₀^∞ exp(−s) ln|x − ℓs| ds``, which is ``ln|x| − exp(−x/ℓ) Ei(x/ℓ)``. In wavevectors that is ``−2 p(q)/(|q| E*(qv))``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import digamma, expi, factorial, gammaln

from skinbayes.arrays import FloatArray

_SERIES = 20  # terms, for |x/ℓ| < 1
_SHORT, _LONG = 1e-7, 1e7  # lengths that are none, and that have no end
_SMALLEST_POWER = 1e-9  # of the frequency, below which a solid has no loss to rounding
_FAR, _FAR_TERMS = (
    50.0,
    24,
)  # |x/ℓ| beyond which exp(−a) Ei(a) is its asymptotic series to rounding, and the terms


class MovingKernel(NamedTuple):
    """What pressures at nodes of a line do, as matrices of shape ``(N, N)`` and ``(N − 1, N)``, dimensionless.

    Attributes
    ----------
    deflection : ``(1/π) ∫ φ_j(x′) k(x_i − x′) dx′`` of hat functions φ_j with the kernel k in place of the logarithm,
        dimensionless; minus this times the pressures is the deflection
    cells : its integrals over x between neighbouring nodes, dimensionless
    """

    deflection: FloatArray
    cells: FloatArray


def hat_integrals(position: FloatArray, once: FloatArray, twice: FloatArray) -> FloatArray:
    """``∫ φ_j(x′) k(x_i − x′) dx′`` for hat functions, from once and twice integrated k at ``x_i − x_j``, shape ``(N, N)``."""
    slope = np.diff(twice, axis=1) / np.diff(position)
    kernel = np.empty_like(twice)
    kernel[:, 1:-1] = np.diff(slope, axis=1)
    kernel[:, 0] = once[:, 0] + slope[:, 0]
    kernel[:, -1] = -once[:, -1] - slope[:, -1]
    return kernel


def moving_kernel(
    position: FloatArray, *, instantaneous: float, compliance: FloatArray, length: FloatArray
) -> MovingKernel:
    """Kernel ``J_0 ln|x| + Σ J_k L(x; ℓ_k)`` at nodes, integrated exactly over piecewise linear pressures.

    Parameters
    ----------
    position : x of the nodes, rising, dimensionless, shape ``(N,)``
    instantaneous : J_0 times a modulus, dimensionless
    compliance : J_k times the same modulus, dimensionless, shape ``(M,)``
    length : ℓ_k = vθ_k in the unit of x, dimensionless, ≥ 0, shape ``(M,)``; may be infinite

    Returns
    -------
    kernel : `MovingKernel`

    References
    ----------
    Hunter, J. Appl. Mech. 28 (1961) 611.
    Johnson, Contact Mechanics (1985), Sect. 9.4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    A pressure 1 on [0, 1] seen from its end, long after a solid of one retardation time 0.1 has passed: ∫ ln x′ dx′ nearly.

    >>> nodes = np.linspace(0.0, 1.0, 5)
    >>> kernel = moving_kernel(nodes, instantaneous=0.0, compliance=np.ones(1), length=np.array([1e-9]))
    >>> print((np.pi * kernel.deflection).sum(axis=1)[-1].round(6))
    -1.0
    """
    offset = position[:, None] - position
    parts = np.array([_logarithm(offset, folds) for folds in (1, 2, 3)]) * instantaneous
    for weight, reach in zip(compliance.tolist(), length.tolist(), strict=True):
        parts += weight * retarded_logarithms(offset, reach)
    return _kernel_of(position, parts / np.pi)


def power_law_kernel(position: FloatArray, power: float) -> MovingKernel:
    """Kernel of a solid whose modulus rises as a power of the frequency, ``E(ω) = (iω)^n``, integrated as `moving_kernel`.

    Its creep ``J(t) = t^n/Γ(1 + n)`` makes of the logarithm ``(1/Γ(n)) ∫₀^∞ t^(n−1) ln|x − t| dt``. That is, but for a constant
    which moves the solid as a whole, ``(A x^n − 1)/n`` behind a pressure (x > 0) and ``(B |x|^n − 1)/n`` before it, with
    ``A = πn cot(πn)/Γ(1 + n)`` and ``B = πn/(sin(πn) Γ(1 + n))``: the logarithm for n → 0.

    Parameters
    ----------
    position : x of the nodes, rising, in the length v over the frequency at which the modulus is 1, shape ``(N,)``
    power : n, dimensionless, 0 ≤ n < 1/2

    Returns
    -------
    kernel : `MovingKernel`

    References
    ----------
    Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity (2010), Chap. 3, doi 10.1142/p614.

    Examples
    --------
    A pressure 1 on [0, 1]: its end lies lower than its beginning, by as much as without loss by nothing.

    >>> nodes = np.linspace(0.0, 1.0, 5)
    >>> ends = [(-np.pi * power_law_kernel(nodes, n).deflection.sum(axis=1))[[0, -1]] for n in (0.0, 0.1)]
    >>> print(np.diff(ends[0]).round(6), np.diff(ends[1]).round(3))
    [0.] [0.475]
    """
    offset = position[:, None] - position
    if power < _SMALLEST_POWER:
        return _kernel_of(position, np.array([_logarithm(offset, folds) for folds in (1, 2, 3)]) / np.pi)
    with np.errstate(divide="ignore"):
        logarithm = np.where(offset == 0, 0.0, np.log(np.abs(offset)))
    angle = np.pi * power
    log_before = float(np.log(angle / np.sin(angle)) - gammaln(1 + power))
    level = np.where(offset > 0, log_before + float(np.log(np.cos(angle))), log_before)
    parts = np.empty((3, *offset.shape))
    for k in (1, 2, 3):
        folded = level + power * logarithm - np.log1p(power / np.arange(1, k + 1)).sum()
        parts[k - 1] = offset**k / factorial(k) * np.expm1(folded) / power
    return _kernel_of(position, parts / np.pi)


def _kernel_of(position: FloatArray, integrals: FloatArray) -> MovingKernel:
    """Kernel of the function that was integrated once, twice and three times, shape ``(3, N, N)``."""
    once, twice, thrice = integrals
    return MovingKernel(
        np.asfortranarray(hat_integrals(position, once, twice)),
        np.diff(hat_integrals(position, twice, thrice), axis=0),
    )


def retarded_logarithms(x: FloatArray, length: float) -> FloatArray:
    """L(x; ℓ) integrated over x once, twice and three times, shape ``(3, ...)``.

    They count from 0 at x = 0. With a = x/ℓ and ``I_k = a^k/k! (ln|a| − H_k)`` the k-th one is
    ``ℓ^k [m_k(a) + a^k/k! ln ℓ/(1+ℓ)]``, ``m_k = I_k − m_(k−1) − γ a^(k−1)/(k−1)!``, ``m_0 = ln|a| − exp(−a) Ei(a)``; ln(1 +
    ℓ), which only moves the solid as a whole, is left out so that nothing grows with the speed. Where a is small this is a
    difference of nearly equal numbers, and ``m_k = a^k [−γ/k! + Σ_(n≥1) (−a)^n/(n+k)! (ψ(n+k+1) − ln|a|)]`` is used.
    """
    if not length > _SHORT:
        return np.array([_logarithm(x, folds) for folds in (1, 2, 3)])
    if not length < _LONG:
        # a shape that takes for ever to come is not there yet
        return np.zeros((3, *x.shape))
    a = x / length
    near = np.abs(a) < 1
    small, large = a[near], a[~near]
    found = np.empty((3, *x.shape))
    with np.errstate(divide="ignore"):
        log_small = np.where(small == 0, 0.0, np.log(np.abs(small)))
    level = np.log(np.abs(large)) - _scaled_exponential_integral(large)
    order = np.arange(1, _SERIES)
    for k in (1, 2, 3):
        signs = (-1.0) ** order / factorial(order + k)
        plain = np.polynomial.polynomial.polyval(
            small, [-np.euler_gamma / factorial(k), *(signs * digamma(order + k + 1))]
        )
        with_log = np.polynomial.polynomial.polyval(small, [0.0, *signs])
        found[k - 1][near] = small**k * (plain - log_small * with_log)
        level = _logarithm(large, k) - level - np.euler_gamma * large ** (k - 1) / factorial(k - 1)
        found[k - 1][~near] = level
        found[k - 1] += a**k / factorial(k) * np.log(length / (1 + length))
        found[k - 1] *= length**k
    return found


def _logarithm(x: FloatArray, folds: int) -> FloatArray:
    """ln|x| integrated from 0, so many times."""
    with np.errstate(divide="ignore"):
        logarithm = np.where(x == 0, 0.0, np.log(np.abs(x)))
    harmonic = (1 / np.arange(1, folds + 1)).sum()
    return np.asarray(x**folds / factorial(folds) * (logarithm - harmonic))


def _scaled_exponential_integral(a: FloatArray) -> FloatArray:
    """exp(−a) Ei(a) for |a| ≥ 1."""
    far = np.abs(a) > _FAR
    found = np.empty_like(a)
    found[~far] = np.exp(-a[~far]) * expi(a[~far])
    term = 1 / a[far]
    total = term.copy()
    for n in range(1, _FAR_TERMS):
        term = term * n / a[far]
        total += term
    found[far] = total
    return found
