"""All commands on a model of two experiments, once."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

import skinbayes as sb

PRESS = {"forward": "indentation", "noise": {"family": "lognormal", "noise_scale": 0.2}}
DEPTH = [1e-4, 2e-4, 3e-4]


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("two") / "two.toml"
    sb.build_joint_problem(
        {
            "large": PRESS
            | {"data": {"indentation_depth": DEPTH, "indentation_force": [4e-3, 0.010, 0.022]}},
            "small": PRESS
            | {"data": {"indentation_depth": DEPTH, "indentation_force": [3e-3, 0.006, 0.013]}},
        },
        parameters={
            "young_modulus_bulk": {"lognormal": ["20 kPa", 1.0], "source": "weak on purpose"},
            "sphere_radius": {"by": "experiment", "large": "8 mm", "small": "3 mm"},
        },
        title="Two balls <b>on</b> one skin",
    ).to_toml(path)
    return path


def words(text: str) -> str:
    return " ".join(text.split())


def test_before_a_fit(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "all rows (6 rows)" in words(run(capsys, "check", model).output)
    assert set(run(capsys, "show", model, "--json").document()["experiments"]) == {"large", "small"}
    assert "small: indentation_force" in run(capsys, "prior", model, "--draws", "200").output
    predicted = run(capsys, "predict", model, "--set", "sphere_radius[small]=8 mm", "--json").document()
    each = {name: one["prediction"] for name, one in predicted["experiments"].items()}
    assert each["small"] == each["large"]
    run(capsys, "template", model, "-o", tmp_path / "data.csv")
    mine = tmp_path / "data-small.csv"
    header = mine.read_text(encoding="utf-8")
    assert header == "indentation_depth [m],indentation_force [N]\n"
    mine.write_text(f"{header}1e-4,1e-3\n", encoding="utf-8")
    assert "all rows (4 rows)" in words(run(capsys, "check", model, "--data", f"small={mine}").output)
    refused = run(capsys, "check", model, "--data", mine)
    assert refused.status == 2 and "--data large=FILE.csv or --data small=FILE.csv" in words(refused.errors)
    assert run(capsys, "predict", model, "--conditions", mine).status == 2


def test_a_fit_its_page_and_a_comparison(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    directory = tmp_path / "run"
    found = run(capsys, "fit", model, "-o", directory, "--ess", "200", "--report", "--json").document()
    assert found["converged"] and set(found["experiments"]) == {"large", "small"}
    assert set(found["agreement"]) == {"large", "small"}
    page = (directory / "report.html").read_text(encoding="utf-8")
    assert "Experiment: large" in page and "Do the experiments agree?" in page and "<b>on</b>" not in page
    for key in ("large-predictive", "small-predictive", "prior-posterior"):
        assert f'<figure id="{key}">' in page
    assert page.count('<figure id="corner">') == 1
    compared = run(capsys, "compare", directory, directory, "--no-refit")
    assert "one experiment left out at a time" in compared.output
    assert run(capsys, "sensitivity", directory).status == 0
