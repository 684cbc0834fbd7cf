"""All commands on a model of two experiments, once."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import skinbayes as sb
from skinbayes.cli.main import main

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


def run(*words: object, status: int = 0) -> str:
    found = CliRunner().invoke(main, [str(word) for word in words])
    assert found.exit_code == status, found.output
    return found.output


def document(*words: object) -> dict[str, Any]:
    found = CliRunner().invoke(main, [*(str(word) for word in words), "--json"])
    assert found.exit_code == 0, found.output
    return dict(json.loads(found.stdout))


def test_before_a_fit(model: Path, tmp_path: Path) -> None:
    assert "all rows (6 rows)" in " ".join(run("check", model).split())
    assert set(document("show", model)["experiments"]) == {"large", "small"}
    assert "small: indentation_force" in run("prior", model, "--draws", 200)
    predicted = document("predict", model, "--set", "sphere_radius[small]=8 mm")["experiments"]
    assert predicted["small"]["prediction"] == predicted["large"]["prediction"]
    run("template", model, "-o", tmp_path / "data.csv")
    header = (tmp_path / "data-small.csv").read_text(encoding="utf-8")
    assert header == "indentation_depth [m],indentation_force [N]\n"
    (tmp_path / "data-small.csv").write_text(f"{header}1e-4,1e-3\n", encoding="utf-8")
    said = run("check", model, "--data", f"small={tmp_path / 'data-small.csv'}")
    assert "all rows (4 rows)" in " ".join(said.split())
    refused = run("check", model, "--data", tmp_path / "data-small.csv", status=2)
    assert "--data large=FILE.csv or --data small=FILE.csv" in " ".join(refused.split())


def test_a_fit_its_page_and_a_comparison(model: Path, tmp_path: Path) -> None:
    directory = tmp_path / "run"
    found = document("fit", model, "-o", directory, "--ess", 200, "--report")
    assert found["converged"] and set(found["experiments"]) == {"large", "small"}
    assert set(found["agreement"]) == {"large", "small"}
    page = (directory / "report.html").read_text(encoding="utf-8")
    assert "Experiment: large" in page and "Do the experiments agree?" in page and "<b>on</b>" not in page
    for key in ("large-predictive", "small-predictive", "prior-posterior"):
        assert f'<figure id="{key}">' in page
    assert page.count('<figure id="corner">') == 1
    said = run("compare", directory, directory, "--no-refit")
    assert "one experiment left out at a time" in said
    assert "sampled anew" not in run("sensitivity", directory)
