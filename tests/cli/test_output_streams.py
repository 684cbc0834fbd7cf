"""Standard output that cannot take every character, is full, or is closed: no traceback, and JSON stays JSON."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

PLACES = {
    "Windows code page": {"PYTHONIOENCODING": "cp1252"},
    "another code page": {"PYTHONIOENCODING": "cp437"},
    "ASCII": {"PYTHONIOENCODING": "ascii"},
    "no language": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}
# starting a command takes a second: each place once, each kind of output once
SHOWN = [(["show", "stribeck"], place) for place in PLACES] + [
    (command, "ASCII") for command in (["--help"], ["predict", "humid-air"], ["check", "contact-area"])
]


def start(*arguments: str, **options: object) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, **(options.pop("environment", None) or {})}  # type: ignore[dict-item]
    command = [sys.executable, "-c", "from skinbayes.cli import main; main()", *arguments]
    options.setdefault("stdout", subprocess.PIPE)
    return subprocess.run(command, stderr=subprocess.PIPE, env=environment, check=False, **options)  # type: ignore[call-overload, no-any-return]


@pytest.mark.parametrize(("command", "place"), SHOWN, ids=str)
def test_characters_that_do_not_exist_are_replaced(command: list[str], place: str) -> None:
    found = start(*command, environment=PLACES[place])
    assert found.returncode == 0 and b"Traceback" not in found.stderr, found.stderr
    assert found.stdout


@pytest.fixture(scope="module")
def here() -> subprocess.CompletedProcess[bytes]:
    return start("show", "stribeck", "--json")


@pytest.mark.parametrize("place", PLACES)
def test_json_says_the_same_everywhere(place: str, here: subprocess.CompletedProcess[bytes]) -> None:
    there = start("show", "stribeck", "--json", environment=PLACES[place])
    assert there.returncode == here.returncode == 0
    assert json.loads(there.stdout.decode("ascii")) == json.loads(here.stdout.decode("utf-8"))


@pytest.mark.parametrize("place", ["Windows code page", "ASCII"])
def test_messages_too(place: str) -> None:
    found = start("predict", "contact-area", "--set", "yield_stress=5 µN", environment=PLACES[place])
    assert found.returncode == 2 and found.stderr.startswith(b"skinbayes: --set yield_stress")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    "command",
    [["models"], ["show", "stribeck", "--json"], ["predict", "contact-area"], ["--help"]],
    ids=" ".join,
)
def test_a_full_disk_is_one_sentence(command: list[str]) -> None:
    with Path("/dev/full").open("wb") as full:
        found = start(*command, stdout=full)
    assert found.returncode == 4
    assert found.stderr.decode().splitlines() == [
        "skinbayes: output cannot be written: No space left on device"
    ]


@pytest.mark.skipif(sys.platform == "win32", reason="closes a descriptor")
@pytest.mark.parametrize("command", [["models"], ["predict", "contact-area", "--json"]], ids=" ".join)
def test_a_closed_output_is_one_sentence(command: list[str]) -> None:
    found = start(*command, stdout=None, preexec_fn=lambda: os.close(1))
    assert found.returncode == 2
    (line,) = found.stderr.decode().splitlines()
    assert line.startswith("skinbayes: standard output is closed")
