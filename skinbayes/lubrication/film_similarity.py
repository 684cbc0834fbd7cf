"""Films of two kinds at speeds at which asperities carry as much of the load, and the whole drag of a cylinder."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from skinbayes.arrays import FloatArray
from skinbayes.lubrication._uniform_spline import spline_coefficients
from skinbayes.lubrication.film_reference import SmoothFilms
from skinbayes.lubrication.film_table import COUETTE, FRACTION, PRESSURE_FLOW

_STEPS = 8  # of Newton's iteration for a speed
_STRETCHES = 0.3, 1.3
_LEAST_ODDS = 1e-12  # of the load that the liquid carries


def whole_drag(outputs: FloatArray, log_number: FloatArray) -> FloatArray:
    """Outputs of cylinders, shape ``(M, 6, S)``, with the whole drag of the liquid in place of its pressure flow."""
    found = outputs.copy()
    couette = log_number + outputs[:, COUETTE] - np.log(3.0)
    found[:, PRESSURE_FLOW] = np.logaddexp(outputs[:, PRESSURE_FLOW], couette)
    return found


def with_whole_drag(smooth: SmoothFilms) -> SmoothFilms:
    """Smooth films of a cylinder with the whole drag of the liquid in place of the pressure flow."""
    log_number = smooth.lowest + smooth.step * np.arange(smooth.coefficients.shape[1] - 2)
    values = np.array(smooth(log_number, range(4)))
    values[2] = np.logaddexp(values[2], log_number + values[1] - np.log(3.0))
    return replace(smooth, coefficients=spline_coefficients(values))


def similar_speeds(
    outputs: FloatArray,
    speeds: FloatArray,
    others: FloatArray,
    places: FloatArray,
    wanted: tuple[float, float],
) -> FloatArray:
    """Speeds at which asperities carry what they carry under other cylinders: ``shift + stretch × speed``.

    Parameters
    ----------
    outputs : of M cylinders, shape ``(M, 6, K)``, at K speeds, in the unit of each material, dimensionless
    speeds : these speeds, rising, dimensionless, shape ``(K,)``
    others, places : those of the other ones, shape ``(M, 6, S)``, at S speeds, shape ``(S,)``
    wanted : two load fractions that are carried at similar speeds, dimensionless

    Returns
    -------
    similar : shift and stretch, dimensionless, shape ``(M, 2)``
    """
    odds = np.log(np.array(wanted)) - np.log1p(-np.array(wanted))
    found = np.empty((len(outputs), 2))
    for row, (one, other) in enumerate(zip(outputs, others, strict=True)):
        first, second = _Continued(speeds, _log_odds(one[FRACTION])).place_of(odds)
        begin, end = _Continued(places, _log_odds(other[FRACTION])).place_of(odds)
        stretch = np.clip((second - first) / (end - begin), *_STRETCHES)
        found[row] = first - stretch * begin, stretch
    return found


class _Continued:
    """A cubic spline through values at places, and straight on at both ends."""

    def __init__(self, places: FloatArray, values: FloatArray) -> None:
        self._spline = CubicSpline(places, values)
        self._slope = self._spline.derivative()
        self._ends, self._points = places[[0, -1]], (places, values)

    def __call__(self, place: FloatArray) -> FloatArray:
        held = np.clip(place, *self._ends)
        return np.asarray(self._spline(held) + self._slope(held) * (place - held))

    def place_of(self, values: FloatArray) -> FloatArray:
        """Where a falling function has given values: Newton steps from straight lines between the points."""
        places, points = self._points
        place = np.interp(-values, -points, places)
        for _ in range(_STEPS):
            place = place - (self(place) - values) / self._slope(np.clip(place, *self._ends))
        return place


def _log_odds(log_fraction: FloatArray) -> FloatArray:
    """ln f/(1 − f) of ln f."""
    return np.asarray(log_fraction - np.log(np.maximum(-np.expm1(log_fraction), _LEAST_ODDS)))
