"""``[discrepancy]`` and ``[noise.correlation]`` of a model, from the file to the page."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray
from importance import importance_sample
from misfit_studies import ROWS, sweep

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.fit import Fit
from skinbayes.plot import plot_discrepancy
from skinbayes.problem import Problem
from skinbayes.problem.subsets import without_data
from skinbayes.report.digest import digest
from skinbayes.report.discrepancy import discrepancy_sentences
from skinbayes.report.trends import trend_sentences

LOAD = np.geomspace(0.01, 0.7, 24)
BUMP = 0.25 * np.exp(-0.5 * (np.log(LOAD / 0.1) / 0.5) ** 2)
PERSON = np.array(["a", "b", "c"] * 8)


def problem(noise: dict[str, Any] | None = None, **tables: Any) -> Problem:
    rng = np.random.default_rng(1)
    return sb.build_problem(
        "constant",
        {
            "normal_force [N]": LOAD,
            "time [s]": 1.5 * np.arange(24.0),
            "person": PERSON,
            "friction_coefficient [1]": 0.5 * np.exp(BUMP + 0.03 * rng.normal(size=24)),
        },
        parameters={"typical_friction_coefficient": {"lognormal": [0.5, 1.0]}},
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.2}, **(noise or {})},
        **tables,
    )


def everything() -> Problem:
    correlation = {"along": "time", "within": "person", "length": {"loguniform": ["1 s", "20 s"]}}
    return problem(
        {"correlation": correlation | {"independent": {"uniform": [0, 1]}, "drift": 0.1}},
        discrepancy={"along": ["normal_force", "time"], "size": {"half_normal": 0.2}},
        groups={"person": {"half_normal": 0.3}},
    )


def test_parameters_and_their_usual_priors() -> None:
    found = problem(discrepancy={"along": "normal_force"})
    assert found.names[-2:] == ("discrepancy_size[normal_force]", "discrepancy_length[normal_force]")
    assert [p.prior_text for p in found.free[-2:]] == ["half_normal(0.3)", "loguniform(0.1, 1.0)"]
    (axis,) = found.correlated.axes
    assert axis.logarithmic and not problem(discrepancy={"along": "time"}).correlated.axes[0].logarithmic
    linear = problem(discrepancy={"along": "normal_force", "axis": "linear"})
    assert not linear.correlated.axes[0].logarithmic
    assert linear.fingerprint != found.fingerprint
    memory = problem({"correlation": {"along": "time"}})
    assert memory.free[-1].prior_text == "loguniform(0.75 s, 8.62 s)"
    assert problem({"correlation": {"along": "order"}}).free[-1].unit == "1"


@pytest.mark.parametrize(
    ("noise", "tables", "said"),
    [
        ({}, {"discrepancy": {"along": "normal_forces"}}, "unknown quantity 'normal_forces'"),
        ({}, {"discrepancy": {"along": "temperature"}}, "no column 'temperature'"),
        ({}, {"discrepancy": {"along": "friction_coefficient"}}, "what the model explains"),
        ({}, {"discrepancy": {"along": "time", "length": {"loguniform": [0.01, 1]}}}, "told from noise"),
        ({}, {"discrepancy": {"along": "time", "length": 5.0}}, "a constant"),
        ({}, {"discrepancy": {"along": "time", "size": {"half_normal": 3}}}, "swallow any misfit"),
        ({}, {"discrepancy": {"along": "time", "within": "people"}}, "no column 'people'"),
        ({}, {"discrepancy": {"along": "time", "axis": "logarithmic"}}, "expected values > 0"),
        ({"family": "relative"}, {"discrepancy": {"along": "time"}}, "closed form"),
        ({"family": "gaussian", "noise_scale": 0.1}, {"discrepancy": {"along": "time"}}, "give one"),
        ({"family": "student_t", "degrees_of_freedom": 4, "correlation": {"along": "time"}}, {}, "closed form"),
        ({"correlation": {"along": "time"}, "discrepancy_scale": 0.1}, {}, "are not"),
        ({"correlation": {"along": "speed"}}, {}, "unknown quantity 'speed'"),
        ({"correlation": {"along": "time", "lenght": 3}}, {}, "unknown key"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_place(
    noise: dict[str, Any], tables: dict[str, Any], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        problem(noise, **tables)


def test_a_column_of_few_values_has_no_curve() -> None:
    with pytest.raises(InputError, match="expected at least 5"):
        sb.build_problem(
            "constant",
            {"time [s]": [1.0, 1.0, 2.0, 3.0], "friction_coefficient [1]": [0.3, 0.2, 0.3, 0.3]},
            parameters={"typical_friction_coefficient": 0.3},
            noise={"family": "lognormal", "noise_scale": 0.1},
            discrepancy={"along": "time"},
        )


def test_the_written_model_is_the_same(tmp_path: Path) -> None:
    whole = everything()
    whole.to_toml(tmp_path / "again.toml")
    again = sb.load_problem(tmp_path / "again.toml")
    theta = whole.draw_prior(np.random.default_rng(1), 4)
    assert again.names == whole.names
    np.testing.assert_array_equal(again.log_posterior(theta), whole.log_posterior(theta))
    assert again.fingerprint == whole.fingerprint


def test_batches_and_leaving_out_agree_with_each_other() -> None:
    whole = everything()
    rng = np.random.default_rng(2)
    theta = whole.draw_prior(rng, 5)
    density = whole.log_likelihood(theta)
    assert np.array_equal(density, [whole.log_likelihood(vector) for vector in theta])
    reduced = without_data(whole, whole.conditions.labels["person"] != "b")
    left_out = whole.log_likelihood_left_out(theta, "person")[:, 1]
    np.testing.assert_allclose(reduced.log_likelihood(theta) + left_out, density, rtol=1e-9, atol=1e-7)
    assert whole.simulate(theta, rng).shape == (5, 24)
    effects = whole.draw_effects(theta, rng)
    assert whole.simulate(theta, rng, effects).shape == (5, 24)
    assert reduced.draw_effects(theta, rng).shape == effects.shape
    assert any("determined" in sentence or "data" in sentence for sentence in whole.check().sentences())


def fit_of(made: Problem, draws: int = 400) -> Fit:
    """A fit of independent draws, in a second."""
    rng = np.random.default_rng(3)
    found = importance_sample(made, rng)
    chosen = rng.choice(len(found.weights), draws, p=found.weights)
    return Fit.from_draws(
        made, made.target().transform.inverse(found.positions[chosen]).reshape(4, -1, made.dimension)
    )


@cache
def fitted(discrepancy: bool) -> Fit:
    load, rng = np.geomspace(0.01, 1.0, ROWS), np.random.default_rng(1)
    bump = 0.25 * np.exp(-0.5 * (np.log(load / 0.1) / 0.7) ** 2)
    base = sweep(np.ones(ROWS))
    friction = base.predict_data(base.prior_medians()) * np.exp(bump + 0.03 * rng.normal(size=ROWS))
    return fit_of(sweep(friction, **({"discrepancy": {"along": "normal_force"}} if discrepancy else {})))


def test_the_page_says_what_the_theory_misses() -> None:
    fit = fitted(True)
    (found,) = digest(fit)["discrepancy"].values()
    curve = np.array(found["curves"][""]["median"])
    true = 0.25 * np.exp(-0.5 * (np.log(np.array(found["x"]) / 0.1) / 0.7) ** 2)
    # up to a height that the constant may have instead
    assert np.abs((curve - curve.mean()) - (true - true.mean())).max() < 0.05
    assert found["probability_of_none_over_prior"] < 0.1
    (sentence,) = discrepancy_sentences(fit)
    assert sentence.startswith("Along normal force: the theory misses up to") and "want it" in sentence
    assert not trend_sentences(fit)
    assert plot_discrepancy(fit).axes[0].get_xscale() == "log"


def test_predictions_of_the_fit_contain_the_curve() -> None:
    fit = fitted(True)
    middle = fit.groups["posterior_predictive"]["friction_coefficient"].median(("chain", "draw")).values
    observed = fit.groups["observed_data"]["friction_coefficient"].values
    assert np.sqrt(np.mean(np.log(middle / observed) ** 2)) < 0.04
    without = (
        fitted(False).groups["posterior_predictive"]["friction_coefficient"].median(("chain", "draw")).values
    )
    assert np.sqrt(np.mean(np.log(without / observed) ** 2)) > 0.06


def test_a_trend_without_it_names_what_to_try() -> None:
    *_, remedy = trend_sentences(fitted(False))
    assert '[discrepancy] with along = "normal_force"' in remedy
    assert not discrepancy_sentences(fitted(False))


def test_memory_and_drift_in_words() -> None:
    fit = fit_of(problem({"correlation": {"along": "time", "drift": 0.1}}), 40)
    drift, memory = discrepancy_sentences(fit)
    assert drift.startswith("Drift over the series:")
    assert "24 such rows" in memory and isinstance(fit.groups["discrepancy"], xarray.Dataset)
