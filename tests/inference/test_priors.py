"""Closed-form log-densities against scipy.stats; distribution functions, truncation and refusals."""

import pickle
import warnings
from dataclasses import FrozenInstanceError
from math import inf, nan

import numpy as np
import pytest
from scipy import integrate, stats

from skinbayes.errors import InputError
from skinbayes.statistics.families import FAMILIES
from skinbayes.statistics.priors import make_prior

# family, arguments, the same distribution by another class or limit of SciPy where there is one
CASES = [
    ("lognormal", [15e6, 0.5], stats.lognorm(s=0.5, scale=15e6)),
    ("lognormal", [1e-9, 2.5], stats.lognorm(s=2.5, scale=1e-9)),
    ("normal", [-3.0, 2.0], stats.norm(-3.0, 2.0)),
    ("truncated_normal", [1.0, 2.0, 0.0, 3.0], stats.truncnorm(-0.5, 1.0, loc=1.0, scale=2.0)),
    ("truncated_normal", [0.0, 1.0, 5.0, inf], stats.truncnorm(5.0, inf)),
    ("truncated_normal", [0.0, 1.0, -inf, inf], stats.norm()),
    ("uniform", [1e6, 5e7], stats.uniform(1e6, 4.9e7)),
    ("loguniform", [1e3, 1e9], stats.loguniform(1e3, 1e9)),
    ("half_normal", [0.3], stats.halfnorm(scale=0.3)),
    ("exponential", [4.0], stats.expon(scale=4.0)),
    ("gamma", [2.5, 0.2], stats.gamma(2.5, scale=0.2)),
    ("gamma", [0.5, 3.0], stats.gamma(0.5, scale=3.0)),
    ("beta", [2.0, 5.0], stats.beta(2.0, 5.0)),
    ("beta", [0.5, 0.5], stats.beta(0.5, 0.5)),
    ("student_t", [1.0, 0.5, 4.0], stats.t(4.0, loc=1.0, scale=0.5)),
    ("student_t", [0.0, 1.0, 1e8], stats.norm()),  # the limit of many degrees of freedom
    ("half_student_t", [0.7, 1.0], stats.halfcauchy(scale=0.7)),  # one degree of freedom
    ("half_cauchy", [2.0], stats.halfcauchy(scale=2.0)),
]
IDS = [f"{family}-{arguments}" for family, arguments, _ in CASES]


def test_every_family_is_tested():
    assert {family for family, _, _ in CASES} == set(FAMILIES)


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_density_and_quantiles_agree_with_scipy(family, arguments, reference):
    prior = make_prior(family, arguments)
    u = np.concatenate([np.linspace(0.001, 0.999, 41), [1e-6, 1 - 1e-6]])
    x = reference.ppf(u)
    # 1e-7: the half_student_t and large-ν cases are limits or lose digits in SciPy's ppf near zero
    np.testing.assert_allclose(prior.log_density(x), reference.logpdf(x), rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(prior.cdf(x), u, rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(prior.quantile(u), x, rtol=2e-6)
    assert prior.median == pytest.approx(reference.median(), rel=1e-6)
    np.testing.assert_allclose(prior.interval(0.9), reference.ppf([0.05, 0.95]), rtol=1e-6)
    np.testing.assert_allclose(prior.support, reference.support(), rtol=1e-15)


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_density_is_the_slope_of_the_distribution_function(family, arguments, reference):
    """Independent of SciPy's logpdf: the closed form integrates to the difference of the cdf."""
    prior = make_prior(family, arguments)
    low, high = prior.interval(0.8)
    area, _ = integrate.quad(
        lambda x: float(np.exp(prior.log_density(x))), low, high, epsrel=1e-10, limit=200
    )
    assert area == pytest.approx(0.8, abs=1e-7)


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_impossible_values_give_minus_infinity_in_silence(family, arguments, reference):
    prior = make_prior(family, arguments)
    lower, upper = prior.support
    strange = np.array([nan, inf, -inf, 0.0, -0.0, 5e-324, -5e-324, 1e308, -1e308])
    beyond = np.array([np.nextafter(lower, -inf), np.nextafter(upper, inf)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        values = prior.log_density(np.concatenate([strange, beyond]))
        assert float(prior.log_density(nan)) == -inf
    assert not np.isnan(values).any()
    assert not (values == inf).any()
    assert (values[:3] == -inf).all()
    if lower > -inf:
        assert values[-2] == -inf
    if upper < inf:
        assert values[-1] == -inf


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_batch_and_rows_agree_to_the_last_bit(family, arguments, reference):
    prior = make_prior(family, arguments)
    table = np.empty((67, 3))
    table[:, 1] = reference.rvs(67, random_state=np.random.default_rng(5))
    strided = table[:, 1]
    batch = prior.log_density(strided)
    assert batch.tolist() == [float(prior.log_density(value)) for value in strided]
    assert batch.tolist() == [float(prior.log_density(np.array([value]))[0]) for value in strided]
    assert batch[3:40].tolist() == prior.log_density(strided[3:40]).tolist()


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_draws_follow_the_distribution(family, arguments, reference):
    prior = make_prior(family, arguments)
    draws = prior.draw(np.random.default_rng(11), 2000)
    assert stats.kstest(draws, reference.cdf).pvalue > 1e-3
    assert np.isfinite(prior.log_density(draws)).all()


@pytest.mark.parametrize(("family", "arguments", "reference"), CASES, ids=IDS)
def test_pickles_and_is_frozen(family, arguments, reference):
    prior = make_prior(family, arguments)
    copy = pickle.loads(pickle.dumps(prior))
    assert copy == prior
    assert hash(copy) == hash(prior)
    x = reference.ppf([0.1, 0.6])
    assert copy.log_density(x).tolist() == prior.log_density(x).tolist()
    with pytest.raises(FrozenInstanceError):
        prior.family = "normal"


def test_zero_from_the_generator_does_not_become_infinite():
    class Zeros:
        def random(self, n):
            return np.zeros(n)

    assert np.isfinite(make_prior("normal", [0.0, 1.0]).draw(Zeros(), 2)).all()


@pytest.mark.parametrize(
    ("family", "arguments", "words"),
    [
        ("lognormall", [1.0, 1.0], "Did you mean 'lognormal'"),
        ("lognormal", [1.0], "1 argument found; expected 2"),
        ("normal", [0.0, 1.0, 2.0], "3 arguments found; expected 2"),
        ("uniform", [5.0, 5.0], "uniform from 5 to 5 has no mass"),
        ("loguniform", [2.0, 1.0], "from 2 to 1 has no mass"),
        ("loguniform", [0.0, 1.0], "lower is 0; expected a number > 0"),
        ("truncated_normal", [0.0, 1.0, 2.0, 2.0], "has no mass"),
        ("truncated_normal", [0.0, 1.0, 40.0, 50.0], "has no mass"),
        ("lognormal", [-1.0, 1.0], "median is -1; expected a number > 0"),
        ("normal", [0.0, 0.0], "sd is 0; expected a number > 0"),
        ("half_normal", [-0.1], "scale is -0.1; expected a number > 0"),
        ("normal", [inf, 1.0], "mean is inf; expected a finite number"),
        ("uniform", [0.0, inf], "upper is inf; expected a finite number"),
        ("normal", [nan, 1.0], "mean is nan; expected a finite number"),
        ("normal", ["1", 1.0], "found '1'; expected a number"),
        ("normal", [True, 1.0], "found True; expected a number"),
        ("normal", [None, 1.0], "found None; expected a number"),
        ("normal", "12", "expected normal [mean, sd]"),
        ("normal", 3.0, "expected normal [mean, sd]"),
    ],
)
def test_refusals_say_what_was_expected(family, arguments, words):
    with pytest.raises(InputError) as caught:
        make_prior(family, arguments)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("family", "arguments", "lower", "upper"),
    [
        ("normal", [1.0, 1.0], 0.0, inf),
        ("normal", [0.0, 1.0], 5.0, 7.0),
        ("lognormal", [2.0, 0.5], 0.5, 3.0),
        ("gamma", [3.0, 1.0], 1.0, inf),
        ("truncated_normal", [0.0, 1.0, -1.0, 4.0], 0.5, 2.0),
        ("half_student_t", [1.0, 3.0], 0.2, 5.0),
        ("student_t", [0.0, 1.0, 3.0], -inf, -2.0),
        ("uniform", [0.0, 10.0], 2.0, 3.0),
    ],
)
def test_truncation_renormalises(family, arguments, lower, upper):
    whole = make_prior(family, arguments)
    cut = whole.truncated(lower, upper)
    mass, _ = integrate.quad(
        lambda x: float(np.exp(whole.log_density(x))), cut.lower, cut.upper, epsrel=1e-12
    )
    low, high = (cut.quantile(q) for q in (1e-6, 1 - 1e-6))
    area, _ = integrate.quad(lambda x: float(np.exp(cut.log_density(x))), low, high, epsrel=1e-10, limit=200)
    assert area == pytest.approx(1 - 2e-6, abs=1e-8)
    inside = np.linspace(float(low), float(high), 9)
    np.testing.assert_allclose(cut.log_density(inside), whole.log_density(inside) - np.log(mass), rtol=1e-9)
    u = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(cut.cdf(cut.quantile(u)), u, atol=1e-9)
    assert cut.support == (max(lower, whole.lower), min(upper, whole.upper))
    assert cut.log_density([np.nextafter(cut.lower, -inf), np.nextafter(cut.upper, inf)]).tolist() == [
        -inf,
        -inf,
    ]
    assert cut.cdf([cut.lower, cut.upper]).tolist() == pytest.approx([0.0, 1.0], abs=1e-12)
    assert pickle.loads(pickle.dumps(cut)) == cut != whole


def test_truncated_twice_is_truncated_once():
    prior = make_prior("normal", [0.0, 2.0])
    assert prior.truncated(-1.0, 5.0).truncated(0.0, 9.0) == prior.truncated(0.0, 5.0)
    assert prior.truncated() is prior


def test_truncation_without_mass_is_refused():
    with pytest.raises(InputError, match="no mass between 0 and inf"):
        make_prior("normal", [-100.0, 1.0]).truncated(lower=0.0)
    with pytest.raises(InputError, match="no mass between 2 and 3"):
        make_prior("uniform", [0.0, 1.0]).truncated(2.0, 3.0)


def test_description_converts_values_but_not_numbers():
    assert make_prior("student_t", [2e6, 1e6, 4.0]).description("MPa", 1e6) == (
        "student t, location 2 MPa, scale 1 MPa, degrees of freedom 4"
    )
    cut = make_prior("normal", [1e-6, 1e-6]).truncated(lower=0.0)
    assert cut.description("um", 1e-6) == "normal, mean 1 um, sd 1 um, cut off below 0 um"
    assert make_prior("beta", [2.0, 3.0]).description() == "beta, a 2, b 3"


def test_building_most_priors_does_not_import_scipy_stats():
    import subprocess
    import sys

    code = (
        "import sys; from skinbayes.statistics import make_prior;"
        "make_prior('lognormal', [1, 1]).log_density([1.0]);"
        "sys.exit('scipy.stats' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_families_document_kinds():
    assert FAMILIES["beta"].dimensionless
    assert not FAMILIES["lognormal"].dimensionless
    assert [argument.kind for argument in FAMILIES["gamma"].arguments] == ["number", "value"]
    assert FAMILIES["lognormal"].signature() == "lognormal [median, sd of ln]"
