"""A series whose rows are not independent: AR(1) noise and a drift of the friction coefficient itself.

With independent noise the answer is wrong and sure of it, and the page says that the rows follow each other; with noise that has
a memory, and a drift, the truth is inside.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.report.trends import trend_sentences

TRUTH, SLOPE, MEMORY, SCATTER, ROWS, STEP = 0.300, 6e-4, 0.8, 0.05, 200, 1.5


def fitted(correlation: dict[str, Any] | None) -> sb.Fit:
    """A fit to the series, which is the same whatever the noise of the model."""
    rng, time = np.random.default_rng(3), STEP * np.arange(ROWS)
    noise = rng.normal(size=ROWS)
    for row in range(1, ROWS):
        noise[row] = MEMORY * noise[row - 1] + np.sqrt(1.0 - MEMORY**2) * noise[row]
    with_memory = {} if correlation is None else {"correlation": {"along": "time", **correlation}}
    problem = sb.build_problem(
        "constant",
        {
            "time [s]": time,
            "friction_coefficient [1]": (TRUTH + SLOPE * time) * np.exp(SCATTER * noise),
        },
        parameters={"typical_friction_coefficient": {"loguniform": [0.01, 10.0]}},
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.2}, **with_memory},
    )
    return sb.sample(problem, seed=1, ess=400)


@pytest.mark.slow
def test_the_truth_is_inside_where_rows_may_follow_each_other() -> None:
    fit = fitted({"drift": 0.5})
    assert fit.converged
    low, high = fit.quantiles("typical_friction_coefficient", (0.05, 0.95))
    assert low < TRUTH < high and high - low < 0.1
    # each of the two intervals misses the truth in one of ten series; this is one series
    shortest, longest = fit.quantiles("correlation_length", (0.05, 0.95))
    assert shortest < -STEP / np.log(MEMORY) < longest


def test_independent_noise_is_sure_of_a_wrong_value_and_the_page_says_why() -> None:
    fit = fitted(None)
    low, _ = fit.quantiles("typical_friction_coefficient", (0.05, 0.95))
    assert low > 1.2 * TRUTH
    said = " ".join(trend_sentences(fit))
    assert "follow each other" in said and "[noise.correlation]" in said
