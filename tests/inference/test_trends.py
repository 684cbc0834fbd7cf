"""Trends of residuals that a free scatter hides: found where they are, and seldom where there are none."""

from __future__ import annotations

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.fit import misfit
from skinbayes.report import digest, quality
from skinbayes.report.trends import trend_sentences
from skinbayes.statistics.trends import KINDS, trends

ROWS = 24
LOAD = np.geomspace(0.05, 1.6, ROWS)
COLUMNS = {"load": LOAD, "order": np.random.default_rng(0).permutation(ROWS).astype(float)}


def simulated(rng, draws=400):
    """Residuals of a right model: scatter of its own in every row, and a mean that the posterior knows badly."""
    return rng.normal(size=(draws, ROWS)) + 0.3 * rng.normal(size=(draws, 1))


def test_a_right_model_is_seldom_suspected():
    found = 0
    for seed in range(300):
        rng = np.random.default_rng(seed)
        checks = trends(rng.normal(size=ROWS), simulated(rng), COLUMNS)
        assert len(checks) == len(COLUMNS) * len(KINDS)
        assert [check.probability for check in checks] == sorted(check.probability for check in checks)
        found += checks[0].found
    # 5 % of 300 are 15 ± 3.8
    assert 3 <= found <= 27


def test_effects_of_rows_that_stand_together_are_no_curve():
    """Three strokes of each session, whose mean its effect takes: neighbours are less alike than new strokes would be."""
    found = 0
    for seed in range(100):
        rng = np.random.default_rng(seed)
        strokes = rng.normal(size=(ROWS // 3, 3))
        residuals = (strokes - strokes.mean(axis=1, keepdims=True)).ravel()
        found += trends(residuals, simulated(rng), {"order": np.arange(ROWS)})[0].found
    # 12 if a correlation below what is expected counted as one above it does
    assert found <= 4


def autocorrelated(rng):
    values = [rng.normal()]
    for _ in range(ROWS - 1):
        values.append(0.9 * values[-1] + np.sqrt(1 - 0.9**2) * rng.normal())
    return np.array(values)


@pytest.mark.parametrize(("kinds", "make"), [
    ({"slope", "neighbours"}, lambda rng: np.linspace(-1.5, 1.5, ROWS) + 0.5 * rng.normal(size=ROWS)),
    ({"curvature", "neighbours"}, lambda rng: 3 * np.linspace(-1, 1, ROWS) ** 2 - 1 + 0.4 * rng.normal(size=ROWS)),
    ({"spread"}, lambda rng: np.geomspace(0.1, 3, ROWS) * rng.normal(size=ROWS)),
    ({"neighbours", "slope", "curvature"}, autocorrelated),
], ids=["slope", "bend", "spread", "series"])  # fmt: skip
def test_what_is_there_is_found_along_its_column(kinds, make):
    first = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        checks = trends(make(rng), simulated(rng), COLUMNS)
        if checks[0].found:
            first.append(checks[0])
    assert len(first) >= 25
    assert sum(check.column == "load" and check.kind in kinds for check in first) >= 0.85 * len(first)


def test_thirds_are_means_along_the_column():
    rng = np.random.default_rng(1)
    residuals = np.linspace(-1.0, 1.0, ROWS)
    (check,) = [c for c in trends(residuals, simulated(rng), {"load": LOAD}) if c.kind == "slope"]
    assert check.low == pytest.approx(residuals[:8].mean()) and check.high == pytest.approx(
        residuals[16:].mean()
    )
    assert check.value == pytest.approx(1.0, abs=1e-2) and check.expected[0] < 0.0 < check.expected[1]


def test_nothing_is_said_of_few_rows_or_columns_that_hardly_vary():
    rng = np.random.default_rng(1)
    many = simulated(rng)
    assert trends(many[0], many, {"state": np.repeat([0.0, 1.0], ROWS // 2)}) == ()
    assert trends(many[0, :5], many[:, :5], {"load": LOAD[:5]}) == ()
    assert trends(np.full(ROWS, np.nan), many, {"load": LOAD}) == ()
    assert trends(many[0], many[:50], {"load": LOAD}) == ()


def load_series(exponent: float) -> sb.Fit:
    """Friction ∝ F^exponent with a scatter of 7 %, fitted by a model in which it does not depend on the load."""
    rng = np.random.default_rng(3)
    force = np.repeat(np.geomspace(0.05, 1.6, 6), 2)
    friction = 0.6 * (force / 0.3) ** exponent * np.exp(0.07 * rng.normal(size=12))
    problem = sb.build_problem(
        "friction",
        {"normal_force": force, "sphere_radius": np.full(12, 8e-3), "friction_coefficient": friction},
        parameters={
            "frictional_shear_stress": {"loguniform": ["0.5 MPa", "500 MPa"]},
            "young_modulus_layer": "7 MPa",
            "young_modulus_bulk": "20 kPa",
            "layer_thickness": "20 um",
        },
        noise={"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
        surface="paper_reference",
        name="series",
    )
    return sb.sample(problem, seed=1, ess=400, importance=True)


def test_a_load_series_that_the_theory_does_not_follow_is_no_good_fit():
    fit = load_series(-0.15)
    said, remedy = trend_sentences(fit)
    assert said.startswith("μ falls along normal force as this model cannot: on average the data lie ")
    assert "above the model in the lower third" in said and "below it in the upper third" in said
    assert '[discrepancy] with along = "normal_force"' in remedy
    assert quality.misfit(fit) and quality.verdict(fit)[0] == "The model misses a trend."
    found = digest(fit)["trends"]["friction_coefficient"]
    assert "normal_force" in {check["column"] for check in found}
    assert all(check["probability"] <= 0.05 for check in found)


def test_a_load_series_that_it_does_follow_is_not_suspected(monkeypatch):
    fit, asked = load_series(0.0), []
    monkeypatch.setattr(misfit, "trends", lambda *given: asked.append(1) or trends(*given))
    assert fit.prior_sensitivity() is fit.prior_sensitivity()
    assert trend_sentences(fit) == [] and not quality.misfit(fit)
    assert digest(fit)["trends"] == {"friction_coefficient": []}
    (checks,) = fit.residual_trends.values()
    assert {check.column for check in checks} == {"normal_force", "order"}
    assert "trends do not speak against it" in quality.verdict(fit)[0]
    assert asked == [1]  # verdict, page, terminal and JSON share it
