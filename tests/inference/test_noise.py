"""Noise families against scipy.stats, against their own normalisation, and draws against densities."""

import pickle
from itertools import pairwise
from math import inf, nan

import numpy as np
import pytest
from scipy import integrate, stats

from skinbayes.errors import InputError
from skinbayes.statistics.noise_families import NOISE_FAMILIES, noise_family

OBSERVED = np.array([0.3, 1.4, 2.2])
PREDICTED = np.array([[0.35, 1.2, 2.0], [0.2, 1.9, 3.0]])
SPREAD = np.array([0.05, 0.0, 0.3])
SCALE = np.array([[0.2], [0.4]])
DISCREPANCY = np.array([[0.1], [0.25]])
TAILS = np.array([[3.0], [7.0]])


def shape(family, degrees_of_freedom=TAILS):
    """The shape parameters of a family, as keywords."""
    return {"degrees_of_freedom": degrees_of_freedom} if family.shape_parameters else {}


def reference(name, predicted, scale, spread, tails, discrepancy, observed):
    """The same distribution from scipy.stats, for scalars."""
    if name in ("gaussian", "student_t"):
        width = np.sqrt(scale**2 + spread**2 + (discrepancy * predicted) ** 2)
    elif name == "relative":
        width = np.sqrt((scale * predicted) ** 2 + spread**2 + (discrepancy * predicted) ** 2)
    else:
        width = np.sqrt(scale**2 + (spread / observed) ** 2 + discrepancy**2)
    if name in ("gaussian", "relative"):
        return stats.norm(predicted, width)
    if name == "student_t":
        return stats.t(tails, loc=predicted, scale=width)
    if name == "gamma":
        return stats.gamma(1 / width**2, scale=predicted * width**2)
    if name == "lognormal":
        return stats.lognorm(s=width, scale=predicted)
    return LogT(tails, np.log(predicted), width)


class LogT:
    """Student's t of the logarithm, which scipy.stats does not have."""

    def __init__(self, tails, location, scale):
        self.t = stats.t(tails, loc=location, scale=scale)

    def logpdf(self, y):
        return self.t.logpdf(np.log(y)) - np.log(y)

    def cdf(self, y):
        return self.t.cdf(np.log(y))


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_density_agrees_with_scipy(name):
    family = noise_family(name)
    value = family.log_density(OBSERVED, PREDICTED, SCALE, SPREAD, DISCREPANCY, **shape(family))
    assert value.shape == (2, 3)
    for b in range(2):
        for n in range(3):
            y = OBSERVED[n]
            expected = reference(
                name, PREDICTED[b, n], SCALE[b, 0], SPREAD[n], TAILS[b, 0], DISCREPANCY[b, 0], y
            ).logpdf(y)
            assert value[b, n] == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("name", NOISE_FAMILIES)
@pytest.mark.parametrize("prediction", [0.4, 3.0])
def test_density_integrates_to_one(name, prediction):
    family = noise_family(name)
    fraction = (
        0.2  # known spread of the datum: held as a fraction in the logarithmic families, whatever y is drawn
    )

    def density(t):
        y = np.exp(t) if family.logarithmic else t
        spread = fraction * y if family.logarithmic else fraction
        value = np.exp(
            float(family.log_density([y], [[prediction]], 0.3, [spread], 0.15, **shape(family, 5.0))[0, 0])
        )
        return value * y if family.logarithmic else value

    centre = np.log(prediction) if family.logarithmic else prediction
    cuts = [centre - 100.0, centre - 2.0, centre, centre + 2.0, centre + 100.0]  # beyond: < 1e-9 with 5 tails
    area = sum(integrate.quad(density, low, high, epsabs=1e-10)[0] for low, high in pairwise(cuts))
    assert area == pytest.approx(1.0, abs=1e-7)


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_draws_follow_the_density(name):
    family = noise_family(name)
    observed, spread = 1.1, 0.2
    predicted = np.full((3000, 1), 0.9)
    draws = family.draw(
        np.random.default_rng(8), predicted, 0.25, [spread], 0.1, observed=[observed], **shape(family, 4.0)
    )
    assert draws.shape == (3000, 1)
    expected = reference(name, 0.9, 0.25, spread, 4.0, 0.1, observed)
    assert stats.kstest(draws[:, 0], expected.cdf).pvalue > 1e-3


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_parameter_vectors_do_not_mix(name):
    family = noise_family(name)
    together = family.log_density(OBSERVED, PREDICTED, SCALE, SPREAD, DISCREPANCY, **shape(family))
    for b in range(2):
        one = family.log_density(
            OBSERVED, PREDICTED[b : b + 1], SCALE[b : b + 1], SPREAD, DISCREPANCY[b : b + 1],
            **shape(family, TAILS[b : b + 1]),
        )  # fmt: skip
        assert one[0].tolist() == together[b].tolist()


@pytest.mark.parametrize("name", ["student_t", "log_student_t"])
def test_many_degrees_of_freedom_are_normal(name):
    family = noise_family(name)
    normal = noise_family("lognormal" if family.logarithmic else "gaussian")
    np.testing.assert_allclose(
        family.log_density(OBSERVED, PREDICTED, SCALE, degrees_of_freedom=1e9),
        normal.log_density(OBSERVED, PREDICTED, SCALE),
        rtol=1e-6,
    )


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_impossible_is_minus_infinity(name):
    family = noise_family(name)
    predicted = np.array([[nan, inf, -inf, 0.5]])
    assert family.log_density([1.0] * 4, predicted, 0.1, **shape(family, 4.0))[0, :3].tolist() == [-inf] * 3
    assert np.isfinite(family.log_density([1.0] * 4, predicted, 0.1, **shape(family, 4.0))[0, 3])
    for scale in (0.0, -0.1, nan, inf):
        assert family.log_density([1.0], [[1.0]], scale, **shape(family, 4.0)).tolist() == [[-inf]]
    # a known spread makes an exact model possible
    assert np.isfinite(family.log_density([1.0], [[1.0]], 0.0, [0.1], **shape(family, 4.0))).all()
    if family.shape_parameters:
        for tails in (0.0, -1.0, nan):
            assert family.log_density([1.0], [[1.0]], 0.1, **shape(family, tails)).tolist() == [[-inf]]


@pytest.mark.parametrize("name", ["lognormal", "log_student_t"])
def test_logarithmic_families_need_positive_numbers(name):
    family = noise_family(name)
    value = family.log_density(
        [1.0, 1.0, -1.0, 0.0], [[0.0, -1.0, 1.0, 1.0]], 0.1, [0.1] * 4, **shape(family, 4.0)
    )
    assert value.tolist() == [[-inf] * 4]
    assert np.isnan(family.draw(np.random.default_rng(0), [[-1.0]], 0.1, **shape(family, 4.0))).all()
    with pytest.raises(InputError, match="Row 2 of the data is -1"):
        family.check_observed([1.0, -1.0])


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_data_that_are_not_numbers_are_refused(name):
    noise_family(name).check_observed(OBSERVED)
    with pytest.raises(InputError, match="Row 3"):
        noise_family(name).check_observed([1.0, 2.0, nan])


def test_relative_scale_is_free_of_units():
    """In another unit of the observable the log-density changes by ln of that unit only."""
    for name, family in NOISE_FAMILIES.items():
        if family.relative:
            small = family.log_density(OBSERVED, PREDICTED, SCALE, SPREAD, **shape(family))
            large = family.log_density(1e3 * OBSERVED, 1e3 * PREDICTED, SCALE, 1e3 * SPREAD, **shape(family))
            np.testing.assert_allclose(large, small - np.log(1e3), rtol=1e-10, err_msg=name)


def test_unknown_names_and_missing_arguments():
    with pytest.raises(InputError, match="Known: gaussian"):
        noise_family("gauss")
    with pytest.raises(TypeError, match="needs degrees_of_freedom"):
        noise_family("student_t").log_density([1.0], [[1.0]], 1.0)


@pytest.mark.parametrize("name", NOISE_FAMILIES)
def test_pickles(name):
    family = noise_family(name)
    assert pickle.loads(pickle.dumps(family)) == family
    assert family.normal == (not family.shape_parameters and family.one_shape)
