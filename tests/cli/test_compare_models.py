"""``compare`` of models that were not sampled yet, and the page that it writes."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

MODEL = """
title = "Friction is {median}"
forward = "constant"
[data]
file = "mine.csv"
observable = "friction_coefficient"
[parameters]
typical_friction_coefficient = {{ lognormal = [{median}, 0.3] }}
[noise]
family = "lognormal"
noise_scale = 0.1
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two models of one table, in the working directory."""
    monkeypatch.chdir(tmp_path)
    Path("mine.csv").write_text("friction_coefficient [1]\n0.41\n0.39\n0.40\n0.42\n", encoding="utf-8")
    for name, median in (("near", 0.4), ("far", 1.0)):
        Path(f"{name}.toml").write_text(MODEL.format(median=median), encoding="utf-8")
    return tmp_path


def test_models_are_sampled_once(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("compare", "near.toml", "far.toml", "--ess", 200, "--no-refit", "--json")
    first = run(capsys, *asked, "--report", "page.html")
    assert first.status == 0
    assert "near: sampled into runs/near-seed1" in first.errors
    document = first.document()
    assert document["report"] == "page.html"
    assert [model["name"] for model in document["models"]] == ["near", "far"]
    page = Path("page.html").read_text(encoding="utf-8")
    assert "near and far compared" in page and "Friction is 1.0" in page
    assert page.count("<figure") == 3  # which is ahead, and each beside its data
    for sentence in document["sentences"]:
        assert sentence.split("'")[0].split(":")[0] in page

    again = run(capsys, "compare", "runs/near-seed1", *asked[2:])
    assert "far: read from runs/far-seed1" in again.errors
    assert again.document()["models"] == document["models"]


def test_what_cannot_be_compared(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def complaint(*arguments: object) -> str:
        outcome = run(capsys, "compare", *arguments)
        assert outcome.status == 2 and not Path("runs").exists()
        return outcome.errors

    assert "neither a run nor a model" in complaint("near.toml", "faar")
    assert "no file" in complaint("near.toml", "faar.toml") or "faar.toml" in complaint(
        "near.toml", "faar.toml"
    )
    assert "two of the models have this name" in complaint("near.toml", "near.toml")
    assert "a comparison needs at least two" in complaint("near.toml")
    Path("notes.html").write_text("my notes", encoding="utf-8")
    assert "is no page of skinbayes" in complaint("near.toml", "far.toml", "--report", "notes.html")
    assert Path("notes.html").read_text(encoding="utf-8") == "my notes"
