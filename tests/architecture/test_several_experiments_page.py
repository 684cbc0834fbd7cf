"""The page on several experiments says what is so: its model files are read, its programs run."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from source_tree import ROOT

import skinbayes as sb
from skinbayes.files.modelschema import ExperimentBlock

PAGE = (ROOT / "docs" / "several-experiments.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    found = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return [text for word, text in found if word == language]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    steel, glass = blocks("")
    (tmp_path / "one-skin.toml").write_text(blocks("toml")[0], encoding="utf-8")
    (tmp_path / "steel.csv").write_text(steel, encoding="utf-8")
    (tmp_path / "glass.csv").write_text(glass, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_tables_of_an_experiment_are_named() -> None:
    said = re.search(r"would say – (.*?) – and everything", PAGE, re.DOTALL)
    assert said is not None
    assert set(re.findall(r"`(\w+)`", said[1])) == set(ExperimentBlock.model_fields)


def test_the_programs_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second, _ = blocks("python")
    known: dict[str, object] = {}
    exec(first, known)
    width = {name: np.ptp(np.log(q)) for name, q in known["by_itself"].items()}  # type: ignore[attr-defined]
    assert np.ptp(np.log(known["together"])) < min(width.values())  # type: ignore[call-overload]
    drawn, pulls = capsys.readouterr().out.splitlines()
    assert drawn == "Data and model against indentation depth δ" and pulls == "[[], []]"
    exec(second, {})
    problem, same = sb.load_joint_problem("one-skin.toml"), sb.load_joint_problem("values.toml")
    theta = problem.prior_medians()
    assert problem.names == same.names
    assert same.log_posterior(theta) == pytest.approx(float(problem.log_posterior(theta)), rel=1e-12)


def test_sliding_and_pressing_make_one_model(tmp_path: Path) -> None:
    file = tmp_path / "sliding.toml"
    file.write_text(blocks("toml")[1], encoding="utf-8")
    data = {
        "friction": {
            "speed_viscosity_product": [1e-4, 1e-2],
            "normal_force": [0.2, 0.2],
            "friction_coefficient": [1.0, 0.5],
        },
        "indentation": {"indentation_depth": [1e-4, 3e-4], "indentation_force": [5e-3, 2e-2]},
    }
    problem = sb.load_joint_problem(file, data)
    assert problem.names[:2] == ("young_modulus_bulk", "frictional_shear_stress")
    assert [one.names for one in problem.experiments.values()] == [
        ("young_modulus_bulk", "frictional_shear_stress", "noise_scale"),
        ("young_modulus_bulk", "noise_scale"),
    ]


@pytest.mark.slow
def test_one_loss_in_sliding_and_pressing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Loss of an indentation sharpens that of friction, and the two are said to disagree where they were simulated so."""
    (tmp_path / "one-loss.toml").write_text(blocks("toml")[2], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    known: dict[str, np.ndarray] = {}
    exec(blocks("python")[2], known)
    assert np.ptp(known["both"]) < 0.5 * np.ptp(known["friction"])
    assert known["both"][0] < 0.16 < known["both"][1]
    agree, disagree = capsys.readouterr().out.splitlines()
    assert agree == "[[], []]" and disagree == "[['loss_tangent_bulk'], ['loss_tangent_bulk']]"
