"""Noise families that a user brings: they scatter as they say, in every place, and not as a normal distribution."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats
from small_models import finger

import skinbayes as sb
from skinbayes.statistics.noise_families import NOISE_FAMILIES
from skinbayes.vocabulary import QUANTITIES

PARAMETERS = 'frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"'


def laplace_log_density(z):
    return -np.abs(z) - np.log(2.0)


def laplace_draw(rng, size):
    return rng.laplace(size=size)


def power_log_density(z, tail_exponent):
    return stats.gennorm.logpdf(z, tail_exponent)


def power_draw(rng, size, tail_exponent):
    return stats.gennorm.rvs(tail_exponent, size=size, random_state=rng)


@pytest.fixture
def own_families():
    """A Laplace family of ln, and a generalised normal with a shape parameter of its own; gone after the test."""
    sb.register_noise(
        sb.NoiseFamily("log_laplace", "Laplace of ln", laplace_log_density, laplace_draw, True, True)
    )
    sb.register_quantity("tail_exponent", symbol="β", unit="1", maximum=10.0)
    sb.register_noise(
        sb.NoiseFamily(
            "generalised_normal",
            "tails by choice",
            power_log_density,
            power_draw,
            False,
            False,
            ("tail_exponent",),
        )
    )
    yield
    for name in ("log_laplace", "generalised_normal"):
        del NOISE_FAMILIES[name]
    del QUANTITIES["tail_exponent"]


def test_a_laplace_family_from_outside(own_families, tmp_path):
    problem = finger(tmp_path, PARAMETERS, 'family = "log_laplace"\nnoise_scale = { half_normal = 0.5 }')
    theta = np.array([[8e6, 0.3], [12e6, 0.5]])
    y, f = problem.observed, problem.predict_data(theta)
    expected = stats.laplace.logpdf(np.log(y), np.log(f), theta[:, 1:]) - np.log(y)
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-12)
    normal = stats.norm.logpdf(np.log(y), np.log(f), theta[:, 1:]) - np.log(y)
    assert np.abs(expected - normal).max() > 0.1
    drawn = problem.simulate(np.tile(theta[0], (2000, 1)), np.random.default_rng(2))
    residual = (np.log(drawn) - np.log(f[0])) / theta[0, 1]
    assert stats.kstest(residual.ravel(), stats.laplace.cdf).pvalue > 1e-3
    assert stats.kstest(residual.ravel(), stats.norm.cdf).pvalue < 1e-6


def test_a_shape_parameter_of_ones_own_is_inferred_like_any_other(own_families, tmp_path):
    noise = 'family = "generalised_normal"\nnoise_scale = 0.3\ntail_exponent = { uniform = [0.5, 5] }'
    problem = finger(tmp_path, PARAMETERS, noise)
    assert problem.names == ("frictional_shear_stress", "tail_exponent")
    theta = np.array([[9e6, 1.3]])
    expected = stats.gennorm.logpdf(problem.observed, 1.3, problem.predict_data(theta), 0.3)
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-12)
    assert problem.check().identifiability is not None
    fit = sb.sample(problem, seed=2, ess=200, walkers=16, ensembles=2, max_steps=1000)
    assert 0.5 < fit.draws("tail_exponent").mean() < 5.0
    # the posterior on a grid, for the mean of ln of the stress
    stress, tail = np.meshgrid(np.geomspace(2e6, 4e7, 301), np.linspace(0.5, 5.0, 151)[1:-1], indexing="ij")
    grid = np.stack([stress.ravel(), tail.ravel()], axis=-1)
    weight = np.exp(problem.log_posterior(grid) + np.log(grid[:, 0]))
    mean = np.sum(weight * np.log(grid[:, 0])) / weight.sum()
    width = np.sqrt(np.sum(weight * (np.log(grid[:, 0]) - mean) ** 2) / weight.sum())
    assert abs(np.log(fit.draws("frictional_shear_stress")).mean() - mean) < 4 * width / np.sqrt(150)


def test_effects_of_groups_need_a_normal_family(own_families, tmp_path):
    text = 'family = "log_laplace"\nnoise_scale = 0.3\n[groups.person]\nscale = { half_normal = 0.3 }'
    with pytest.raises(sb.InputError, match="closed form, which noise 'log_laplace' does not allow"):
        finger(tmp_path, PARAMETERS, text)


def test_parameters_of_other_families_are_refused(own_families, tmp_path):
    with pytest.raises(sb.InputError, match="needs tail_exponent"):
        finger(tmp_path, PARAMETERS, 'family = "generalised_normal"\nnoise_scale = 0.3')
    with pytest.raises(sb.InputError, match="'gaussian' has no tail exponent; generalised_normal has"):
        finger(tmp_path, PARAMETERS, 'family = "gaussian"\nnoise_scale = 0.3\ntail_exponent = 2')
    with pytest.raises(sb.InputError, match=r"tail_exponent.*found 11.*between 0 and 10"):
        finger(tmp_path, PARAMETERS, 'family = "generalised_normal"\nnoise_scale = 0.3\ntail_exponent = 11')


def test_names_are_taken_once(own_families):
    with pytest.raises(sb.InputError, match="noise family 'log_laplace' already"):
        sb.register_noise(
            sb.NoiseFamily("log_laplace", "another", power_log_density, laplace_draw, True, True)
        )
    with pytest.raises(sb.InputError, match="'tail_exponent' means something else already"):
        sb.register_quantity("tail_exponent", symbol="b", unit="m")
    with pytest.raises(sb.InputError, match="letters, digits and underscores"):
        sb.register_quantity("tail exponent", symbol="b", unit="1")


def test_a_shape_parameter_that_is_no_quantity_is_named(tmp_path):
    family = sb.NoiseFamily("odd", "odd", power_log_density, power_draw, False, False, ("tail_weight",))
    sb.register_noise(family)
    try:
        with pytest.raises(sb.InputError, match=r"'tail_weight'.*register_quantity"):
            finger(tmp_path, PARAMETERS, 'family = "odd"\nnoise_scale = 0.3\ntail_weight = 2')
    finally:
        del NOISE_FAMILIES["odd"]
