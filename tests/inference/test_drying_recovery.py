"""Parameters of simulated drying series come back, and 90 % intervals cover the truth in about 90 % of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom
from small_models import write_model

from skinbayes.problem import Problem, load_problem

SERIES, ROUNDS = 60, 25
TIMES = np.concatenate([[5.0, 15.0], np.linspace(60.0, 420.0, 7), np.linspace(430.0, 640.0, 27)])
TEXT = """
title = "A drop on skin"
forward = "drying"
[data]
file = "series.csv"
observable = "friction_coefficient"
[surface]
name = "paper_reference"
[noise]
family = "lognormal"
noise_scale = 0.06
[parameters]
frictional_shear_stress = { lognormal = ["12 MPa", 0.5] }
evaporation_rate = { lognormal = ["0.17 um/s", 0.08] }
young_modulus_layer = { lognormal = ["7 MPa", 0.2] }
rms_height = { lognormal = ["22.4 um", 0.12] }
yield_stress = "50 MPa"
initial_film = "90 um"
contact_angle_counterface = "10 deg"
film_spread = "0.5 um"
young_modulus_layer_dry = "1 GPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
nominal_pressure = "6.83 kPa"
surface_tension = "72 mN/m"
contact_angle_skin = "80 deg"
wetting_time = "30 s"
"""


def bound(folder: Path, friction: np.ndarray) -> Problem:
    rows = [f"{t!r},{m!r}" for t, m in zip(TIMES.tolist(), friction.tolist(), strict=True)]
    text = "\n".join(["time [s],friction_coefficient [1]", *rows])
    (folder / "series.csv").write_text(text + "\n", encoding="utf-8")
    return load_problem(write_model(folder, TEXT))


def intervals(problem: Problem, maker: Problem, rng: np.random.Generator) -> np.ndarray:
    """90 % intervals of all parameters by importance sampling, refined about the posterior, shape ``(D, 2)``."""
    # the table of bridges depends on the priors only, so that one serves all series
    problem.__dict__["model"] = maker.model
    draws = np.log(problem.draw_prior(rng, 1000))
    log_prior = prior_in_logs(problem)
    weight = problem.log_likelihood(np.exp(draws))
    proposal = 0.0 * weight
    found_it = False
    for round_ in range(ROUNDS):
        if not found_it:
            fraction = flattened(weight - proposal, draws.shape[1])
        middle = fraction @ draws
        spread = np.cov(draws.T, aweights=fraction) * (4.0 if round_ == 0 else 2.0 if found_it else 1.6)
        root = np.linalg.cholesky(spread + 1e-12 * np.eye(middle.size))
        # tails of Student's t with 5 degrees of freedom
        normal = rng.normal(size=(1200, middle.size)) / np.sqrt(rng.chisquare(5, 1200) / 5)[:, None]
        draws = middle + normal @ root.T
        proposal = -(5 + middle.size) / 2 * np.log1p((normal**2).sum(axis=1) / 5)
        weight = problem.log_likelihood(np.exp(draws)) + log_prior(draws)
        ratio = np.where(np.isfinite(weight), weight - proposal, -np.inf)
        fraction = np.exp(ratio - ratio.max())
        fraction /= fraction.sum()
        enough = 1 / np.square(fraction).sum() > 200
        if enough and found_it:  # twice, the second time about the posterior itself and wider
            break
        found_it = enough
    else:
        raise AssertionError("the posterior was not found")
    found = []
    for column in draws.T:
        order = np.argsort(column)
        below = np.cumsum(fraction[order])
        found.append(np.interp([0.05, 0.95], below, column[order]))
    return np.array(found)


def prior_in_logs(problem: Problem):
    def density(draws: np.ndarray) -> np.ndarray:
        return problem.log_prior(np.exp(draws)) + draws.sum(axis=1)

    return density


def flattened(weight: np.ndarray, dimension: int) -> np.ndarray:
    """Weights raised to the largest power that leaves a fair number of draws."""
    usable = np.where(np.isfinite(weight), weight - np.max(weight[np.isfinite(weight)]), -np.inf)
    for power in np.geomspace(1.0, 1e-4, 60):
        fraction = np.exp(power * usable)
        fraction /= fraction.sum()
        if 1 / np.square(fraction).sum() > 12 * dimension:
            break
    return fraction


@pytest.mark.slow
def test_intervals_cover_the_truth_as_often_as_they_say(tmp_path: Path) -> None:
    maker = bound(tmp_path, np.ones(TIMES.size))
    rng = np.random.default_rng(11)
    truths = maker.draw_prior(rng, SERIES)
    covered, widths = [], []
    for truth in truths:
        problem = bound(tmp_path, maker.simulate(truth, rng))
        ends = intervals(problem, maker, rng)
        covered.append((ends[:, 0] < np.log(truth)) & (np.log(truth) < ends[:, 1]))
        widths.append(np.diff(ends, axis=1)[:, 0])
    hits = np.sum(covered, axis=0)
    # 90 % of 60 series: between 48 and 59 with 99 % probability
    low, high = binom.ppf([0.005, 0.995], SERIES, 0.9)
    assert np.all((hits >= low) & (hits <= high)), dict(zip(maker.names, hits.tolist(), strict=True))
    assert low * maker.dimension < hits.sum()
    # the series, not the prior, sets the width of what they tell best
    prior = {"frictional_shear_stress": 0.5, "evaporation_rate": 0.08}
    for name, sd in prior.items():
        assert np.median(widths, axis=0)[maker.names.index(name)] < 0.5 * 3.29 * sd, name
