"""Roots of the bridge equation with the gap distribution at each pressure itself, not interpolated."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.wetting._falling import falling_root
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._mixture import Filled, Mixture, fill

_RUNG = 0.12  # of the ladder of ln p on which roots are told apart
_FIRST_RUNGS = 3  # looked at before the next six, and so on
_CLOSE = 1e-12  # relative residual that is left
_TOLERATED = 1e-9  # relative residual beyond which there is no solution
_NUDGE = 1e-4  # of ln p, for slopes along it


def filled_at(source: GapSource, log_pressure: FloatArray, gap: FloatArray) -> tuple[Filled, FloatArray]:
    """What lies below ``gap`` (m), and ū (m), at ln p (Pa), all of shape ``(B, F)``."""
    mixture, mean = source.at(np.exp(log_pressure))
    n = mixture.fraction.shape[-1]
    filled = fill(Mixture(*(part.reshape(-1, n) for part in mixture)), gap.reshape(-1))
    return Filled(*(part.reshape(gap.shape) for part in filled)), mean


def roots_at_gaps(
    source: GapSource,
    pressure: FloatArray,
    wetting_tension: FloatArray,
    gap: FloatArray,
    largest: bool,
    count: bool = True,
) -> tuple[FloatArray, FloatArray]:
    """ln p at Kelvin lengths, and how many roots there are.

    ``p − p0 − Γ F(d; p)/d`` is not positive at p0 and not negative at p0 + Γ/d, as F is between 0 and 1. A ladder of
    pressures between tells the roots apart; two that lie within a rung are missed, as are all of a fold narrower than that.

    Parameters
    ----------
    source : of B skins
    pressure : p0, Pa, shape ``(B,)``
    wetting_tension : γ_w Σcos θ, N/m, ≥ 0, shape ``(B,)``
    gap : d, m, > 0, shape ``(B, F)``
    largest : take the largest root instead of the smallest
    count : False stops at the smallest root, several times faster, and gives nan for the number of roots
    """
    start = np.log(pressure)
    strength = wetting_tension[:, None] / gap / pressure[:, None]
    end = start[:, None] + np.log1p(strength)
    span = end - start[:, None]
    rungs = max(2, int(np.ceil(np.max(span, initial=0.0, where=np.isfinite(span)) / _RUNG)) + 1)

    def climb(x: FloatArray) -> FloatArray:
        area = filled_at(source, x, gap)[0].area
        return np.asarray(start[:, None] + np.log1p(strength * area) - x)

    if not (count or largest):
        low = start[:, None] + _RUNG * (_first_rise(source, start, strength, gap, rungs) - 1)
        possible = np.isfinite(low) & np.isfinite(strength)
        smallest = falling_root(climb, low, low + _RUNG, _CLOSE)
        return np.where(possible, smallest, np.nan), np.full(gap.shape, np.nan)
    ladder = start[:, None] + _RUNG * np.arange(rungs)
    mixture, _ = source.at(np.exp(ladder))
    solutions = np.zeros(gap.shape)
    low, high = np.full(gap.shape, np.nan), np.full(gap.shape, np.nan)
    for row in range(pressure.size):
        above = _above(
            Mixture(*(part[row] for part in mixture)), ladder[row] - start[row], strength[row], gap[row]
        )
        above[:, 0] = False
        # where the ladder ends below the upper bound, the bound itself is the last rung
        above = np.concatenate([above, np.ones((gap.shape[1], 1), dtype=bool)], axis=1)
        rises = ~above[:, :-1] & above[:, 1:]
        falls = above[:, :-1] & ~above[:, 1:]
        solutions[row] = rises.sum(axis=1) + falls.sum(axis=1)
        rung = rises.shape[1] - 1 - rises[:, ::-1].argmax(axis=1) if largest else rises.argmax(axis=1)
        low[row] = ladder[row][rung]
        high[row] = np.append(ladder[row][1:], ladder[row][-1] + _RUNG)[rung]
    possible = np.isfinite(low) & np.isfinite(strength)
    found: FloatArray = np.where(possible, falling_root(climb, low, high, _CLOSE), np.nan)
    return found, np.where(possible, solutions, np.nan)


def _above(mixture: Mixture, rise: FloatArray, strength: FloatArray, gap: FloatArray) -> BoolArray:
    """Where p exceeds p0 and the capillary pressure, shape ``(F, K)``: F gaps of one skin, K pressures, ``rise`` = ln p/p0."""
    each = Mixture(*(np.tile(part, (gap.size, 1)) for part in mixture))
    area = fill(each, np.repeat(gap, rise.size)).area.reshape(-1, rise.size)
    return np.asarray(rise - np.log1p(strength[:, None] * area) > 0)


def _first_rise(
    source: GapSource, start: FloatArray, strength: FloatArray, gap: FloatArray, rungs: int
) -> FloatArray:
    """The first rung, from 1 on, where p exceeds p0 and the capillary pressure, ``(B, F)``; ``rungs`` if none, nan for nan."""
    found = np.full(gap.shape, float(rungs))
    sought = np.isfinite(start[:, None] + strength)
    found[~sought] = np.nan
    first, span = 1, _FIRST_RUNGS
    rows = np.flatnonzero(sought.any(axis=1))
    while rows.size and first < rungs:
        rise: FloatArray = _RUNG * np.arange(first, min(first + span, rungs), dtype=np.float64)
        mixture, _ = source.select(rows).at(np.exp(start[rows, None] + rise))
        for place, row in enumerate(rows):
            each = Mixture(*(part[place] for part in mixture))
            above = _above(each, rise, strength[row], gap[row])
            now = sought[row] & above.any(axis=1)
            found[row, now] = first + above[now].argmax(axis=1)
            sought[row] &= ~now
        rows = rows[sought[rows].any(axis=1)]
        first, span = first + span, 2 * span
    return found


def refine_films(
    source: GapSource,
    pressure: FloatArray,
    wetting_tension: FloatArray,
    film: FloatArray,
    log_pressure: FloatArray,
    z: FloatArray,
    reference: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Newton steps for ln p and z = ln(1 + d0/d) from an approximate solution until both equations hold to 1e-12.

    Parameters
    ----------
    source : of B skins
    pressure, reference : p0, Pa, and d0, m, shape ``(B,)``
    wetting_tension : γ_w Σcos θ, N/m, ≥ 0, shape ``(B,)``
    film : m, shape ``(B, F)``
    log_pressure, z : approximate solution, p in Pa, dimensionless, shape ``(B, F)``
    """
    start, d0 = np.log(pressure)[:, None], reference[:, None]
    strength = (wetting_tension / pressure)[:, None]
    x, active = log_pressure.copy(), np.isfinite(log_pressure)
    z = z.copy()
    for _ in range(20):
        gap = d0 / np.expm1(np.maximum(z, 1e-14))
        here = filled_at(source, x, gap)[0]
        total = 1 + strength / gap * here.area
        r_pressure = x - start - np.log(total)
        r_film = np.log(here.film / film)
        error = np.maximum(np.abs(r_pressure), np.abs(r_film))
        active = active & (error > _CLOSE)
        if not active.any():
            break
        beside = filled_at(source, x + _NUDGE, gap)[0]
        area_slope, film_slope = ((b - h) / _NUDGE for b, h in zip(beside[:2], here[:2], strict=True))
        # along z: d ln d/dz = −1/(1 − e^(−z)); 1/d itself rises by e^z/d0
        turn = 1 / np.expm1(-z)
        bulk = strength / total
        a = 1 - bulk / gap * area_slope
        b = -bulk * (np.exp(z) / d0 * here.area + here.density * turn / gap)
        c, e = film_slope / here.film, gap * here.density * turn / here.film
        determinant = a * e - b * c
        step_x = np.clip((b * r_film - e * r_pressure) / determinant, -0.3, 0.3)
        step_z = np.clip((c * r_pressure - a * r_film) / determinant, -0.3, 0.3)
        x = np.where(active, np.maximum(x + step_x, start), x)
        z = np.where(active, np.maximum(z + step_z, 0.0), z)
    # what has not come close is no solution
    return np.where(error < _TOLERATED, x, np.nan), z
