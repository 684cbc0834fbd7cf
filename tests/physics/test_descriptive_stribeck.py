"""Baseline models without theory: limits and shape of the descriptive Stribeck curve, the constant, and their model files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import skinbayes as sb
from skinbayes.forward import Tables, forward_model

LAW = {
    "plateau_friction_coefficient": 0.8,
    "transition_speed_viscosity_product": 4e-3,
    "transition_exponent": 1.3,
    "transition_load_exponent": 0.4,
    "rising_friction_coefficient": 0.03,
    "rising_exponent": 0.6,
}


def friction(product: np.ndarray, load: float = 1.0, **changed: float) -> np.ndarray:
    inputs = {name: np.array(value) for name, value in (LAW | changed).items()}
    inputs |= {"speed_viscosity_product": product, "normal_force": np.array(load)}
    return forward_model("stribeck-descriptive").evaluate(inputs, Tables())["friction_coefficient"]


def test_plateau_and_rising_branch() -> None:
    assert friction(np.array([0.0, 1e-12])) == pytest.approx(0.8, rel=1e-9)
    # far beyond the transition the correction is (plateau/rising) x^-(a + b)
    far = np.array([1e4, 1e5]) * 4e-3
    assert_allclose(friction(far), 0.03 * np.array([1e4, 1e5]) ** 0.6, rtol=1e-5)
    # at the transition both have the same weight
    assert friction(np.array(4e-3)) == pytest.approx((0.8 + 0.03) / 2, rel=1e-14)


def test_it_is_smooth_positive_and_never_overflows() -> None:
    products = np.geomspace(1e-300, 1e300, 4001)
    values = friction(products, transition_exponent=8.0, rising_exponent=0.9)
    assert (values > 0).all() and np.isfinite(values).all()
    # the curve is the closed form of the weighted mean, computed with the logistic function
    from scipy.special import expit

    x = np.log(np.geomspace(1e-8, 1e2, 300) / 4e-3)
    expected = 0.8 * expit(-1.3 * x) + 0.03 * np.exp(0.6 * x) * expit(1.3 * x)
    assert_allclose(friction(np.geomspace(1e-8, 1e2, 300)), expected, rtol=1e-12)


def test_the_load_moves_the_transition_only() -> None:
    products = np.geomspace(1e-6, 1.0, 50)
    assert_allclose(friction(products * 3.0**0.4, load=3.0), friction(products), rtol=1e-13)
    hersey = friction(products, load=2.0, transition_load_exponent=1.0)
    assert_allclose(hersey, friction(products / 2.0), rtol=1e-13)


def test_speed_times_viscosity_given_in_parts() -> None:
    inputs = {name: np.array(value) for name, value in LAW.items()}
    inputs |= {"viscosity": np.array([0.1, 2.0]), "sliding_speed": np.array([0.05, 0.01])}
    inputs["normal_force"] = np.array(1.0)
    found = forward_model("stribeck-descriptive").evaluate(inputs, Tables())["friction_coefficient"]
    assert_allclose(found, friction(np.array([5e-3, 2e-2])), rtol=1e-15)


def test_its_profile_is_the_curve() -> None:
    model = forward_model("stribeck-descriptive")
    inputs = {name: np.array([value, value * 1.1]) for name, value in LAW.items()}
    inputs |= {
        "viscosity": np.array([0.1]),
        "sliding_speed": np.array([0.1]),
        "normal_force": np.array([1.0]),
    }
    (profile,) = model.profiles
    grid = profile.grid(inputs, Tables())
    curves = profile.evaluate(inputs, Tables(), grid)
    assert curves.shape == (2, len(grid))
    assert_allclose(curves[0], friction(grid), rtol=1e-14)


@pytest.mark.parametrize("name", ["finger-null", "finger-descriptive"])
def test_the_shipped_baseline_models_explain_all_rows_with_the_same_scatter(name: str) -> None:
    problem = sb.load_problem(name)
    assert problem.conditions.n_rows == 165
    priors = {p.label: p.prior_text for p in problem.free}
    for label in ("noise_scale", "group_scale[person]", "group_scale[liquid]"):
        assert priors[label] == "half_normal(0.5)"
    assert problem.groups is not None and problem.groups.columns == ("person", "liquid")
    assert np.isfinite(problem.log_posterior(problem.draw_prior(np.random.default_rng(1), 200))).all()


def test_the_null_model_is_one_number() -> None:
    problem = sb.load_problem("finger-null")
    theta = np.array([0.4, 0.3, 0.2, 0.5])
    assert set(problem.predict(theta)["friction_coefficient"].tolist()) == {0.4}


BASELINES = [
    ('["finger-nul"]', "finger-null"),
    ('["finger-null", "finger-null"]', "each once"),
    ('["mine.toml"]', "other models than 'mine'"),
    ("3", "baseline_models"),
]


@pytest.mark.parametrize(("value", "said"), BASELINES)
def test_baseline_models_that_cannot_be(value: str, said: str, tmp_path: Path) -> None:
    text = (Path(__file__).resolve().parents[2] / "models" / "finger-null.toml").read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(f"baseline_models = {value}\n{text}", encoding="utf-8")
    with pytest.raises(sb.InputError, match=said):
        sb.load_problem(path)


def test_baseline_models_are_named_in_the_model_file(tmp_path: Path) -> None:
    text = (Path(__file__).resolve().parents[2] / "models" / "finger-null.toml").read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(f'baseline_models = ["finger-descriptive", "own/null.toml"]\n{text}', encoding="utf-8")
    expected = ("finger-descriptive", str((tmp_path / "own" / "null.toml").resolve()))
    assert sb.load_problem(path).spec.baseline_models == expected
