"""``skinbayes reproduce``: terminal, JSON, page and figures; the whole of it is slow."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run, run_process

FEW = ("nominal-pressure", "droplet-film", "eq-4", "dry-yields", "separation-without")


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """A handful of cheap rows, two demonstrations and two figures."""
    from skinbayes.plot import paper
    from skinbayes.report import reproduction_page
    from skinbayes.reproduce import demonstrations, statements, table

    stated = {name: found for name, found in statements().items() if name in FEW}
    monkeypatch.setattr(table, "statements", lambda: stated)
    shown = ("seventy-six-seconds", "dry-friction")
    module = __import__("sys").modules[demonstrations.__module__]
    monkeypatch.setattr(
        module, "ALL", tuple(one for one in module.ALL if one.__name__ in ("time", "dry_friction"))
    )
    assert len(module.ALL) == len(shown)
    chosen = tuple(one for one in paper.FIGURES if one.key in ("fig05", "fig19"))
    for place in (paper, reproduction_page):
        monkeypatch.setattr(place, "FIGURES", chosen)


def test_terminal_of_eighty_columns(
    capsys: pytest.CaptureFixture[str], few: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    outcome = run(capsys, "reproduce")
    assert outcome.status == 0
    assert max(map(len, outcome.output.splitlines())) <= 80
    lines = outcome.output.splitlines()
    assert any("6.83 kPa" in line and line.endswith("yes") for line in lines)
    assert any(
        "≈ 90 µm" in line and "78.1 µm" in line and "−13 %" in line and line.endswith("NO") for line in lines
    )
    assert "4 of 5 agree: 2 of 3 numbers, 1 of 1 equations, 1 of 1 statements in words." in outcome.output
    assert "What does not agree, and why" in outcome.output


def test_json_document(capsys: pytest.CaptureFixture[str], few: None) -> None:
    document = run(capsys, "reproduce", "--json").document()
    found = {row["id"]: row for row in document["quantities"]}
    assert set(found) == set(FEW)
    for row in found.values():
        assert {
            "id",
            "where",
            "description",
            "unit",
            "paper",
            "computed",
            "relative_difference",
            "agrees",
            "note",
        } <= set(row)
    assert found["droplet-film"]["paper"] == pytest.approx(90e-6)
    assert found["droplet-film"]["relative_difference"] == pytest.approx(78.125 / 90 - 1)
    assert found["droplet-film"]["agrees"] is False and found["nominal-pressure"]["agrees"] is True
    assert found["eq-4"]["paper"] == pytest.approx(found["eq-4"]["computed"], rel=1e-6)
    assert found["dry-yields"]["paper"] == "complete"
    assert found["dry-yields"]["relative_difference"] is None
    assert len(document["inputs"]) == 53 and len(document["not_computed"]) == 25
    assert all(row["reason"] for row in document["not_computed"])


def test_page_and_figures(capsys: pytest.CaptureFixture[str], few: None, tmp_path: Path) -> None:
    page, folder = tmp_path / "paper.html", tmp_path / "figures"
    outcome = run(capsys, "reproduce", "-o", page, "--figures", folder)
    assert outcome.status == 0
    assert sorted(path.name for path in folder.iterdir()) == [
        "captions.md",
        "fig05.pdf",
        "fig05.png",
        "fig19.pdf",
        "fig19.png",
    ]
    assert (folder / "captions.md").read_text(encoding="utf-8").count("**Fig. ") == 2
    text = page.read_text(encoding="utf-8")
    assert text.count("<figure") == 3 and "http://" not in text.replace("http://www.w3.org", "")
    for words in (
        "4 of 5 agree",
        'id="droplet-film"',
        "What does not agree",
        "Stated, but not computed",
        "are what 13",
    ):
        assert words in text
    again = run(capsys, "reproduce", "-o", page)
    assert again.status == 0


def test_other_files_are_not_overwritten(
    capsys: pytest.CaptureFixture[str], few: None, tmp_path: Path
) -> None:
    other = tmp_path / "notes.html"
    other.write_text("mine", encoding="utf-8")
    outcome = run(capsys, "reproduce", "-o", other)
    assert (
        outcome.status == 2
        and "exists already" in outcome.errors
        and other.read_text(encoding="utf-8") == "mine"
    )
    outcome = run(capsys, "reproduce", "--figures", other)
    assert outcome.status == 2 and "expected a folder" in outcome.errors


@pytest.mark.slow
def test_all_of_it(tmp_path: Path) -> None:
    outcome = run_process(
        "reproduce", "--json", "-o", "paper.html", "--figures", "figures", cwd=tmp_path, timeout=900
    )
    assert outcome.status == 0
    document = outcome.document()
    assert document["total"] == 134 and document["agreeing"] == 115
    names = {path.stem for path in (tmp_path / "figures").glob("*.pdf")}
    assert names == {f"fig{n:02}" for n in (*range(3, 18), 19, 20, 21)}
    text = (tmp_path / "paper.html").read_text(encoding="utf-8")
    assert text.count("<figure") == 19 and len(text) < 5_000_000
