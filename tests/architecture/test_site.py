"""The site finds every page, and builds without a warning."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from source_tree import ROOT

DOCS = ROOT / "docs"
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
WORDS = re.compile(r"<!-- (.*?) -->")
"""What a figure says: text drawn as paths stands beside them in comments."""
BUILD = "sphinx-build -W --keep-going -q -c docs . build/site"


def entries(page: Path) -> list[str]:
    """What the navigation of a page names, relative to the root, without suffix."""
    found = [
        line for block in TOCTREE.findall(page.read_text(encoding="utf-8")) for line in block.splitlines()
    ]
    named = [line for line in found if line and not line.startswith(":")]
    return [str((page.parent / line).resolve().relative_to(ROOT)) for line in named]


def pages() -> set[str]:
    """Every document and notebook, without suffix."""
    found = [*DOCS.glob("*.md"), *DOCS.glob("api/*.md"), *ROOT.glob("notebooks/*.ipynb"), *ROOT.glob("*.md")]
    return {str(path.relative_to(ROOT).with_suffix("")) for path in found}


def test_the_navigation_names_pages_once_and_then_the_rest() -> None:
    named = [entry for page in DOCS.glob("*.md") for entry in entries(page)]
    assert sorted(named) == sorted(set(named))
    assert set(named) - pages() == {"docs/the-rest"}, "a page that is not there"
    rest = {page for page in pages() - set(named) if not page.startswith("docs/")}
    assert not rest, (
        "docs/conf.py puts pages of docs into the navigation that are not named there, but no others"
    )


def test_the_build_is_what_contributing_says_and_ci_runs() -> None:
    assert BUILD in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert BUILD in (ROOT / ".ci" / "run").read_text(encoding="utf-8")


def test_named_tests_are_there() -> None:
    theory = (DOCS / "theory.md").read_text(encoding="utf-8")
    assert (
        len(
            re.findall(
                r"^\| .* \| .* \| .* \| \[\w+\]\(\.\./tests/physics/test_\w+\.py\) \|$", theory, re.MULTILINE
            )
        )
        > 10
    )


@pytest.mark.site
def test_the_gallery_is_what_its_programs_draw(tmp_path: Path) -> None:
    """Words and numbers in the figures are those of the page; curves may differ in a last bit."""
    subprocess.run(
        [sys.executable, DOCS / "figures" / "gallery.py", tmp_path], check=True, cwd=tmp_path, timeout=500
    )
    drawn = {path.name for path in tmp_path.glob("*.svg")}
    shown = set(re.findall(r"\(figures/([\w-]+\.svg)\)", (DOCS / "gallery.md").read_text(encoding="utf-8")))
    assert drawn == shown and len(drawn) > 8
    for name in drawn:
        now, stored = ((folder / name).read_text(encoding="utf-8") for folder in (tmp_path, DOCS / "figures"))
        assert sorted(WORDS.findall(now)) == sorted(WORDS.findall(stored)), (
            f"{name}: python docs/figures/gallery.py"
        )


@pytest.mark.slow
def test_the_site_builds_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("sphinx", reason="the site needs skinbayes[docs]")
    pytest.importorskip("myst_nb", reason="the site needs skinbayes[docs]")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-c", "docs", ".", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=900, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    for page in pages():
        html = tmp_path / f"{page}.html"
        assert html.is_file(), page
        for link in re.findall(r'(?:href|src)="([^"#?:]+)[#?"]', html.read_text(encoding="utf-8")):
            assert (html.parent / link).exists(), f"{page}: {link}"
