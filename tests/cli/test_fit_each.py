"""``fit --each`` as a user meets it."""

from __future__ import annotations

import json
from pathlib import Path

import pandas
import pytest
from command_line import run

DATA = "person,normal_force [N],friction_coefficient [1]\n" + "".join(
    f"P{i},0.5,{0.3 + 0.2 * i + 0.01 * j}\n" for i in range(1, 4) for j in range(3)
)

MODEL = """format = 1
title = "A level for each"
forward = "constant"

[data]
observable = "friction_coefficient"

[parameters.typical_friction_coefficient]
uniform = [0, 3]
source = "made up"

[noise]
family = "lognormal"
noise_scale = 0.05
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("panel.csv").write_text(DATA)
    Path("level.toml").write_text(MODEL)
    return tmp_path


def fit(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    outcome = run(capsys, "fit", "level.toml", *words)
    return outcome.status, outcome.output, outcome.errors


def test_each_person(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = fit(capsys, "--data", "panel.csv", "--each", "person", "--ess", "200", "--runs")
    assert status == 0, out
    assert "3 fits: all converged." in out
    directory = folder / "runs" / "level-each-person-seed1"
    assert str(directory.relative_to(folder) / "results.csv") in out
    table = pandas.read_csv(directory / "results.csv", index_col="name")
    middles = table["typical_friction_coefficient [1]"]
    assert list(table.index) == ["P1", "P2", "P3"]
    assert middles.to_numpy() == pytest.approx([0.51, 0.71, 0.91], rel=0.05)
    # again: nothing is fitted, and the document holds the same
    status, out, _ = fit(
        capsys, "--data", "panel.csv", "--each", "person", "--ess", "200", "--runs", "--json"
    )
    document = json.loads(out)
    assert status == 0 and [one["name"] for one in document["fits"]] == ["P1", "P2", "P3"]
    assert document["fits"][0]["quantities"]["typical_friction_coefficient"][1] == pytest.approx(
        middles["P1"], rel=1e-6
    )


def test_each_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = DATA.splitlines()
    for i in (1, 2):
        rows = [line for line in lines[1:] if line.startswith(f"P{i}")]
        Path(f"data-{i}.csv").write_text("\n".join([lines[0], *rows]) + "\n")
    Path("data-3.csv").write_text("person,normal_force [N]\nP3,0.5\n")
    status, out, _ = fit(capsys, "--data", "data-*.csv", "--each", "file", "--ess", "200", "-o", "out")
    assert status == 3
    assert "3 fits: 2 converged, 1 ended in an error." in out
    assert "data-3: data-3.csv: no column 'friction_coefficient [..]'" in " ".join(out.split())
    assert sorted(path.name for path in (folder / "out" / "draws").iterdir()) == ["data-1.npz", "data-2.npz"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--each", "persons", "--data", "panel.csv"), "no label column 'persons'"),
        (("--each", "file"), "--each file: expected the files, --data 'FOLDER/*.csv'"),
        (("--each", "file", "--data", "nothing-*.csv"), "--data nothing-*.csv: no such file"),
        (("--each", "missing.csv", "--data", "panel.csv"), "missing.csv"),
        (("--each", "person", "--data", "panel.csv", "--report"), "--report: one page for one fit"),
        (("--data", "panel.csv", "--runs"), "expected --each WHAT with them"),
    ],
)
def test_what_cannot_be_is_said(
    folder: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], said: str
) -> None:
    status, out, err = fit(capsys, *words)
    assert status == 2 and said in " ".join(err.split()) and not out
    assert not (folder / "runs").exists()
