"""Populations of simulated panels come back with coverage; eleven people with four parameters each converge."""

from __future__ import annotations

import numpy as np
import pytest
from panels import CONTRAST, CURVE, LEVEL, curves, one_ensemble, treated
from scipy import stats

from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions

PANELS = 100


def shared_draws(seed: int, effect: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Draws of median, scale, contrast and spread of the contrast of one panel, in SI, and the truth."""
    problem, truth = treated(np.random.default_rng([seed, 31]), effect=effect)
    return one_ensemble(problem.target(), seed, 200)[:, : len(truth)], truth


def test_the_first_parameters_are_those_of_the_truth() -> None:
    problem, _ = treated(np.random.default_rng(1))
    assert [name.partition("[")[0] for name in problem.names[:4]] == [
        LEVEL, "population_scale", "contrast", "contrast_scale",
    ]  # fmt: skip
    assert problem.names[2] == CONTRAST


@pytest.mark.slow
def test_intervals_of_populations_cover() -> None:
    """90 % intervals of location, spread and contrast hold the truth in 90 % of panels drawn from the priors.

    Each count is binomial: below by chance in one of a thousand cases.
    """
    inside = np.zeros(4, dtype=int)
    for seed in range(PANELS):
        draws, truth = shared_draws(seed)
        low, high = np.quantile(draws, [0.05, 0.95], axis=0)
        inside += (low < truth) & (truth < high)
    assert (inside >= stats.binom.ppf(1e-3, PANELS, 0.9)).all(), inside


@pytest.mark.slow
def test_a_treatment_without_effect_is_found_at_its_nominal_rate() -> None:
    """A probability of 95 % or more, to either side, comes up in at most 10 % of panels without effect.

    By chance beyond the bound in one of a thousand cases.
    """
    found = 0
    for seed in range(PANELS):
        draws, _ = shared_draws(1000 + seed, effect=0.0)
        lower = float((draws[:, 2] < 0.0).mean())
        found += max(lower, 1.0 - lower) >= 0.95
    assert found <= stats.binom.ppf(0.999, PANELS, 0.1), found


@pytest.mark.slow
def test_eleven_people_of_four_parameters_converge() -> None:
    problem, medians, values = curves(1)
    target = problem.target()
    assert problem.dimension == 4 * 11 + 9
    chains = run_ensembles(target, SamplerOptions(seed=1, max_steps=4000))
    assert chains.converged, chains.report.sentence()
    draws = target.transform.inverse(chains.draws()[0].reshape(-1, problem.dimension))
    place = {name: i for i, name in enumerate(problem.names)}
    missed = 0
    for name in CURVE:
        low, high = np.quantile(draws[:, place[name]], [0.005, 0.995])
        # the median of eleven people lies about that of the population
        assert low < medians[name] < high
        scores = [place[f"population_deviate[{name}, P{i:02d}]"] for i in range(11)]
        scale = draws[:, [place[f"population_scale[{name}]"]]]
        people = draws[:, [place[name]]] * np.exp(scale * draws[:, scores])
        low, high = np.quantile(people, [0.05, 0.95], axis=0)
        missed += int(((values[name] < low) | (values[name] > high)).sum())
    assert missed <= stats.binom.ppf(0.999, 44, 0.1)
