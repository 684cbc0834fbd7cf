"""Many fits: each is what it would be alone, whoever makes it and whatever happens to the others."""

from __future__ import annotations

import json
import multiprocessing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from exact_engines import FromPrior
from numpy.testing import assert_array_equal

import skinbayes as sb
from skinbayes.each.problems import share_preparation
from skinbayes.errors import FingerprintMismatch, InputError, RepairWarning

PRIOR = {"typical_friction_coefficient": {"uniform": [0, 2]}}
NOISE = {"family": "gaussian", "noise_scale": 0.1}
LEVEL = "typical_friction_coefficient"


def panel(people: int = 4, **more: Any) -> sb.Problem:
    rng = np.random.default_rng(1)
    names = np.repeat([f"P{i + 1}" for i in range(people)], 3)
    own = np.repeat(rng.uniform(0.3, 1.5, people), 3)
    data = {"person": names, "friction_coefficient": own + rng.normal(0, 0.1, names.size)}
    return sb.build_problem("constant", data, parameters=PRIOR, noise=NOISE, **more)


def problems(people: int = 4) -> dict[str, Any]:
    return sb.problems_of_each(panel(people), column="person")


@pytest.fixture(scope="module")
def alone() -> dict[str, sb.Fit]:
    fits = sb.fit_each(problems(), seed=5, engine=FromPrior())
    return {one.name: sb.sample(problems()[one.name], seed=one.seed, engine=FromPrior()) for one in fits.fits}


def test_each_is_the_fit_of_its_own_data(alone: dict[str, sb.Fit]) -> None:
    fits = sb.fit_each(problems(), seed=5, engine=FromPrior())
    assert fits.converged and fits.sentence() == "4 fits: all converged."
    table = fits.table()
    for name, fit in alone.items():
        low, middle, high = fit.quantiles(LEVEL)
        assert table.loc[name, [f"{LEVEL}_q05", LEVEL, f"{LEVEL}_q95"]].tolist() == [low, middle, high]
        assert table.loc[name, "rows"] == 3
        kept = fits.draws(name)[LEVEL]
        assert len(kept) == 1000 and np.isin(kept, fit.draws(LEVEL)).all()


def test_who_else_is_there_does_not_matter() -> None:
    many = sb.fit_each(problems(), seed=5, engine=FromPrior())
    few = sb.fit_each({name: problems()[name] for name in ("P4", "P2")}, seed=5, engine=FromPrior())
    assert few.fits[1].seed == many.fits[1].seed
    assert few.fits[1].quantities == many.fits[1].quantities


def test_a_fit_that_fails_costs_itself_alone() -> None:
    given = problems()
    given["nobody"] = InputError("nobody: no rows")
    fits = sb.fit_each(given, seed=3, engine=FromPrior(broken=2))
    failures = {one.name: one.failure for one in fits.fits if one.failure}
    assert failures["nobody"] == "nobody: no rows" and 1 < len(failures) < 5
    assert "RuntimeError: no such posterior" in failures.values()
    assert f"{len(failures)} ended in an error" in fits.sentence() and not fits.converged
    assert np.isnan(fits.table().loc["nobody", LEVEL])
    with pytest.raises(InputError, match="ended in an error: nobody: no rows"):
        fits.draws("nobody")
    with pytest.raises(InputError, match="no fit of 'P9'"):
        fits.draws("P9")


def test_stopped_and_begun_again_it_is_the_same(tmp_path: Path) -> None:
    whole = sb.fit_each(problems(), seed=5, engine=FromPrior(), directory=tmp_path / "whole")

    def stop(done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sb.fit_each(problems(), seed=5, engine=FromPrior(), directory=tmp_path / "cut", progress=stop)
    lines = tmp_path / "cut" / "fits.jsonl"
    assert len(lines.read_bytes().splitlines()) == 2
    lines.write_bytes(lines.read_bytes()[:-20])  # killed while writing
    told: list[int] = []
    with pytest.warns(RepairWarning, match="1 of 2 lines are not what was written; fitted again"):
        again = sb.fit_each(
            problems(), seed=5, engine=FromPrior(), directory=tmp_path / "cut", progress=lambda done, _: told.append(done)
        )  # fmt: skip
    assert told == [2, 3, 4]
    drop = ["seconds"]
    assert again.table().drop(columns=drop).equals(whole.table().drop(columns=drop))
    for name in problems():
        assert_array_equal(again.draws(name)[LEVEL], whole.draws(name)[LEVEL])


def test_data_that_changed_are_fitted_again_and_no_others(tmp_path: Path) -> None:
    sb.fit_each(problems(), seed=5, engine=FromPrior(), directory=tmp_path / "fits")
    changed = problems() | {"P2": panel(3)}
    told: list[int] = []
    fits = sb.fit_each(
        changed, seed=5, engine=FromPrior(), directory=tmp_path / "fits", progress=lambda done, _: told.append(done)
    )  # fmt: skip
    assert told == [4] and fits.table().loc["P2", "rows"] == 9
    with pytest.raises(
        FingerprintMismatch, match="holds a set of fits of my-model with other seed than here"
    ):
        sb.fit_each(problems(), seed=6, engine=FromPrior(), directory=tmp_path / "fits")


def test_names_that_no_file_can_have_and_run_directories(tmp_path: Path) -> None:
    names = ["a/b", "a b", "..", "A_B", "ä" * 200]
    data = {"person": np.repeat(names, 2), "friction_coefficient": np.linspace(0.3, 0.9, 10)}
    problem = sb.build_problem("constant", data, parameters=PRIOR, noise=NOISE)
    fits = sb.fit_each(
        sb.problems_of_each(problem, column="person"), engine=FromPrior(), directory=tmp_path / "fits", runs=True
    )  # fmt: skip
    files = [one.file for one in fits.fits]
    assert len({file.casefold() for file in files}) == 5 and all(len(file) < 70 for file in files)
    for one in fits.fits:
        run = sb.load_fit(tmp_path / "fits" / "runs" / one.file)
        assert run.problem is not None and run.problem.conditions.n_rows == 2
        assert run.quantiles(LEVEL).tolist() == one.quantities[LEVEL]
    lines = (tmp_path / "fits" / "fits.jsonl").read_text(encoding="utf-8").splitlines()
    written = (tmp_path / "fits" / "results.csv").read_text(encoding="utf-8").splitlines()
    assert len(written) == 6 and f"{LEVEL}_q95 [1]" in written[0]
    assert {json.loads(line)["name"] for line in lines} == set(names)


def test_effects_of_the_column_itself_are_left_out() -> None:
    grouped = panel(groups={"person": {"half_normal": 0.3}})
    one = sb.problems_of_each(grouped, column="person")["P1"]
    assert one.groups is None and one.names == (LEVEL,)  # type: ignore[union-attr]
    with pytest.raises(InputError, match="no label column 'persons'"):
        sb.problems_of_each(grouped, column="persons")


def test_files_and_tables_of_settings(tmp_path: Path) -> None:
    header = "person,friction_coefficient [1]\n"
    files = [tmp_path / name for name in ("a.csv", "b.csv", "c.csv")]
    for file, text in zip(
        files, (header + "P1,0.4\n", header + "P1,0.5\nP2,0.6\n", "person\nP1\n"), strict=True
    ):
        file.write_text(text)
    found = sb.problems_of_each(panel(), files)
    assert [getattr(found[name], "n_data", None) or found[name].observed.size for name in "ab"] == [1, 2]  # type: ignore[union-attr]
    assert isinstance(found["c"], InputError)
    table = tmp_path / "settings.csv"
    table.write_text("name;young_modulus_bulk [kPa];layer_thickness\nsoft;10;\nstiff;30;200 um\n")
    found = sb.problems_of_each("forearm-glass", table=table)
    assert {name: one.settings for name, one in found.items()} == {  # type: ignore[union-attr]
        "soft": {"young_modulus_bulk": "10 kPa"},
        "stiff": {"young_modulus_bulk": "30 kPa", "layer_thickness": "200 um"},
    }
    with pytest.raises(InputError, match="young_modulus_bulk is given in the table and by the settings"):
        sb.problems_of_each("forearm-glass", table=table, settings={"young_modulus_bulk": "1 kPa"})
    table.write_text("name,noise_scale [1]\nlow,0.05\nlow,0.2\n")
    with pytest.raises(InputError, match="line 3: a second line is called 'low'"):
        sb.problems_of_each(panel(), table=table)


def test_a_table_of_films_is_made_once() -> None:
    found = sb.problems_of_each("finger-stribeck", column="liquid", settings={"flow_factors": "none"})
    usable = [one for one in found.values() if isinstance(one, sb.Problem)]
    built: list[Any] = []

    def prepare(forward: Any, ranges: Any, *rest: Any) -> Any:
        built.append(ranges)
        return forward

    usable = [replace(one, forward=replace(one.forward, prepare=prepare)) for one in usable]
    share_preparation(usable)
    assert len(built) == 1 and len(usable) > 1
    for one in usable:
        for name, (low, high) in one.ranges().items():
            assert built[0][name][0] <= low and high <= built[0][name][1]


def test_processes_and_a_scheduler_give_the_same_numbers(cluster: Any) -> None:
    here = sb.fit_each(problems(), seed=5, engine=FromPrior())
    for other in (
        sb.fit_each(problems(), seed=5, engine=FromPrior(), cores=2),
        sb.fit_each(problems(), seed=5, engine=FromPrior(), scheduler=cluster.scheduler_address),
    ):
        assert other.table().drop(columns="seconds").equals(here.table().drop(columns="seconds"))


def test_workers_that_are_killed_cost_their_task_only() -> None:
    killed: list[int] = []

    def told(done: int, total: int) -> None:
        if done in (2, 3, 4):
            for process in multiprocessing.active_children()[:1]:
                killed.append(done)
                process.kill()

    here = sb.fit_each(problems(8), seed=5, engine=FromPrior())
    other = sb.fit_each(problems(8), seed=5, engine=FromPrior(), cores=2, progress=told)
    assert killed == [2, 3, 4]
    assert other.table().drop(columns="seconds").equals(here.table().drop(columns="seconds"))
