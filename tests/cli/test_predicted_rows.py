"""``predict`` says which parameters it used, which rows have no prediction and why, and shows no underflow as a number."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import run

from skinbayes.problem import load_problem

ROWS = "normal_force [N],sliding_speed [m/s],viscosity [Pa s]\n0.5,0.01,1\n0.5,0.01,1e9\n0.5,0.02,1\n0.5,0.01,1e8\n"


@pytest.fixture
def rows(tmp_path: Path) -> Path:
    (tmp_path / "rows.csv").write_text(ROWS)
    return tmp_path / "rows.csv"


def test_rows_without_prediction_are_named_with_the_reason(capsys, rows: Path) -> None:
    outcome = run(capsys, "predict", "stribeck", "--conditions", rows, "--json")
    assert outcome.status == 2
    friction = json.loads(outcome.output)["prediction"]["friction_coefficient"]
    assert [value is None for value in friction] == [False, True, False, True]
    said = [line for line in outcome.errors.splitlines() if "no finite value" in line]
    assert ["row 2" in said[0], "row 4" in said[1], len(said)] == [True, True, 2]
    assert all("thicker than the inlet" in line for line in said)
    table = run(capsys, "predict", "stribeck", "--conditions", rows)
    assert table.status == 2 and table.output.count("–") >= 2 and "row 4" in table.errors


def test_no_prediction_at_all_is_refused(capsys, tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text(ROWS.splitlines()[0] + "\n0.5,0.01,1e9\n")
    outcome = run(capsys, "predict", "stribeck", "--conditions", tmp_path / "rows.csv")
    assert outcome.status == 2 and not outcome.output and "no row has a prediction" in outcome.errors


def test_medians_of_priors_are_not_taken_for_a_fit(capsys) -> None:
    outcome = run(capsys, "predict", "forearm-glass", "--set", "rms_height=20 um")
    assert outcome.status == 0
    (note,) = [line for line in outcome.errors.splitlines() if "no result of a fit" in line]
    assert "frictional_shear_stress" in note and "median of the prior" in note and "rms_height" not in note
    assert "no result of a fit" not in run(capsys, "predict", "contact-area").errors


def test_underflow_is_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = load_problem("contact-area")
    values = np.array([4.792e-322, -5e-324, 2.2e-308, 1e-300, -1e-300, 0.0, np.nan, np.inf])
    monkeypatch.setattr(
        type(problem), "evaluate", lambda *a, **k: {"mean_separation": np.resize(values, (1, 61))}
    )
    found = problem.predict(np.empty(0))["mean_separation"][:8]
    np.testing.assert_array_equal(found, [0, 0, 0, 1e-300, -1e-300, 0, np.nan, np.inf])
