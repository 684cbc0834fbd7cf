"""Parameters that differ from person to person as a population does: closed forms, moves, results, predictions, messages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from panels import (
    CONTRAST,
    CONTRAST_SCALE,
    LEVEL,
    NOISE,
    POPULATION,
    SCALE,
    constant_problem,
    curves,
    one_ensemble,
    treated,
)
from scipy import stats

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.problem import Problem
from skinbayes.problem.target import PosteriorTarget
from skinbayes.sampling.advance import advance
from skinbayes.sampling.hierarchical_moves import HierarchicalMoves
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.starts import initial_states


def six_people() -> tuple[Problem, np.ndarray]:
    """Three rows of each of six people, and the means of ln of their friction."""
    rng = np.random.default_rng(3)
    values = np.log(0.4) + 0.3 * rng.normal(size=6)[:, np.newaxis] + NOISE * rng.normal(size=(6, 3))
    people = np.repeat([f"P{i}" for i in range(6)], 3)
    return constant_problem(people, np.exp(values).ravel(), POPULATION), values.mean(axis=1)


def test_normal_population_of_normal_people_against_quadrature() -> None:
    """Location, scale and each person where means of known error come from a normal population.

    The quadrature integrates the people out in closed form. Tolerances are four standard errors with 300 independent draws;
    these are 188 steps of 64 walkers, whose autocorrelation time is below 20.
    """
    problem, means = six_people()
    found = one_ensemble(problem.target(), 5, 250)
    location, scale = np.meshgrid(np.linspace(-2.5, 0.5, 401), np.linspace(1e-3, 2.5, 500), indexing="ij")
    variance = scale**2 + NOISE**2 / 3
    log_density = stats.norm.logpdf(location, np.log(0.5), 1.0) + stats.halfnorm.logpdf(scale, scale=0.5)
    for mean in means:
        log_density += stats.norm.logpdf(mean, location, np.sqrt(variance))
    weight = np.exp(log_density - log_density.max())
    weight /= weight.sum()
    pull = scale**2 / variance  # what is left of the distance of a person from the median
    person = (weight * (location + pull * (means[0] - location))).sum()
    first = np.log(found[:, 0]) + found[:, 1] * found[:, 2]
    for values, exact in ((np.log(found[:, 0]), location), (found[:, 1], scale)):
        centre = (weight * exact).sum()
        width = np.sqrt((weight * (exact - centre) ** 2).sum())
        assert abs(values.mean() - centre) < 4 * width / np.sqrt(300)
        assert values.std() == pytest.approx(width, rel=0.16)
    assert abs(first.mean() - person) < 4 * first.std() / np.sqrt(300)


def test_without_a_likelihood_the_priors_come_back() -> None:
    """Location, scales, contrast and deviates, where nothing but the moves keeps them; each by chance in one of 30,000 cases.

    Draws far enough apart to be independent: 40 steps of ensembles whose autocorrelation time is 10 or so.
    """
    problem, _ = treated(np.random.default_rng(2), people=5, repeats=1)
    target = PosteriorTarget(problem, use_likelihood=False)
    found = one_ensemble(target, 7, 400)
    assert target.hierarchy is not None
    apart = found.reshape(300, 64, -1)[::40].reshape(-1, problem.dimension)
    exact = {
        LEVEL: stats.lognorm(0.5, scale=0.5),
        SCALE: stats.halfnorm(scale=0.4),
        CONTRAST: stats.norm(0, 0.3),
        CONTRAST_SCALE: stats.halfnorm(scale=0.1),
    }
    for place, name in enumerate(problem.names):
        assert stats.kstest(apart[:, place], exact.get(name, stats.norm()).cdf).pvalue > 3e-5, name


def test_moves_keep_the_density_that_they_report() -> None:
    problem, _ = treated(np.random.default_rng(4), people=4, repeats=1)
    target, options = problem.target(), SamplerOptions(seed=1)
    state = initial_states(target, options)[0]
    made = advance(target, state, 20, HierarchicalMoves(target))
    flat = made.positions.reshape(-1, problem.dimension)
    assert_allclose(target.log_density(flat), made.log_density.ravel(), rtol=1e-9, atol=1e-9)
    again = advance(
        target, advance(target, state, 12, HierarchicalMoves(target)).end, 8, HierarchicalMoves(target)
    )
    assert_array_equal(again.positions, made.positions[12:])
    assert made.evaluations > 20 * len(state.positions)


def test_people_have_the_values_that_their_terms_make() -> None:
    """Nested places within people: ln of a value is the sum of its terms; a batch and single vectors agree to the last bit."""
    people, places = np.array(["A", "A", "A", "B", "B", "B"]), np.array(["l", "r", "l", "l", "r", "r"])
    problem = constant_problem(
        people, np.full(6, 0.5), POPULATION | {"within": {"column": "side", "scale": 0.2}}, side=places
    )
    assert problem.names[:2] == (LEVEL, SCALE)
    theta = problem.draw_prior(np.random.default_rng(1), 4)
    z = {name.partition(", ")[2].removesuffix("]"): theta[:, i] for i, name in enumerate(problem.names)}
    assert set(z) - {""} == {"A", "B", "A, l", "A, r", "B, l", "B, r"}
    found = problem.inputs(theta)[LEVEL]
    for row, (who, where) in enumerate(zip(people, places, strict=True)):
        exact = np.log(theta[:, 0]) + theta[:, 1] * z[who] + 0.2 * z[f"{who}, {where}"]
        assert_allclose(np.log(found[:, row]), exact, rtol=1e-12)
    for i in range(4):
        assert_array_equal(problem.inputs(theta[i : i + 1])[LEVEL][0], found[i])
        assert_array_equal(problem.log_likelihood(theta[i]), problem.log_likelihood(theta)[i])


def test_two_groupings_on_two_parameters_are_moved_each_by_its_levels() -> None:
    problem, _, _ = curves(1, people=3, rows=4)
    table = dict(problem.dataset.columns) | {"liquid": np.tile(["a", "b"], 6)}  # type: ignore[union-attr]
    person = {"by": "person", "population": {"lognormal": [0.7, 0.5], "scale": {"half_normal": 0.5}}}
    liquid = {"by": "liquid", "population": {"lognormal": ["5 mN/m", 1.0], "scale": 0.3}}
    crossed = sb.build_problem(
        "stribeck-descriptive",
        {f"{k} [{problem.dataset.units[k]}]" if k in problem.dataset.units else k: v for k, v in table.items()},  # type: ignore[union-attr]
        parameters={
            "plateau_friction_coefficient": person, "transition_speed_viscosity_product": liquid, "transition_exponent": 1.0,
            "rising_friction_coefficient": 0.05, "rising_exponent": 0.5,
        },
        noise={"family": "lognormal", "noise_scale": 0.1},
    )  # fmt: skip
    hierarchy = crossed.target().hierarchy
    assert hierarchy is not None
    assert [(g.column, g.blocks.shape) for g in hierarchy.groupings] == [
        ("person", (3, 1)),
        ("liquid", (2, 1)),
    ]
    theta = crossed.draw_prior(np.random.default_rng(1), 2)
    terms = crossed.target().pointwise(crossed.target().transform.forward(theta))
    assert_allclose(terms.sum(axis=1), crossed.log_likelihood(theta), rtol=1e-12)


def test_bounded_parameters_stay_in_their_range() -> None:
    """A fraction has a population of its logit, and a contrast that is a difference."""
    people = np.repeat(["A", "B", "C"], 4)
    problem = sb.build_problem(
        "indentation",
        {
            "person": people, "treatment": np.tile(["before", "after"], 6),
            "indentation_depth [m]": np.tile([1e-4, 2e-4, 3e-4, 4e-4], 3), "sphere_radius [m]": np.full(12, 3e-3),
            "indentation_force [N]": np.linspace(1e-3, 2e-2, 12),
        },
        parameters={
            "young_modulus": "20 kPa",
            "poisson_ratio": {"by": "person", "population": {
                "uniform": [0.3, 0.5], "scale": {"half_normal": 0.5},
                "contrast": {"column": "treatment", "reference": "before", "effect": {"normal": [0, 0.5]}},
            }},
        },
        noise={"family": "lognormal", "noise_scale": 0.3},
    )  # fmt: skip
    theta = problem.draw_prior(np.random.default_rng(1), 500)
    values = problem.inputs(theta)["poisson_ratio"]
    assert values.min() > -1.0 and values.max() < 0.5
    fit = sb.Fit.from_draws(problem, theta)
    (row,) = fit.contrasts().to_dict("records")
    assert (row["kind"], row["unit"], row["compared"]) == ("difference", "1", "after/before")


@pytest.fixture(scope="module")
def fit() -> sb.Fit:
    """Draws of the posterior of six people, made from the closed form: the median and the scale are known, the people normal."""
    problem, means = six_people()
    rng = np.random.default_rng(1)
    median, scale = np.exp(np.log(0.4) + 0.05 * rng.normal(size=1000)), np.full(1000, 0.3)
    precision = 1 / 0.3**2 + 3 / NOISE**2
    centre = (np.log(median)[:, np.newaxis] / 0.3**2 + means * 3 / NOISE**2) / precision
    values = centre + rng.normal(size=centre.shape) / np.sqrt(precision)
    scores = (values - np.log(median)[:, np.newaxis]) / 0.3
    return sb.Fit.from_draws(problem, np.column_stack([median, scale, scores]))


def test_what_a_fit_says_of_people(fit: sb.Fit) -> None:
    people = fit.people().set_index("level")
    _, means = six_people()
    precision = 1 / 0.3**2 + 3 / NOISE**2
    for i, mean in enumerate(means):
        exact = np.exp((np.log(0.4) / 0.3**2 + mean * 3 / NOISE**2) / precision)
        assert people.loc[f"P{i}", "median"] == pytest.approx(exact, rel=0.02)
    # a score is known as well as a person is, and no better than the median allows
    pull = 1 / 0.3**2 / precision
    exact = (1 / precision + ((1 - pull) * 0.05) ** 2) / 0.3**2
    assert people["shrinkage"].mean() == pytest.approx(exact, rel=0.1)
    assert list(fit.summary().index) == [LEVEL, SCALE]
    assert f"person_{LEVEL}[P3]" in fit.summary(derived=True).index
    from skinbayes.report import digest, remarks

    said = " ".join(remarks(fit))
    assert "for the median person" in said and "population_deviate" not in said
    assert set(digest(fit, with_priors=False)["populations"]) == {LEVEL}
    assert [t.get_text() for t in fit.plot_people().axes[0].get_yticklabels()] == [
        f"P{i}" for i in np.argsort(people["median"].to_numpy())
    ]


def test_new_people_are_drawn_from_the_population(fit: sb.Fit) -> None:
    rows = {"person": ["P2", "new", "new", "another"], "normal_force [N]": [1.0, 1.0, 2.0, 1.0]}
    found = fit.predict(rows)
    model, measured = found.of_model["friction_coefficient"], found.of_measurement["friction_coefficient"]
    assert_allclose(model[:, 0], fit.draws(f"person_{LEVEL}[P2]"), rtol=1e-12)
    assert_allclose(model[:, 1], fit.draws(LEVEL), rtol=1e-12)  # without scatter the median person
    logs = np.log(measured)
    # four standard errors of a standard deviation from 1,000 draws
    assert logs[:, 1].std() == pytest.approx(np.sqrt(0.05**2 + 0.3**2 + NOISE**2), rel=0.09)
    assert np.corrcoef(logs[:, 1], logs[:, 2])[0, 1] == pytest.approx(0.9, abs=0.05)  # one person
    assert abs(np.corrcoef(logs[:, 1], logs[:, 3])[0, 1]) < 0.16  # two
    assert any("new, another" in note for note in found.notes)
    with pytest.raises(InputError, match="not measured"):
        fit.design(rows)


def test_a_contrast_has_a_probability() -> None:
    problem, _ = treated(np.random.default_rng(6), people=4, repeats=1)
    theta = np.tile(problem.prior_medians(), (400, 1))
    place = {name: i for i, name in enumerate(problem.names)}
    theta[:, place[CONTRAST]] = np.where(np.arange(400) < 360, -0.2, 0.1)
    theta[:, place[CONTRAST_SCALE]] = 0.1
    theta[:, place[f"population_deviate[{LEVEL}, P1, after/before]"]] = 5.0
    fit = sb.Fit.from_draws(problem, theta)
    found = fit.contrasts().set_index("who")
    assert found.loc["", "median"] == pytest.approx(np.exp(-0.2))
    assert found.loc["", "probability_lower"] == pytest.approx(0.9)
    assert found.loc["P1", "probability_lower"] == 0.0 and found.loc[
        "P2", "probability_lower"
    ] == pytest.approx(0.9)
    from skinbayes.report import remarks

    (said,) = [one for one in remarks(fit) if "after over before" in one]
    assert "0.819" in said and "90.0 %" in said
    from skinbayes.plot.symbols import spoken_name
    from skinbayes.report.opening import answer

    assert answer(fit).startswith("Typical friction coefficient, after over before = 0.819 (90 %")
    from skinbayes.report.sentences import title_name

    assert title_name(fit, CONTRAST) == "Contrast δ (typical friction coefficient, after)"
    assert fit.symbol(CONTRAST) == "δ (μ_typ, after)"
    assert spoken_name(SCALE) == "population scale (typical friction coefficient)"
    without = fit.predict({"person": ["P1"], "normal_force [N]": [1.0]})
    named = fit.predict({"person": ["P1"], "treatment": ["before"], "normal_force [N]": [1.0]})
    assert_array_equal(without.of_model["friction_coefficient"], named.of_model["friction_coefficient"])
    assert any("predicted for 'before', the reference" in note for note in without.notes)
    with pytest.raises(InputError, match="treatment 'third' was not measured"):
        fit.predict({"person": ["P1"], "treatment": ["third"], "normal_force [N]": [1.0]})


def test_the_model_file_of_a_population_says_the_same(tmp_path: Path) -> None:
    problem, _ = treated(np.random.default_rng(8), people=4, repeats=1)
    problem.to_toml(tmp_path / "panel.toml")
    again = sb.load_problem(tmp_path / "panel.toml")
    theta = problem.draw_prior(np.random.default_rng(1), 3)
    assert again.names == problem.names and again.fingerprint == problem.fingerprint
    assert_array_equal(again.log_posterior(theta), problem.log_posterior(theta))


def test_what_the_design_of_a_panel_cannot_tell_is_said() -> None:
    """Different people with and without, few people, and the same people as a group: at the check, and with the contrast."""
    from skinbayes.report import remarks

    people, treatment = np.repeat(["A", "B", "C", "D"], 2), np.repeat(["before", "after"], 4)
    population = POPULATION | {"contrast": TREATED}

    def said(treatment: np.ndarray) -> tuple[str, str]:
        problem = constant_problem(people, np.linspace(0.4, 0.5, 8), population, treatment=treatment)
        fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 100))
        return " ".join(problem.check().sentences()), " ".join(remarks(fit))

    checked, reported = said(treatment)
    assert "0 of 4 levels of person were measured with and without" in checked
    assert "different levels of person" in checked and "4 levels of person hardly tell how far" in checked
    assert "Nobody was measured both with after and with before" in reported
    treatment[1] = "after"
    checked, reported = said(treatment)
    assert "1 of 4 levels" in checked and "rests on these" in checked and "Nobody" not in reported
    grouped = sb.build_problem(
        "constant",
        {"person": people, "friction_coefficient": np.linspace(0.4, 0.5, 8)},
        parameters={LEVEL: {"by": "person", "population": POPULATION}},
        groups={"person": {"scale": {"half_normal": 0.3}}},
        noise={"family": "lognormal", "noise_scale": NOISE},
    )
    assert "only their sum is known" in " ".join(grouped.check().sentences())


TREATED = {"column": "treatment", "reference": "before", "effect": {"normal": [0, 0.5]}}


@pytest.mark.parametrize(
    ("population", "message"),
    [
        ({"lognormal": [0.5, 1.0]}, "found no 'scale'"),
        ({"scale": 0.3}, "found 0 priors or values"),
        (POPULATION | {"scale": {"half_normal": 5}}, "can swallow any misfit"),
        (POPULATION | {"spread": 1}, "unknown key 'spread'"),
        (POPULATION | {"within": {"column": "person", "scale": 0.1}}, "expected each once"),
        (POPULATION | {"within": {"column": "place", "scale": 0.1}}, "no column 'place'"),
        (POPULATION | {"contrast": TREATED | {"reference": "without"}}, "expected 'without', the reference"),
        (POPULATION | {"contrast": {"column": "treatment", "reference": "before"}}, "found no 'effect'"),
    ],
)
def test_what_a_population_cannot_be_is_said(population: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        constant_problem(
            np.array(["A", "B"]), np.array([0.4, 0.5]), population, treatment=np.array(["before", "after"])
        )


def test_one_person_is_no_population() -> None:
    with pytest.raises(InputError, match="all rows have one person"):
        constant_problem(np.array(["A", "A"]), np.array([0.4, 0.5]), POPULATION)
