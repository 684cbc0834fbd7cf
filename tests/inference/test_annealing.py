"""A population led to a narrow likelihood is distributed as it should be, modes included."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from small_models import write_model

from skinbayes.problem import load_problem
from skinbayes.problem import target as target_module
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.sampling.ensemble_engine import EnsembleEngine
from skinbayes.sampling.options import SamplerOptions
from skinbayes.statistics.annealing import anneal, effective_number, largest_power

COUNT = 2000


def normal(position):
    return -0.5 * np.square(position).sum(axis=1)


@pytest.mark.parametrize("final", [0.25, 1.0])
def test_a_narrow_gaussian_is_reached(final):
    # prior N(0, 1), likelihood N(3, 0.02²) in each of three dimensions: the tempered posterior is normal too
    def likelihood(position):
        return -0.5 * np.square((position - 3.0) / 0.02).sum(axis=1)

    rng = np.random.default_rng(2)
    start = rng.normal(size=(COUNT, 3))
    there = anneal(start, likelihood(start), 0.0, final, normal, likelihood, rng)
    precision = 1 + final / 0.02**2
    scores = (there - 3.0 * final / 0.02**2 / precision) * np.sqrt(precision)
    # members share ancestors: a few hundred of them are independent
    assert np.abs(scores.mean(axis=0)).max() < 0.25
    assert scores.std(axis=0) == pytest.approx(np.ones(3), abs=0.15)
    assert len(np.unique(there, axis=0)) > 0.95 * COUNT


def test_modes_keep_their_masses():
    # a quarter of the mass on the left, three quarters on the right, both far narrower than the prior
    def likelihood(position):
        left, right = (np.square((position - c) / 0.01).sum(axis=1) / 2 for c in (-1.0, 1.0))
        return np.logaddexp(np.log(0.25) - left, np.log(0.75) - right)

    fractions = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        start = rng.normal(size=(COUNT, 2))
        there = anneal(start, likelihood(start), 0.0, 1.0, normal, likelihood, rng)
        assert (np.abs(np.abs(there) - 1.0) < 0.06).all()
        fractions.append(float(np.mean(there[:, 0] > 0)))
    assert np.mean(fractions) == pytest.approx(0.75, abs=0.06)


def test_impossible_places_are_never_taken_and_nothing_moves_without_a_rise():
    def likelihood(position):
        value = -0.5 * np.square(position / 0.05).sum(axis=1)
        value[position[:, 0] < 0] = np.nan
        value[position[:, 1] > 0.1] = np.inf
        return value

    rng = np.random.default_rng(3)
    start = np.abs(rng.normal(size=(200, 2))) * [1.0, -1.0]
    there = anneal(start, likelihood(start), 1e-3, 1.0, normal, likelihood, rng)
    assert (there[:, 0] >= 0).all() and (there[:, 1] <= 0.1).all()
    still = anneal(start, likelihood(start), 1.0, 1.0, normal, likelihood, rng)
    np.testing.assert_array_equal(still, start)


def test_powers_and_effective_numbers():
    rng = np.random.default_rng(4)
    value = 50 * rng.normal(size=500)
    power = largest_power(value, 200.0)
    assert effective_number(power * value) == pytest.approx(200.0, rel=1e-6)
    following = largest_power(value, 200.0, power, 1.0)
    assert effective_number((following - power) * value) == pytest.approx(200.0, rel=1e-6)
    assert largest_power(1e-6 * value, 200.0) == 1.0


MODEL = """
title = "Many data"
forward = "constant"
[data]
file = "many.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [1, 2.0] }
[noise]
family = "lognormal"
noise_scale = { lognormal = [0.5, 1.5] }
"""


def problem_of_many_data(folder):
    data = np.exp(np.random.default_rng(5).normal(np.log(0.7), 0.02, size=400))
    (folder / "many.csv").write_text(
        "friction_coefficient [1]\n" + "\n".join(map(repr, data.tolist())) + "\n"
    )
    return load_problem(write_model(folder, MODEL))


def test_starts_are_led_on_where_prior_draws_do_not_find_the_posterior(tmp_path, monkeypatch):
    problem = problem_of_many_data(tmp_path)
    target = problem.target()
    led = target.starts(np.random.default_rng(1), 64)
    monkeypatch.setattr(target_module, "FOUND", -1.0)
    chosen = target.starts(np.random.default_rng(1), 64)
    best = target.log_density(led).max()
    # of a normal posterior in two dimensions widened to a quarter of its power nothing lies 60 below its top
    assert (target.log_density(led) > best - 60).all()
    assert np.median(target.log_density(chosen)) < best - 200
    assert len(np.unique(led, axis=0)) == 64


def test_what_starts_cost_is_counted_and_is_part_of_what_a_run_cost(tmp_path, monkeypatch):
    """Each row that the likelihood is asked for: candidates, and the moves of the population that is led on."""
    target = problem_of_many_data(tmp_path).target()
    asked = []
    likelihood = StatisticalModel.data_likelihood

    def watched(problem):
        density = likelihood(problem)
        return replace(density, function=lambda theta: asked.append(len(theta)) or density.function(theta))

    monkeypatch.setattr(StatisticalModel, "data_likelihood", watched)
    _, counted = target.starts_counted(np.random.default_rng(1), 64)
    assert counted == sum(asked) > 20 * 64
    asked.clear()
    draws = EnsembleEngine().run(target, SamplerOptions(seed=1, ess=500))
    assert draws.diagnostics["evaluations"] == sum(asked)
