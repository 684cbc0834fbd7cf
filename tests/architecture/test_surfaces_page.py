"""The page on measured surfaces says what is so: its programs run, and its commands print what it shows.

``python tests/architecture/test_surfaces_page.py`` writes what they print now into the page.
"""

from __future__ import annotations

import contextlib
import re
import tempfile
from pathlib import Path

import pytest
from command_line_page import BLOCK, run
from source_tree import ROOT

PAGE = ROOT / "docs" / "surfaces.md"


def programs() -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def printed(folder: Path) -> list[str]:
    """What the commands of each block print, in order, on the surfaces that the first program makes."""
    with contextlib.chdir(folder):
        exec(programs()[0], {})
    commands = [
        found.replace("$ ", "").splitlines() for found, _ in BLOCK.findall(PAGE.read_text(encoding="utf-8"))
    ]
    return ["".join(run(command, folder) for command in block) for block in commands]


def test_commands_and_programs_do_what_the_page_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = [output for _, output in BLOCK.findall(PAGE.read_text(encoding="utf-8"))]
    assert printed(tmp_path) == shown, (
        "if the change is meant: python tests/architecture/test_surfaces_page.py"
    )
    assert all(
        (tmp_path / "both" / name).is_file() for name in ("spectrum.csv", "surface.toml", "spectrum.html")
    )
    with contextlib.chdir(tmp_path):
        exec(programs()[1], {})
    size, height, _ = capsys.readouterr().out.split()[-3:]
    assert int(size) > 30 and 1e-5 < float(height) < 5e-5


def refresh() -> None:
    """Write what the commands print now into the page."""
    with tempfile.TemporaryDirectory() as folder:
        outputs = iter(printed(Path(folder)))
    text = BLOCK.sub(lambda found: f"```\n{found[1]}{next(outputs)}```", PAGE.read_text(encoding="utf-8"))
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    refresh()
