"""The simultaneous band of an empirical distribution, against ArviZ, simulation and a case by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom

from skinbayes.statistics.counts import count_p_value
from skinbayes.statistics.uniformity import random_rank, uniform_band


def test_p_values_of_uniform_numbers_are_uniform() -> None:
    rng = np.random.default_rng(5)
    band = uniform_band(150)
    p = np.array([band.p_value(values) for values in rng.random((600, 150))])
    for level in (0.05, 0.2, 0.5):
        assert binom(600, level).ppf(1e-4) <= np.sum(p <= level) <= binom(600, level).ppf(1 - 1e-4)


def test_outside_the_band_is_where_the_p_value_is_small() -> None:
    rng = np.random.default_rng(6)
    band = uniform_band(100)
    low, high = band.limits(0.8)
    for values in rng.random((100, 100)):
        found = band.difference(values)
        outside = bool(((found < low - 1e-9) | (found > high + 1e-9)).any())
        assert outside == (band.p_value(values) <= 0.2)


def test_one_number_by_hand() -> None:
    # of one number u the count at z < u is 0, which has probability 1 - z, and after it 1 with probability z: the deepest is
    # 2 min(1 - z, z) at the places next to u and at the ends; 0.5 is in the middle of all
    assert uniform_band(1).p_value(np.array([0.005])) == pytest.approx(0.02, abs=0.011)
    assert uniform_band(1).p_value(np.array([0.5])) == pytest.approx(1.0, abs=0.03)


@pytest.mark.filterwarnings("ignore::FutureWarning")
def test_the_band_is_that_of_arviz() -> None:
    bands = pytest.importorskip("arviz.stats.ecdf_utils", reason="ArviZ from 1 on has it elsewhere")
    for count in (50, 200):
        band = uniform_band(count)
        expected = bands.ecdf_confidence_band(count, band.places, band.places, 0.95, "optimized")
        for mine, theirs in zip(band.limits(), expected, strict=True):
            # theirs is optimised to a few thousandths: a count more or less at some places
            assert np.abs(mine - (theirs - band.places)).max() <= 1.01 / count


def test_ranks_among_ties_are_random() -> None:
    rng = np.random.default_rng(7)
    draws = np.array([0.0, 1.0, 1.0, 2.0])
    assert random_rank(0.5, draws, rng) == 1
    found = np.bincount([random_rank(1.0, draws, rng) for _ in range(3000)], minlength=5)
    assert found[0] == found[4] == 0
    assert found[1:4] == pytest.approx([1000, 1000, 1000], abs=4 * np.sqrt(3000 * 2 / 9))


def test_a_count_of_events_alike_is_binomial() -> None:
    assert count_p_value(2, np.full(10, 0.5)) == pytest.approx(2 * binom.cdf(2, 10, 0.5))
    assert count_p_value(99, np.full(100, 0.8)) < 1e-3
