"""Which predictions are values, and which rows of the data have none."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.problem.predicting import PredictingModel
from skinbayes.vocabulary import QUANTITIES

_NAMED = 5  # rows that a message lists


def has_value(name: str, values: FloatArray) -> NDArray[np.bool_]:
    """Tell where a prediction is a number, or infinite where that means something (the Kelvin radius of saturated air)."""
    infinite = QUANTITIES[name].infinite_allowed
    return np.isfinite(values) | (infinite & (values == np.inf))


def predicted_everywhere(problem: PredictingModel, draws: FloatArray) -> tuple[NDArray[np.bool_], str]:
    """Which of the parameter vectors have a value at all rows, for what the data hold, or for everything without data.

    Returns
    -------
    usable : shape ``(B,)``
    missing : where no vector at all has one, the rows with which none has and why; else empty
    """
    predicted = problem.predict(draws)
    names = problem.observables if problem.observations else tuple(predicted)
    found = {name: has_value(name, predicted[name]) for name in names}
    usable = np.logical_and.reduce([values.all(axis=-1) for values in found.values()])
    if usable.any():
        return usable, ""
    labels = problem.conditions.row_labels()
    for name, values in found.items():
        rows = np.flatnonzero(~values.any(axis=0))
        if rows.size:
            listed = ", ".join(labels[row] for row in rows[:_NAMED]) + (
                " and others" if rows.size > _NAMED else ""
            )
            many = "row" if rows.size == 1 else "rows"
            why = (
                " ".join(problem.explain(draws[:1], int(rows[0])))
                or "inputs there lie outside the range of the forward model"
            )
            return usable, f"{name} has no value at {many} {listed}: {why}"
    return usable, "each of them lacks a value at some row or other"
