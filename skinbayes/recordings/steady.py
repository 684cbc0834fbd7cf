"""The steady part of a stroke, by a stated rule."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.recordings.recording import Rules
from skinbayes.recordings.strokes import Stroke

PIECES = 100
"""Means of neighbouring samples among which changes are looked for."""

SHORTEST = 5
"""Such means that a piece between changes has at least."""


def steady_part(
    stroke: Stroke, rules: Rules, time: FloatArray, way: FloatArray | None, friction: FloatArray
) -> tuple[int, int]:
    """First sample of the steady part of a stroke and the one after its last.

    Parameters
    ----------
    stroke, rules : the stroke and how its steady part is chosen
    time : s, shape ``(n,)``
    way : position or integrated speed, m, shape ``(n,)``, or None
    friction : what is looked at for changes, of any unit, shape ``(n,)``
    """
    begin, end = stroke.moving_start, stroke.moving_stop
    if rules.steady == "change points":
        return _longest_piece(friction, begin, end)
    by_way = way is not None and not np.isnan(stroke.length)
    axis = way if by_way and way is not None else time
    first, last = (axis[stroke.start], axis[stroke.stop - 1]) if by_way else (axis[begin], axis[end - 1])
    if last == first:
        return begin, end
    share = (axis[begin:end] - first) / (last - first)
    inside = np.flatnonzero((share >= 0.5 - 0.5 * rules.share) & (share <= 0.5 + 0.5 * rules.share))
    return (begin + int(inside[0]), begin + int(inside[-1]) + 1) if inside.size else (begin, begin)


def _longest_piece(values: FloatArray, begin: int, end: int) -> tuple[int, int]:
    """The longest of at most three pieces, each with a straight line of its own, that the criterion of Schwarz prefers."""
    block = max(1, (end - begin) // PIECES)
    count = (end - begin) // block
    with np.errstate(all="ignore"):
        means = np.nanmean(values[begin : begin + count * block].reshape(count, block), axis=1)
    known = np.isfinite(means)
    if known.sum() < 3 * SHORTEST:
        return begin, end
    means = np.interp(np.arange(count), np.flatnonzero(known), means[known])
    misfit = _misfits(means)
    cuts = np.arange(SHORTEST, count - SHORTEST + 1)
    best: tuple[float, tuple[int, ...]] = (misfit[0, count], (0, count))
    candidates = [best]
    two = misfit[0, cuts] + misfit[cuts, count]
    candidates.append((float(two.min()), (0, int(cuts[two.argmin()]), count)))
    three = misfit[0, cuts][:, None] + misfit[np.ix_(cuts, cuts)] + misfit[cuts, count][None, :]
    i, j = np.unravel_index(int(np.argmin(three)), three.shape)
    if np.isfinite(three[i, j]):
        candidates.append((float(three[i, j]), (0, int(cuts[i]), int(cuts[j]), count)))
    floor = 1e-12 * float(means @ means) + 1e-300
    independent = max(2.0 * SHORTEST, count * _independent(means[count // 4 : count - count // 4]))
    scores = [
        independent * np.log((found + floor) / count) + 3 * (len(edges) - 1) * np.log(independent)
        for found, edges in candidates
    ]
    edges = candidates[int(np.argmin(scores))][1]
    longest = int(np.argmax(np.diff(edges)))
    return begin + edges[longest] * block, end if edges[longest + 1] == count else begin + edges[
        longest + 1
    ] * block


def _independent(y: FloatArray) -> float:
    """Share of the means that count as independent, from the correlation of neighbours about a straight line."""
    x = np.arange(y.size) - 0.5 * (y.size - 1)
    left = y - y.mean() - x * ((x @ y) / (x @ x))
    power = float(left @ left)
    neighbours = max(0.0, float(left[1:] @ left[:-1]) / power) if power > 0 else 0.0
    return (1.0 - neighbours) / (1.0 + neighbours)


def _misfits(y: FloatArray) -> FloatArray:
    """Squares about the straight line through ``y[a:b]``, shape ``(n + 1, n + 1)``; infinite for pieces that are too short."""
    count = y.size
    x = np.arange(count, dtype=np.float64)
    sums = [np.concatenate(([0.0], np.cumsum(v))) for v in (y, x, x * y, x * x, y * y)]
    a, b = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    n = (b - a).astype(np.float64)
    sy, sx, sxy, sxx, syy = (s[b] - s[a] for s in sums)
    with np.errstate(all="ignore"):
        vxx, vxy, vyy = sxx - sx * sx / n, sxy - sx * sy / n, syy - sy * sy / n
        found = vyy - np.where(vxx > 0, vxy * vxy / vxx, 0.0)
    return np.where(n >= SHORTEST, np.maximum(found, 0.0), np.inf)
