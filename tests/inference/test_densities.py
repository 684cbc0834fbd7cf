"""Densities take a Jacobian, likelihoods do not; products by type; impossible values counted."""

import pickle
from math import inf, nan

import numpy as np
import pytest
from scipy import integrate, stats

from skinbayes.statistics.densities import LogDensity, LogLikelihood
from skinbayes.statistics.priors import make_prior
from skinbayes.statistics.transforms import VectorTransform

PRIORS = (make_prior("lognormal", [2.0, 0.5]), make_prior("uniform", [0.0, 3.0]))
TO_LINE = VectorTransform.for_supports([prior.support for prior in PRIORS])


def poisson(theta):
    """Four counts with mean a·b."""
    mean = theta[:, :1] * theta[:, 1:]
    return stats.poisson.logpmf(np.array([2, 3, 5, 1]), mean).sum(axis=1)


def refuse(theta):
    assert (theta[:, 1] <= 3.0).all(), "the likelihood was asked about an excluded parameter"
    return -theta[:, 0]


def test_independent_priors_add_up():
    """Columns of one family are evaluated together; the sum is that of the priors one by one."""
    priors = (
        make_prior("lognormal", [2.0, 0.5]),
        make_prior("uniform", [0.0, 3.0]),
        make_prior("lognormal", [5.0, 1.5]).truncated(upper=9.0),
        make_prior("student_t", [0.0, 1.0, 3.0]),
        make_prior("uniform", [-1.0, 1.0]),
    )
    rng = np.random.default_rng(3)
    theta = np.stack([prior.draw(rng, 50) for prior in priors], axis=1)
    theta[7, 2], theta[9, 4], theta[11, 0] = 9.5, nan, -1.0
    values = LogDensity.independent(priors)(theta)
    expected = sum(prior.log_density(theta[:, i]) for i, prior in enumerate(priors))
    np.testing.assert_allclose(values, expected, rtol=1e-13)
    assert np.flatnonzero(values == -inf).tolist() == [7, 9, 11]


def test_density_in_new_coordinates_keeps_its_mass():
    posterior = LogDensity.independent(PRIORS).times(LogLikelihood(poisson))
    natural, _ = integrate.dblquad(
        lambda b, a: float(np.exp(posterior(np.array([[a, b]]))[0])), 1e-3, 30.0, 0.0, 3.0, epsrel=1e-6
    )
    on_line = posterior.transformed(TO_LINE)
    z = np.linspace(-12.0, 12.0, 241)
    grid = np.stack(np.meshgrid(z, z, indexing="ij"), axis=-1).reshape(-1, 2)
    # trapezoidal rule: converges exponentially for a smooth density that vanishes at both ends
    mass = np.exp(on_line(grid)).sum() * (z[1] - z[0]) ** 2
    assert mass == pytest.approx(natural, rel=1e-4)


def test_the_prior_alone_gets_the_jacobian():
    prior, likelihood = LogDensity.independent(PRIORS), LogLikelihood(poisson)
    z = np.random.default_rng(1).normal(size=(20, 2))
    theta = TO_LINE.inverse(z)
    on_line = prior.transformed(TO_LINE)(z)
    np.testing.assert_allclose(on_line - prior(theta), TO_LINE.log_jacobian(z), rtol=1e-12)
    both = prior.times(likelihood).transformed(TO_LINE)(z)
    np.testing.assert_allclose(both, on_line + likelihood(theta), rtol=1e-12)


def test_two_densities_are_not_multiplied():
    prior = LogDensity.independent(PRIORS)
    with pytest.raises(TypeError, match="not by another density"):
        prior.times(prior)
    with pytest.raises(TypeError):
        prior * prior


def test_likelihood_is_not_asked_where_the_prior_is_zero():
    posterior = LogDensity.independent(PRIORS).times(LogLikelihood(refuse))
    theta = np.array([[1.0, 4.0], [1.0, 2.0], [-1.0, 3.5], [nan, 5.0]])
    values = posterior(theta)
    assert values[[0, 2, 3]].tolist() == [-inf] * 3
    assert values[1] == LogDensity.independent(PRIORS)(theta[1:2])[0] - 1.0
    assert posterior(theta[[0]]).tolist() == [-inf]


def test_far_out_on_the_line_is_impossible_not_nan():
    posterior = LogDensity.independent(PRIORS).transformed(TO_LINE)
    values = posterior(np.array([[1e5, 0.0], [-1e5, 0.0], [inf, 0.0], [nan, 0.0], [0.0, 1e5]]))
    assert not np.isnan(values).any()
    assert values[:4].tolist() == [-inf] * 4


def test_a_posterior_travels_to_another_process():
    posterior = LogDensity.independent(PRIORS).times(LogLikelihood(poisson))
    posterior = posterior.transformed(TO_LINE)
    z = np.random.default_rng(4).normal(size=(5, 2))
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(posterior))(z), posterior(z))


def test_batch_and_rows_agree_to_the_last_bit():
    written = {
        "lognormal": [2.0, 0.5],
        "gamma": [2.5, 0.3],
        "beta": [2.0, 3.0],
        "student_t": [0.0, 1.0, 4.0],
        "half_cauchy": [1.0],
        "loguniform": [1.0, 1e3],
        "truncated_normal": [0.0, 1.0, -1.0, 2.0],
    }
    priors = [make_prior(family, arguments) for family, arguments in written.items()] * 2
    to_line = VectorTransform.for_supports([prior.support for prior in priors])
    density = LogDensity.independent(priors).transformed(to_line)
    z = np.random.default_rng(5).normal(size=(33, len(priors)))
    assert density(z).tolist() == [float(density(row[None])[0]) for row in z]
    assert density(z[5:20]).tolist() == density(z)[5:20].tolist()
