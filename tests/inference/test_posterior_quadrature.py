"""Whole fits of small models against brute-force quadrature of the same posterior."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from small_models import student, three_parameters, two_parameters

from skinbayes.fit import Fit, sample
from skinbayes.problem import Problem

WITHIN = 4.5
"""Accepted distance in Monte Carlo standard errors; with the 24 comparisons below, once in 6000 runs by chance."""


def friction(problem: Problem, shear: np.ndarray, modulus: np.ndarray) -> np.ndarray:
    """Predictions on a grid, from one evaluation at σ_f = 1 Pa for each modulus: μ is proportional to σ_f."""
    columns = {"frictional_shear_stress": 1.0, "young_modulus_layer": None, "noise_scale": 0.1}
    theta = np.stack([
        modulus if columns[name] is None else np.full(modulus.shape, columns[name]) for name in problem.names
    ], axis=-1)  # fmt: skip
    return problem.predict(theta)["friction_coefficient"] * shear[:, None, None]


def log_prior_three(shear, modulus, scale, width, of_shear):
    """Densities written down here once more, in ln of the parameters."""
    return (
        of_shear(np.log(shear))[:, None, None]
        + stats.norm.logpdf(np.log(modulus), np.log(7e6), width)[None, :, None]
        + (stats.halfnorm.logpdf(scale, scale=0.5) + np.log(scale))[None, None, :]
    )


def flat(log_shear):
    """Log-uniform, as the grid is."""
    return np.zeros_like(log_shear)


def about_ten(log_shear):
    """Lognormal about 10 MPa."""
    return stats.norm.logpdf(log_shear, np.log(10e6), 0.7)


def quadrature(
    problem: Problem, width: float, log_likelihood: Callable, of_shear: Callable = flat
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Marginal densities on grids of ln θ: name to (grid of θ, density per ln θ)."""
    shear = np.exp(np.linspace(np.log(0.5e6), np.log(500e6), 361))
    modulus = np.exp(np.linspace(np.log(7e6) - 5 * width, np.log(7e6) + 5 * width, 121))
    scale = np.exp(np.linspace(np.log(0.02), np.log(3.0), 181))
    mu = friction(problem, shear, modulus)
    log_p = log_prior_three(shear, modulus, scale, width, of_shear)
    for k, s in enumerate(scale):
        log_p[:, :, k] += log_likelihood(problem.observed, mu, s).sum(axis=-1)
    p = np.exp(log_p - log_p.max())
    grids = (shear, modulus, scale)
    names = ("frictional_shear_stress", "young_modulus_layer", "noise_scale")
    return {
        name: (grid, p.sum(axis=tuple(a for a in range(3) if a != axis)))
        for axis, (name, grid) in enumerate(zip(names, grids, strict=True))
    }


def quantiles(grid: np.ndarray, density: np.ndarray, fractions: tuple[float, ...]) -> np.ndarray:
    """ln of quantiles by the trapezoidal rule in ln θ; and the density there per ln θ."""
    x = np.log(grid)
    mass = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(x))])
    at = np.interp(fractions, mass / mass[-1], x)
    return np.stack([at, np.interp(at, x, density / mass[-1])])


def compare(fit: Fit, marginals: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    fractions = (0.05, 0.5, 0.95)
    summary = fit.summary()
    for name, (grid, density) in marginals.items():
        expected, height = quantiles(grid, density, fractions)
        draws = np.log(fit.draws(name))
        size = min(summary.loc[name, "ess_bulk"], summary.loc[name, "ess_tail"], draws.size)
        error = np.sqrt(np.array(fractions) * (1 - np.array(fractions)) / size) / height
        found = np.quantile(draws, fractions)
        assert np.all(np.abs(found - expected) < WITHIN * error), (
            f"{name}: {np.round((found - expected) / error, 2)} standard errors at {fractions}"
        )
        # the whole distribution, not three quantiles of it alone
        x = np.log(grid)
        mass = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(x))])
        u = np.interp(draws[:: max(1, draws.size // 1000)], x, mass / mass[-1])
        assert stats.kstest(u, "uniform").pvalue > 1e-4


def test_two_parameters(tmp_path: Path) -> None:
    problem = two_parameters(tmp_path)
    shear = np.exp(np.linspace(np.log(10e6) - 6, np.log(10e6) + 6, 2401))
    scale = np.exp(np.linspace(np.log(0.05), np.log(3.0), 601))
    unit = problem.predict(np.array([1.0, 0.1]))["friction_coefficient"]
    residual = np.log(problem.observed) - np.log(shear[:, None] * unit)
    log_p = (
        stats.norm.logpdf(np.log(shear), np.log(10e6), 1.0)[:, None]
        + (stats.halfnorm.logpdf(scale, scale=0.5) + np.log(scale))[None, :]
        - 0.5 * (residual**2).sum(axis=-1)[:, None] / scale**2
        - len(problem.observed) * np.log(scale)
    )
    p = np.exp(log_p - log_p.max())
    fit = sample(problem, seed=11, ess=4000)
    assert fit.converged
    compare(fit, {"frictional_shear_stress": (shear, p.sum(axis=1)), "noise_scale": (scale, p.sum(axis=0))})


def test_three_parameters(tmp_path: Path) -> None:
    problem = three_parameters(tmp_path)
    fit = sample(problem, seed=12, ess=4000)
    assert fit.converged

    def lognormal(y, mu, s):
        return stats.norm.logpdf(np.log(y) - np.log(mu), 0.0, s)

    marginals = quadrature(problem, 0.5, lognormal)
    compare(fit, marginals)
    # the data say little about the modulus: were the prior ignored, the shear stress would be sharper
    shear = fit.summary().loc["frictional_shear_stress"]
    assert np.log(shear["q95"] / shear["q05"]) > 2 * 1.5 * 0.5


def test_heavy_tails(tmp_path: Path) -> None:
    problem = student(tmp_path)
    fit = sample(problem, seed=13, ess=4000)
    assert fit.converged

    def heavy(y, mu, s):
        return stats.t.logpdf((y - mu) / s, 3) - np.log(s)

    compare(fit, quadrature(problem, 0.3, heavy, about_ten))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_three_parameters_for_many_seeds(seed: int, tmp_path: Path) -> None:
    problem = three_parameters(tmp_path)

    def lognormal(y, mu, s):
        return stats.norm.logpdf(np.log(y) - np.log(mu), 0.0, s)

    compare(sample(problem, seed=100 + seed, ess=2000), quadrature(problem, 0.5, lognormal))
