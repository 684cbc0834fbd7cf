"""Thousands of rows in bounded memory, with the numbers that unbounded evaluation gives."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from many_rows import run, write_loads
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import logsumexp
from small_models import write_model

from skinbayes.comparison import compare
from skinbayes.comparison.scores import score
from skinbayes.errors import InputError
from skinbayes.fit import sample, tree
from skinbayes.fit.tree import posterior_groups, prior_groups
from skinbayes.forward import deduplicated_rows
from skinbayes.forward.deduplicated_rows import on_distinct, once_for_distinct
from skinbayes.problem import Problem, load_problem
from skinbayes.problem.pieces import PIECE, in_pieces, named_in_pieces
from skinbayes.problem.rows import MOST_ROWS, MOST_ROWS_OF_EXPENSIVE_MODELS
from skinbayes.statistics.pareto import left_out_density

MEGABYTES = 1000
"""Resident memory that a command may take."""

GROUPED = """
title = "Two states of skin of several people"
forward = "friction"
[data]
observable = "friction_coefficient"
[surface]
name = "paper_reference"
[parameters]
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
young_modulus_layer = { by = "state", dry = { fixed = "1 GPa" }, wet = { fixed = "7 MPa" } }
yield_stress = { by = "state", dry = { fixed = "50 MPa" }, wet = { fixed = "inf Pa" } }
frictional_shear_stress = { lognormal = ["15 MPa", 0.3], source = "test" }
[groups.person]
scale = { fixed = 0.2, source = "test" }
[noise]
family = "lognormal"
noise_scale = { fixed = 0.2, source = "test" }
"""


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    folder = tmp_path_factory.mktemp("rows")
    return load_problem("forearm-glass", data=write_loads(folder / "data.csv", 1200))


def vectors(problem: Problem, count: int, seed: int = 2) -> np.ndarray:
    return problem.draw_prior(np.random.default_rng(seed), count)


def test_pieces_of_a_batch_give_the_numbers_of_its_vectors_one_by_one(problem: Problem) -> None:
    theta = vectors(problem, 2 * PIECE // 1200 + 3)
    whole = problem.log_likelihood(theta)
    assert_array_equal(whole, [problem.log_likelihood(vector) for vector in theta])
    assert_array_equal(problem.predict_data(theta)[-1], problem.predict_data(theta[-1]))
    assert_array_equal(
        problem.log_likelihood(theta, pointwise=True)[-1], problem.log_likelihood(theta[-1], True)
    )
    for name, values in problem.derived(theta).items():
        assert_array_equal(values[-1:], problem.derived(theta[-1])[name])


def test_draws_do_not_depend_on_the_pieces(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    theta = vectors(problem, 40)
    drawn = problem.simulate(theta, np.random.default_rng(3))
    monkeypatch.setattr(in_pieces, "__defaults__", (10**9,))
    monkeypatch.setattr(named_in_pieces, "__defaults__", (10**9,))
    assert_array_equal(problem.simulate(theta, np.random.default_rng(3)), drawn)


def test_no_piece_is_larger_than_its_bound() -> None:
    seen: list[int] = []

    def function(part: np.ndarray) -> np.ndarray:
        seen.append(len(part))
        return part[:, 0]

    in_pieces(function, np.zeros((1000, 2)), size=300, piece=3000)
    assert max(seen) == 10
    assert sum(seen) == 1000


def test_equal_rows_are_predicted_once(tmp_path: Path) -> None:
    repeated = load_problem("forearm-glass", data=write_loads(tmp_path / "data.csv", 600, distinct=6))
    assert repeated.deduplicated is not None
    assert len(repeated.deduplicated.first) == 6
    theta = vectors(repeated, 5)
    inputs = repeated.inputs(theta)
    every_row = repeated.evaluate(inputs)["friction_coefficient"]
    assert_array_equal(repeated.predict(theta)["friction_coefficient"], every_row)
    asked: list[int] = []

    class Counting:
        def evaluate(self, inputs: dict[str, np.ndarray], tables: object) -> dict[str, np.ndarray]:
            asked.append(max(values.shape[-1] for values in inputs.values()))
            return repeated.forward.evaluate(inputs, tables)  # type: ignore[arg-type]

    repeated.__dict__["model"] = Counting()
    repeated.log_likelihood(theta)
    assert set(asked) == {6}


def test_columns_that_agree_in_the_first_vector_alone_are_told_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deduplicated_rows, "FEW", 0)  # so few are not told apart otherwise
    inputs = {"a": np.array([[1.0, 1.0, 1.0, 2.0], [3.0, 4.0, 3.0, 5.0]]), "b": np.array([[7.0]])}
    shapes: list[tuple[int, ...]] = []

    def double(few: dict[str, np.ndarray]) -> np.ndarray:
        shapes.append(few["a"].shape)
        return 2 * few["a"] * few["b"]

    assert_array_equal(on_distinct(inputs, double), 14 * inputs["a"])
    assert shapes == [(2, 3)]
    alike = once_for_distinct(inputs, lambda common: {"c": 2 * common["a"] * common["b"]})
    assert_array_equal(alike["c"], 14 * inputs["a"])


def test_stress_variance_is_integrated_once_for_rows_of_equal_skin(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    from skinbayes.forward import contact_inputs

    asked: list[tuple[int, ...]] = []
    integral = contact_inputs.integrated

    def watched(spectrum: object, skin: object) -> np.ndarray:
        asked.append(np.shape(skin.young_modulus_layer))  # type: ignore[attr-defined]
        return integral(spectrum, skin)  # type: ignore[arg-type]

    monkeypatch.setattr(contact_inputs, "integrated", watched)
    problem.log_likelihood(vectors(problem, 3))
    assert asked == [(3, 2)]


def test_effects_of_groups_leave_the_information_of_the_whole_covariance(tmp_path: Path) -> None:
    """Against a dense covariance and its inverse, which is what the check used to need."""
    people = {"person": [f"p{i % 7}" for i in range(60)]}
    data = write_loads(tmp_path / "data.csv", 60, columns=people)
    grouped = load_problem(write_model(tmp_path, GROUPED), data=data)
    theta = grouped.prior_medians()
    member = np.array(people["person"])
    covariance = 0.2**2 * (np.eye(60) + (member[:, None] == member[None, :]))
    changes = np.random.default_rng(5).normal(size=(4, 60))
    independent = grouped.independent_scatter(theta, changes)
    assert_allclose(
        independent @ independent.T, changes @ np.linalg.solve(covariance, changes.T), rtol=1e-10, atol=1e-10
    )


def test_thinned_groups_say_which_draws_they_hold_and_loo_uses_those(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, kept = 450, 4 * 60 * 450
    monkeypatch.setattr(tree, "KEPT_NUMBERS", kept)
    problem = load_problem("forearm-glass", data=write_loads(tmp_path / "data.csv", rows))
    centre = problem.prior_medians()
    length = 101  # more than 60 of each chain: one in two is kept
    spread = np.random.default_rng(1).normal(size=(4, length, len(centre)))
    draws = centre * np.exp(0.0001 * spread)
    groups = posterior_groups(problem, draws, np.zeros((4, length)), np.random.default_rng(2))
    density = groups["log_likelihood"]
    assert density.sizes["draw"] == -(-length // 2)
    assert_array_equal(density["draw"], np.arange(0, length, 2))
    assert groups["posterior"].sizes["draw"] == length
    assert "row" not in groups["posterior"].dims
    assert_array_equal(
        density["friction_coefficient"][1, 3], problem.log_likelihood(draws[1, 6], pointwise=True)
    )
    assert_array_equal(
        groups["derived_by_row"]["relative_contact_area"][0, 1],
        problem.derived(draws[0, 2])["relative_contact_area"][0],
    )
    assert_array_equal(
        groups["posterior"]["rms_slope"][2, 5], problem.derived(draws[2, 5])["rms_slope"][0, 0]
    )
    assert groups["posterior"]["shear_stress_over_yield_stress"].dims == ("chain", "draw")
    # draws nearly the same have nearly equal weights, so that smoothing them changes nothing: plain importance sampling
    log_weight = -density["friction_coefficient"].values.reshape(-1, rows)
    plain = np.log(len(log_weight)) - logsumexp(log_weight, axis=0)
    found = [left_out_density(-column, 200).log_density for column in log_weight.T]
    assert_allclose(found, plain, rtol=1e-4, atol=1e-4)
    prior = prior_groups(problem, draws[:1], np.random.default_rng(3))
    assert "row" not in prior["prior"].dims


def test_more_rows_than_were_ever_run_are_refused(tmp_path: Path) -> None:
    data = write_loads(tmp_path / "data.csv", MOST_ROWS + 1)
    with pytest.raises(InputError, match=rf"{MOST_ROWS + 1} rows.*at most {MOST_ROWS}"):
        load_problem("forearm-glass", data=data)
    times = tmp_path / "times.csv"
    most = MOST_ROWS_OF_EXPENSIVE_MODELS
    times.write_text("time [s]\n" + "".join(f"{t}\n" for t in range(1, most + 2)), encoding="utf-8")
    with pytest.raises(InputError, match=rf"{most + 1} rows.*at most {most}.*'drying'"):
        load_problem("drying", conditions=times)


def test_a_thousand_rows_are_checked_and_fitted_in_little_memory(tmp_path: Path) -> None:
    data = write_loads(tmp_path / "data.csv", 1000)
    status, said, memory = run("check", "forearm-glass", "--data", data)
    assert status == 0, said
    assert "combinations are determined" in said
    assert memory < MEGABYTES / 3
    status, said, memory = run(
        "fit", "forearm-glass", "--data", data, "--max-steps", "100", "--ess", "10", "-o", tmp_path / "run"
    )
    assert status in (0, 3), said
    assert memory < MEGABYTES / 2


@pytest.mark.slow
def test_ten_thousand_rows_are_fitted_in_a_gigabyte(tmp_path: Path) -> None:
    data = write_loads(tmp_path / "data.csv", 10_000)
    directory = tmp_path / "run"
    for command in (
        ("check", "forearm-glass", "--data", data),
        ("prior", "forearm-glass", "--data", data, "--json"),
        ("predict", "forearm-glass", "--conditions", data, "--json"),
        ("fit", "forearm-glass", "--data", data, "--cores", "2", "--max-steps", "100", "-o", directory),
        ("report", directory),
        ("compare", directory, directory),
    ):
        status, said, memory = run(*command)
        # memory is asked for here; a hundred steps need not be enough
        assert status in ((0, 3) if command[0] == "fit" else (0,)), said[-2000:]
        assert memory < MEGABYTES, command[0]
    assert (directory / "report.html").stat().st_size < 10e6


@pytest.mark.slow
def test_models_of_many_rows_are_compared_as_models_of_few(tmp_path: Path) -> None:
    """The same fit with its densities at every draw and at one in several: elpd agrees within its own noise."""
    problem = load_problem("finger-null", data=None)
    fit = sample(problem, seed=1, ess=400)
    whole = compare([fit, fit], refit=False).models[0].elpd_loo
    thinned = {**fit.groups, "log_likelihood": fit.groups["log_likelihood"].isel(draw=slice(None, None, 10))}
    assert_allclose(score(replace(fit, groups=thinned)).single.elpd, whole, atol=0.5)
