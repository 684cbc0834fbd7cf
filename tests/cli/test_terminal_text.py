"""What files and arguments hold is shown on the terminal, never obeyed by it; JSON stays valid and whole."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import pytest
from command_line import ROOT, run

# colour, a C1 control sequence, a title of the window, overrides of the direction of writing, line separator, bell
EVIL = ("\x1b[31m", "\x9b31m", "\x1b]0;x\x07", "\u202e", "\u2066", "\u2028", "\x08")
UNSAFE = {chr(i) for i in (*range(0x20), *range(0x7F, 0xA0))} - {"\n"} | set(
    "\u202a\u202b\u202d\u202e\u2066\u2067\u2028"
)


def harmless(text: str) -> None:
    assert not UNSAFE & set(text), {hex(ord(c)) for c in UNSAFE & set(text)}


@pytest.mark.parametrize("evil", EVIL, ids=repr)
def test_show_of_a_table(evil: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(f"person,friction_coefficient [1],{evil}b\n{evil}red,0.5,{evil}\n", encoding="utf-8")
    shown = run(capsys, "show", path)
    assert shown.status == 0 and "red" in shown.output
    harmless(shown.output)
    refused = run(capsys, "check", "finger-water", "--data", path)
    assert refused.status == 2
    harmless(refused.errors)


@pytest.mark.parametrize("evil", EVIL, ids=repr)
def test_arguments(evil: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    for words in (
        [evil], ["show", evil], ["fit", evil], ["predict", "contact-area", "--set", f"{evil}=1"],
        ["predict", "contact-area", "--set", evil],
        ["check", "finger-water", "--data", evil], ["template", f"{evil}.toml"], ["fit", "finger-water", f"--{evil}"],
        ["predict", "contact-area", "--set", f"yield_stress=1{evil}"], ["report", evil],
    ):  # fmt: skip
        refused = run(capsys, *words)
        assert refused.status == 2
        harmless(refused.errors + refused.output)


def test_json_is_whole_and_harmless(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    label = "".join(EVIL) + "José 漢 😀"
    path = tmp_path / "mine.csv"
    path.write_text(f"person,friction_coefficient [1]\n{label},0.5\n", encoding="utf-8")
    shown = run(capsys, "show", path, "--json")
    harmless(shown.output)
    assert json.loads(shown.output)["rows"][0][0] == label and "José" in shown.output


def test_long_values_are_not_repeated(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(f"person,friction_coefficient [1]\n{'x' * 5000},0.5\n", encoding="utf-8")
    assert "x" * 501 not in run(capsys, "show", path).output.replace("\n", "").replace(" ", "")
    long = "x" * 5000
    for words in (
        ["predict", "contact-area", "--set", f"{long}=1"], ["predict", "contact-area", "--set", f"yield_stress={long}"],
        ["predict", "contact-area", "--set", f"surface={long}"], ["predict", "contact-area", "--set", long],
        [long], ["show", long],
        ["check", "finger-water", "--data", long], ["fit", "finger-water", f"--{long}"],
    ):  # fmt: skip
        refused = run(capsys, *words)
        assert refused.status == 2 and "x" * 401 not in refused.errors, words[0]


def test_a_file_that_a_model_names_is_not_quoted(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    secret = "root:$6$saltsalt$verysecret:19000:0:99999:7:::\ndaemon:*:18375:0:99999:7:::\n"
    (tmp_path / "shadow").write_text(secret)
    text = (ROOT / "models" / "finger-water.toml").read_text(encoding="utf-8")
    data = text.replace('dataset = "fehlberg2025-finger-stribeck"', 'file = "shadow"')
    surface = text.replace('name = "paper_reference"', 'file = "shadow"')
    for name, changed in (("data", data), ("surface", surface)):
        assert changed != text
        (tmp_path / f"{name}.toml").write_text(changed, encoding="utf-8")
        refused = run(capsys, "check", tmp_path / f"{name}.toml")
        assert refused.status == 2
        assert not any(word in refused.errors for word in ("root:", "salt", "secret", "19000", "daemon"))


def test_text_leaves_by_one_door() -> None:
    # click.echo and print would send what they are given
    for path in sorted((ROOT / "skinbayes" / "cli").glob("*.py")):
        calls = [
            ast.unparse(n.func)
            for n in ast.walk(ast.parse(path.read_text("utf-8")))
            if isinstance(n, ast.Call)
        ]
        allowed = {"output.py", "main.py"}
        assert path.name in allowed or not {"click.echo", "print", "click.secho"} & set(calls), path.name
