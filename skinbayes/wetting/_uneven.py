"""Averages of a curve over a normally distributed film: the curve is piecewise linear, with a step at its beginning."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtr

from skinbayes.arrays import FloatArray, IndexArray

_WIDEST = 1e5  # standard deviation over the last edge beyond which nothing but the steps of the curve counts
_FAR = 8.0  # standard deviations beyond which a normal distribution has nothing left
_PLACES = 256  # treated at a time, so that their terms fit into the cache


def uneven_average(
    edge: FloatArray, local: FloatArray, before: FloatArray, place: FloatArray, width: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Averages over normal distributions about ``place``, and their derivatives along it.

    The curve is ``before`` below the first edge, linear between edges, and constant beyond the last. It is a step and a sum
    of ramps, whose averages are closed forms; ramps that begin far from a place are as good as their unsmoothed selves.

    Parameters
    ----------
    edge, local : places where the slope changes, ascending, and the curve there, shape ``(B, n)``
    before : shape ``(B,)``
    place, width : means, may be infinite, and standard deviations, > 0, in the unit of the edges, shape ``(B, T)``

    Returns
    -------
    average, slope : shape ``(B, T)``; nan where anything is nan
    """
    count, n = edge.shape
    grade = np.concatenate([np.diff(local) / np.diff(edge), np.zeros((count, 1))], axis=1)
    turn = np.diff(grade, axis=1, prepend=0.0)
    # wider ones lose their digits between ramps that cancel
    shrink = np.minimum(1.0, _WIDEST * edge[:, -1:] / width)
    place, width = place * shrink, width * shrink
    reach = _FAR * width
    average, slope = np.where(place > edge[:, -1:], local[:, -1:], before[:, None]), np.zeros(place.shape)
    near = (place > edge[:, :1] - reach) & (place < edge[:, -1:] + reach)
    rows, columns = np.nonzero(near | np.isnan(place + width + edge[:, -1:]))
    for start in range(0, rows.size, _PLACES):
        member, column = rows[start : start + _PLACES], columns[start : start + _PLACES]
        x, w, far = (a[member, column] for a in (place, width, reach))
        edges = edge[member]
        first = np.count_nonzero(edges < (x - far)[:, None], axis=1)
        end = np.count_nonzero(edges <= (x + far)[:, None], axis=1)
        # at least one, so that no sum is empty; one that is out of reach adds nothing
        first = np.minimum(first, n - 1)
        lengths = np.maximum(end - first, 1)
        which, at = _runs(first, lengths)
        owner = member[which]
        below, ramp = _smoothed((x[which] - edge[owner, at]) / w[which])
        starts = np.cumsum(lengths) - lengths
        turns = turn[owner, at]
        # the ramps that begin before all of these are the straight line that passes the last of them
        last = np.maximum(first - 1, 0)
        passed = first > 0
        line = local[member, last] - local[member, 0] + grade[member, last] * (x - edge[member, last])
        rise = np.add.reduceat(turns * (w[which] * ramp), starts) + np.where(passed, line, 0.0)
        tilt = np.add.reduceat(turns * below, starts) + np.where(passed, grade[member, last], 0.0)
        distance = (x - edge[member, 0]) / w
        step, bell = _smoothed(distance)[0], np.exp(-0.5 * np.square(distance)) / np.sqrt(2 * np.pi)
        jump = local[member, 0] - before[member]
        average[member, column] = before[member] + jump * step + rise
        slope[member, column] = tilt + jump * bell / w
    return average, slope * shrink


def _runs(first: IndexArray, lengths: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Indices ``first, first + 1, …`` of all runs, one after the other, and to which run each belongs."""
    which = np.repeat(np.arange(first.size), lengths)
    starts = np.cumsum(lengths) - lengths
    return which, np.arange(which.size) - (starts - first)[which]


def _smoothed(distance: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Φ(t), and the average ``t Φ(t) + φ(t)`` of a ramp, at distances t of any sign."""
    bell = np.exp(-0.5 * np.square(distance)) / np.sqrt(2 * np.pi)
    away = np.abs(distance)
    return ndtr(distance), np.maximum(distance, 0.0) + (bell - away * ndtr(-away))
