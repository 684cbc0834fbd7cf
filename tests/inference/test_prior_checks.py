"""Contraction, contradiction and ridges on draws of known distributions."""

from math import inf

import numpy as np
import pytest
from scipy import stats

from skinbayes.diagnose import prior_updates, ridges
from skinbayes.statistics.transforms import VectorTransform


def test_contraction_is_measured_in_the_unconstrained_coordinate():
    rng = np.random.default_rng(5)
    prior, posterior = np.exp(rng.normal(size=(20000, 1))), np.exp(0.5 * rng.normal(size=(20000, 1)))
    log = VectorTransform.for_supports([(0.0, inf)])
    (update,) = prior_updates(["a"], prior, posterior, log)
    assert update.contraction == pytest.approx(0.75, abs=0.02)  # 1 − 0.5²; four standard errors
    assert update.verdict == "updated"


def test_verdicts():
    rng = np.random.default_rng(6)
    prior = rng.normal(size=(20000, 4))
    posterior = rng.normal(size=(20000, 4)) * [1.0, 0.2, 0.2, 0.2] + [0.0, 2.0, 2.6, -9.0]
    still, moved, above, below = prior_updates(list("abcd"), prior, posterior)
    assert still.verdict == "not updated"
    assert moved.verdict == "updated"  # the median is at the prior's 97.7 %
    assert moved.prior_quantile == pytest.approx(stats.norm.cdf(2.0), abs=0.01)
    assert (above.verdict, below.verdict) == ("contradicted", "contradicted")


def test_ridges_and_their_exponents():
    rng = np.random.default_rng(7)
    x, y = rng.normal(size=(2, 4000))
    a, b = np.exp(x), np.exp(-2.0 * x + 0.05 * rng.normal(size=4000))
    draws = np.column_stack([a, b, np.exp(y), x + 0.01 * y])
    fixed = np.column_stack([draws, np.ones(4000)])
    found = ridges(["a", "b", "c", "x", "fixed"], fixed)
    assert {(ridge.first, ridge.second) for ridge in found} == {("a", "b"), ("a", "x"), ("b", "x")}
    pair = next(ridge for ridge in found if (ridge.first, ridge.second) == ("a", "b"))
    assert pair.exponent == pytest.approx(-2.0, rel=0.01)
    linear = next(ridge for ridge in found if ridge.second == "x")
    assert not linear.logarithmic
    assert ridges(["a", "c"], draws[:, [0, 2]]) == ()


def test_a_parameter_can_be_moved_without_being_narrowed() -> None:
    rng = np.random.default_rng(4)
    prior = rng.normal(size=(4000, 2))
    posterior = rng.normal([-1.6, 0.3], 1.0, size=(4000, 2))
    moved, still = prior_updates(["a", "b"], prior, posterior)
    assert (moved.verdict, still.verdict) == ("moved", "not updated")
