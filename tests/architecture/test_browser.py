"""Pages of commands and of the site in a real headless browser: nothing missing, readable on a phone, for everybody, on paper.

Needs chromium and ``skinbayes[browser]``; skipped without.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line_page import run
from opened_pages import opened_browser, problems, served, unordered
from source_tree import ROOT

HOSTILE = "<script>alert(1)</script>"
IMAGE = "<img src=x onerror=alert(2)>"
MODEL = f"""
title = "{HOSTILE} on skin"
description = "{IMAGE} & <b>bold</b>"
forward = "friction"
data = {{ file = "hostile.csv", observable = "friction_coefficient" }}
surface = {{ name = "paper_reference" }}

[parameters]
frictional_shear_stress = {{ loguniform = ["0.5 MPa", "500 MPa"], source = "{HOSTILE}" }}
young_modulus_layer = {{ lognormal = ["7 MPa", 0.5], source = "{IMAGE}" }}
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"

[groups."{{COLUMN}}"]
scale = {{ half_normal = 0.5, source = "people differ" }}

[noise]
family = "lognormal"
noise_scale = {{ half_normal = 0.3, source = "<i>weak</i>" }}
"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with opened_browser() as found:
        yield found


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> Path:
    """A folder with a page of each kind, some of labels, titles and columns that would be markup if they could."""
    made = tmp_path_factory.mktemp("pages")
    rows = [
        f"{who},{load},8,{mu},1"
        for who, mu in ((HOSTILE, 1.3), (IMAGE, 1.6), ("a&b", 1.1))
        for load in (100, 200, 400)
    ]
    header = "person,normal_force [mN],sphere_radius [mm],friction_coefficient [1],<u>extra</u> [1]"
    (made / "hostile.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    (made / "hostile.toml").write_text(MODEL.replace("{COLUMN}", "person"), encoding="utf-8")
    heights = np.random.default_rng(1).normal(size=(64, 64)).cumsum(axis=0).cumsum(axis=1)
    np.save(made / "wrist.npy", heights / heights.std() * 20)
    for command in (
        "skinbayes fit hostile.toml --ess 300 --report -o hostile",
        "skinbayes fit forearm-glass --ess 300 --report -o forearm",
        "skinbayes compare forearm-glass forearm-glass-separate --ess 300 --no-refit --report compared.html",
        "skinbayes spectrum wrist.npy --unit um --pixel-size '8 um' -o spectrum",
        "skinbayes reproduce -o reproduced.html",
    ):
        run(command, made)
    return made


PAGES = (
    "hostile/report.html",
    "forearm/report.html",
    "compared.html",
    "spectrum/spectrum.html",
    "reproduced.html",
)


@pytest.mark.slow
@pytest.mark.parametrize("name", PAGES)
@pytest.mark.parametrize("colours", ["light", "dark"])
def test_pages_of_commands(name: str, colours: str, browser: Any, folder: Path) -> None:
    assert (folder / name).is_file(), "the command wrote no page"
    with served(folder) as address:
        assert problems(browser, f"{address}/{name}", colours) == []


@pytest.mark.slow
def test_hostile_words_stay_words(browser: Any, folder: Path) -> None:
    page = browser.new_page()
    page.goto((folder / "hostile" / "report.html").as_uri())
    text = page.inner_text("body") + page.text_content("body")
    assert HOSTILE in text and IMAGE in text
    assert page.evaluate("() => document.querySelectorAll('script, img[onerror], b > b').length") == 0
    page.close()


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, browser: Any) -> Path:
    """The site, with notebooks that are not run."""
    pytest.importorskip("myst_nb", reason="the site needs skinbayes[docs]")
    made = tmp_path_factory.mktemp("site")
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-D",
        "nb_execution_mode=off",
        "-c",
        "docs",
        ".",
        str(made),
    ]
    subprocess.run(command, cwd=ROOT, check=True, timeout=900, capture_output=True)
    return made


SITE = ("docs/index", "docs/quick-start", "docs/how-to", "docs/load-series", "docs/theory", "docs/gallery", "docs/model-files",
        "docs/reporting", "docs/vocabulary", "docs/api/friction", "notebooks/load_series")  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", SITE)
def test_pages_of_the_site(name: str, browser: Any, site: Path) -> None:
    with served(site) as address:
        assert problems(browser, f"{address}/{name}.html") == []


@pytest.mark.slow
def test_a_page_that_is_broken_is_noticed(browser: Any, tmp_path: Path) -> None:
    (tmp_path / "bad.html").write_text(
        "<!DOCTYPE html><html><head><title>x</title></head><body><h1>a</h1><h3>b</h3><img src='none.png'>"
        "<p style='color: #ccc; background: #fff; width: 600px'>pale</p><script>console.error('no')</script></body></html>"
    )
    with served(tmp_path) as address:
        found = " ".join(problems(browser, f"{address}/bad.html"))
    expected = ("console: no", "h3 below h1", "no alternative text", "picture not there", "phone, too wide")
    for said in (*expected, "color-contrast", "html-has-lang"):
        assert said in found, found


def test_headings_in_order() -> None:
    assert unordered([1, 2, 3, 2]) == []
    assert unordered([1, 3]) == ["h3 below h1"]
    assert len(unordered([2, 1])) == 1 and len(unordered([1, 1])) == 1
