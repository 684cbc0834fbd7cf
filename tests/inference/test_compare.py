"""Comparison of models: same data enforced, weights against brute force, honest sentences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from small_models import finger, student, three_parameters, two_parameters

from skinbayes.comparison import ComparedModel, Comparison, compare, stacking_weights
from skinbayes.comparison.scores import score
from skinbayes.errors import InputError
from skinbayes.fit import Fit, sample
from skinbayes.problem import load_problem

QUICK = {"seed": 4, "ess": 1000, "walkers": 32, "max_steps": 600}


@pytest.fixture(scope="module")
def fits(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Fit]:
    folder = tmp_path_factory.mktemp("models")
    off = finger(
        folder,
        # a shear stress ten times too small: its predictions miss every finger
        'frictional_shear_stress = { lognormal = ["0.5 MPa", 0.05] }\nyoung_modulus_layer = "7 MPa"',
        'family = "lognormal"\nnoise_scale = { lognormal = [0.25, 0.05] }',
        "off.toml",
    )
    problems = {
        "three": three_parameters(folder),
        "two": two_parameters(folder),
        "student": student(folder),
        "off": off,
    }
    return {name: sample(problem, **QUICK) for name, problem in problems.items()}


def test_different_data_are_refused(fits: dict[str, Fit], tmp_path: Path) -> None:
    forearm = sample(load_problem("forearm-glass"), seed=1, ess=50, walkers=32, max_steps=200)
    with pytest.raises(InputError, match=r"different data.*11 rows.*2 rows of adams2007"):
        compare([fits["three"], forearm])
    data = tmp_path / "other.csv"
    data.write_text(
        "state,friction_coefficient [1],normal_force [N],sphere_radius [m]\ndry,0.31,0.5,0.008\nwet,1.4,0.5,0.008\n"
    )
    other = sample(load_problem("forearm-glass", data=data), seed=1, ess=50, walkers=32, max_steps=200)
    with pytest.raises(InputError, match="different data"):
        compare([forearm, other])
    with pytest.raises(InputError, match="at least two"):
        compare([forearm])
    with pytest.raises(InputError, match="at least two"):
        compare([])


def test_a_model_against_itself(fits: dict[str, Fit]) -> None:
    result = compare([fits["three"], fits["three"]], refit=False)
    first, second = result.models
    assert first.elpd_difference == second.elpd_difference == 0.0
    assert first.elpd_difference_se == second.elpd_difference_se == 0.0
    assert first.elpd_loo == second.elpd_loo
    assert first.weight == pytest.approx(0.5, abs=1e-6) and second.weight == pytest.approx(0.5, abs=1e-6)
    assert any("do not tell" in sentence for sentence in result.sentences())


def test_models_that_predict_the_same_are_not_told_apart(fits: dict[str, Fit]) -> None:
    # a free modulus changes what is inferred of the shear stress, not what is predicted of friction
    result = compare([fits["two"], fits["three"]], refit=False)
    worse = result.models[1]
    assert -1.0 < worse.elpd_difference <= 0.0
    assert "do not tell" in result.sentences()[0]


def test_a_model_that_misses_the_data_loses(fits: dict[str, Fit]) -> None:
    result = compare([fits["off"], fits["three"], fits["student"]], refit=False)
    assert [model.elpd_difference for model in result.models] == sorted(
        (model.elpd_difference for model in result.models), reverse=True
    )
    last = result.models[-1]
    assert last.name == "off" and last.weight < 0.01 and last.elpd_difference < -20
    assert any("'off'" in sentence and "better" in sentence for sentence in result.sentences())
    assert sum(model.weight for model in result.models) == pytest.approx(1.0, abs=1e-9)
    document = result.to_dict()
    assert document["rows"] == 11 and document["models"][0]["elpd_difference"] == 0.0


def test_standard_error_of_a_difference(fits: dict[str, Fit]) -> None:
    result = compare([fits["off"], fits["three"]], refit=False)
    gap = score(fits["off"]).single.pointwise - score(fits["three"]).single.pointwise
    assert result.models[1].elpd_difference == pytest.approx(gap.sum(), rel=1e-12)
    assert result.models[1].elpd_difference_se == pytest.approx(np.sqrt(11) * np.std(gap, ddof=1), rel=1e-12)


@pytest.mark.parametrize("seed", range(6))
def test_stacking_of_two_against_a_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pointwise = rng.normal(-1.0, 1.0, (2, 12))
    fraction = np.linspace(0.0, 1.0, 200_001)
    score = np.log(
        fraction[:, None] * np.exp(pointwise[0]) + (1 - fraction[:, None]) * np.exp(pointwise[1])
    ).sum(axis=1)
    best = fraction[np.argmax(score)]
    found = stacking_weights(pointwise)
    assert found == pytest.approx([best, 1 - best], abs=2e-3)
    # a maximum: the score there is not below the grid's best
    assert np.log(found @ np.exp(pointwise)).sum() > score.max() - 1e-6


@pytest.mark.parametrize("seed", range(4))
def test_stacking_of_three_against_a_grid(seed: int) -> None:
    pointwise = np.random.default_rng(10 + seed).normal(-1.0, 1.5, (3, 9))
    a, b = np.meshgrid(np.linspace(0, 1, 401), np.linspace(0, 1, 401), indexing="ij")
    inside = a + b <= 1
    weights = np.stack([a[inside], b[inside], 1 - a[inside] - b[inside]])
    best = np.log(weights.T @ np.exp(pointwise)).sum(axis=1).max()
    found = stacking_weights(pointwise)
    assert (found >= 0).all() and found.sum() == pytest.approx(1.0, abs=1e-12)
    assert np.log(found @ np.exp(pointwise)).sum() > best - 1e-6


@pytest.mark.parametrize("shift", [0.0, -900.0, 900.0])
def test_stacking_of_far_away_densities(shift: float) -> None:
    pointwise = np.array([[-1.0, -2.0, -1.5], [-400.0, -500.0, -300.0]]) + shift
    assert stacking_weights(pointwise) == pytest.approx([1.0, 0.0], abs=1e-6)


def model(name: str, gap: float, error: float, unreliable: int = 0, converged: bool = True) -> ComparedModel:
    told_apart = abs(gap) >= max(4.0, 2 * error)
    return ComparedModel(
        name, -5.0 + gap, 1.0, 2.0, gap, error, 0.5, unreliable, converged, told_apart=told_apart
    )


@pytest.mark.parametrize(
    ("other", "rows", "said", "unsaid"),
    [
        (model("b", -3.0, 0.1), 40, "do not tell 'a' and 'b' apart", "better"),
        (model("b", -9.0, 6.0), 40, "do not tell 'a' and 'b' apart", "better"),
        (model("b", -9.0, 2.0), 40, "'a' predicts left-out data better than 'b', by 9.00 ± 2.00", "do not tell"),
        (model("b", -9.0, 2.0), 2, "With 2 data leave-one-out can hardly decide", "Pareto"),
        (model("b", -9.0, 2.0, 3), 40, "3 of 40 data", "NOT CONVERGED"),
        (model("b", -9.0, 2.0, converged=False), 40, "'b' has NOT CONVERGED", "Pareto"),
    ],
)  # fmt: skip
def test_sentences(other: ComparedModel, rows: int, said: str, unsaid: str) -> None:
    text = " ".join(Comparison((model("a", 0.0, 0.0), other), rows).sentences())
    assert said in text and unsaid not in text
