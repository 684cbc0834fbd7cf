"""Wider and narrower priors of every family, and weights of draws, against SciPy and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.statistics.families import FAMILIES
from skinbayes.statistics.priors import make_prior
from skinbayes.statistics.reweighting import reweighted
from skinbayes.statistics.widening import factor_of_reach, widened, width_ratio

EXAMPLES = {
    "lognormal": [3.0, 0.4],
    "normal": [-1.0, 0.5],
    "truncated_normal": [1.0, 0.1, 0.0, 4.0],
    "uniform": [1.0, 3.0],
    "loguniform": [2.0, 50.0],
    "half_normal": [0.3],
    "exponential": [2.0],
    "gamma": [9.0, 0.5],
    "beta": [400.0, 600.0],
    "student_t": [1.0, 0.5, 4.0],
    "half_student_t": [0.5, 4.0],
    "half_cauchy": [0.5],
}
IN_LOGARITHMS = ("lognormal", "loguniform")


def test_every_family_has_an_example():
    assert set(EXAMPLES) == set(FAMILIES)


@pytest.mark.parametrize("factor", [0.5, 2.0, 2.5])
@pytest.mark.parametrize("family", sorted(set(EXAMPLES) - {"gamma"}))
def test_quartiles_lie_that_many_times_as_far_apart(family, factor):
    before = make_prior(family, EXAMPLES[family])
    after = widened(before, factor)
    assert after.family == family
    quartiles = [p.quantile([0.25, 0.75]) for p in (before, after)]
    if family in IN_LOGARITHMS:
        quartiles = [np.log(q) for q in quartiles]
    # a beta distribution is nearly normal here; cut-offs lie far out
    tolerance = {"beta": 0.02, "truncated_normal": 1e-3}.get(family, 1e-9)
    assert np.diff(quartiles[1])[0] / np.diff(quartiles[0])[0] == pytest.approx(factor, rel=tolerance)


@pytest.mark.parametrize("family", ["lognormal", "normal", "uniform", "loguniform", "student_t"])
def test_the_middle_stays(family):
    before = make_prior(family, EXAMPLES[family])
    assert widened(before, 3.0).median == pytest.approx(before.median, rel=1e-9)


def test_a_gamma_keeps_its_mean_until_it_would_be_infinite_at_zero():
    shape, scale = widened(make_prior("gamma", [9.0, 0.5]), 2.0).arguments
    assert (shape, scale) == pytest.approx((9 / 4, 2.0))
    shape, scale = widened(make_prior("gamma", [9.0, 0.5]), 6.0).arguments
    assert (shape, scale) == pytest.approx((1.0, 9.0)) and np.sqrt(shape) * scale == pytest.approx(6 * 1.5)


def test_ends_go_no_further_than_is_possible_and_some_priors_stay_as_they_are():
    wide = widened(make_prior("uniform", [0.2, 0.8]), 10.0, 0.0, 1.0)
    assert wide.support == (0.0, 1.0)
    beta = make_prior("beta", [0.5, 0.5])
    assert widened(beta, 2.0) == beta
    with pytest.raises(InputError):
        widened(make_prior("normal", [-3.0, 1.0]).truncated(lower=0.0), 0.1)
    assert widened(make_prior("normal", [0.0, 1.0]).truncated(lower=0.0), 2.0).support[0] == 0.0


@pytest.mark.parametrize("family", EXAMPLES)
def test_a_difference_in_width_alone_is_found(family):
    before = make_prior(family, EXAMPLES[family])
    assert width_ratio(before, widened(before, 1.5)) == pytest.approx(1.5)
    assert width_ratio(before, make_prior("normal", [7.0, 0.123])) is None


def test_another_middle_is_no_difference_in_width():
    assert width_ratio(make_prior("lognormal", [2.0, 0.5]), make_prior("lognormal", [2.1, 1.0])) is None
    assert width_ratio(make_prior("uniform", [0.0, 2.0]), make_prior("uniform", [0.0, 4.0])) is None


def test_reach_moves_the_ends_of_priors_of_logarithms():
    for family in IN_LOGARITHMS:
        before = make_prior(family, EXAMPLES[family])
        after = widened(before, factor_of_reach(before, 10.0))
        ends = [p.support if family == "loguniform" else p.interval(0.9) for p in (before, after)]
        assert ends[1][1] / ends[0][1] == pytest.approx(10.0) == ends[0][0] / ends[1][0]
    assert factor_of_reach(make_prior("half_normal", [0.2]), 10.0) == 10.0


def test_weights_of_a_wider_normal_distribution_are_refused_for_their_tails():
    draws = np.random.default_rng(1).normal(size=(40, 4000))
    wider = 3 / 8 * draws**2  # twice the standard deviation, an integral twice as large; k is 3/4
    found = [reweighted(np.zeros(4000), ratios) for ratios in wider]
    assert np.mean([entry.shape for entry in found]) == pytest.approx(0.75, abs=0.1)
    narrower = [reweighted(np.zeros(4000), -1.5 * x**2) for x in draws]
    errors = [(entry.log_ratio + np.log(2.0)) / entry.error for entry in narrower]
    assert all(entry.reliable for entry in narrower) and 0.7 < np.std(errors) < 1.3
