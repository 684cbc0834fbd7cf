"""Simulation-based calibration: over the prior, the truth is a posterior draw like any other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from simulated_coverage import with_data
from small_models import finger, student, three_parameters

from skinbayes.fit import sample
from skinbayes.problem import Problem

SIMULATIONS = 100
BINS = 10


def relative(folder: Path) -> Problem:
    """Normal scatter in proportion to the prediction, and a factor between model and truth."""
    return finger(
        folder,
        'frictional_shear_stress = { lognormal = ["10 MPa", 0.5] }\n'
        'young_modulus_layer = { uniform = ["3 MPa", "12 MPa"] }',
        'family = "relative"\nnoise_scale = { lognormal = [0.2, 0.3] }\ndiscrepancy_factor = { lognormal = [1.0, 0.1] }',
        "relative.toml",
    )


@pytest.mark.slow
@pytest.mark.parametrize("build", [three_parameters, student, relative])
def test_ranks_are_uniform_and_intervals_cover(build, tmp_path: Path) -> None:
    problem = build(tmp_path)
    rng = np.random.default_rng(31)
    levels = np.full((SIMULATIONS, problem.dimension), np.nan)
    for i in range(SIMULATIONS):
        truth = problem.draw_prior(rng, 1)[0]
        data = problem.simulate(truth, rng)
        fit = sample(
            with_data(problem, data),
            seed=i,
            ess=400,
            walkers=32,
            max_steps=6000,
        )
        for j, name in enumerate(problem.names):
            draws = fit.draws(name)
            levels[i, j] = (np.sum(draws < truth[j]) + rng.random()) / (draws.size + 1)
    for j, name in enumerate(problem.names):
        counts = np.histogram(levels[:, j], BINS, (0.0, 1.0))[0]
        assert stats.chisquare(counts).pvalue > 1e-3, f"{name}: ranks {counts}"
        assert stats.kstest(levels[:, j], "uniform").pvalue > 1e-3, name
        for fraction in (0.5, 0.9):
            inside = int(np.sum(np.abs(levels[:, j] - 0.5) < fraction / 2))
            assert stats.binomtest(inside, SIMULATIONS, fraction).pvalue > 1e-3, (
                f"{name}: {inside} in the {fraction:.0%} interval"
            )


def test_few_simulations(tmp_path: Path) -> None:
    problem = three_parameters(tmp_path)
    rng = np.random.default_rng(32)
    levels = []
    for i in range(6):
        truth = problem.draw_prior(rng, 1)[0]
        data = problem.simulate(truth, rng)
        fit = sample(
            with_data(problem, data),
            seed=i,
            ess=200,
            importance=True,
            max_steps=1000,
        )
        levels.append(
            [np.mean(fit.draws(name) < value) for name, value in zip(problem.names, truth, strict=True)]
        )
    # under calibration the levels are uniform; all 18 beyond 2.5 % would be a broken posterior
    assert stats.kstest(np.ravel(levels), "uniform").pvalue > 1e-4
