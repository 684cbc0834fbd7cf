"""The figure of the data: its curves against predictions that were computed another way."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from test_narrow_figures import overlaps

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.fit.predicted import observed_values
from skinbayes.plot import plot_data
from skinbayes.plot.data import data_abscissas
from skinbayes.plot.rows import effect_draws

FORCE = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0]
FRICTION = [0.62, 0.55, 0.47, 0.40, 0.37, 0.31]
LOAD = {
    "column": "normal_force",
    "acts_on": "frictional_shear_stress",
    "reference": "1 N",
    "exponent": {"normal": [-0.2, 0.05]},
}


@cache
def fitted(kind: str) -> sb.Fit:
    """Six loads, each twice; draws of the prior with weights."""
    kinds: dict[str, dict[str, Any]] = {
        "power": {"covariates": {"load": LOAD}},
        "discrepancy": {"discrepancy": {"along": "normal_force"}},
        "groups": {"covariates": {"load": LOAD}, "groups": {"person": {"half_normal": 0.3}}},
        "two": {},
    }
    more = kinds[kind]
    data: dict[str, Any] = {
        "normal_force [N]": FORCE * 2,
        "friction_coefficient [1]": [*FRICTION, *(1.3 * value for value in FRICTION)],
        "sphere_radius [m]": [8e-3] * 12 if kind != "two" else [8e-3] * 6 + [4e-3] * 6,
    }
    if kind == "groups":
        data["person"] = ["a"] * 6 + ["b"] * 6
    problem = sb.build_problem(
        "friction", data, surface="paper_reference", noise={"family": "lognormal", "noise_scale": {"half_normal": 0.2}},
        parameters={
            "frictional_shear_stress": {"lognormal": ["6 MPa", 0.2]}, "young_modulus_layer": "20 MPa",
            "young_modulus_bulk": "20 kPa", "layer_thickness": "20 um", "rms_height": "22.4 um",
        }, **more,
    )  # fmt: skip
    before = problem.draw_prior(np.random.default_rng(3), 3000)
    return sb.Fit.from_draws(problem, before, log_weights=problem.log_likelihood(before))


def line(fit: sb.Fit, label: str) -> tuple[np.ndarray, np.ndarray]:
    """Loads and values of a curve of the figure."""
    found = next(one for one in plot_data(fit).axes[0].lines if one.get_label() == label)
    return np.asarray(found.get_xdata(), dtype=float), np.asarray(found.get_ydata(), dtype=float)


def test_a_power_of_the_load_runs_along_the_curve() -> None:
    fit = fitted("power")
    assert fit.problem is not None
    x, y = line(fit, "median")
    middle = np.median(fit.problem.predict(fit.theta())["friction_coefficient"], axis=0)[:6]
    # a band is made of fewer draws than the fit has
    np.testing.assert_allclose(np.exp(np.interp(np.log(FORCE), np.log(x), np.log(y))), middle, rtol=0.02)
    assert middle[0] / middle[-1] > 1.5


def test_theory_and_what_it_misses_are_told_apart() -> None:
    fit = fitted("discrepancy")
    assert fit.problem is not None
    x, theory = line(fit, "theory alone")
    alone = np.median(fit.problem.predict(fit.theta())["friction_coefficient"], axis=0)[:6]
    np.testing.assert_allclose(np.exp(np.interp(np.log(FORCE), np.log(x), np.log(theory))), alone, rtol=0.03)
    # data simulated from the fit contain the curve; noise has the median of 1
    drawn = fit.groups["posterior_predictive"]["friction_coefficient"].values.reshape(-1, 12)
    _, whole = line(fit, "median")
    found = np.exp(np.interp(np.log(FORCE), np.log(x), np.log(whole)))
    expected = np.median(drawn, axis=0)
    np.testing.assert_allclose(found, 0.5 * (expected[:6] + expected[6:]), rtol=0.05)
    assert np.abs(found / alone - 1.0).max() > 0.1


def test_open_dots_are_the_data_without_effects_of_groups() -> None:
    fit = fitted("groups")
    _, shown = line(fit, "less effects of groups")
    levels, draws = effect_draws(fit, "person")
    factor = dict(zip(levels, np.exp(np.median(draws, axis=0)), strict=True))
    people = ["a"] * 6 + ["b"] * 6
    np.testing.assert_allclose(shown * [factor[person] for person in people], observed_values(fit), rtol=1e-9)


@pytest.mark.parametrize("kind", ["power", "discrepancy", "groups", "two"])
@pytest.mark.parametrize("width", ["84 mm", "174 mm"])
def test_no_text_lies_on_another(kind: str, width: str) -> None:
    assert overlaps(plot_data(fitted(kind), width)) == []


def test_data_are_drawn_against_the_condition_asked_for() -> None:
    fit = fitted("two")
    assert list(data_abscissas(fit)) == ["normal_force", "sphere_radius"]
    assert "sphere radius" in fit.plot_data(abscissa="sphere_radius").axes[0].get_xlabel()
    assert "normal force" in fit.plot_data().axes[0].get_xlabel()
    with pytest.raises(
        InputError, match=r"drawn against normal_force, sphere_radius\. Did you mean 'normal_force'"
    ):
        fit.plot_data(abscissa="load")
