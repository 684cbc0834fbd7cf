"""Files stay small, and nothing in the tree belongs to one machine or one day."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from statistics import median

import pytest
from source_tree import ROOT, modules

LONGEST = 400
MEDIAN = 200

TEXT = {".py", ".md", ".toml", ".csv", ".ipynb", ".cff", ".html", ".css", ".j2", ".txt", ".yml", ".cfg", ""}


def tracked_files() -> list[Path]:
    """The files of the project: tracked by git or, in an unpacked sdist, all there are."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    names = (
        listed.stdout.split("\0")
        if listed.returncode == 0
        else [str(p) for p in ROOT.rglob("*") if p.is_file()]
    )
    paths = [ROOT / name for name in names if name and "__pycache__" not in name and ".venv" not in name]
    return [path for path in paths if path.is_file() and path.suffix in TEXT and path.name != "PKG-INFO"]


def lines(path: Path) -> int:
    return path.read_text(encoding="utf-8").count("\n")


def test_no_module_is_long() -> None:
    sizes = {module: lines(path) for module, path in modules().items()}
    assert not {module: size for module, size in sizes.items() if size > LONGEST}
    assert median(size for size in sizes.values() if size > 1) < MEDIAN


def test_no_test_is_long() -> None:
    sizes = {path.name: lines(path) for path in (ROOT / "tests").rglob("*.py")}
    assert not {name: size for name, size in sizes.items() if size > LONGEST}


def test_test_files_have_names_of_their_own() -> None:
    # pytest imports them by their bare names
    names = [path.name for path in (ROOT / "tests").rglob("*.py") if path.name != "conftest.py"]
    assert sorted(names) == sorted(set(names))


# the words are put together here so that this file does not contain what it looks for
FORBIDDEN = {
    "path of a machine": re.compile(
        "|".join(rf"(?<![\w.])/{folder}/" for folder in ("work", "tmp", "root", "home", "opt"))
    ),
    "address of a package registry": re.compile(
        "|".join((r"pypi\.org", "python" + "hosted", "npm" + "js", "index-" + "url"))
    ),
    "unfinished mark": re.compile(
        "|".join(rf"\b{mark}\b" for mark in ("TO" + "DO", "FIX" + "ME", "XX" + "X", "HA" + "CK"))
    ),
    "unfinished function": re.compile("NotImplemented" + "Error"),
}


@pytest.mark.parametrize("what", FORBIDDEN)
def test_no_file_has(what: str) -> None:
    found = []
    for path in tracked_files():
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if match := FORBIDDEN[what].search(line):
                found.append(f"{path.relative_to(ROOT)}, line {number}: {match[0]}")
    assert not found, "\n".join(found)


def test_files_are_looked_at() -> None:
    names = {str(path.relative_to(ROOT)) for path in tracked_files()}
    assert {"README.md", "pyproject.toml", "skinbayes/__init__.py", "models/forearm-glass.toml"} <= names
