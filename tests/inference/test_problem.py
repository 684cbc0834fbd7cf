"""A model file bound to its data: densities, batches, draws."""

from __future__ import annotations

import pickle
import runpy
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import integrate, stats
from small_models import finger, student, three_parameters, two_parameters

from skinbayes.errors import InputError
from skinbayes.problem import Problem, load_problem
from skinbayes.problem.target import PosteriorTarget

FITTED = ("forearm-glass", "forearm-glass-separate", "finger-water")


@pytest.fixture(scope="module", params=FITTED)
def shipped(request: pytest.FixtureRequest) -> Problem:
    return load_problem(request.param)


def draws(problem: Problem, count: int = 64) -> np.ndarray:
    return problem.draw_prior(np.random.default_rng(3), count)


# -- densities -------------------------------------------------------------------------------------------------------


def test_log_likelihood_sums_the_rows(shipped):
    theta = draws(shipped)
    pointwise = shipped.log_likelihood(theta, pointwise=True)
    assert pointwise.shape == (64, len(shipped.observed))
    assert_array_equal(shipped.log_likelihood(theta), pointwise.sum(axis=-1))


def test_rows_of_a_batch_equal_single_vectors_to_the_last_bit(shipped):
    theta = draws(shipped)
    batch = {
        "prior": shipped.log_prior(theta),
        "likelihood": shipped.log_likelihood(theta),
        "posterior": shipped.log_posterior(theta),
        "pointwise": shipped.log_likelihood(theta, pointwise=True),
        "prediction": shipped.predict(theta)["friction_coefficient"],
    }
    for i in (0, 1, 17, 63):
        single = {
            "prior": shipped.log_prior(theta[i]),
            "likelihood": shipped.log_likelihood(theta[i]),
            "posterior": shipped.log_posterior(theta[i]),
            "pointwise": shipped.log_likelihood(theta[i], pointwise=True),
            "prediction": shipped.predict(theta[i])["friction_coefficient"],
        }
        for name, value in single.items():
            assert_array_equal(value, batch[name][i], err_msg=name)
            assert np.ndim(value) == batch[name].ndim - 1
    # any other batch size and memory layout, too
    assert_array_equal(shipped.log_posterior(theta[5:12]), batch["posterior"][5:12])
    assert_array_equal(shipped.log_posterior(np.asfortranarray(theta)), batch["posterior"])
    assert_array_equal(shipped.log_posterior(theta[::-1])[::-1], batch["posterior"])


def test_posterior_is_prior_times_likelihood(shipped):
    theta = draws(shipped)
    assert_allclose(
        shipped.log_posterior(theta), shipped.log_prior(theta) + shipped.log_likelihood(theta), rtol=1e-14
    )


def test_impossible_parameters_have_no_density(shipped):
    theta = np.tile(shipped.prior_medians(), (shipped.dimension + 1, 1))
    for i in range(shipped.dimension):
        theta[i, i] = -1.0
    prior, posterior = shipped.log_prior(theta), shipped.log_posterior(theta)
    assert (prior[:-1] == -np.inf).all() and (posterior[:-1] == -np.inf).all()
    assert np.isfinite(posterior[-1])
    theta[0, 0] = np.nan
    assert shipped.log_posterior(theta)[0] == -np.inf
    assert not np.isnan(shipped.log_likelihood(theta)).any()


def test_prior_transform_is_the_quantile_function(shipped):
    u = np.random.default_rng(1).random((200, shipped.dimension))
    theta = shipped.prior_transform(u)
    assert theta.shape == u.shape
    assert_array_equal(shipped.prior_transform(u[7]), theta[7])
    for i, parameter in enumerate(shipped.free):
        assert_allclose(parameter.prior.cdf(theta[:, i]), u[:, i], atol=1e-12)
    assert_allclose(shipped.prior_transform(np.full(shipped.dimension, 0.5)), shipped.prior_medians())


def test_prior_transform_against_scipy(tmp_path):
    problem = three_parameters(tmp_path)
    u = np.array([[0.05, 0.5, 0.9], [0.3, 0.01, 0.25]])
    expected = np.stack(
        [
            stats.loguniform(0.5e6, 500e6).ppf(u[:, 0]),
            stats.lognorm(0.5, scale=7e6).ppf(u[:, 1]),
            stats.halfnorm(scale=0.5).ppf(u[:, 2]),
        ],
        axis=-1,
    )
    assert_allclose(problem.prior_transform(u), expected, rtol=1e-12)


def test_log_prior_integrates_to_one(tmp_path):
    problem = finger(
        tmp_path,
        'frictional_shear_stress = { uniform = ["1 MPa", "50 MPa"] }\n'
        "young_modulus_layer = { truncated_normal = ['7 MPa', '4 MPa', '1 MPa', '9 MPa'] }",
        'family = "lognormal"\nnoise_scale = 0.2',
    )

    def density(modulus: float, shear: float) -> float:
        return float(np.exp(problem.log_prior([shear * 1e6, modulus * 1e6]))) * 1e12

    # per MPa², and the support is the box
    total, error = integrate.dblquad(density, 1.0, 50.0, 1.0, 9.0)
    assert error < 1e-6
    assert total == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("build", [two_parameters, three_parameters])
def test_posterior_mass_is_the_same_in_both_coordinates(build, tmp_path):
    # the Jacobian of the sampler's coordinates: ∫ p(θ) dθ over the noise scale alone, by quadrature both ways
    problem = build(tmp_path)
    target = problem.target()
    theta = problem.prior_medians()
    i = problem.names.index("noise_scale")

    def in_parameters(scale: float) -> float:
        at = theta.copy()
        at[i] = scale
        return float(np.exp(problem.log_posterior(at) + 40.0))

    at_rest = target.transform.forward(theta[np.newaxis])

    def in_coordinates(z: float) -> float:
        at = at_rest.copy()
        at[0, i] = z
        return float(np.exp(target.log_density(at)[0] + 40.0))

    direct = integrate.quad(in_parameters, 0.0, 20.0, points=[0.1, 0.3, 1.0], limit=400)[0]
    mapped = integrate.quad(in_coordinates, -6.0, 3.0, limit=400)[0]
    # Jacobian of the coordinates that are held still, each by central differences of the map itself
    others = 0.0
    for j in range(problem.dimension):
        if j != i:
            step = np.zeros_like(at_rest)
            step[0, j] = 1e-5
            ends = [target.transform.inverse(at_rest + sign * step)[0, j] for sign in (1, -1)]
            others += float(np.log((ends[0] - ends[1]) / 2e-5))
    assert mapped == pytest.approx(direct * np.exp(others), rel=1e-6)


def test_likelihood_against_hand_written_densities(tmp_path):
    problem = student(tmp_path)
    theta = draws(problem, 5)
    mu = problem.predict(theta)["friction_coefficient"]
    observed = problem.observed
    expected = stats.t.logpdf(observed, 3, loc=mu, scale=theta[:, 2:])
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-11)
    problem = three_parameters(tmp_path)
    expected = stats.lognorm.logpdf(observed, s=theta[:, 2:], scale=mu)
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-11)


def test_a_factor_between_model_and_truth_multiplies_predictions(tmp_path):
    text = 'frictional_shear_stress = "15 MPa"\nyoung_modulus_layer = "7 MPa"'
    noise = 'family = "gaussian"\nnoise_scale = { half_normal = 0.5 }\n'
    plain = finger(tmp_path, text, noise)
    scaled = finger(tmp_path, text, noise + "discrepancy_factor = { lognormal = [0.8, 0.1] }")
    assert scaled.names == ("noise_scale", "discrepancy_factor")
    mu = plain.predict([0.3])["friction_coefficient"]
    assert_allclose(scaled.predict([0.3, 0.8])["friction_coefficient"], 0.8 * mu, rtol=1e-14)
    expected = stats.norm.logpdf(plain.observed, 0.8 * mu, 0.3)
    assert_allclose(scaled.log_likelihood([0.3, 0.8], pointwise=True), expected, rtol=1e-12)


def test_wrong_shapes_are_refused(shipped):
    for theta in (1.0, np.zeros(shipped.dimension + 1), np.zeros((2, 2, shipped.dimension)), np.zeros((0,))):
        with pytest.raises(InputError, match=f"expected \\({shipped.dimension},\\)"):
            shipped.log_posterior(theta)
    assert shipped.log_posterior(np.empty((0, shipped.dimension))).shape == (0,)


def test_simulated_data_scatter_as_the_noise_says(tmp_path):
    problem = two_parameters(tmp_path)
    theta = np.tile([12e6, 0.3], (4000, 1))
    simulated = problem.simulate(theta, np.random.default_rng(2))
    assert simulated.shape == (4000, 11)
    scores = np.log(simulated / problem.predict(theta)["friction_coefficient"]) / 0.3
    assert stats.kstest(scores.ravel(), "norm").pvalue > 1e-3
    again = problem.simulate(theta[:1], np.random.default_rng(2))
    assert again.shape == (1, 11) and problem.simulate(theta[0], np.random.default_rng(2)).shape == (11,)


def test_a_problem_is_frozen_and_travels_to_other_processes(shipped):
    with pytest.raises(FrozenInstanceError):
        shipped.fingerprint = "another"
    theta = draws(shipped, 8)
    copy = pickle.loads(pickle.dumps(shipped))
    assert_array_equal(copy.log_posterior(theta), shipped.log_posterior(theta))
    target = pickle.loads(pickle.dumps(shipped.target()))
    z = target.transform.forward(theta)
    assert_array_equal(target.log_density(z), shipped.target().log_density(z))


def test_starts_are_finite_distinct_and_seeded(shipped):
    target = shipped.target()
    first = target.starts(np.random.default_rng(5), 64)
    assert first.shape == (64, shipped.dimension)
    assert np.isfinite(target.log_density(first)).all()
    assert len(np.unique(first, axis=0)) == 64
    assert_array_equal(first, target.starts(np.random.default_rng(5), 64))
    assert PosteriorTarget(shipped, use_likelihood=False).fingerprint != target.fingerprint


# -- the fast way through the physics -----------------------------------------------------------------------------------


def test_posterior_of_a_shipped_model_is_that_of_the_public_functions(monkeypatch):
    """Physics with all its checks, and densities of SciPy; 1e-11 is what a sum of 16 terms up to 1e4 leaves."""
    folder = Path(__file__).parents[2] / "benchmarks"
    monkeypatch.syspath_prepend(str(folder))
    case = runpy.run_path(str(folder / "log_posterior.py"))["Case"]()
    assert_allclose(case.problem.log_posterior(case.batch), case.plain(case.batch), rtol=1e-12, atol=1e-11)


def test_width_of_noise_that_is_fixed_is_that_of_noise_that_is_free(tmp_path):
    free = two_parameters(tmp_path)
    fixed = finger(
        tmp_path,
        'frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"',
        'family = "lognormal"\nnoise_scale = { fixed = 0.3, source = "given" }',
    )
    stress = np.array([[5e6], [2e7], [-1.0]])
    both = np.concatenate([stress, np.full((3, 1), 0.3)], axis=1)
    for pointwise in (True, False):
        assert_array_equal(fixed.log_likelihood(stress, pointwise), free.log_likelihood(both, pointwise))
    assert_array_equal(fixed.noise_width(stress[0]), free.noise_width(both[0]))
