"""A fit with effects of people and liquids, and flags, whose draws are chosen by hand; the curve is a descriptive law."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import xarray

from skinbayes.fit import Fit, sample
from skinbayes.problem import load_problem

MEANING = "the contact is wider than half the radius of the ball"


@cache
def finger_fit() -> Fit:
    """The descriptive law on all 165 rows, sampled much too briefly."""
    return sample(
        load_problem("finger-descriptive"), max_steps=100, ensembles=2, walkers=32, importance=False
    )


def with_effects(fit: Fit, column: str, centres: np.ndarray, width: float, scale: float) -> Fit:
    """The fit with normal effects about ``centres`` and a scale about ``scale``."""
    posterior = fit.groups["posterior"].copy(deep=True)
    rng = np.random.default_rng(2)
    effect = posterior[f"{column}_effect"]
    effect.values = centres + width * rng.normal(size=effect.shape)
    scales = posterior["group_scale"]
    scales.loc[{"group": column}] = scale * np.exp(0.1 * rng.normal(size=scales.shape[:2]))
    return replace(fit, groups={**fit.groups, "posterior": posterior})


def with_flags(fit: Fit, **fractions: np.ndarray) -> Fit:
    """The fit with the fraction of the draws in which each row is flagged, by flag; all mean the same."""
    rows = fit.groups["observed_data"]["row"]
    validity = xarray.Dataset(
        {name: (("row",), values) for name, values in fractions.items()}, coords={"row": rows}
    )
    assert fit.problem is not None
    forward = replace(
        fit.problem.forward,
        flags=lambda inputs, tables: {},
        flag_meanings=dict.fromkeys(fractions, MEANING),
    )
    problem = replace(fit.problem, forward=forward)
    return replace(fit, groups={**fit.groups, "validity": validity}, problem=problem)
