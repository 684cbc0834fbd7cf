"""docs/command-line.md shows every command and option, and what they print."""

from __future__ import annotations

import json
import re
from pathlib import Path

import command_line_page as page
import pytest

from skinbayes.cli.main import cli

BLOCKS = page.blocks()
QUICK = ("models", "show", "template", "check", "prior", "predict")
TEXT = page.PAGE.read_text(encoding="utf-8")


def subcommand(command: str) -> str:
    return command.split()[1]


def test_every_command_and_option_is_there() -> None:
    for name, command in cli.commands.items():
        assert f"skinbayes {name}" in TEXT or f"| {name} " in TEXT, name
        for option in command.params:
            for flag in option.opts:
                assert not flag.startswith("-") or f"`{flag}" in TEXT, f"{name} {flag}"


def test_every_option_in_the_page_exists() -> None:
    flags = {flag for command in cli.commands.values() for option in command.params for flag in option.opts}
    assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", TEXT)) <= flags | {"--help"}


@pytest.mark.parametrize(
    ("commands", "shown"),
    [b for b in BLOCKS if subcommand(b[0][0]) in QUICK],
    ids=lambda value: str(value)[:60],
)
def test_quick_commands_print_what_the_page_shows(commands: list[str], shown: str, tmp_path: Path) -> None:
    assert [page.run(command, tmp_path) for command in commands] == [shown], (
        "if the change is meant: python tests/architecture/command_line_page.py"
    )


def test_fit_and_compare_print_what_the_page_shows(tmp_path: Path) -> None:
    for commands, shown in BLOCKS:
        if subcommand(commands[0]) not in ("fit", "compare", "sensitivity") or page.ABRIDGED in shown:
            continue
        printed = "".join(page.run(command, tmp_path) for command in commands)
        # draws are the same from run to run, but libraries may differ in the last bit of a logarithm
        for name, row in page.numbers(shown).items():
            found = page.numbers(printed)[name]
            assert found == pytest.approx(row, rel=0.1, abs=0.1), f"{commands[-1]}: {name}"
        assert set(page.numbers(printed)) == set(page.numbers(shown))


def test_the_json_document_has_the_keys_that_the_page_shows(tmp_path: Path) -> None:
    ((command,), shown) = next(block for block in BLOCKS if page.ABRIDGED in block[1])
    document = json.loads(page.run(f"{command} --ess 100", tmp_path))
    assert list(json.loads(re.sub(r",\n *…\n", "\n", shown))) == list(document)
    entry = document["parameters"]["frictional_shear_stress"]
    assert all(f'"{key}"' in shown for key in entry)
