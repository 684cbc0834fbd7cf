"""Round trips, Jacobians against finite differences, and behaviour far out."""

import pickle
from math import inf

import numpy as np
import pytest
from scipy import integrate

from skinbayes.errors import InputError
from skinbayes.statistics.priors import make_prior
from skinbayes.statistics.transforms import Transform, VectorTransform, transform_for

SUPPORTS = [
    (-inf, inf, "identity"),
    (0.0, inf, "log"),
    (-2.0, inf, "log"),
    (-inf, 3.0, "log_below"),
    (0.0, 1.0, "logit"),
    (-1.0, 0.5, "logit"),
    (1e6, 5e6, "logit"),
    (1e3, 1e9, "log_logit"),
]


@pytest.mark.parametrize(("lower", "upper", "kind"), SUPPORTS)
def test_round_trip_and_order(lower, upper, kind):
    transform = transform_for((lower, upper))
    assert transform.kind == kind
    z = np.linspace(-8.0, 8.0, 65)
    x = transform.inverse(z)
    assert (np.diff(x) > 0).all()
    assert (x > lower).all()
    assert (x < upper).all()
    np.testing.assert_allclose(transform.forward(x), z, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize(("lower", "upper", "kind"), SUPPORTS)
def test_jacobian_is_the_derivative(lower, upper, kind):
    transform = transform_for((lower, upper))
    z = np.linspace(-6.0, 6.0, 25)
    step = 1e-4
    slope = (transform.inverse(z + step) - transform.inverse(z - step)) / (2 * step)
    np.testing.assert_allclose(
        transform.log_jacobian(z), np.log(slope), atol=1e-6
    )  # truncation error of step²


@pytest.mark.parametrize(("lower", "upper", "kind"), SUPPORTS)
def test_far_out_nothing_is_nan(lower, upper, kind):
    transform = transform_for((lower, upper))
    z = np.array([-1e4, -800.0, -50.0, 50.0, 800.0, 1e4])
    assert not np.isnan(transform.inverse(z)).any()
    assert (transform.inverse(z) >= lower).all()
    assert (transform.inverse(z) <= upper).all()
    assert np.isfinite(transform.log_jacobian(z)).all()


def test_small_distances_to_the_ends_keep_their_digits():
    logit = Transform("logit", 0.0, 1.0)
    assert float(logit.inverse(-100.0)) == pytest.approx(np.exp(-100.0), rel=1e-12)
    assert float(logit.log_jacobian(700.0)) == pytest.approx(-700.0, rel=1e-12)
    assert float(logit.forward(1e-200)) == pytest.approx(np.log(1e-200), rel=1e-12)


def test_outside_the_support_is_nan_in_silence():
    assert np.isnan(transform_for((0.0, inf)).forward(-1.0))
    assert np.isnan(transform_for((0.0, 1.0)).forward([-0.5, 1.5])).all()
    assert transform_for((0.0, inf)).forward(0.0) == -inf


def test_log_logit_spreads_decades_evenly():
    transform = transform_for((1e3, 1e9))
    assert float(transform.inverse(0.0)) == pytest.approx(1e6, rel=1e-12)


@pytest.mark.parametrize("support", [(1.0, 1.0), (2.0, 1.0), (float("nan"), 1.0)])
def test_empty_support_is_refused(support):
    with pytest.raises(InputError, match="is empty"):
        transform_for(support)


@pytest.mark.parametrize(
    ("family", "arguments"),
    [("lognormal", [2.0, 0.7]), ("beta", [2.0, 3.0]), ("uniform", [-1.0, 4.0]), ("loguniform", [1e2, 1e7])],
)
def test_density_in_z_integrates_to_one(family, arguments):
    prior = make_prior(family, arguments)
    transform = transform_for(prior.support)
    area, _ = integrate.quad(
        lambda z: float(np.exp(prior.log_density(transform.inverse(z)) + transform.log_jacobian(z))), -40, 40
    )
    assert area == pytest.approx(1.0, abs=1e-6)


def test_vector_of_maps_equals_maps_one_by_one():
    supports = [(lower, upper) for lower, upper, _ in SUPPORTS]
    vector = VectorTransform.for_supports(supports)
    z = np.random.default_rng(2).normal(scale=3.0, size=(37, len(supports)))
    x = vector.inverse(z)
    single = [transform_for(support) for support in supports]
    for column, transform in enumerate(single):
        np.testing.assert_array_equal(x[:, column], transform.inverse(z[:, column]))
    expected = sum(transform.log_jacobian(z[:, i]) for i, transform in enumerate(single))
    np.testing.assert_allclose(vector.log_jacobian(z), expected, rtol=1e-13)
    np.testing.assert_allclose(vector.forward(x), z, rtol=1e-9, atol=1e-9)
    copy = pickle.loads(pickle.dumps(vector))
    assert copy == vector
    np.testing.assert_array_equal(copy.inverse(z), x)


@pytest.mark.parametrize("supports", [[(0.0, inf)] * 5, [(s[0], s[1]) for s in SUPPORTS] * 2])
def test_batch_and_rows_agree_to_the_last_bit(supports):
    vector = VectorTransform.for_supports(supports)
    z = np.random.default_rng(3).normal(scale=2.0, size=(41, len(supports)))
    x, jacobian = vector.inverse(z), vector.log_jacobian(z)
    for row in range(len(z)):
        assert vector.inverse(z[row : row + 1])[0].tolist() == x[row].tolist()
        assert float(vector.log_jacobian(z[row : row + 1])[0]) == float(jacobian[row])
    assert vector.inverse(np.asfortranarray(z)).tolist() == x.tolist()
