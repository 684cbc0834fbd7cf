"""``design`` on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

ROWS = "state,normal_force [N],sphere_radius [mm]\nwet,1,7.1\ndry,1,7.1\ndry,5,7.1\n"


@pytest.fixture
def candidates(tmp_path: Path) -> Path:
    """A CSV of rows that could be measured."""
    path = tmp_path / "candidates.csv"
    path.write_text(ROWS)
    return path


def test_before_any_data_a_dry_row_tells_about_the_yield_stress(
    capsys: pytest.CaptureFixture[str], candidates: Path
) -> None:
    picture = candidates.with_name("design.svg")
    outcome = run(
        capsys, "design", "forearm-glass", "--candidates", candidates, "--parameter", "yield_stress[dry]", "--rows", "2",
        "-o", picture, "--json",
    )  # fmt: skip
    assert outcome.status == 0 and "what is known is its prior" in outcome.errors
    document = outcome.document()
    assert {one["row"] for one in document["candidates"][:2]} == {2, 3}  # wet skin has no yield stress
    assert len(document["chosen"]) == 2 and document["about"] == ["yield_stress[dry]"]
    assert picture.read_bytes().lstrip().startswith(b"<?xml")
    table = run(capsys, "design", "forearm-glass", "--candidates", candidates)
    assert table.status == 0 and "information" in table.output and "nats" in table.output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["forearm-glass"], "Missing option '--candidates'"),
        (["forearm-glass", "--candidates", "ROWS", "-o", "x.txt"], "ends in .svg"),
        (["forearm-glass", "--candidates", "ROWS", "--parameter", "rms_heigth"], "Did you mean 'rms_height'"),
        (["nowhere", "--candidates", "ROWS"], "neither a run nor a model"),
    ],
)
def test_what_cannot_be_done_is_explained(
    capsys: pytest.CaptureFixture[str], candidates: Path, arguments: list[str], message: str
) -> None:
    outcome = run(capsys, "design", *(str(candidates) if word == "ROWS" else word for word in arguments))
    assert outcome.status == 2 and message in outcome.errors
