"""Loss of simulated skin comes back at the conditions of the finger pads, and elastic skin is refuted where it can be."""

from __future__ import annotations

import numpy as np
import pytest
from importance import importance_sample
from scipy import stats
from simulated_coverage import inside, possible_draws, with_data

from skinbayes.problem import load_problem

SIMULATIONS = 50
NEXT_TO_NOTHING = 0.02
"""tan δ up to which the posterior is averaged for its density at 0, over the prior's, the Bayes factor of elastic tissue
(Savage and Dickey): elastic skin is this model at 0."""


def study(
    simulations: int, seed: int = 31
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """True tan δ, its level, posterior mean and deviation of its logit, and ln of the Bayes factor against elastic skin."""
    maker = load_problem("finger-stribeck-viscoelastic")
    place = maker.names.index("loss_tangent_bulk")
    rng = np.random.default_rng(seed)
    truths = possible_draws(maker, rng, simulations)
    transform = maker.target().transform
    rows = []
    for truth, unconstrained in zip(truths, transform.forward(truths), strict=True):
        found = importance_sample(with_data(maker, maker.simulate(truth, rng)), rng)
        mean, width = found.moments()
        elastic = found.weights @ (transform.inverse(found.positions)[:, place] < NEXT_TO_NOTHING)
        least = 0.5 / found.effective_size  # none of the draws is as elastic as that
        factor = np.log(NEXT_TO_NOTHING / 0.5) - np.log(max(elastic, least))
        rows.append((truth[place], found.levels(unconstrained)[place], mean[place], width[place], factor))
        print(*(f"{x:.4f}" for x in rows[-1]), flush=True)
    return tuple(np.array(rows).T)  # type: ignore[return-value]


@pytest.mark.slow
def test_intervals_of_the_loss_cover_the_truth() -> None:
    """The 90 % intervals of 50 simulations, within what is binomial at 0.5 % on either side: 38 to 50 of them."""
    truths, levels, *_, factors = study(SIMULATIONS)
    low, high = stats.binom.ppf([0.005, 0.995], SIMULATIONS, 0.9)
    assert low <= inside(levels, 0.9) <= high
    assert stats.kstest(levels, "uniform").pvalue > 0.005
    lossy = truths > 0.1
    # where tissue loses that much, elastic skin is refuted more often than not
    assert np.count_nonzero(factors[lossy] > 0) > np.count_nonzero(lossy) / 2
