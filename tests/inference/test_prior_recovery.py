"""Without a likelihood the sampler returns the prior; with one, simulated truths are covered."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from small_models import finger, three_parameters

from skinbayes.fit import sample
from skinbayes.problem import load_problem
from skinbayes.problem.simulated import with_data
from skinbayes.problem.target import PosteriorTarget
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions

EVERY_KIND = (
    'frictional_shear_stress = { loguniform = ["0.5 MPa", "500 MPa"] }\n'
    "young_modulus_layer = { truncated_normal = ['7 MPa', '5 MPa', '1 MPa', '9 MPa'] }\n"
    "poisson_ratio_layer = { uniform = [0.2, 0.7] }\n"  # cut off at 0.5 by the physical range
    "poisson_ratio_bulk = { normal = [0.45, 0.1] }\n"
    'rms_height = { lognormal = ["22 um", 0.5] }\n'
    "hurst_exponent = { beta = [5, 2] }\n"
    'yield_stress = { gamma = [2, "30 MPa"] }'
)
EXACT = {
    "frictional_shear_stress": stats.loguniform(0.5e6, 500e6),
    "young_modulus_layer": stats.truncnorm(-6 / 5, 2 / 5, loc=7e6, scale=5e6),
    "poisson_ratio_layer": stats.uniform(0.2, 0.3),
    "poisson_ratio_bulk": stats.truncnorm(-14.5, 0.5, loc=0.45, scale=0.1),
    "rms_height": stats.lognorm(0.5, scale=22e-6),
    "hurst_exponent": stats.beta(5, 2),
    "yield_stress": stats.gamma(2, scale=30e6),
    "noise_scale": stats.halfcauchy(scale=0.3),
}


def independent_draws(problem, seed: int) -> np.ndarray:
    """Draws an autocorrelation time apart, from the prior alone, in SI."""
    target = PosteriorTarget(problem, use_likelihood=False)
    chains = run_ensembles(target, SamplerOptions(importance=False, seed=seed, ess=2500))
    assert chains.converged
    positions, _ = chains.draws()
    flat = positions.reshape(-1, positions.shape[-1])
    # further apart than the draws that are kept: KS assumes independence
    return target.transform.inverse(flat[np.random.default_rng(1).permutation(len(flat))[:1000]])


def test_without_a_likelihood_the_prior_comes_back(tmp_path: Path) -> None:
    problem = finger(tmp_path, EVERY_KIND, 'family = "lognormal"\nnoise_scale = { half_cauchy = 0.3 }')
    assert set(problem.names) == set(EXACT)
    draws = independent_draws(problem, seed=21)
    for i, name in enumerate(problem.names):
        assert stats.kstest(draws[:, i], EXACT[name].cdf).pvalue > 1e-3 / len(EXACT), name
    # independent in the prior, so uncorrelated in ranks
    ranks = np.abs(stats.spearmanr(draws).statistic - np.eye(len(EXACT)))
    assert ranks.max() < 4.5 / np.sqrt(len(draws))


def test_prior_draws_are_the_prior(tmp_path: Path) -> None:
    problem = finger(tmp_path, EVERY_KIND, 'family = "lognormal"\nnoise_scale = { half_cauchy = 0.3 }')
    draws = problem.draw_prior(np.random.default_rng(4), 4000)
    for i, name in enumerate(problem.names):
        assert stats.kstest(draws[:, i], EXACT[name].cdf).pvalue > 1e-3 / len(EXACT), name


@pytest.mark.slow
@pytest.mark.parametrize("name", ["forearm-glass", "forearm-glass-separate", "finger-water"])
def test_shipped_priors_come_back(name: str) -> None:
    problem = load_problem(name)
    draws = independent_draws(problem, seed=22)
    for i, parameter in enumerate(problem.free):
        assert stats.kstest(draws[:, i], parameter.prior.cdf).pvalue > 1e-3 / problem.dimension


def test_known_truths_are_covered(tmp_path: Path) -> None:
    problem = three_parameters(tmp_path)
    truth = np.array([12e6, 6e6, 0.25])
    for seed in (1, 2, 3):
        data = problem.simulate(truth, np.random.default_rng(seed))
        fit = sample(with_data(problem, data), seed=seed, ess=1000, walkers=32)
        for name, value in zip(problem.names, truth, strict=True):
            low, high = np.quantile(fit.draws(name), [0.0005, 0.9995])
            assert low < value < high, f"{name}, seed {seed}"
        # what the data determine, σ_f/E0, comes back sharply: the scatter of eleven people is 0.25/√11 = 8 %
        ratio = np.log(fit.draws("frictional_shear_stress") / fit.draws("young_modulus_layer") / 2.0)
        assert abs(ratio.mean()) < 4 * 0.25 / np.sqrt(11)
        assert 0.5 * 0.25 / np.sqrt(11) < ratio.std() < 2.5 * 0.25 / np.sqrt(11)
