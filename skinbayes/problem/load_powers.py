"""How each part of a prediction goes with the load: what a series of loads can tell of it."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.units import format_quantity
from skinbayes.vocabulary import QUANTITIES

STEP = 1e-3
"""Of ln of the load over which powers are taken."""

LEAST_RANGE = 1.2
"""Largest over smallest load below which nothing is said."""


def load_powers(problem: StatisticalModel) -> tuple[str, ...]:
    """A sentence on the parts of the prediction and the powers of the load with which they go, at the prior medians.

    Parameters
    ----------
    problem : any; nothing is said if its forward model has no parts, or its rows hardly differ in load
    """
    parts = problem.forward.parts
    inputs = problem.inputs(problem.prior_medians()[np.newaxis])
    load = "normal_force" if "normal_force" in inputs else "nominal_pressure"
    if parts is None or load not in problem.conditions.values:
        return ()
    loads = problem.conditions.values[load]
    if loads.max() < LEAST_RANGE * loads.min():
        return ()
    with np.errstate(all="ignore"):
        low, high = (
            parts({**inputs, load: inputs[load] * np.exp(step)}, problem.tables) for step in (-STEP, STEP)
        )
        total = [np.asarray(sum(found.values())) for found in (low, high)]
        share = {name: np.median(values / total[0]) for name, values in low.items()}
        powers = {name: _power(low[name], high[name]) for name in low}
    said = [f"{QUANTITIES[name].meaning} {share[name]:.0%}, power {_ends(powers[name])}" for name in powers]
    listed = said if len(said) > 1 else []
    unit = QUANTITIES[load].unit
    ends = " to ".join(format_quantity(float(end), unit, 3) for end in (loads.min(), loads.max()))
    return (
        f"Over the loads of the data ({ends}) the prediction at the prior medians goes as the load to the power "
        f"{_ends(_power(*total))}" + (f"; {'; '.join(listed)}." if listed else "."),
    )


def _power(low: FloatArray, high: FloatArray) -> FloatArray:
    return np.asarray(np.log(high / low) / (2 * STEP))


def _ends(powers: FloatArray) -> str:
    least, most = (f"{end + 0.0:.2f}".replace("-0.00", "0.00") for end in (np.min(powers), np.max(powers)))
    return least if least == most else f"{least} to {most}"
