"""Pareto-smoothed weights, their shape, and the errors of means under them."""

from __future__ import annotations

import arviz
import numpy as np
import pytest

from skinbayes.statistics.pareto import left_out_density, pareto_shape, smoothed
from skinbayes.statistics.reweighting import reweighted


@pytest.mark.skipif(not hasattr(arviz, "psislw"), reason="this ArviZ has it in another place")
def test_smoothed_weights_are_those_of_arviz():
    rng = np.random.default_rng(2)
    for shape in (0.1, 0.5, 0.9):
        ratios = -shape * np.log(rng.uniform(size=3000))
        expected, k = arviz.psislw(ratios.copy())
        found, own, _ = smoothed(ratios)
        assert own == pytest.approx(float(k), rel=1e-9)
        np.testing.assert_allclose(found - np.logaddexp.reduce(found), np.asarray(expected), atol=1e-9)


def test_weights_hundreds_of_powers_of_ten_apart_have_an_enormous_shape_in_silence():
    """Their ratios vanish beside the largest, one over them is infinite: warnings are errors here."""
    for spread in (100.0, 300.0, 700.0, 3000.0):
        for seed in range(10):
            log_weights = spread * np.random.default_rng(seed).normal(size=400)
            weights, shape, _ = smoothed(log_weights)
            assert shape > 10 and pareto_shape(np.exp(log_weights - log_weights.max())) == shape
            assert np.isfinite(weights).all() and weights.max() <= log_weights.max()
    ratios = np.random.default_rng(1).uniform(size=10_000) ** -0.3
    assert pareto_shape(1e-300 * ratios) == pytest.approx(pareto_shape(ratios), abs=1e-3)


def test_errors_of_mean_ratios_hold_where_their_variance_is_infinite():
    """The mean of exp(a x²/2), (1 − a)^(-1/2), is estimated with a variance for a < 0.5 only; beyond, it comes out too small."""
    wrong = often = 0
    for seed in range(150):
        x = np.random.default_rng([7, seed]).normal(size=4000)
        for a in (0.6, 0.69):
            found = left_out_density(-a * x**2 / 2, 4000)
            again = reweighted(np.zeros(4000), a * x**2 / 2)
            if not again.reliable:
                continue
            exact = -0.5 * np.log1p(-a)
            wrong += (
                abs(again.log_ratio - exact) > 3 * again.error
                or abs(found.log_density + exact) > 3 * found.error
            )
            often += 1
            assert again.error < 0.3
    # the error of independent draws alone was exceeded three times by 14 of 240
    assert often > 200 and wrong <= 0.02 * often
