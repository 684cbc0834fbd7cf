"""What friction does from stroke to stroke: running in, drift, scatter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from skinbayes.arrays import FloatArray

CLEARLY = 6.0
"""By how much the criterion of a curve has to be below that of a simpler one; a ratio of likelihoods of 20."""

FEWEST_STROKES = 6
"""With fewer no trend is looked for."""


@dataclass(frozen=True)
class StrokeTrend:
    """Friction against the number of the stroke.

    Attributes
    ----------
    kind : what describes it best: the same in all strokes, a straight line, or an exponential approach to a last value
    first, last : friction coefficient of the curve at the first and the last stroke, dimensionless
    half : strokes in which half of the approach is done; nan of other kinds
    scatter : of strokes about the curve, a standard deviation, dimensionless
    explained : what the errors of single strokes make of that, root mean square, dimensionless
    """

    kind: Literal["constant", "drift", "running in"]
    first: float
    last: float
    half: float
    scatter: float
    explained: float


def stroke_trend(number: FloatArray, friction: FloatArray, error: FloatArray) -> StrokeTrend | None:
    """The curve that describes friction against the number of the stroke best, None with too few strokes.

    Constant, straight line and exponential approach are compared by the information criterion of Akaike, corrected for few data
    (Hurvich & Tsai 1989, 10.1093/biomet/76.2.297); a parameter more has to lower it by 6.

    Parameters
    ----------
    number : of the stroke, shape ``(S,)``
    friction : friction coefficient, dimensionless, shape ``(S,)``
    error : its standard error, dimensionless, shape ``(S,)``

    Examples
    --------
    >>> number = np.arange(1.0, 21.0)
    >>> friction = 0.4 + 0.2 * 0.5 ** ((number - 1) / 3) + 0.002 * np.cos(7 * number)
    >>> found = stroke_trend(number, friction, np.full(20, 0.002))
    >>> found.kind, round(found.first, 2), round(found.last, 2), round(found.half, 1)
    ('running in', 0.6, 0.4, 3.0)
    """
    count = number.size
    if count < FEWEST_STROKES:
        return None
    x = number - number[0]
    ones = np.ones(count)
    half_lives = np.geomspace(0.5, max(1.0, x[-1] / 2), 60)
    candidates = [("constant", np.nan, 1, [ones]), ("drift", np.nan, 2, [ones, x])]
    candidates += [("running in", half, 3, [ones, 0.5 ** (x / half)]) for half in half_lives]
    best: tuple[float, str, float, FloatArray, int] | None = None
    for kind, half, parameters, basis in candidates:
        design = np.column_stack(basis)
        curve = design @ np.linalg.lstsq(design, friction, rcond=None)[0]
        square = float(np.sum((friction - curve) ** 2)) + 1e-20
        free = parameters + 1
        score = count * np.log(square / count) + 2 * free * count / max(count - free - 1, 0.5)
        score += CLEARLY * (parameters - 1)
        if best is None or score < best[0]:
            best = score, kind, half, curve, parameters
    assert best is not None
    _, kind, half, curve, parameters = best
    scatter = float(np.sqrt(np.sum((friction - curve) ** 2) / (count - parameters)))
    explained = float(np.sqrt(np.mean(error**2)))
    return StrokeTrend(kind, float(curve[0]), float(curve[-1]), float(half), scatter, explained)  # type: ignore[arg-type]
