"""Whole groups left out: importance sampling and refits against closed forms; what is kept of a problem without a level."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray
from grouped_toys import Design
from numpy.testing import assert_allclose
from scipy import stats
from scipy.special import logsumexp

from skinbayes.comparison import compare, scores
from skinbayes.comparison.parts import single_data
from skinbayes.comparison.scores import LeftOut, LeftOutLevel, difference, score
from skinbayes.comparison.verdicts import unreliable_levels
from skinbayes.fit import Fit, sample
from skinbayes.fit.refit import predict_left_out, ratio_of_evidences
from skinbayes.problem import load_problem
from skinbayes.problem.subsets import without_data
from skinbayes.statistics.pareto import left_out_density

QUICK = {"seed": 3, "ess": 2000, "walkers": 32, "max_steps": 600}


@pytest.fixture(scope="module")
def design() -> Design:
    return Design(7)


@pytest.fixture(scope="module")
def gaussian(design: Design, tmp_path_factory: pytest.TempPathFactory) -> Fit:
    """One free parameter, of which everything is normal."""
    folder = tmp_path_factory.mktemp("gaussian")
    return sample(load_problem(design.write(folder, "0.2", "0.4")), **QUICK)


@pytest.fixture(scope="module")
def scales(design: Design, tmp_path_factory: pytest.TempPathFactory) -> Fit:
    """Scatter and scale of the effect of persons are free too."""
    folder = tmp_path_factory.mktemp("scales")
    path = design.write(folder, "{ half_normal = 0.5 }", "{ half_normal = 0.5 }", "scales")
    return sample(load_problem(path), **QUICK)


def test_levels_left_out_of_a_normal_model(design: Design, gaussian: Fit) -> None:
    everything = design.log_evidence(0.2, 0.4, np.ones(24, dtype=bool))
    found = score(gaussian)
    for column, member in (("person", design.person), ("liquid", design.liquid)):
        left_out = found.left_out[column]
        exact = [everything - design.log_evidence(0.2, 0.4, member != i) for i in range(member.max() + 1)]
        # importance weights of 8000 nearly independent draws
        assert_allclose(left_out.pointwise, exact, atol=0.02)
        assert left_out.elpd == pytest.approx(sum(exact), abs=0.05)
        assert left_out.elpd_se is None  # six persons, four liquids
        assert not left_out.unreliable
    exact = [everything - design.log_evidence(0.2, 0.4, np.arange(24) != i) for i in range(24)]
    assert_allclose(found.single.pointwise, exact, atol=0.02)
    assert found.single.elpd_se == pytest.approx(np.sqrt(24) * np.std(exact, ddof=1), rel=0.02)


def integrated(design: Design, rows: np.ndarray, person: float | None = None) -> float:
    """ln p of the data of some rows, the scatter (and the scale of persons) integrated out on a grid of ln."""
    grid = np.linspace(np.log(0.03), np.log(2.5), 45)
    values = np.exp(grid)
    prior = stats.halfnorm.logpdf(values, scale=0.5) + grid
    if person is not None:
        line = np.array([design.log_evidence(noise, person, rows) for noise in values])
        return float(logsumexp(line + prior) + np.log(grid[1] - grid[0]))
    table = np.array([[design.log_evidence(noise, scale, rows) for scale in values] for noise in values])
    return float(logsumexp(table + prior[:, None] + prior) + 2 * np.log(grid[1] - grid[0]))


def test_levels_left_out_with_free_scales(design: Design, scales: Fit) -> None:
    found = score(scales).left_out["person"]
    everything = integrated(design, np.ones(24, dtype=bool))
    exact = np.array([everything - integrated(design, design.person != i) for i in range(6)])
    good = np.array([entry.reliable for entry in found.levels])
    assert good.sum() >= 3
    assert_allclose(found.pointwise[good], exact[good], atol=0.1)
    # a refit, which has no weights to smooth
    refit = predict_left_out(scales.problem, design.person != 2, left_out_draws(scales, 2), 2000, seed=5)
    assert refit.reliable and refit.error < 0.02
    assert refit.log_density == pytest.approx(exact[2], abs=5 * refit.error)


def left_out_draws(fit: Fit, place: int) -> np.ndarray:
    return fit.groups["log_likelihood_left_out"]["person"].values[..., place].reshape(-1)


def outlying(folder: Path) -> tuple[Design, Path]:
    """One person of whom nothing prepares: with persons taken to be alike, scatter alone must explain them."""
    design = Design(11, person=0.05)
    design.values[design.person == 2] += 0.9
    return design, design.write(folder, "{ half_normal = 0.5 }", "0.05", "outlying")


def test_refits_where_importance_sampling_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    design, path = outlying(tmp_path)
    fit = sample(load_problem(path), **QUICK)
    plain = compare([fit, fit], refit=False)
    before = plain.models[0].left_out["person"]
    assert before.unreliable == ["p2"]
    assert any("refits without them would tell" in sentence for sentence in plain.sentences())
    calls: list[tuple[int, int]] = []
    with monkeypatch.context() as patch:
        patch.setattr(scores, "MOST_REFITTED_DATA", 23)  # one refit of 24 data is too many to be made unasked
        patch.setattr(scores, "_refitted", None)
        unasked = compare([fit, fit])
    assert unasked.models[0].refits_not_made == 1 and unasked.models[0].left_out["person"] == before
    assert any("1 refit of 24 data was not made" in sentence for sentence in unasked.sentences())
    found = score(fit, refit=True, progress=lambda done, total: calls.append((done, total)))
    left_out = found.left_out["person"]
    assert left_out.refitted == ["p2"] and left_out.unreliable == []
    assert calls[0] == (0, calls[-1][1]) and calls[-1] == (len(calls) - 1, len(calls) - 1)
    kept = [entry for entry in left_out.levels if not entry.refitted]
    assert kept == [entry for entry in before.levels if entry.level != "p2"]
    exact = integrated(design, np.ones(24, dtype=bool), 0.05) - integrated(design, design.person != 2, 0.05)
    error = left_out.levels[2].error
    assert error < 0.2
    assert left_out.levels[2].elpd == pytest.approx(exact, abs=5 * error)
    # importance sampling was off by more
    assert abs(left_out.levels[2].elpd - exact) < abs(before.levels[2].elpd - exact)


@pytest.mark.parametrize("distance", [0.5, 2.0, 4.0])
def test_the_ratio_of_evidences_of_two_normal_distributions(distance: float) -> None:
    # exp(u) = exp(d x - 3) moves a standard normal by d; its evidence is exp(d²/2 - 3)
    rng = np.random.default_rng(4)
    without, whole = rng.normal(size=3000), rng.normal(distance, 1.0, 8000)
    value, error = ratio_of_evidences(distance * without - 3.0, distance * whole - 3.0)
    assert 0 < error < 0.2
    assert value == pytest.approx(distance**2 / 2 - 3.0, abs=4 * error)


def test_the_error_of_the_ratio_is_what_repetition_shows() -> None:
    rng = np.random.default_rng(6)
    found = np.array(
        [ratio_of_evidences(2 * rng.normal(size=400), 2 * rng.normal(2, 1, 900)) for _ in range(300)]
    )
    # a standard deviation from 300 repetitions is known to 4 %
    assert np.std(found[:, 0]) == pytest.approx(np.mean(found[:, 1]), rel=0.2)
    assert np.mean(found[:, 0]) == pytest.approx(2.0, abs=4 * np.std(found[:, 0]) / np.sqrt(300))


def test_posteriors_without_overlap_are_said_to_have_none() -> None:
    rng = np.random.default_rng(6)
    _, error = ratio_of_evidences(12 * rng.normal(size=400), 12 * rng.normal(12, 1, 900))
    assert error > 0.5
    assert ratio_of_evidences(np.full(5, -np.inf), np.full(5, -np.inf))[1] == np.inf


def test_weighted_draws_give_the_same_ratio() -> None:
    # draws of a wider normal distribution, weighted to a standard one
    rng = np.random.default_rng(4)
    wide, whole = rng.normal(0, 1.5, 6000), rng.normal(2.0, 1.0, 8000)
    log_weights = -(wide**2) / 2 + wide**2 / 4.5
    value, error = ratio_of_evidences(2 * wide - 3.0, 2 * whole - 3.0, log_weights, 8000)
    assert 0 < error < 0.05
    assert value == pytest.approx(-1.0, abs=4 * error)


def test_without_the_problem_nothing_is_sampled_anew(tmp_path: Path) -> None:
    _, path = outlying(tmp_path)
    fit = sample(load_problem(path), seed=3, ess=200, walkers=32, max_steps=400)
    found = compare([replace(fit, problem=None)] * 2)
    assert found.models[0].refitted_rows == 0 and found.models[0].left_out["person"].unreliable
    assert "which need the model and its data" in " ".join(found.sentences())


# -- a problem without a level ---------------------------------------------------------------------------------------


PHYSICS = """
title = "Fingers in two liquids"
forward = "friction"
[data]
file = "rows.csv"
observable = "friction_coefficient"
spread = "use"
input_spread = "use"
[surface]
name = "paper_reference"
[parameters]
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
[parameters.frictional_shear_stress]
by = "liquid"
water = { lognormal = ["10 MPa", 0.5] }
oil = { lognormal = ["5 MPa", 0.5] }
[noise]
family = "lognormal"
noise_scale = { half_normal = 0.3 }
[groups.person]
scale = { half_normal = 0.5 }
[covariates.hydration]
column = "skin_hydration"
acts_on = "friction_coefficient"
reference = 50
exponent = { normal = [0, 0.5] }
"""

HEADER = (
    "person,liquid,friction_coefficient [1],friction_coefficient_standard_deviation [1],skin_hydration [1],"
    "nominal_pressure [kPa],nominal_pressure_standard_deviation [kPa]\n"
)
ROWS = ["ann,water,1.1,0.1,40,5,1\n", "bob,water,0.8,0.1,60,6,1\n", "ann,oil,0.7,0.05,40,7,2\n",
        "cyd,oil,0.6,0.02,80,8,1\n", "cyd,water,1.5,0.1,80,5,2\n"]  # fmt: skip


@pytest.mark.parametrize("level", ["ann", "cyd"])
def test_without_a_person_is_as_if_never_measured(level: str, tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(PHYSICS, encoding="utf-8")
    (tmp_path / "rows.csv").write_text(HEADER + "".join(ROWS), encoding="utf-8")
    whole = load_problem(tmp_path / "model.toml")
    left = [row for row in ROWS if not row.startswith(level)]
    (tmp_path / "rows.csv").write_text(HEADER + "".join(left), encoding="utf-8")
    never = load_problem(tmp_path / "model.toml")
    without = without_data(whole, whole.conditions.labels["person"] != level)
    assert without.names == never.names == whole.names
    assert (without.data_fingerprint, without.fingerprint) == (never.data_fingerprint, never.fingerprint)
    theta = whole.draw_prior(np.random.default_rng(3), 20)
    assert_allclose(without.log_posterior(theta), never.log_posterior(theta), rtol=1e-12)
    # by the rule of products the two parts make the whole
    place = list(dict.fromkeys(row.split(",")[0] for row in ROWS)).index(level)
    parts = without.log_likelihood(theta) + whole.log_likelihood_left_out(theta, "person")[:, place]
    assert_allclose(parts, whole.log_likelihood(theta), rtol=1e-9)


def test_a_parameter_of_the_level_left_out_keeps_its_prior(tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(PHYSICS, encoding="utf-8")
    (tmp_path / "rows.csv").write_text(HEADER + "".join(ROWS), encoding="utf-8")
    whole = load_problem(tmp_path / "model.toml")
    without = without_data(whole, whole.conditions.labels["liquid"] != "oil")
    theta = without.draw_prior(np.random.default_rng(3), 2)
    theta[1] = theta[0]
    theta[1, list(without.names).index("frictional_shear_stress[oil]")] *= 2
    first, second = without.log_likelihood(theta)
    assert first == second


AREAS = """
title = "Contact area at two magnifications"
forward = "contact-area"
[data]
file = "areas.csv"
observables = ["relative_contact_area", "plastic_fraction"]
[surface]
name = "paper_reference"
[parameters]
young_modulus_layer = { lognormal = ["1 GPa", 0.5] }
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
yield_stress = "50 MPa"
nominal_pressure = "6.83 kPa"
[noise.relative_contact_area]
family = "lognormal"
noise_scale = 0.1
[noise.plastic_fraction]
family = "gaussian"
noise_scale = 0.1
"""


def test_one_datum_of_several_observables_left_out(tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(AREAS, encoding="utf-8")
    (tmp_path / "areas.csv").write_text(
        "wavevector [1/m],relative_contact_area [1],plastic_fraction [1]\n1e5,1e-3,0.2\n1e6,1e-4,0.9\n",
        encoding="utf-8",
    )
    problem = load_problem(tmp_path / "model.toml")
    theta = problem.draw_prior(np.random.default_rng(3), 5)
    pointwise = problem.log_likelihood(theta, pointwise=True)
    keep = np.array([True, True, False, True])
    assert_allclose(without_data(problem, keep).log_likelihood(theta), pointwise[:, keep].sum(1), rtol=1e-12)
    nothing = without_data(problem, np.zeros(4, dtype=bool))
    assert_allclose(nothing.log_posterior(theta), problem.log_prior(theta), rtol=1e-12)
    # also in the coordinates in which it is sampled
    z = problem.target().transform.forward(theta)
    gap = problem.target().log_density(z) - without_data(problem, keep).target().log_density(z)
    assert_allclose(gap, pointwise[:, 2], rtol=1e-9, atol=1e-9)


# -- several observables, words, JSON --------------------------------------------------------------------------------


def test_single_data_of_several_observables() -> None:
    rng = np.random.default_rng(8)
    first, second = rng.normal(0.3, 1.0, 6), rng.normal(0.3, 2.0, 4)
    y, width = np.concatenate([first, second]), np.repeat([1.0, 2.0], [6, 4])
    # a mean with a flat prior: posterior and predictive densities are normal
    precision = (1 / width**2).sum()
    mean = rng.normal((y / width**2).sum() / precision, precision**-0.5, (4, 4000))
    groups = {
        "log_likelihood": xarray.Dataset({
            "one": (("chain", "draw", "row"), stats.norm.logpdf(first, mean[..., None], 1.0)),
            "two": (("chain", "draw", "other"), stats.norm.logpdf(second, mean[..., None], 2.0)),
        }),
    }  # fmt: skip
    left = precision - 1 / width**2
    others = ((y / width**2).sum() - y / width**2) / left
    exact = stats.norm.logpdf(y, others, np.sqrt(1 / left + width**2))
    parts = single_data(Fit(groups, {}))
    found = [left_out_density(column, 16_000).log_density for column in parts.densities.T]
    assert_allclose(found, exact, atol=0.02)


def test_json_of_levels(gaussian: Fit, scales: Fit) -> None:
    result = compare([gaussian, gaussian], refit=False)
    document = json.loads(json.dumps(result.to_dict()))
    for model in document["models"]:
        assert {"name", "elpd_loo", "weight", "unreliable_rows", "left_out"} <= set(model)
        entry = model["left_out"]["person"]
        assert set(entry["levels"]) == {f"p{i}" for i in range(6)}
        assert entry["levels"]["p0"]["rows"] == 4
        assert entry["difference"] == 0.0 and entry["difference_se"] is None
        assert entry["elpd"] == pytest.approx(
            sum(level["elpd"] for level in entry["levels"].values()), rel=1e-12
        )
    said = " ".join(document["sentences"])
    assert "cannot tell which physics" in said and "a person never measured" in said
    assert "With 4 liquids" in said


def test_differences_are_to_the_best_in_each_column(gaussian: Fit, tmp_path: Path) -> None:
    other = Design(7).write(tmp_path, "1.2", "0.4", "wide")
    wide = sample(load_problem(other), **QUICK)
    result = compare([wide, gaussian], refit=False)
    assert [model.name for model in result.models] == ["toy", "wide"]
    for column in ("person", "liquid"):
        best, worse = (model.left_out[column] for model in result.models)
        gap = worse.pointwise - best.pointwise
        assert best.difference == 0.0 and worse.difference == pytest.approx(gap.sum(), rel=1e-12)
        assert worse.difference_se is None
    assert any("does so better than 'wide'" in sentence for sentence in result.sentences())


@pytest.mark.parametrize(
    ("each", "count", "sign", "error"),
    [
        (1.0, 16, 1, True), (-1.0, 16, -1, True), (0.2, 16, 0, True),  # ± 1 each: 16 ± 4, −16 ± 4, 3.2 ± 4
        (3.0, 4, 1, False), (3.0, 2, 0, False), (9.0, 1, 0, False),  # the t distribution of few parts is wide
    ],
)  # fmt: skip
def test_what_counts_as_a_difference(each: float, count: int, sign: int, error: bool) -> None:
    spread = np.array([(-1.0) ** i for i in range(count)]) * (1.0 if count > 1 else 0.0)
    found = difference(each + spread, np.zeros(count))
    assert found.value == pytest.approx(each * count)
    assert found.sign == sign and (found.error is not None) == error


def test_words_on_levels_fitted_anew() -> None:
    def level(name: str, refitted: bool, reliable: bool) -> LeftOutLevel:
        return LeftOutLevel(name, 3, -1.0, 0.1, 1.2, refitted, reliable)

    levels = (level("a", True, True), level("b", False, True), level("c", True, False))
    said = [one.text for one in unreliable_levels("mine", LeftOut("liquid", levels, -3.0, 0.0))]
    assert "sampled anew without a, 1 of 3 liquids" in said[0]
    assert "1 of 3 liquids (c)" in said[1] and "even refits" in said[1]
