"""The notebooks run from top to bottom, and are stored without output."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import matplotlib
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


def test_every_notebook_is_run_by_a_test() -> None:
    source = Path(__file__).read_text(encoding="utf-8")
    assert not [path.name for path in NOTEBOOKS if f'"{path.name}")' not in source]
