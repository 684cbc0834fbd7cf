"""What is left out and how: few data exactly, blocks of rows, limits of k, and the evidence by another method."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from grouped_toys import Design
from numpy.testing import assert_allclose
from scipy import stats
from scipy.special import logsumexp

import skinbayes.sampling.nested_engine
from skinbayes.comparison import CrossCheck, compare, cross_check
from skinbayes.comparison.cross_check import OPTIONS
from skinbayes.comparison.parts import blocks, longest_column
from skinbayes.comparison.scores import score
from skinbayes.errors import InputError
from skinbayes.fit import Fit, sample
from skinbayes.problem import load_problem

SHIPPED = ("forearm-glass", "forearm-glass-separate")


@pytest.fixture(scope="module")
def shipped() -> dict[str, Fit]:
    return {name: sample(load_problem(name), seed=1, importance=True) for name in SHIPPED}


def exact_leave_one_out() -> dict[str, float]:
    """Of the two shipped models, by quadrature: friction is σ_f times a number, ln σ_f is uniform before.

    σ_f is integrated in closed form, the other parameters over quasi-random points.
    """
    problem = load_problem("forearm-glass")
    unit = stats.qmc.Sobol(problem.dimension, seed=3).random(2**13)
    theta = problem.prior_transform(unit)
    low, high = np.log(0.5e6), np.log(500e6)
    y, width = np.log(problem.observed), 0.1
    needed = y - np.log(problem.predict(theta)["friction_coefficient"]) + np.log(theta[:, :1])

    def one(x: np.ndarray, scale: float) -> np.ndarray:
        inside = stats.norm.cdf((high - x) / scale) - stats.norm.cdf((low - x) / scale)
        return np.log(inside) - np.log(high - low)

    def mean(values: np.ndarray) -> float:
        return float(logsumexp(values) - np.log(len(values)))

    dry, wet = (mean(one(x, width)) - of for x, of in zip(needed.T, y, strict=True))
    apart = stats.norm.logpdf(needed[:, 0] - needed[:, 1], 0, width * np.sqrt(2))
    shared = mean(apart + one(needed.mean(axis=1), width / np.sqrt(2))) - y.sum()
    separate = mean(one(needed[:, 0], width) + one(needed[:, 1], width)) - y.sum()
    return {name: 2 * z - dry - wet for name, z in zip(SHIPPED, (shared, separate), strict=True)}


def test_few_data_are_left_out_exactly(shipped: dict[str, Fit]) -> None:
    exact = exact_leave_one_out()
    result = compare(list(shipped.values()))
    assert [model.name for model in result.models] == list(SHIPPED)
    for model in result.models:
        assert model.refitted_rows == 2 and model.unreliable_rows == 0
        assert 0 < model.monte_carlo_error < 0.05
        assert model.elpd_loo == pytest.approx(exact[model.name], abs=4 * model.monte_carlo_error)
        assert model.elpd_loo_se is None and not model.told_apart
    assert sum(model.weight or 0.0 for model in result.models) == pytest.approx(1.0)
    # what importance sampling made of it: shared behind, or hardly ahead, where it is ahead by 2.5
    assert exact[SHIPPED[0]] - exact[SHIPPED[1]] == pytest.approx(2.46, abs=0.03)
    assert result.models[1].elpd_difference == pytest.approx(-2.46, abs=0.15)


def from_few_draws(fit: Fit) -> Fit:
    """The same draws, said to be worth 20 independent ones: the limit of k is then 0.23."""
    sampling = {**fit.provenance["sampling"], "ess_bulk": [20.0]}
    return Fit(fit.groups, {**fit.provenance, "sampling": sampling})


def test_weights_are_blank_where_a_term_is_unreliable(shipped: dict[str, Fit]) -> None:
    few = [from_few_draws(fit) for fit in shipped.values()]
    result = compare(few, refit=False)
    assert all(model.unreliable_rows > 0 for model in result.models)
    assert [model.weight for model in result.models] == [None, None]
    document = json.loads(json.dumps(result.to_dict()))
    assert document["models"][0]["weight"] is None and document["models"][0]["elpd_loo_se"] is None
    assert any("no stacking weights" in sentence for sentence in document["sentences"])


@pytest.fixture(scope="module")
def water() -> Fit:
    return sample(load_problem("finger-water"), seed=1, importance=True)


def test_the_limit_of_k_is_that_of_the_effective_draws(water: Fit) -> None:
    """The same densities count as reliable from many draws, and not from few."""
    fit = water
    many = score(fit).single
    largest = max(entry.pareto_k for entry in many.levels)
    assert 0.3 < largest < 0.65 and not many.unreliable
    few = score(from_few_draws(fit)).single
    assert len(few.unreliable) == sum(entry.pareto_k > 1 - 1 / np.log10(20) for entry in many.levels) > 0


def test_draws_with_weights_reach_further(water: Fit) -> None:
    """A datum that resampled draws cannot leave out is left out by the weighted ones, without a refit."""
    from skinbayes.comparison import scores

    fit = water
    parts = scores.single_data(fit)
    before = scores._by_weights(parts, 25.0)
    after = scores._by_own_weights(fit, parts, 25.0, before)
    assert sum(not entry.reliable for entry in after) < sum(not entry.reliable for entry in before)
    exact = scores._refitted(fit, parts, 6, 4000.0, before[6])
    assert exact.elpd == pytest.approx(after[6].elpd, abs=0.05)


# -- blocks of rows --------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def toy(tmp_path_factory: pytest.TempPathFactory) -> tuple[Design, Fit]:
    """Everything normal but one parameter, of which everything is known; effects of groups integrated out."""
    design = Design(7)
    path = design.write(tmp_path_factory.mktemp("toy"), "0.2", "0.4")
    return design, sample(load_problem(path), seed=3, importance=True)


def test_blocks_left_out_of_a_normal_model(toy: tuple[Design, Fit]) -> None:
    design, fit = toy
    everything = design.log_evidence(0.2, 0.4, np.ones(24, dtype=bool))
    block = np.arange(24) // 8
    exact = [everything - design.log_evidence(0.2, 0.4, block != i) for i in range(3)]
    for refit in (False, True):
        left_out = score(fit, refit, ["order in 3"]).left_out["order in 3"]
        assert [entry.level for entry in left_out.levels] == ["rows 1 to 8", "rows 9 to 16", "rows 17 to 24"]
        assert_allclose(left_out.pointwise, exact, atol=0.05)
    result = compare([fit, fit], refit=False, leave_out=["order in 3", "person"])
    said = " ".join(result.sentences())
    assert "carries over to conditions at which nothing was measured" in said
    assert "In that 'toy' and 'toy' are not told apart" in said
    assert "order in 3" in json.loads(json.dumps(result.to_dict()))["models"][0]["left_out"]


def test_the_evidence_has_effects_of_groups_integrated_out(toy: tuple[Design, Fit]) -> None:
    design, fit = toy
    value, error = fit.provenance["sampling"]["log_evidence"]
    assert value == pytest.approx(design.log_evidence(0.2, 0.4, np.ones(24, dtype=bool)), abs=4 * error)


SWEEP = """
title = "A sweep"
forward = "constant"
[data]
file = "sweep.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = { lognormal = [0.5, 1.0] }
[noise]
family = "lognormal"
noise_scale = 0.1
"""

HEADER = "occasion [1],normal_force [N],friction_coefficient [1],operator\n"


def sweep(folder: Path, forces: list[float]) -> Fit:
    (folder / "sweep.toml").write_text(SWEEP, encoding="utf-8")
    lines = [f"{1 + i // 4},{force},0.5,{'ab'[i % 2]}\n" for i, force in enumerate(forces)]
    (folder / "sweep.csv").write_text(HEADER + "".join(lines), encoding="utf-8")
    problem = load_problem(folder / "sweep.toml")
    return Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 50))


def test_rows_of_the_same_value_stay_together(tmp_path: Path) -> None:
    fit = sweep(tmp_path, [3.0, 1.0, 1.0, 2.0, 1.0, 3.0, 2.0, 1.0])
    along = blocks(fit, "normal_force in 3")
    assert along.labels == ("1 N", "2 N", "3 N")
    assert along.member.tolist() == [2, 0, 0, 1, 0, 2, 1, 0]
    assert blocks(fit, "occasion in 2").member.tolist() == [0, 0, 0, 0, 1, 1, 1, 1]
    assert blocks(fit, "operator").labels == ("a", "b")
    assert blocks(fit, "normal_force").name == "normal_force in 3"


def test_blocks_that_cannot_be_made(tmp_path: Path) -> None:
    fit = sweep(tmp_path, [1.0] * 8)
    for wanted in ("force in 3", "normal_force in 1", "normal_force by 3"):
        with pytest.raises(InputError, match=r"leave out: .* columns: "):
            blocks(fit, wanted)
    with pytest.raises(InputError, match="does not differ from row to row"):
        blocks(fit, "normal_force in 3")
    with pytest.raises(InputError, match="not at hand"):
        blocks(Fit(fit.groups, fit.provenance), "normal_force in 3")


def test_the_column_of_a_sweep() -> None:
    assert longest_column(load_problem("forearm-glass")) == "order"
    problem = load_problem("finger-stribeck")
    found = longest_column(problem)
    counts = {name: np.unique(values).size for name, values in problem.conditions.values.items()}
    assert counts[found] == max(counts.values()) > 11


# -- evidence by nested sampling -------------------------------------------------------------------------------------


def test_nested_sampling_agrees(toy: tuple[Design, Fit], monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("dynesty")
    monkeypatch.setitem(OPTIONS, "live_points", 25)
    design, fit = toy
    found = cross_check(fit)
    assert found.agrees and "they agree" in found.sentence()
    exact = design.log_evidence(0.2, 0.4, np.ones(24, dtype=bool))
    assert found.nested == pytest.approx(exact, abs=4 * found.nested_se)
    assert found.nested_se < 0.6


def test_what_is_said_of_a_check() -> None:
    assert CrossCheck("a", -1.0, 0.1, -1.2, 0.1).agrees
    apart = CrossCheck("a", -1.0, 0.03, -1.5, 0.04)
    assert apart.agrees is False and "they DISAGREE, by 10.0 combined" in apart.sentence()
    alone = CrossCheck("a", None, None, -1.5, 0.1)
    assert alone.agrees is None and "no evidence of its own" in alone.sentence()


def test_without_dynesty_it_is_said_how_to_install_it(
    toy: tuple[Design, Fit], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(skinbayes.sampling.nested_engine, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'skinbayes\[nested\]'"):
        compare([toy[1], toy[1]], nested=True)
