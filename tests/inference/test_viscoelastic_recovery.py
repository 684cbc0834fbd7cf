"""Loss of simulated skin comes back at the conditions of the finger pads, and the evidence prefers the substrate that it was."""

from __future__ import annotations

import numpy as np
import pytest
from loss_studies import LOSS, FoundLoss, simulation
from scipy import stats
from simulated_coverage import inside

from skinbayes.problem import load_problem

SIMULATIONS, ELASTIC = 50, 10


def several(kind: str, count: int) -> list[FoundLoss]:
    found = []
    for number in range(count):
        found.append(simulation(number, kind))
        print(kind, number, found[-1], flush=True)
    return found


def test_the_two_models_differ_by_the_loss_alone() -> None:
    relaxing, elastic = load_problem("finger-stribeck-viscoelastic"), load_problem("finger-stribeck")
    assert set(relaxing.names) - set(elastic.names) == {LOSS} and set(elastic.names) <= set(relaxing.names)
    assert relaxing.data_fingerprint == elastic.data_fingerprint
    priors = {p.label: p.prior_text for p in relaxing.free}
    assert all(priors[p.label] == p.prior_text for p in elastic.free)


@pytest.mark.slow
def test_intervals_of_the_loss_cover_the_truth() -> None:
    """The 90 % intervals of 50 simulations, within what is binomial at 0.5 % on either side: 38 to 50 of them."""
    found = several("prior", SIMULATIONS)
    levels = np.array([one.level for one in found])
    low, high = stats.binom.ppf([0.005, 0.995], SIMULATIONS, 0.9)
    assert low <= inside(levels, 0.9) <= high
    assert stats.kstest(levels, "uniform").pvalue > 0.005
    # where tissue loses that much, elastic skin is refuted more often than not
    lossy = [one.preference > 0 for one in found if one.truth > 0.1]
    assert sum(lossy) > len(lossy) / 2


@pytest.mark.slow
def test_elastic_skin_is_preferred_where_it_is_the_truth() -> None:
    """More often than not, and never refuted: ln of the Bayes factor below 3 in each of ten simulations.

    Elastic data give the wrong model e³ in its favour with a probability of at most e⁻³, so that ten of them all do not with 60 %
    at least.
    """
    found = [one.preference for one in several("elastic", ELASTIC)]
    assert sum(preference < 0 for preference in found) > ELASTIC / 2
    assert max(found) < 3
