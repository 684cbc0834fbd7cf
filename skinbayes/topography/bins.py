"""Averages of modes over bins of wavevectors, and how many independent modes are in each."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from skinbayes.arrays import FloatArray, IndexArray
from skinbayes.errors import InputError
from skinbayes.topography.periodogram import Periodogram
from skinbayes.topography.windows import REACH, mode_correlation

NEAR = 96
"""Modes up to this many steps from the origin along both axes are counted pair by pair."""

BINS_PER_DECADE = 16
"""Of a spectrum of a map, unless one asks for another number: a power law of exponent −4 changes by 1.8 within a bin."""


class Bins(NamedTuple):
    """Sums over the modes of each bin; those of the whole plane, so that each independent mode counts twice.

    Attributes
    ----------
    number : of each bin on the grid that all spectra share, see `bin_of`, shape ``(K,)``
    modes : in the whole plane, shape ``(K,)``
    power : mean C, m^4 (or m^3 of lines), shape ``(K,)``
    log_wavevector : mean of ln q, q in 1/m, shape ``(K,)``
    spread : variance of ln q within the bin, dimensionless, shape ``(K,)``
    """

    number: IndexArray
    modes: FloatArray
    power: FloatArray
    log_wavevector: FloatArray
    spread: FloatArray


def bin_of(wavevector: FloatArray, per_decade: int) -> IndexArray:
    """Number of the bin of each wavevector (1/m) > 0: bin k reaches from 10^(k/n) to 10^((k+1)/n) 1/m, in all spectra alike."""
    found = np.log10(wavevector)
    found *= per_decade
    # what lies on an edge but for rounding belongs to the bin above it
    found += 1e-9
    return np.floor(found, out=found).astype(np.intp)


def averaged(index: IndexArray, power: FloatArray, log_wavevector: FloatArray, count: FloatArray) -> Bins:
    """Means over bins of modes given one by one, all of shape ``(n,)``; ``count`` is what each stands for."""
    first, size = int(index.min()), int(index.max() - index.min()) + 1
    sums = [
        np.bincount(index - first, weights, size).astype(np.float64)
        for weights in (count, count * power, count * log_wavevector, count * np.square(log_wavevector))
    ]
    return bins_of_sums(first, sums)


def bins_of_sums(first: int, sums: list[FloatArray]) -> Bins:
    """Bins from sums of counts, of counts times C, ln q and (ln q)²; empty ones are dropped."""
    full = np.flatnonzero(sums[0])
    modes, power, log_q, squares = (one[full] for one in sums)
    mean = log_q / modes
    spread = np.maximum(squares / modes - np.square(mean), 0.0)
    return Bins(full + first, modes, power / modes, mean, spread)


def area_bins(found: Periodogram, per_decade: int) -> Bins:
    """Radial averages of a map up to the circle that the smaller Nyquist wavevector allows."""
    largest = found.largest * (1 - 1e-12)
    top = int(bin_of(np.array([largest]), per_decade)[0])
    first = int(bin_of(np.array([min(found.wavevector_x[1], found.wavevector_y[1])]), per_decade)[0])
    size = top - first + 1
    sums = [np.zeros(size) for _ in range(4)]
    squares = np.square(found.wavevector_x)
    block = max(1, 2**20 // squares.size)  # arrays that stay in the cache
    for start in range(0, found.wavevector_y.size, block):
        rows = slice(start, start + block)
        q2 = np.square(found.wavevector_y[rows])[:, None] + squares
        inside = (q2 > 0) & (q2 <= largest**2)
        count = (found.count_y[rows][:, None] * found.count_x)[inside]
        # modes at both ends of an axis are their own mirror images, there forward and backward agree
        power = (found.forward[rows] + found.backward[rows])[inside]
        log_q = np.log(q2[inside])
        log_q *= 0.5
        index = np.floor(log_q * (per_decade / np.log(10)) + 1e-9).astype(np.intp) - first
        for sum_, weights in zip(
            sums, (count, 0.5 * count * power, count * log_q, count * np.square(log_q)), strict=True
        ):
            sum_ += np.bincount(index, weights, size)
    if not sums[0].any():
        raise InputError(
            "the map has no mode below its Nyquist wavevector; expected more pixels along both sides"
        )
    return bins_of_sums(first, sums)


def independent_area_modes(found: Periodogram, bins: Bins, per_decade: int) -> FloatArray:
    """Independent modes of each bin, shape ``(K,)``, of a Gaussian surface whose spectrum is flat within a bin.

    ``N²/(2 ΣΣ ρ(k − k′))`` over all pairs of its N modes, with ρ the squared correlation that the window makes. Far from the
    origin the pairs are those of an infinite plane, with a share that the edges of the bin cut off.
    """
    rho = mode_correlation(found.window)
    if rho[1] == 0:
        return bins.modes / 2
    reach = np.arange(-REACH, REACH + 1)
    weights = rho[np.abs(reach)][:, None] * rho[np.abs(reach)]
    step_x, step_y = float(found.wavevector_x[1]), float(found.wavevector_y[1])
    # pairs d steps apart across a ring of width w: a share 1 − d/w of them is inside
    across = np.hypot(reach[:, None] * step_y, reach * step_x) * (2 / np.pi)
    lower = 10.0 ** (bins.number / per_decade)
    width = bins.modes * found.cell / (2 * np.pi * np.exp(bins.log_wavevector))
    far = np.sum(weights * np.maximum(1 - across / width[:, None, None], 0.0), axis=(1, 2))
    pairs = np.maximum(far, 1.0) * bins.modes
    near = lower * 10 ** (1 / per_decade) < NEAR * min(step_x, step_y)
    if near.any():
        side_x, side_y = (min(NEAR, axis.size - 1) for axis in (found.wavevector_x, found.wavevector_y))
        q_x, q_y = np.arange(-side_x, side_x + 1) * step_x, np.arange(-side_y, side_y + 1) * step_y
        q = np.hypot(q_y[:, None], q_x)
        q[side_y, side_x] = 1.0
        index = bin_of(q, per_decade)
        index[side_y, side_x] = -(10**9)
        place = np.searchsorted(bins.number, index)
        member = np.where(np.isin(index, bins.number[near]), place, -1)
        counted = _pairs(member, weights, bins.number.size)
        pairs = np.where(near, counted, pairs)
    return np.asarray(np.square(bins.modes) / (2 * pairs))


def _pairs(member: IndexArray, weights: FloatArray, size: int) -> FloatArray:
    """Sum of weights over all pairs of neighbours in the same bin, shape ``(size,)``; −1 belongs to no bin."""
    total = np.zeros(size)
    rows, columns = member.shape
    for i, a in enumerate(range(-REACH, REACH + 1)):
        for j, b in enumerate(range(-REACH, REACH + 1)):
            if weights[i, j] < 1e-12:
                continue
            here = member[max(a, 0) : rows + min(a, 0), max(b, 0) : columns + min(b, 0)]
            there = member[max(-a, 0) : rows + min(-a, 0), max(-b, 0) : columns + min(-b, 0)]
            same = here[(here == there) & (here >= 0)]
            total += weights[i, j] * np.bincount(same, minlength=size)
    return total


def independent_line_modes(modes: FloatArray, window: str) -> FloatArray:
    """The same of lines, from the number of their modes in each bin: modes of neighbouring bins hardly matter."""
    rho = mode_correlation(window)
    pairs = modes + 2 * sum(rho[d] * np.maximum(modes - d, 0) for d in range(1, REACH + 1))
    return np.asarray(np.square(modes) / pairs)


NEIGHBOURHOOD = 0.25 * np.log(10)
"""Standard deviation of the nearness of bins for `local_power_law`, of ln q."""


class PowerLaw(NamedTuple):
    """A straight line through the neighbours of each bin, of ln C over ln q; all of shape ``(K,)``.

    Attributes
    ----------
    level : of ln C at the bin
    exponent : α = −dln C/dln q, dimensionless
    variance : of the exponent, from the modes of the neighbours, dimensionless
    """

    level: FloatArray
    exponent: FloatArray
    variance: FloatArray


def local_power_law(
    log_wavevector: FloatArray, power: FloatArray, independent: FloatArray, *, width: float = NEIGHBOURHOOD
) -> PowerLaw:
    """Lines of least squares through all bins, weighted by their modes and their nearness in ln q."""
    log_c = np.log(power)
    if log_c.size < 3:
        return PowerLaw(log_c, np.zeros(log_c.size), np.full(log_c.size, np.inf))
    weights = np.exp(-0.5 * np.square((log_wavevector[:, None] - log_wavevector) / width)) * independent
    weights /= weights.sum(axis=1, keepdims=True)
    centre = weights @ log_wavevector
    apart = log_wavevector - centre[:, None]
    each = weights * apart / np.sum(weights * np.square(apart), axis=1, keepdims=True)
    exponent = np.clip(-each @ log_c, -6.0, 6.0)
    level = weights @ log_c - exponent * (log_wavevector - centre)
    return PowerLaw(level, exponent, np.square(each) @ (1 / independent))


class Smoothed(NamedTuple):
    """What is left of the widths of bins and window where the spectrum is nearly a power law.

    Attributes
    ----------
    wavevector : at which a power law has the mean of each bin, 1/m
    power : less what the window smears there from longer waves, m^4 or m^3
    independent : modes less for what the slope within the bin unbalances
    """

    wavevector: FloatArray
    power: FloatArray
    independent: FloatArray


def at_power_law(bins: Bins, independent: FloatArray, *, smear: float, dimensions: int) -> Smoothed:
    """Correct bins to second order in their width and in that of the window.

    With α of `local_power_law`, the mean of q^−α over modes whose ln q have mean m and variance s² is that of
    q = exp(m − α s²/2). A window that spreads each mode over neighbours at distances of variance ``smear`` (1/m², per axis)
    adds half of that times the second derivative of C, a share α²/(2q²) of an isotropic spectrum and α(α + 1)/(2q²) of one of
    lines.
    """
    exponent = local_power_law(bins.log_wavevector, bins.power, independent).exponent
    wavevector = np.exp(bins.log_wavevector - exponent * bins.spread / 2)
    curved = np.square(exponent) if dimensions == 2 else exponent * (exponent + 1)
    added = smear * np.maximum(curved, 0.0) / (2 * np.square(wavevector))
    return Smoothed(
        wavevector, bins.power / (1 + added), independent / np.exp(np.square(exponent) * bins.spread)
    )
