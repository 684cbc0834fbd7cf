"""Weights of a mixture of models, by stacking of predictive distributions."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray


def stacking_weights(pointwise: FloatArray) -> FloatArray:
    """Weights of a mixture of predictive distributions that maximise its summed log density at left-out data.

    Parameters
    ----------
    pointwise : log predictive density of each left-out datum under each model, shape ``(models, N)``

    Returns
    -------
    ndarray
        Shape ``(models,)``, non-negative, sum 1.

    Examples
    --------
    >>> stacking_weights(np.log([[0.5, 0.5], [0.1, 0.1]])).round(3).tolist()
    [1.0, 0.0]
    """
    from scipy.optimize import minimize

    count = len(pointwise)
    density = np.exp(pointwise - pointwise.max(axis=0))
    solution = minimize(
        lambda w: -np.log(w @ density).sum(),
        np.full(count, 1 / count),
        jac=lambda w: -(density / (w @ density)).sum(axis=1),
        bounds=[(0.0, 1.0)] * count,
        constraints={"type": "eq", "fun": lambda w: w.sum() - 1.0, "jac": lambda w: np.ones(count)},
        method="SLSQP",
    )
    weights: FloatArray = np.clip(solution.x, 0.0, 1.0)
    return weights / weights.sum()
