"""The notebooks run from top to bottom, and are stored without output."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from source_tree import ROOT

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


def cells(path: Path, kind: str) -> list[dict[str, Any]]:
    return [
        cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == kind
    ]


def test_there_are_notebooks() -> None:
    assert "forearm_glass.ipynb" in {path.name for path in NOTEBOOKS}


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_is_stored_without_output(path: Path) -> None:
    for cell in cells(path, "code"):
        assert cell["outputs"] == []
        assert cell["execution_count"] is None


def run(path: Path) -> dict[str, Any]:
    """The names that a notebook leaves after all its code cells."""
    names: dict[str, Any] = {"__name__": "__main__"}
    for number, cell in enumerate(cells(path, "code"), 1):
        exec(compile("".join(cell["source"]), f"{path.name}, code cell {number}", "exec"), names)
    return names


def test_the_worked_example_runs_and_concludes_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    names = run(ROOT / "notebooks" / "forearm_glass.ipynb")
    assert "Converged" in capsys.readouterr().out
    assert not list(tmp_path.iterdir())  # a reader's folder stays as it is
    # "a wet one three times larger or smaller than the dry one" is compatible with the data
    assert 1 / 4 < names["low"] < 1 / 2.5
    assert 2.5 < names["high"] < 4
    assert 0.8 < names["median"] < 1.25
    assert "do not tell" in names["comparison"].sentences()[0]


def follow(path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Run a notebook in a folder, which stays as it is."""
    matplotlib.use("Agg")
    monkeypatch.chdir(folder)
    names = run(path)
    assert not list(folder.iterdir())
    return names


@pytest.mark.site
def test_a_load_series_whose_trend_the_theory_misses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = follow(ROOT / "notebooks" / "load_series.ipynb", tmp_path, monkeypatch)
    without, curve = (names["known"][name] for name in ("without", "with a curve"))
    assert float(curve["median"]) == pytest.approx(float(without["median"]), rel=0.1)  # "hardly moves"
    assert float(curve["q95"] - curve["q05"]) > 3 * float(
        without["q95"] - without["q05"]
    )  # "several times as wide"


@pytest.mark.site
def test_sites_differ_by_a_ratio_that_is_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = follow(ROOT / "notebooks" / "sites_and_people.ipynb", tmp_path, monkeypatch)
    table = names["fit"].summary()
    alone = (
        table.loc["frictional_shear_stress[palm]", "q95"] / table.loc["frictional_shear_stress[palm]", "q05"]
    )
    assert names["high"] / names["low"] < 1.15 < 3 < alone
    means = names["rows"].groupby("body_site")["friction_coefficient"].apply(lambda one: np.log(one).mean())
    assert np.log(names["middle"]) == pytest.approx(means["palm"] - means["forearm"], abs=0.02)


@pytest.mark.site
def test_a_stribeck_curve_of_the_paper_has_no_shift(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = follow(ROOT / "notebooks" / "stribeck_curve.ipynb", tmp_path, monkeypatch)
    assert names["fit"].converged and names["low"] < 1 < names["high"] < 2


@pytest.mark.site
def test_humid_air_says_where_the_layer_softens(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = follow(ROOT / "notebooks" / "humid_air.ipynb", tmp_path, monkeypatch)
    assert names["fit"].converged and 0.85 < names["low"] < names["high"] < 0.93


@pytest.mark.site
def test_two_models_of_dry_and_wet_skin_are_not_told_apart(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = follow(ROOT / "notebooks" / "comparing_models.ipynb", tmp_path, monkeypatch)
    assert all(fit.converged for fit in names["fits"])
    assert "do not tell" in names["comparison"].sentences()[0]


def test_every_notebook_is_run_by_a_test() -> None:
    source = Path(__file__).read_text(encoding="utf-8")
    assert not [path.name for path in NOTEBOOKS if f'"notebooks" / "{path.name}"' not in source]
