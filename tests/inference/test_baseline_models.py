"""Fits beside models without theory: they win where there is something to explain, lose where they invent it."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from grouped_toys import Design

import skinbayes.fit
from skinbayes.comparison import against_baselines, noise_floor
from skinbayes.comparison.noise_floor import NoiseFloor
from skinbayes.errors import InputError
from skinbayes.fit import Fit, load_fit, sample
from skinbayes.problem import load_problem

QUICK = {"seed": 3, "ess": 400, "walkers": 32, "max_steps": 400, "ensembles": 2}

THEORY = """
baseline_models = {baseline_models}
title = "A law of speed times viscosity"
forward = "stribeck-descriptive"
[data]
file = "curve.csv"
observable = "friction_coefficient"
[parameters]
plateau_friction_coefficient = {{ lognormal = [0.8, 0.3] }}
transition_speed_viscosity_product = "5 mN/m"
transition_exponent = 2
rising_friction_coefficient = 0.05
rising_exponent = 0.5
normal_force = "1 N"
{scatter}
"""

SCATTER = """
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.5 }
[groups.person]
scale = { half_normal = 0.5 }
[groups.liquid]
scale = { half_normal = 0.5 }
"""

NULL = (
    """
title = "People and liquids"
forward = "constant"
[data]
file = "curve.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [0.5, 1.0] }
"""
    + SCATTER
)


def write(folder: Path, law: bool, baseline_models: str = '["null.toml"]') -> Path:
    """Ten liquids and four persons: friction that follows the law of the model, or is scatter about 0.3."""
    rng = np.random.default_rng(12)
    lines = ["person,liquid,speed_viscosity_product [N/m],friction_coefficient [1]"]
    effects = 0.2 * rng.normal(size=4)
    # friction is that of a liquid alone where there is no law
    typical = 0.3 * np.exp(0.1 * rng.normal(size=10))
    for liquid, product in enumerate(np.geomspace(1e-4, 1.0, 10)):
        for person in range(4):
            x = product * rng.uniform(0.7, 1.4) / 5e-3
            friction = (0.8 + 0.05 * x**2.5) / (1 + x**2) if law else typical[liquid]
            y = friction * np.exp(effects[person] + 0.1 * rng.normal())
            lines.append(f"p{person},l{liquid},{float(x * 5e-3)!r},{float(y)!r}")
    (folder / "curve.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "null.toml").write_text(NULL, encoding="utf-8")
    path = folder / "theory.toml"
    path.write_text(THEORY.format(baseline_models=baseline_models, scatter=SCATTER), encoding="utf-8")
    return path


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Baseline models are fitted with few walkers; the names of those that were sampled."""
    sampled: list[str] = []

    def short(problem, **options):
        sampled.append(problem.name)
        return sample(problem, **(QUICK | options))

    monkeypatch.setattr(skinbayes.fit, "sample", short)
    return sampled


def test_a_law_that_holds_beats_the_null_model(tmp_path: Path, quick: list[str]) -> None:
    run = tmp_path / "run"
    fit = sample(load_problem(write(tmp_path, law=True)), **QUICK, directory=run)
    heard: list[str] = []
    found = against_baselines(fit, run, progress=lambda name, _: heard.append(name))
    assert found is not None and quick == ["null"] and set(heard) == {"null"}
    verdicts = {ranked.question: ranked.verdict for ranked in found.ranking}
    assert verdicts["liquid"] == "beats"
    assert not found.loses
    said = found.sentences()
    assert any("'theory' beats 'null' in predicting a left-out liquid" in sentence for sentence in said)
    assert any(sentence.startswith("Noise floor") for sentence in said)
    assert any("a liquid never measured" in sentence for sentence in said)
    headers, rows = found.headers(), found.rows()
    assert [row[0] for row in rows] == ["theory", "null", "noise floor"]
    assert all(len(row) == len(headers) for row in rows)
    assert headers[1:4] == ["one datum left out", "one person left out", "one liquid left out"]
    document = json.loads(json.dumps(found.to_dict()))
    assert document["model"] == "theory" and document["loses"] is False
    assert {model["name"] for model in document["models"]} == {"theory", "null"}
    assert set(document["models"][0]["group_scales"]) == {"person", "liquid"}
    assert document["noise_floor"]["degrees_of_freedom"] == 27
    stored_baseline_models(tmp_path, run, found.to_dict(), quick)


def stored_baseline_models(folder: Path, run: Path, before: dict, quick: list[str]) -> None:
    """The rest of the test above, on the run it made: stored fits are used again, also when the user's files are gone."""
    stored = load_fit(run / "baselines" / "null")
    assert stored.provenance["sampling"]["seed"] == 3
    assert stored.provenance["data"]["fingerprint"] == load_fit(run).provenance["data"]["fingerprint"]
    (folder / "null.toml").unlink()
    fit = load_fit(run)
    assert fit.problem is not None
    again = against_baselines(fit, run)
    assert quick == ["null"]
    assert again is not None and again.to_dict() == before
    # another model of this name is fitted anew
    copy = run / "baseline-models" / "null.toml"
    copy.write_text(NULL.replace("[0.5, 1.0]", "[0.5, 0.7]"), encoding="utf-8")
    changed = against_baselines(fit, run)
    assert quick == ["null", "null"]
    assert changed is not None and changed.to_dict() != before


def test_a_law_that_does_not_hold_loses(tmp_path: Path, quick: list[str]) -> None:
    fit = sample(load_problem(write(tmp_path, law=False)), **QUICK)
    found = against_baselines(fit)
    assert found is not None and found.loses
    assert not (tmp_path / "baselines").exists()
    assert {s.question: s.verdict for s in found.ranking}["liquid"] == "loses to"
    assert any("'theory' LOSES to 'null' in predicting a left-out liquid" in s for s in found.sentences())
    (ranked,) = [s for s in found.ranking if s.question == "liquid"]
    own, other = (
        next(m for m in found.comparison.models if m.name == name).left_out["liquid"]
        for name in ("theory", "null")
    )
    assert ranked.difference == pytest.approx(own.elpd - other.elpd, rel=1e-12)
    gap = own.pointwise - other.pointwise
    assert ranked.difference_se == pytest.approx(math.sqrt(10) * np.std(gap, ddof=1), rel=1e-12)


def test_a_model_equals_itself_under_another_name(tmp_path: Path, quick: list[str]) -> None:
    path = Design(3, persons=5).write(
        tmp_path, "0.2", "0.4", "first", top='baseline_models = ["second.toml"]'
    )
    Design(3, persons=5).write(tmp_path, "0.2", "0.4", "second")
    fit = sample(load_problem(path), **QUICK)
    found = against_baselines(fit)
    assert found is not None
    assert {ranked.verdict for ranked in found.ranking} == {"equals"}
    assert sum("equals 'second'" in sentence for sentence in found.sentences()) == 3


def test_selected_rows_are_those_of_the_baseline_model_too(tmp_path: Path, quick: list[str]) -> None:
    path = write(tmp_path, law=False)
    text = path.read_text(encoding="utf-8")
    kept = ", ".join(f'"l{i}"' for i in range(3))
    text = text.replace(
        'observable = "friction_coefficient"',
        f'observable = "friction_coefficient"\nrows = {{ liquid = [{kept}] }}',
    )
    path.write_text(text, encoding="utf-8")
    run = tmp_path / "run"
    fit = sample(load_problem(path), **QUICK, directory=run)
    found = against_baselines(fit, run)
    assert found is not None and found.comparison.rows == 12
    stored = load_fit(run / "baselines" / "null")
    assert stored.problem is not None and stored.problem.conditions.n_rows == 12


def test_without_baseline_models_there_is_nothing_to_say(tmp_path: Path) -> None:
    fit = sample(
        load_problem(write(tmp_path, law=True, baseline_models="[]")),
        seed=3,
        ess=100,
        walkers=32,
        max_steps=200,
    )
    assert against_baselines(fit) is None


def test_baseline_models_that_are_not_there_or_explain_something_else(tmp_path: Path) -> None:
    missing = load_problem(write(tmp_path, law=True, baseline_models='["gone.toml"]'))
    with pytest.raises(InputError, match=r"no file .*gone\.toml"):
        sample(missing, directory=tmp_path / "run")
    assert not (tmp_path / "run").exists()
    spread = (tmp_path / "curve.csv").read_text(encoding="utf-8").replace("\n", ",0.1\n")
    spread = spread.replace(
        "coefficient [1],0.1", "coefficient [1],friction_coefficient_standard_deviation [1]"
    )
    path = write(tmp_path, law=True)
    (tmp_path / "curve.csv").write_text(spread, encoding="utf-8")
    for name, use in (("theory", "use"), ("null", "ignore")):
        text = (tmp_path / f"{name}.toml").read_text(encoding="utf-8")
        text = text.replace("[parameters]", f'spread = "{use}"\n[parameters]')
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    fit = sample(load_problem(path), seed=3, ess=100, walkers=32, max_steps=200)
    with pytest.raises(InputError, match="does not explain the same data"):
        against_baselines(fit)


# -- noise floor -----------------------------------------------------------------------------------------------------


def test_the_noise_floor_of_the_finger_data() -> None:
    floor = noise_floor(load_problem("finger-null"))
    assert floor is not None
    # balanced: double centring, written down once more
    problem = load_problem("finger-descriptive")
    table = np.log(problem.observed).reshape(15, 11)
    residual = table - table.mean(axis=0) - table.mean(axis=1, keepdims=True) + table.mean()
    assert floor.standard_deviation == pytest.approx(np.sqrt((residual**2).sum() / 140), rel=1e-12)
    assert floor.standard_deviation == pytest.approx(0.300, abs=5e-4)
    assert floor.degrees_of_freedom == 140
    assert noise_floor(problem) == floor


@pytest.mark.parametrize(
    ("scatter", "said"),
    [(0.4, "adds errors of its own"), (0.3, "about what offsets"), (0.2, "explains how rows differ")],
)
def test_what_is_said_beside_the_floor(scatter: float, said: str) -> None:
    assert said in NoiseFloor(("person", "liquid"), "friction_coefficient", True, 0.3, 140).against(scatter)


def test_no_floor_without_groups() -> None:
    assert noise_floor(load_problem("finger-water")) is None


@pytest.mark.slow
def test_the_shipped_baseline_models_on_the_finger_data(tmp_path: Path) -> None:
    fits: dict[str, Fit] = {
        name: sample(load_problem(name), seed=1) for name in ("finger-null", "finger-descriptive")
    }
    assert all(fit.converged for fit in fits.values())
    from skinbayes.comparison import compare

    result = compare(list(fits.values()))
    assert [model.name for model in result.models] == ["finger-descriptive", "finger-null"]
    # Monte Carlo error of these sums is some tenths; levels with bad Pareto k are off by one or two
    assert result.models[0].elpd_loo == pytest.approx(221.3, abs=1.5)
    assert result.models[1].elpd_loo == pytest.approx(142.9, abs=0.5)
    assert result.models[1].left_out["liquid"].elpd == pytest.approx(122.9, abs=0.5)
    assert result.models[1].left_out["person"].elpd == pytest.approx(132.4, abs=0.5)
