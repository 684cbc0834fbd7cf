"""Shares of a variance against algebra, and a copula against the distribution that draws are from."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from skinbayes.errors import InputError
from skinbayes.statistics.copula import GaussianCopula
from skinbayes.statistics.variance_shares import variance_shares


@pytest.mark.parametrize("correlation", [0.0, 0.6])
def test_linear_normal_shares_are_those_of_algebra(correlation: float) -> None:
    # y = 2a + b + 1.5e: alone a explains (2 + ρ)², b (1 + 2ρ)², both 5 + 4ρ, of 7.25 + 4ρ
    rng, rho = np.random.default_rng(2), correlation
    a, b = rng.multivariate_normal([0, 0], [[1, rho], [rho, 1]], size=40_000).T
    y = 2 * a + b + 1.5 * rng.normal(size=len(a))
    total = 7.25 + 4 * rho
    of_a, of_b, of_both = (2 + rho) ** 2 / total, (1 + 2 * rho) ** 2 / total, (5 + 4 * rho) / total
    found = variance_shares(y, {"a": a[:, None], "b": b[:, None]})
    expected = {
        "a": (of_a + of_both - of_b) / 2, "b": (of_b + of_both - of_a) / 2, "residual": 1 - of_both,
    }  # fmt: skip
    assert found.variance == pytest.approx(total, rel=0.03)
    for name, share in expected.items():
        assert found.shares[name] == pytest.approx(share, abs=0.01), name
        assert found.shares[name] == pytest.approx(share, abs=6 * found.standard_errors[name] + 1e-3), name
    assert sum(found.shares.values()) == pytest.approx(1.0, abs=1e-12)


def test_parabolas_and_products_are_seen_and_noise_is_not_fitted() -> None:
    a, b, c = np.random.default_rng(3).normal(size=(3, 20_000))
    curved = variance_shares(a * a + a * b, {"a": a[:, None], "b": b[:, None]})
    # Var a² = 2, Var ab = 1, and the product belongs half to each
    assert curved.shares["a"] == pytest.approx(2.5 / 3, abs=0.02)
    assert curved.shares["b"] == pytest.approx(0.5 / 3, abs=0.02)
    nothing = variance_shares(c, {"a": a[:, None], "none": np.empty((len(a), 0))})
    assert nothing.shares == pytest.approx({"a": 0.0, "none": 0.0, "residual": 1.0}, abs=2e-3)


def test_a_copula_has_margins_and_correlations_of_the_draws() -> None:
    rng = np.random.default_rng(4)
    covariance = np.array([[1.0, 0.7, -0.3], [0.7, 1.0, 0.1], [-0.3, 0.1, 1.0]])
    normal = rng.multivariate_normal(np.zeros(3), covariance, size=4000)
    # monotone functions of normal variables, for which it is exact
    draws = np.stack([np.exp(normal[:, 0]), stats.norm.cdf(normal[:, 1]), normal[:, 2] ** 3], axis=-1)
    found = GaussianCopula.of_draws(["a", "b", "c"], draws).values(rng.normal(size=(20_000, 3)))
    for column, other in zip(found.T, draws.T, strict=True):
        assert stats.ks_2samp(column, other).pvalue > 1e-3
    ranks = stats.spearmanr(found).statistic
    assert ranks == pytest.approx(6 / np.pi * np.arcsin(covariance / 2), abs=0.04)


def test_a_batch_and_its_rows_agree_to_the_last_bit() -> None:
    rng = np.random.default_rng(5)
    copula = GaussianCopula.of_draws(
        ["a", "b"], rng.normal(size=(500, 2)) @ np.array([[1.0, 0.5], [0.0, 1.0]])
    )
    normal = rng.normal(size=(7, 1, 2))
    together = copula.values(normal)
    assert all((copula.values(one) == together[i]).all() for i, one in enumerate(normal))


def test_draws_that_say_nothing_are_refused() -> None:
    with pytest.raises(InputError, match="20 draws; expected at least 100"):
        GaussianCopula.of_draws(["a"], np.random.default_rng(1).normal(size=(20, 1)))
    with pytest.raises(InputError, match="b is 1 in all draws"):
        GaussianCopula.of_draws(["a", "b"], np.stack([np.arange(200.0), np.ones(200)], axis=-1))
