"""The moves leave targets of known distribution as they are, and the test would notice if they did not."""

from __future__ import annotations

import numpy as np
import pytest
from sampling_targets import Banana, UnitGaussian
from scipy.stats import gaussian_kde, multivariate_t

from skinbayes.sampling.convergence import autocorrelation_time
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.moves import (
    default_moves,
    few_walkers_moves,
    kernel_density_proposal,
    student_proposal,
)
from skinbayes.sampling.options import SamplerOptions

LIMIT = 4.5
"""Standard errors; about 100 statistics are looked at, so chance alone reaches 4.5 once in a thousand seeds."""


def snooker_mixture():
    from emcee.moves import DEMove, DESnookerMove

    return [(DEMove(), 0.8), (DESnookerMove(), 0.2)]


def standard_error(statistic):
    """Of the mean of a statistic of shape (ensembles, steps, walkers), from its own autocorrelation."""
    tau, _ = autocorrelation_time(statistic.transpose(0, 2, 1).reshape(-1, statistic.shape[1]))
    return np.std(statistic) * np.sqrt(tau / statistic.size)


def largest_error(chains, target):
    """Largest deviation of mean, variance or a quantile's coverage from the truth, in standard errors."""
    kept = chains.positions[:, chains.kept]
    flat = kept.reshape(-1, kept.shape[-1])
    scores = target.scores(flat)
    probabilities = target.probabilities(flat)
    statistics = [scores, scores**2 - 1.0]
    statistics += [(probabilities <= level) - level for level in (0.05, 0.25, 0.5, 0.75, 0.95)]
    columns = [column.reshape(kept.shape[:-1]) for statistic in statistics for column in statistic.T]
    return max(abs(column.mean()) / standard_error(column) for column in columns)


@pytest.mark.parametrize(
    ("target", "ess"),
    [(UnitGaussian(2), 20_000), (UnitGaussian(5), 10_000), (UnitGaussian(10), 2_000), (Banana(2), 8_000)],
    ids=["gaussian-2", "gaussian-5", "gaussian-10", "banana"],
)
def test_default_moves_sample_known_targets(target, ess):
    chains = run_ensembles(target, SamplerOptions(importance=False, seed=11, ess=ess))
    assert chains.converged
    assert largest_error(chains, target) < LIMIT


@pytest.mark.parametrize(
    ("target", "ess"),
    [(UnitGaussian(2), 10_000), (UnitGaussian(5), 10_000), (UnitGaussian(10), 4_000), (Banana(2), 5_000)],
    ids=["gaussian-2", "gaussian-5", "gaussian-10", "banana"],
)
def test_moves_for_few_walkers_sample_known_targets(target, ess):
    chains = run_ensembles(target, SamplerOptions(importance=False, seed=11, ess=ess, expensive=True))
    assert chains.converged and chains.positions.shape[2] == 64
    assert largest_error(chains, target) < LIMIT


def test_banana_moments():
    """x1 = z + bend·(x0² − 1) has mean 0, variance 1 + 2·bend², where z and x0 are standard normal."""
    chains = run_ensembles(Banana(2, bend=0.5), SamplerOptions(importance=False, seed=3, ess=8_000))
    bent = chains.positions[:, chains.kept, :, 1]
    assert bent.mean() == pytest.approx(0.0, abs=4 * standard_error(bent))
    assert (bent**2).mean() == pytest.approx(1.5, abs=4 * standard_error(bent**2))
    assert standard_error(bent**2) < 0.05


def test_the_same_test_catches_a_biased_move():
    target = UnitGaussian(5)
    chains = run_ensembles(
        target, SamplerOptions(importance=False, seed=11, ess=1e9, max_steps=300), moves=snooker_mixture
    )
    assert largest_error(chains, target) > LIMIT
    assert chains.report.r_hat.max() < 1.02  # R-hat does not see the bias


@pytest.mark.slow
@pytest.mark.parametrize("dimension", [2, 5, 10])
def test_claimed_effective_sample_size_is_the_real_one(dimension):
    """The mean square error of a mean over many seeds is the variance over the claimed effective sample size."""
    target = UnitGaussian(dimension, spread=10.0, shift=8.0)
    ratios = []
    for seed in range(40):
        chains = run_ensembles(target, SamplerOptions(importance=False, seed=seed))
        mean = chains.positions[:, chains.kept].mean(axis=(0, 1, 2))
        ratios.append(mean**2 * chains.report.ess_bulk)
    # chi-square of 40·dimension values about 1: five standard deviations
    assert np.mean(ratios) == pytest.approx(1.0, abs=5 * np.sqrt(2.0 / (40 * dimension)))


@pytest.mark.parametrize("moves", [default_moves, few_walkers_moves])
def test_a_flat_complement_falls_back_to_differential_evolution(moves):
    """If the other half lies in a plane there is no density of it; the proposal then comes from its differences."""
    learnt = moves()[1][0]
    rng = np.random.RandomState(5)
    sample = rng.normal(size=(8, 3))
    complement = rng.normal(size=(8, 3))
    complement[:, 2] = 1.0
    proposal, factors = learnt.get_proposal(sample, [complement], np.random.RandomState(6))
    assert np.isfinite(proposal).all()
    assert np.array_equal(factors, np.zeros(8))  # symmetric
    assert np.array_equal(proposal[:, 2], sample[:, 2])  # differences lie in the plane
    assert not np.array_equal(proposal[:, :2], sample[:, :2])


def test_kernel_density_is_the_one_of_scipy():
    kernel_density = default_moves()[1][0]
    rng = np.random.RandomState(5)
    sample, complement = rng.normal(size=(64, 3)), rng.normal(size=(64, 3)) @ rng.normal(size=(3, 3))
    proposal, factors = kernel_density.get_proposal(sample, [complement[:20], complement[20:]], rng)
    independent = gaussian_kde(complement.T)
    assert factors == pytest.approx(independent.logpdf(sample.T) - independent.logpdf(proposal.T), abs=1e-10)


def test_student_distribution_is_the_one_of_scipy():
    rng = np.random.RandomState(5)
    sample, complement = rng.normal(size=(64, 3)), rng.normal(size=(64, 3)) @ rng.normal(size=(3, 3))
    proposal, factors = student_proposal(sample, complement, rng)
    independent = multivariate_t(complement.mean(axis=0), 1.1 * np.cov(complement.T), df=5)
    assert factors == pytest.approx(independent.logpdf(sample) - independent.logpdf(proposal), abs=1e-10)


def test_student_proposals_follow_it():
    """The covariance of a Student distribution with 5 degrees of freedom is 5/3 of the squared scale."""
    rng = np.random.RandomState(5)
    complement = 7.0 + rng.normal(size=(64, 3)) @ rng.normal(size=(3, 3))
    proposal, _ = student_proposal(np.zeros((200_000, 3)), complement, rng)
    expected = 1.1 * 5 / 3 * np.cov(complement.T)
    assert np.cov(proposal.T) == pytest.approx(expected, rel=0.05, abs=0.05 * np.abs(expected).max())
    assert proposal.mean(axis=0) == pytest.approx(complement.mean(axis=0), abs=0.02)


def test_kernel_density_proposals_follow_it():
    """The covariance of the proposals is the one of the walkers, widened by Scott's bandwidth squared."""
    rng = np.random.RandomState(5)
    complement = rng.normal(size=(64, 3)) @ rng.normal(size=(3, 3))
    proposal, _ = kernel_density_proposal(np.zeros((100_000, 3)), complement, rng)
    expected = np.cov(complement.T, bias=True) + gaussian_kde(complement.T).covariance
    assert np.cov(proposal.T) == pytest.approx(expected, rel=0.03, abs=0.03 * np.abs(expected).max())


def test_moves_take_all_randomness_from_the_generator_they_are_given():
    rng = np.random.RandomState(5)
    sample, complement = rng.normal(size=(64, 3)), rng.normal(size=(64, 3))
    for move, _ in default_moves() + few_walkers_moves()[1:]:
        move.setup(sample)
        np.random.seed(1)  # noqa: NPY002
        first = move.get_proposal(sample, [complement], np.random.RandomState(6))
        np.random.seed(2)  # noqa: NPY002
        second = move.get_proposal(sample, [complement], np.random.RandomState(6))
        assert np.array_equal(first[0], second[0])
        assert np.array_equal(first[1], second[1])
