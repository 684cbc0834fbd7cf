"""Loss of a cycle of indentation for many materials at once: functions of one or two numbers, interpolated."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebval, chebval2d, chebvander
from scipy.special import dawsn, gamma

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.viscoelastic_indentation import indentation_cycle
from skinbayes.contact.viscoelastic_materials import standard_linear_solid

LARGEST_RELAXATION_STRENGTH = 100.0
"""Δ, dimensionless, up to which the loss of a standard linear solid is known."""

_POWERS, _STRENGTHS, _TIMES = 10, 9, 24  # nodes
_TURN = 3.0  # of ln of the time ratio, over which its axis bends
_SHORT = 1e-4  # t/τ below which nothing has relaxed
_FAR = 8.0  # of it, beyond which the loss is a power of the time ratio
_END = _FAR / np.hypot(_TURN, _FAR)


def loss_fraction_of_constant_loss(loss_tangent: ArrayLike) -> FloatArray:
    """Work that is not given back over the work of pressing in, for any ball, rate and depth, see `indentation_cycle`.

    Parameters
    ----------
    loss_tangent : tan δ, dimensionless, 0 ≤ tan δ < 1, any shape

    Returns
    -------
    loss_fraction : dimensionless, within 1e-6 of that of `indentation_cycle`; nan where the argument is impossible

    Examples
    --------
    >>> print(loss_fraction_of_constant_loss([0.0, 0.158]).round(3))
    [0.   0.25]
    """
    tangent = np.asarray(loss_tangent, dtype=np.float64)
    power = np.where((tangent >= 0) & (tangent < 1), 2 / np.pi * np.arctan(tangent), np.nan)
    return np.asarray(power * chebval(4 * power - 1, _per_power()))[()]


def loss_fraction_of_relaxation(relaxation_strength: ArrayLike, time_ratio: ArrayLike) -> FloatArray:
    """The same of a standard linear solid.

    Parameters
    ----------
    relaxation_strength : Δ = E_g/E∞ − 1, dimensionless, 0 ≤ Δ ≤ 100, broadcasts
    time_ratio : relaxation time over the time of pressing in, dimensionless, > 0, broadcasts

    Returns
    -------
    loss_fraction : dimensionless, within 0.002 of that of `indentation_cycle`; nan where an argument is impossible

    Examples
    --------
    >>> print(loss_fraction_of_relaxation(0.47, [0.25, 0.5]).round(3))
    [0.25  0.251]
    """
    strength, ratio = np.broadcast_arrays(
        *(np.asarray(x, dtype=np.float64) for x in (relaxation_strength, time_ratio))
    )
    with np.errstate(all="ignore"):
        fast, time = np.log(1 + strength), np.log(ratio)
        place = time + fast / 2
        held = np.clip(place, -_FAR, _FAR)
        scaled = 2 * fast / np.log(1 + LARGEST_RELAXATION_STRENGTH) - 1, held / np.hypot(_TURN, held) / _END
        good = (strength >= 0) & (np.abs(scaled[0]) <= 1 + 1e-12) & np.isfinite(place)
        along, across = (np.where(good, x, 0.0) for x in scaled)
        relative = chebval2d(along, across, _per_sine())
        return np.asarray(np.where(good, np.exp(relative) * _sine(strength, ratio), np.nan))[()]


def stiffening_of_constant_loss(loss_tangent: FloatArray, turns: FloatArray) -> FloatArray:
    """Force at the end of pressing in at a constant rate over that of elastic tissue of the modulus at ω_r; ``turns``: ω_r t."""
    power = 2 / np.pi * np.arctan(loss_tangent)
    return np.asarray(turns**-power * 1.5 * gamma(1.5) / gamma(2.5 - power))


def stiffening_of_relaxation(relaxation_strength: FloatArray, turns: FloatArray) -> FloatArray:
    """The same over that of relaxed tissue, for Δ and t/τ: ``1 + Δ ∫exp((s − t)/τ) d(s^(3/2))/t^(3/2)``."""
    root = np.sqrt(turns)
    # by the series of Dawson's integral where it has no digits
    remaining = np.where(turns < _SHORT, 1 - 2 / 5 * turns, 1.5 * (root - dawsn(root)) / turns**1.5)
    return np.asarray(1 + relaxation_strength * remaining)


def _sine(strength: FloatArray, ratio: FloatArray) -> FloatArray:
    """sin δ at the frequency of one over the time of pressing in."""
    loss = strength / (ratio + 1 / ratio)
    return np.asarray(loss / np.hypot(loss, 1 + strength / (1 + 1 / np.square(ratio))))


@lru_cache(maxsize=1)
def _per_power() -> FloatArray:
    """Coefficients of loss over n, for n from 0 to 1/2."""
    powers = (chebpts1(_POWERS) + 1) / 4
    found = [
        indentation_cycle(
            1.0,
            1.0,
            sphere_radius=1.0,
            material=ConstantLossMaterial(
                modulus=1.0, tan_delta=float(np.tan(np.pi / 2 * n)), reference_frequency=1.0
            ),
        ).loss_fraction
        / n
        for n in powers.tolist()
    ]
    return np.asarray(np.linalg.solve(chebvander(4 * powers - 1, _POWERS - 1), np.array(found)))


@lru_cache(maxsize=1)
def _per_sine() -> FloatArray:
    """Coefficients of ln of loss over sin δ, over ln(1 + Δ) and the bent axis of the time."""
    fast = (chebpts1(_STRENGTHS) + 1) / 2 * np.log(1 + LARGEST_RELAXATION_STRENGTH)
    axis = _END * chebpts1(_TIMES)
    places = _TURN * axis / np.sqrt(1 - np.square(axis))
    found = np.empty((_STRENGTHS, _TIMES))
    for i, strength in enumerate(np.expm1(fast).tolist()):
        for j, ratio in enumerate(np.exp(places - fast[i] / 2).tolist()):
            cycle = indentation_cycle(
                1.0,
                1.0,
                sphere_radius=1.0,
                material=standard_linear_solid(1.0, 1 + strength, relaxation_time=ratio),
            )
            found[i, j] = np.log(cycle.loss_fraction / _sine(np.asarray(strength), np.asarray(ratio)))
    along = np.linalg.solve(chebvander(chebpts1(_STRENGTHS), _STRENGTHS - 1), found)
    return np.asarray(np.linalg.solve(chebvander(chebpts1(_TIMES), _TIMES - 1), along.T).T)
