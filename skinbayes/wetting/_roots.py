"""Total pressure at a given Kelvin length, with gap distributions from a family."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.wetting._family import GapFamily

_CLOSE = 1e-6  # change of ln p at which one more Newton step is enough
_STRIDE = 4  # longest Newton step in units of the step of the map itself


def smallest_root(
    family: GapFamily, pressure: FloatArray, wetting_tension: FloatArray, gap: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Smallest root ln p at Kelvin lengths ``gap`` (m, shape ``(B, M)``), and whether it was found in the family's range.

    From p0 the map ``p → p0 + Γ F(d; p)/d`` climbs to the smallest root and never passes it. Newton steps shorten the climb;
    they are held to a few times its own step, so that they do not jump over a pair of roots.

    Parameters
    ----------
    family : of B skins, from p0 upwards
    pressure : p0, Pa, shape ``(B,)``
    wetting_tension : γ_w Σcos θ, N/m, ≥ 0, shape ``(B,)``
    gap : d, m, shape ``(B, M)``
    """
    ground = np.log(pressure)[:, None]
    top = (family.start + family.span)[:, None]
    strength = wetting_tension[:, None] / gap / pressure[:, None]
    x = np.broadcast_to(ground, gap.shape).copy()
    lower, upper = x.copy(), np.broadcast_to(top, gap.shape).copy()
    active = np.ones(gap.shape, dtype=bool)
    for _ in range(60):
        area, slope = family.cover(x, gap)
        total = 1 + strength * area
        climb = ground + np.log(total) - x
        gain = strength * slope / total
        lower, upper = np.where(climb >= 0, x, lower), np.where(climb < 0, x, upper)
        newton = climb / np.where(gain < 1, 1 - gain, 1.0)
        stride = _STRIDE * np.abs(climb)
        following = np.clip(x + np.clip(newton, -stride, stride), lower, upper)
        x = np.where(active, following, x)
        # Newton steps square the error: the one that was short is the last
        active = active & (np.abs(newton) > _CLOSE) & (following < top)
        if not active.any():
            break
    return x, ~active & (x < top)
