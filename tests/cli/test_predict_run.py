"""``predict --run``: the posterior at new rows on the command line."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from command_line import run

import skinbayes as sb

ROWS = "state,normal_force [N],sphere_radius [mm]\nwet,0.1,7.1\nwet,10,7.1\ndry,1,7.1\ndry,2,7.1\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a fit as one file, and rows."""
    place = tmp_path_factory.mktemp("predict")
    problem = sb.load_problem("forearm-glass")
    before = problem.draw_prior(np.random.default_rng(1), 20_000)
    sb.Fit.from_draws(problem, before, log_weights=problem.log_likelihood(before)).save(place / "fit.nc")
    (place / "rows.csv").write_text(ROWS)
    return place


def test_json_csv_and_python_agree(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    statement = "friction_coefficient < 1.5"
    outcome = run(
        capsys, "predict", "--run", folder / "fit.nc", "--conditions", folder / "rows.csv", "--probability", statement,
        "--along", "normal_force", "--confidence", "0.5", "-o", folder / "out.csv", "--overwrite", "--json",
    )  # fmt: skip
    assert outcome.status == 0
    document = outcome.document()
    prediction = sb.load_fit(folder / "fit.nc").predict(folder / "rows.csv")
    low, middle, high = prediction.quantiles("friction_coefficient", measured=False)
    assert document["prediction"]["friction_coefficient"] == {
        "q05": low.tolist(), "median": middle.tolist(), "q95": high.tolist(),
    }  # fmt: skip
    assert document["probability"] == prediction.probability(statement).tolist()
    wet, dry = document["holds"]
    assert wet["conditions"]["state"] == "wet" and dry["intervals"] == [[1.0, 2.0]]
    with (folder / "out.csv").open() as file:
        written = list(csv.DictReader(file))
    assert [float(row["friction_coefficient_median [1]"]) for row in written] == middle.tolist()
    assert [row["state"] for row in written] == ["wet", "wet", "dry", "dry"]
    # the data: 0.3 dry and 1.4 wet, with 10 % noise
    assert middle[0] == pytest.approx(1.4, rel=0.1) and middle[2] == pytest.approx(0.3, rel=0.1)


def test_the_terminal_says_what_was_asked(capsys: pytest.CaptureFixture[str], folder: Path) -> None:
    outcome = run(
        capsys, "predict", "--run", folder / "fit.nc", "--conditions", folder / "rows.csv",
        "--probability", "friction_coefficient < 0.6", "--along", "normal_force",
    )  # fmt: skip
    assert outcome.status == 0
    text = " ".join(outcome.output.split())  # wrapped where the output is narrow
    assert "'friction_coefficient < 0.6' does not hold with 95 % probability at any normal_force" in text
    assert "for normal_force from 1 N to 2 N at state dry" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["predict"], "found neither a model nor --run"),
        (["predict", "forearm-glass", "--run", "FIT"], "found a model and --run"),
        (["predict", "--run", "FIT"], "expected rows to predict too"),
        (["predict", "--run", "FIT", "--conditions", "ROWS", "--along", "normal_force"], "expected a statement too"),
        (["predict", "--run", "FIT", "--conditions", "ROWS", "--set", "rms_height=2 um"], "expected it with a model only"),
        (["predict", "forearm-glass", "--probability", "friction_coefficient < 1"], "expected them with --run"),
        (
            ["predict", "--run", "FIT", "--conditions", "ROWS", "--probability", "friction_coefficient < 1", "--along", "load"],
            "Did you mean 'normal_force'",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_explained(
    capsys: pytest.CaptureFixture[str], folder: Path, arguments: list[str], message: str
) -> None:
    words = {"FIT": str(folder / "fit.nc"), "ROWS": str(folder / "rows.csv")}
    outcome = run(capsys, *(words.get(word, word) for word in arguments))
    assert outcome.status == 2 and message in outcome.errors


def test_a_model_alone_writes_its_predictions(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, folder: Path
) -> None:
    target = tmp_path / "out.csv"
    assert (
        run(capsys, "predict", "forearm-glass", "--conditions", folder / "rows.csv", "-o", target).status == 0
    )
    again = run(capsys, "predict", "forearm-glass", "--conditions", folder / "rows.csv", "--json").document()
    with target.open() as file:
        written = [float(row["friction_coefficient [1]"]) for row in csv.DictReader(file)]
    assert written == again["prediction"]["friction_coefficient"]
    assert run(capsys, "predict", "forearm-glass", "-o", target).status == 2
