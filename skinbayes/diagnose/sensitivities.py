"""How predictions answer to parameters: finite differences at several points of the prior."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

IntArray: TypeAlias = NDArray[np.intp]

Predict = Callable[[FloatArray], FloatArray]
"""``(B, D)`` parameters to ``(B, N)`` predictions, on the scale on which the noise is given."""

Derived = Callable[[FloatArray], Mapping[str, FloatArray]]
"""``(B, D)`` parameters to named quantities, each ``(B,)``, ``(B, 1)`` or ``(B, N)``."""

STEP = 0.01
"""Half-width of the central difference, in prior standard deviations."""


@dataclass(frozen=True)
class Sensitivities:
    """Derivatives with respect to one coordinate for each parameter: its logarithm, or itself.

    Attributes
    ----------
    names : D parameters
    logarithmic : for each, True if the coordinate is ln
    prior_spread : standard deviation of each coordinate under the prior, shape ``(D,)``
    slopes : derivative of the predictions, shape ``(B, N, D)``
    derived : derivative of ln of each derived quantity that is positive and moves, ``(B, D)``, ``(B, 1, D)`` or ``(B, N, D)``
    failed : number of points that were left out because a prediction about them was not finite
    """

    names: tuple[str, ...]
    logarithmic: tuple[bool, ...]
    prior_spread: FloatArray
    slopes: FloatArray
    derived: dict[str, FloatArray]
    failed: int

    def scaled(self, noise: FloatArray, rows: IntArray) -> FloatArray:
        """Change of each row, in units of its noise, for one prior standard deviation; shape ``(B, rows, D)``."""
        return self.slopes[:, rows, :] * self.prior_spread / noise[rows, None]

    def derived_for(self, rows: IntArray) -> dict[str, FloatArray]:
        """Slopes of ln of the derived quantities in prior standard deviations, mean over ``rows``; ``(B, D)``."""
        means = {}
        for name, slopes in self.derived.items():
            if slopes.ndim == 3:  # a quantity that is the same for all rows may come as (B, 1)
                here = rows[rows < slopes.shape[1]] if slopes.shape[1] > 1 else slice(None)
                slopes = slopes[:, here, :].mean(axis=1)
            means[name] = slopes * self.prior_spread
        return means


def sensitivities(
    names: tuple[str, ...],
    predict: Predict,
    points: FloatArray,
    logarithmic: tuple[bool, ...],
    prior_spread: FloatArray,
    derived: Derived | None = None,
) -> Sensitivities:
    """Central differences of predictions and derived quantities.

    Parameters
    ----------
    names : D parameters
    predict : the predictions
    points : where to differentiate, shape ``(B, D)``, natural coordinates
    logarithmic : for each parameter, True to differentiate with respect to its logarithm
    prior_spread : standard deviation of each coordinate, shape ``(D,)``
    derived : quantities between parameters and predictions

    Returns
    -------
    the derivatives at those points where everything is finite

    Raises
    ------
    InputError
        if that is nowhere

    Examples
    --------
    >>> result = sensitivities(
    ...     ("a", "b"), lambda t: np.log(t[:, :1] / t[:, 1:] ** 2), np.array([[2.0, 3.0]]), (True, True), np.ones(2)
    ... )
    >>> print(result.slopes.round(6).tolist())
    [[[1.0, -2.0]]]
    """
    slopes, derived_slopes = [], []
    with np.errstate(all="ignore"):
        for column, (log, spread) in enumerate(zip(logarithmic, prior_spread, strict=True)):
            step = STEP * spread
            up, down = points.copy(), points.copy()
            up[:, column] = points[:, column] * np.exp(step) if log else points[:, column] + step
            down[:, column] = points[:, column] * np.exp(-step) if log else points[:, column] - step
            both = np.concatenate([up, down])
            slopes.append(_difference(np.asarray(predict(both), dtype=float), step))
            if derived is not None:
                quantities = {name: np.asarray(value, dtype=float) for name, value in derived(both).items()}
                derived_slopes.append({name: _difference(np.log(v), step) for name, v in quantities.items()})
    stacked = np.stack(slopes, axis=-1)
    quantities = {
        name: np.stack([s[name] for s in derived_slopes], axis=-1) for name in (derived_slopes or [{}])[0]
    }
    finite = np.isfinite(stacked).all(axis=(1, 2))
    if not finite.any():
        raise InputError("No prior draw has finite predictions; the priors or the conditions must be wrong.")
    kept = {name: value[finite] for name, value in quantities.items()}
    return Sensitivities(
        names,
        logarithmic,
        np.asarray(prior_spread, dtype=float),
        stacked[finite],
        {name: value for name, value in kept.items() if _moves(value * prior_spread)},
        int((~finite).sum()),
    )


def _moves(effect: FloatArray) -> bool:
    # rounding errors of a constant are no dependence
    return bool(np.isfinite(effect).all() and np.abs(effect).max() > 1e-6)


def _difference(both: FloatArray, step: float) -> FloatArray:
    half = len(both) // 2
    return (both[:half] - both[half:]) / (2.0 * step)
