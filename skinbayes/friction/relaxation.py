"""What time on the skin changes, one relaxation each: contact that grows, a layer that softens, friction that runs in."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray, floats


def contact_after_dwell(
    dwell_time: ArrayLike, contact_growth_time: ArrayLike, *, initial_contact_fraction: ArrayLike
) -> FloatArray:
    """Area of real contact after a time at rest over that after a long one, ``1 − (1 − f0) exp(−t/τ)``.

    Parameters
    ----------
    dwell_time : t, time between touching and sliding, s, ≥ 0, any shape
    contact_growth_time : τ, s, > 0, broadcasts
    initial_contact_fraction : f0, the fraction that is there at once, dimensionless, 0 ≤ f0 ≤ 1, broadcasts

    Returns
    -------
    fraction : dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    First-order kinetics, as images of finger pads on glass show it: sweat softens the keratin of the contacts until the area
    saturates, for most within 20 s, whatever the load. Elastomers touch at once.
    The paper has no dwell; the area that grows is that of its Sect. 4.

    References
    ----------
    Dzidek, Bochereau, Johnson, Hayward & Adams, PNAS 114 (2017) 10864, doi 10.1073/pnas.1706233114.

    Examples
    --------
    >>> print(contact_after_dwell([0.0, 7.0, 60.0], 7.0, initial_contact_fraction=0.2).round(3))
    [0.2   0.706 1.   ]
    """
    time, scale, first = floats(dwell_time, contact_growth_time, initial_contact_fraction)
    with np.errstate(all="ignore"):
        left = _left(time, scale)
        return np.asarray(np.where((first >= 0.0) & (first <= 1.0), 1 - (1 - first) * left, np.nan))[()]


def occluded_modulus(
    young_modulus_layer: ArrayLike,
    occluded_modulus_ratio: ArrayLike,
    *,
    dwell_time: ArrayLike,
    occlusion_time: ArrayLike,
) -> FloatArray:
    """Young's modulus of a layer that softens under a counterface through which no moisture passes.

    ``E0(t) = E0 r^(1 − exp(−t/τ))``: ln E0 relaxes from its value at first contact to ln(r E0).

    Parameters
    ----------
    young_modulus_layer : E0 at first contact, Pa, > 0, any shape
    occluded_modulus_ratio : r, modulus after long occlusion over E0, dimensionless, > 0, broadcasts
    dwell_time : t, s, ≥ 0, broadcasts
    occlusion_time : τ, s, > 0, broadcasts

    Returns
    -------
    young_modulus_layer : Pa, broadcast shape; nan where an argument is impossible

    Notes
    -----
    A description: that moisture under a glass makes finger pads rub harder within about 20 s is measured, the modulus on the way
    is not. Its logarithm relaxes, since it goes over decades: Fig. 17 of the paper.

    References
    ----------
    Dzidek, Adams, Andrews, Zhang & Johnson, J. R. Soc. Interface 14 (2017) 20160935, doi 10.1098/rsif.2016.0935.

    Examples
    --------
    >>> print(occluded_modulus(1e9, 0.01, dwell_time=[0.0, 20.0, 200.0], occlusion_time=20.0).round(-5))
    [1.00e+09 5.44e+07 1.00e+07]
    """
    modulus, ratio, time, scale = floats(
        young_modulus_layer, occluded_modulus_ratio, dwell_time, occlusion_time
    )
    with np.errstate(all="ignore"):
        found = modulus * ratio ** (1 - _left(time, scale))
        return np.asarray(np.where(np.minimum(modulus, ratio) > 0.0, found, np.nan))[()]


def run_in_factor(cycle: ArrayLike, run_in_cycles: ArrayLike, *, run_in_ratio: ArrayLike) -> FloatArray:
    """Friction of a stroke over that after many strokes on the same place, ``1 + (r − 1) exp(−(n − 1)/N)``.

    Parameters
    ----------
    cycle : n, number of the stroke, the first is 1, dimensionless, ≥ 1, any shape
    run_in_cycles : N, strokes over which the difference falls to 1/e, dimensionless, > 0, broadcasts
    run_in_ratio : r, friction of the first stroke over the last, dimensionless, > 0, broadcasts

    Returns
    -------
    factor : dimensionless, broadcast shape; nan where an argument is impossible

    Notes
    -----
    A description of one relaxation; what runs in – a film that is rubbed off, a surface that is smoothed, skin that sweats – it
    does not say. In the place of the constant shear stress of Sect. 4 of the paper.

    References
    ----------
    Blau, Wear 71 (1981) 29, doi 10.1016/0043-1648(81)90137-X (forms of running-in; the exponential is the simplest of them).

    Examples
    --------
    >>> print(run_in_factor([1, 6, 100], 5.0, run_in_ratio=0.8).round(3))
    [0.8   0.926 1.   ]
    """
    number, scale, ratio = floats(cycle, run_in_cycles, run_in_ratio)
    with np.errstate(all="ignore"):
        return np.asarray(np.where(ratio > 0.0, 1 + (ratio - 1) * _left(number - 1, scale), np.nan))[()]


def _left(elapsed: FloatArray, scale: FloatArray) -> FloatArray:
    """What is left of a difference, exp(−t/τ); nan where an argument is impossible."""
    return np.where((elapsed >= 0.0) & (scale > 0.0), np.exp(-elapsed / scale), np.nan)
