"""Surfaces found from their spectra: intervals that cover, and how far a surface reaches into friction."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize
from synthetic_spectra import made_up_surface, map_of, radial_average

import skinbayes as sb
from skinbayes.problem.spectrum_problem import spectrum_problem
from skinbayes.roughness import SelfAffineSpectrum

TRUE = ("rms_height", "hurst_exponent", "wavevector_rolloff")


def posterior_quantiles(problem: sb.Problem, seed: int) -> dict[str, np.ndarray]:
    """5, 50 and 95 % quantiles of `posterior_draws`."""
    return {
        name: np.quantile(column, [0.05, 0.5, 0.95])
        for name, column in zip(problem.names, posterior_draws(problem, seed).T, strict=True)
    }


def posterior_draws(problem: sb.Problem, seed: int) -> np.ndarray:
    """Draws from one ensemble of walkers in ln of the parameters, without any of the package's rules."""
    import emcee

    rng = np.random.default_rng(seed)

    def log_density(x: np.ndarray) -> np.ndarray:
        # beyond the ends of the priors the density is zero
        density = problem.log_posterior(np.exp(np.clip(x, -60, 60))) + x.sum(axis=-1)
        return np.where(np.isfinite(density), density, -np.inf)

    tried = np.log(problem.draw_prior(rng, 4000))
    start = tried[np.argmax(log_density(tried))]
    best = optimize.minimize(
        lambda x: min(-float(log_density(x[None])[0]), 1e10),
        start,
        method="Nelder-Mead",
        options={"maxiter": 2000},
    ).x
    walkers, width = best + 0.01 * rng.normal(size=(128, len(best))), 0.01
    while (outside := ~np.isfinite(log_density(walkers))).any():  # the best may lie at an end of a prior
        width /= 2
        walkers[outside] = best + width * rng.normal(size=(outside.sum(), len(best)))
    sampler = emcee.EnsembleSampler(*walkers.shape, log_density, vectorize=True)
    sampler.random_state = np.random.RandomState(seed).get_state()
    sampler.run_mcmc(walkers, 500, skip_initial_state_check=True)
    return np.asarray(np.exp(sampler.get_chain(discard=200, flat=True)))


def test_the_sampler_finds_what_quadrature_finds() -> None:
    truth, _, surface = made_up_surface(np.random.default_rng(3), seed=3, size=128, pixel=4e-6)
    measured = radial_average(surface, 12)
    fit = sb.fit_spectrum(measured, seed=1, ess=400)
    assert fit.converged
    own = posterior_quantiles(spectrum_problem(measured), seed=1)
    for name in TRUE:
        low, _, high = own[name]
        assert fit.quantiles(name) == pytest.approx(own[name], abs=0.12 * (high - low)), name
        assert low - 0.5 * (high - low) < truth[name] < high + 0.5 * (high - low)


def compared(kink: float, seed: int) -> sb.Comparison:
    """How `compare` puts the free form and the self-affine one on a random map, from draws without the package's rules.

    Beyond 2e5 1/m the spectrum falls by a power of q that is ``kink`` less than before.
    """
    truth = SelfAffineSpectrum(
        rms_height=3e-6, hurst_exponent=0.75, wavevector_min=1.2e4, wavevector_rolloff=5e4, wavevector_max=1e9
    )
    surface = map_of(lambda q: truth.power(q) * np.maximum(q / 2e5, 1.0) ** kink, seed=seed)
    measured = radial_average(surface, 12)
    fits = []
    for shape in ("self-affine", "free-form"):
        problem = spectrum_problem(measured, shape=shape, name=shape)
        fits.append(sb.Fit.from_draws(problem, posterior_draws(problem, seed)[::16]))
    return sb.compare(fits)


@pytest.mark.slow
@pytest.mark.parametrize("kink", [0.0, 1.6])
def test_the_shape_that_a_surface_has_predicts_better(kink: float) -> None:
    for seed in (1, 2):
        comparison = compared(kink, seed)
        best, other = comparison.models
        print(kink, seed, best.name, other.elpd_difference, other.elpd_difference_se)
        if kink:
            assert best.name == "free-form" and other.told_apart
        else:  # six factors that are not needed predict no better
            assert not other.told_apart


@pytest.mark.slow
def test_intervals_of_100_synthetic_maps_cover() -> None:
    # 90 % intervals of 100 surfaces: outside 80 to 98 with probability 2e-3 for each of three parameters
    rng, hits = np.random.default_rng(11), dict.fromkeys(TRUE, 0)
    for number in range(100):
        truth, _, surface = made_up_surface(rng, seed=number)
        found = posterior_quantiles(spectrum_problem(radial_average(surface)), seed=number)
        for name, value in truth.items():
            hits[name] += bool(found[name][0] <= value <= found[name][2])
    print(hits)
    assert all(80 <= count <= 98 for count in hits.values()), hits
