"""Group effects, covariates, several observables and errors in inputs, from the model file to the likelihood."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy import stats

from skinbayes.errors import InputError
from skinbayes.problem import Problem, load_problem

MODEL = """
format = 1
title = "Fingers in two liquids"
forward = "friction"

[data]
file = "mine.csv"
observable = "friction_coefficient"
{data}

[surface]
name = "paper_reference"

[parameters]
frictional_shear_stress = {{ loguniform = ["1 MPa", "100 MPa"] }}
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
nominal_pressure = "7 kPa"

[noise]
family = "{family}"
noise_scale = {{ half_normal = 0.3 }}
{more}
"""

GROUPS = """
[groups.person]
scale = { uniform = [0, 1] }

[groups.liquid]
scale = { half_normal = 0.5 }
"""

ROWS = """person,liquid,friction_coefficient [1],skin_hydration [1],normal_force [N]
ann,water,1.1,40,0.5
ann,oil,0.7,40,0.6
bob,water,0.8,60,1.0
bob,oil,0.6,60,0.9
cyd,water,1.5,80,2.0
"""


def write(folder: Path, more: str = "", family: str = "lognormal", data: str = "", rows: str = ROWS) -> Path:
    (folder / "mine.csv").write_text(rows, encoding="utf-8")
    path = folder / "mine.toml"
    path.write_text(MODEL.format(more=more, family=family, data=data), encoding="utf-8")
    return path


def problem_of(folder: Path, *arguments: str, **named: str) -> Problem:
    return load_problem(write(folder, *arguments, **named))


def covariance(person: float, liquid: float, noise: float) -> np.ndarray:
    people, liquids = np.array([0, 0, 1, 1, 2]), np.array([0, 1, 0, 1, 0])
    same = [labels[:, None] == labels for labels in (people, liquids)]
    return person**2 * same[0] + liquid**2 * same[1] + noise**2 * np.eye(5)


# -- groups ----------------------------------------------------------------------------------------------------------


def test_group_effects_are_integrated_out(tmp_path: Path) -> None:
    problem = problem_of(tmp_path, GROUPS)
    assert problem.names == (
        "frictional_shear_stress", "noise_scale", "group_scale[person]", "group_scale[liquid]",
    )  # fmt: skip
    theta = np.array([[12e6, 0.2, 0.3, 0.1], [20e6, 0.1, 0.01, 0.6]])
    predicted = problem.predict(theta)["friction_coefficient"]
    y = problem.observed
    for i, (_, noise, person, liquid) in enumerate(theta):
        expected = stats.multivariate_normal(np.log(predicted[i]), covariance(person, liquid, noise))
        assert problem.log_likelihood(theta)[i] == pytest.approx(
            expected.logpdf(np.log(y)) - np.log(y).sum(), rel=1e-10
        )
    assert_array_equal(problem.log_likelihood(theta[1]), problem.log_likelihood(theta)[1])


def test_additive_groups_of_gaussian_noise(tmp_path: Path) -> None:
    problem = problem_of(tmp_path, GROUPS, family="gaussian")
    theta = np.array([12e6, 0.2, 0.3, 0.1])
    expected = stats.multivariate_normal(
        problem.predict(theta)["friction_coefficient"], covariance(0.3, 0.1, 0.2)
    )
    assert problem.log_likelihood(theta) == pytest.approx(expected.logpdf(problem.observed), rel=1e-10)


def test_leaving_one_person_out_is_a_conditional_density(tmp_path: Path) -> None:
    problem = problem_of(tmp_path, GROUPS)
    theta = np.array([12e6, 0.2, 0.3, 0.1])
    mean, total = np.log(problem.predict(theta)["friction_coefficient"]), covariance(0.3, 0.1, 0.2)
    y = np.log(problem.observed)
    joint = stats.multivariate_normal(mean, total).logpdf(y) - y.sum()
    for i, rows in enumerate(([0, 1], [2, 3], [4])):
        rest = [row for row in range(5) if row not in rows]
        without = (
            stats.multivariate_normal(mean[rest], total[np.ix_(rest, rest)]).logpdf(y[rest]) - y[rest].sum()
        )
        assert problem.log_likelihood_left_out(theta, "person")[i] == pytest.approx(joint - without, rel=1e-9)
    pointwise = problem.log_likelihood(theta, pointwise=True)
    rest = [0, 1, 2, 3]
    without = stats.multivariate_normal(mean[rest], total[np.ix_(rest, rest)]).logpdf(y[rest]) - y[rest].sum()
    assert pointwise[4] == pytest.approx(joint - without, rel=1e-9)


def test_simulated_groups_have_the_covariance_of_the_likelihood(tmp_path: Path) -> None:
    problem = problem_of(tmp_path, GROUPS)
    theta = np.tile([12e6, 0.2, 0.3, 0.1], (40_000, 1))
    drawn = np.log(problem.simulate(theta, np.random.default_rng(3)))
    expected = covariance(0.3, 0.1, 0.2)
    assert_allclose(np.cov(drawn.T), expected, atol=5 * np.sqrt(2 / 40_000) * expected.max())
    independent = problem.independent_scatter(theta[0], np.eye(5))
    # zeros of the covariance come back from an inversion as rounding errors
    assert_allclose(np.linalg.inv(independent @ independent.T), expected, rtol=1e-12, atol=1e-16)


def test_effects_follow_from_data(tmp_path: Path) -> None:
    problem = problem_of(tmp_path, GROUPS)
    theta = np.tile([12e6, 0.2, 0.3, 0.1], (20_000, 1))
    effects = problem.draw_effects(theta, np.random.default_rng(5))
    residual = np.log(problem.observed) - np.log(problem.predict(theta[0])["friction_coefficient"])
    member = np.zeros((5, 5))
    member[np.arange(5), [0, 0, 1, 1, 2]] = 1
    member[np.arange(5), [3, 4, 3, 4, 3]] += 1
    prior = np.diag([0.09] * 3 + [0.01] * 2)
    mean = prior @ member.T @ np.linalg.solve(covariance(0.3, 0.1, 0.2), residual)
    assert_allclose(effects.mean(axis=0), mean, atol=5 * 0.3 / np.sqrt(20_000))


@pytest.mark.parametrize(
    ("more", "named", "fragments"),
    [
        ("[groups.hand]\nscale = 0.1", {}, ("groups.hand", "person")),
        ("[groups.state]\nscale = 0.1", {}, ("groups.state", "no column 'state'")),
        (GROUPS, {"family": "relative"}, ("closed form", "gaussian or lognormal")),
        ("[groups.person]\nscale = { uniform = [0, 9] }", {}, ("swallow", "groups.person.scale")),
        ("[groups.person]\nscale = { half_cauchy = 0.5 }", {}, ("swallow",)),
        ("[groups.person]\nsize = 1\nscale = 0.1", {}, ("size",)),
    ],
)
def test_groups_that_cannot_be(
    tmp_path: Path, more: str, named: dict[str, str], fragments: tuple[str, ...]
) -> None:
    with pytest.raises(InputError) as caught:
        problem_of(tmp_path, more, **named)
    for fragment in fragments:
        assert fragment in str(caught.value)


# -- covariates ------------------------------------------------------------------------------------------------------


COVARIATE = """
[covariates.hydration]
column = "skin_hydration"
acts_on = "{target}"
reference = 50
exponent = {{ normal = [0, 0.5] }}
"""


@pytest.mark.parametrize("target", ["frictional_shear_stress", "friction_coefficient"])
def test_a_covariate_multiplies_as_a_power(tmp_path: Path, target: str) -> None:
    plain = problem_of(tmp_path)
    problem = problem_of(tmp_path, COVARIATE.format(target=target))
    assert problem.names == ("frictional_shear_stress", "covariate_exponent[hydration]", "noise_scale")
    theta = np.array([[12e6, 0.7, 0.2], [12e6, 0.0, 0.2]])
    base = plain.predict(np.array([12e6, 0.2]))["friction_coefficient"]
    found = problem.predict(theta)["friction_coefficient"]
    assert_allclose(found[0], base * (np.array([40, 40, 60, 60, 80]) / 50) ** 0.7, rtol=1e-12)
    assert_allclose(found[1], base, rtol=1e-12)
    assert_array_equal(problem.predict(theta[0])["friction_coefficient"], found[0])


@pytest.mark.parametrize(
    ("old", "new", "fragments"),
    [
        ("skin_hydration", "degrees_of_freedom", ("no column 'degrees_of_freedom", "hydration")),
        ("TARGET", "sphere_radius_of_the_ball", ("acts_on", "unknown quantity")),
        ("TARGET", "sliding_speed", ("neither an input", "sliding_speed")),
        ("reference = 50", "reference = 0", ("> 0", "power")),
        ("reference = 50", 'reference = "5 N"', ("reference",)),
    ],
)
def test_covariates_that_cannot_be(tmp_path: Path, old: str, new: str, fragments: tuple[str, ...]) -> None:
    text = COVARIATE.format(target="TARGET").replace(old, new).replace("TARGET", "frictional_shear_stress")
    with pytest.raises(InputError) as caught:
        problem_of(tmp_path, text)
    for fragment in fragments:
        assert fragment in str(caught.value)


def test_rows_to_predict_need_the_column(tmp_path: Path) -> None:
    path = write(tmp_path, COVARIATE.format(target="frictional_shear_stress"))
    (tmp_path / "rows.csv").write_text("nominal_pressure [kPa]\n5\n", encoding="utf-8")
    with pytest.raises(InputError, match="skin_hydration"):
        load_problem(path, conditions=tmp_path / "rows.csv")


# -- errors in inputs ------------------------------------------------------------------------------------------------


SPREAD = """
time [s],time_standard_deviation [s],friction_coefficient [1]
40,4,1.4
525,4,1.9
535,4,1.5
"""


def drying_with_spread(folder: Path, data: str) -> Problem:
    shipped = Path(__file__).resolve().parents[2] / "models" / "drying.toml"
    text = shipped.read_text(encoding="utf-8").partition("[conditions]")[0]
    text = text.replace(
        'frictional_shear_stress = { fixed = "15 MPa"',
        'frictional_shear_stress = { lognormal = ["15 MPa", 0.5]',
    )
    (folder / "series.csv").write_text(SPREAD.lstrip(), encoding="utf-8")
    noise = '\n[noise]\nfamily = "gaussian"\nnoise_scale = 0.1\n'
    block = f'\n[data]\nfile = "series.csv"\nobservable = "friction_coefficient"\n{data}\n'
    (folder / "series.toml").write_text(text + block + noise, encoding="utf-8")
    return load_problem(folder / "series.toml")


def test_the_spread_of_an_input_widens_the_noise(tmp_path: Path) -> None:
    problem = drying_with_spread(tmp_path, 'input_spread = "use"')
    theta = np.array([15e6])
    width = problem.noise_width(theta)
    assert width[0] == pytest.approx(0.1, rel=1e-12)
    # the slope of the curve at the other rows, from the forward model at times a second apart
    times = np.array([524.0, 526.0, 534.0, 536.0])
    rows = type(problem.conditions)({"time": times}, {}, 4)
    friction = problem.predict(theta, rows)["friction_coefficient"]
    slope = (friction[1::2] - friction[::2]) / 2
    assert_allclose(width[1:], np.hypot(0.1, 4 * slope), rtol=0.1)


def test_input_spread_must_be_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="input_spread"):
        drying_with_spread(tmp_path, "")
    assert_allclose(
        drying_with_spread(tmp_path, 'input_spread = "ignore"').noise_width(np.array([15e6])), 0.1
    )


# -- several observables ---------------------------------------------------------------------------------------------


SUMMARY = """
wet_plateau [1],wet_plateau_standard_deviation [1],peak_width [s],peak_width_standard_deviation [s]
1.3,0.1,80,20
1.5,0.2,60,30
"""

NOISE = """
[data]
file = "summary.csv"
observables = ["wet_plateau", "peak_width"]
spread = "use"

[noise.wet_plateau]
family = "gaussian"
noise_scale = 0

[noise.peak_width]
family = "lognormal"
noise_scale = { half_normal = 0.3 }
"""


def summary(folder: Path, noise: str = NOISE) -> Problem:
    shipped = Path(__file__).resolve().parents[2] / "models" / "drying.toml"
    text = shipped.read_text(encoding="utf-8").partition("[conditions]")[0]
    text = text.replace('forward = "drying"', 'forward = "drying-features"')
    text = text.replace(
        'frictional_shear_stress = { fixed = "15 MPa"',
        'frictional_shear_stress = { lognormal = ["15 MPa", 0.5]',
    )
    (folder / "summary.csv").write_text(SUMMARY.lstrip(), encoding="utf-8")
    (folder / "summary.toml").write_text(text + noise, encoding="utf-8")
    return load_problem(folder / "summary.toml")


def test_several_observables_each_with_its_noise(tmp_path: Path) -> None:
    problem = summary(tmp_path)
    assert problem.names == ("frictional_shear_stress", "noise_scale[peak_width]")
    assert problem.datum_labels() == ["wet_plateau, 1", "wet_plateau, 2", "peak_width, 1", "peak_width, 2"]
    theta = np.array([16e6, 0.4])
    found = problem.predict(theta)
    plateau, width = found["wet_plateau"], found["peak_width"]
    expected = np.concatenate(
        [
            stats.norm.logpdf([1.3, 1.5], plateau, [0.1, 0.2]),
            stats.lognorm.logpdf([80, 60], s=np.hypot(0.4, [20 / 80, 30 / 60]), scale=width),
        ]
    )
    assert_allclose(problem.log_likelihood(theta, pointwise=True), expected, rtol=1e-10)
    assert problem.log_likelihood(theta) == pytest.approx(expected.sum(), rel=1e-12)
    assert problem.simulate(theta, np.random.default_rng(1)).shape == (4,)
    assert "wet_plateau" in " ".join(problem.check().sentences())


@pytest.mark.parametrize(
    ("old", "new", "fragment"),
    [
        ("[noise.peak_width]", "[noise.peak_time]", "peak_time"),
        ('"wet_plateau", "peak_width"', '"wet_plateau", "wet_plateau"', "twice"),
        ('"wet_plateau", "peak_width"', '"wet_plateau", "film_thickness"', "film_thickness"),
        ("noise_scale = 0", "", "needs noise_scale"),
        ('spread = "use"', 'spread = "ignore"', "noise_scale is 0"),
    ],
)
def test_several_observables_that_cannot_be(tmp_path: Path, old: str, new: str, fragment: str) -> None:
    with pytest.raises(InputError, match=fragment):
        summary(tmp_path, NOISE.replace(old, new, 1))


def test_groups_need_one_observable(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="one observable"):
        summary(tmp_path, NOISE + "\n[groups.person]\nscale = 0.2\n")
