"""Tables at any width: words stay whole, numbers keep their units, COLUMNS counts where there is no terminal."""

from __future__ import annotations

import re

import pytest
from command_line import run

from skinbayes.cli.output import PIPED, print_table

HEADERS = ("parameter", "median", "source")
ROWS = [
    ["frictional_shear_stress", "14.82 MPa", "Weak on purpose: three decades (10.1007/s11249-012-0053-2)"],
    ["young_modulus_layer[wet]", "7.028 MPa", "rubbery wet stratum corneum and indentation of epidermis"],
]


@pytest.mark.parametrize("columns", [200, 160, 100, 80, 72, 60, 40])
def test_no_word_is_broken_at_any_width(
    columns: int, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    print_table(HEADERS, ROWS, title="What is known", right=(1,))
    printed = capsys.readouterr().out
    assert all(len(line) <= columns for line in printed.splitlines())
    pieces = printed.split()
    for row in ROWS:
        for cell in row:
            assert set(cell.split()) <= set(pieces) | {"parameter"}, columns
    assert all(re.search(rf"{number} MPa", printed) for number in ("14.82", "7.028"))


@pytest.mark.parametrize("command", [["models"], ["show", "finger-water"], ["check", "forearm-glass"],
                                     ["predict", "forearm-glass"], ["prior", "forearm-glass"]])  # fmt: skip
def test_commands_keep_to_80_columns(
    command: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(PIPED))
    wide = run(capsys, *command).output
    monkeypatch.setenv("COLUMNS", "80")
    narrow = run(capsys, *command).output
    assert max(len(line) for line in narrow.splitlines()) <= 80
    rule = re.compile(r"[\s─]+")
    # the same words, only elsewhere; a list repeats its headers
    assert set(rule.split(wide)) <= set(rule.split(narrow)) | {
        h for h in rule.split(wide) if f"{h}:" in narrow
    }


@pytest.mark.parametrize("nonsense", ["", "0", "-5", "wide", "1e3"])
def test_a_width_that_is_none_is_not_taken(
    nonsense: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    usual = run(capsys, "models").output
    monkeypatch.setenv("COLUMNS", nonsense)
    assert run(capsys, "models").output == usual
