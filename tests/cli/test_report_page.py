"""The report page: well formed, self-contained, safe, and it says what the fit says."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace
from functools import cache
from html import escape
from html.parser import HTMLParser
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from skinbayes.errors import InputError, MachineError
from skinbayes.fit import Fit, load_fit, sample
from skinbayes.plot.numbers import quantity
from skinbayes.plot.symbols import spoken_name
from skinbayes.problem import load_problem
from skinbayes.report import write_report

VOID = {"meta", "img", "br", "hr", "link", "input"}

BRIEFLY = {"max_steps": 100, "ensembles": 2, "walkers": 32, "importance": False}
"""Sampled much too briefly for anything but showing that a page can be made."""

HOSTILE = "<script>alert(1)</script> \"double\" 'single' & <img src=x onerror=alert(2)>"


class Page(HTMLParser):
    """Reads a page and remembers elements, links and text; fails where tags do not match."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str]]] = []
        self.text = ""
        self.feed(page)
        self.close()
        assert self.open == [], f"not closed: {self.open}"

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-1:]}"
        self.open.pop()

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] != "style":
            self.text += data

    def all(self, tag: str) -> list[dict[str, str]]:
        return [attributes for name, attributes in self.elements if name == tag]


@cache
def short_fit() -> Fit:
    """Enough draws to show what was learnt, by far not as many as were asked for."""
    return sample(
        load_problem("forearm-glass"), ess=1e6, max_steps=300, ensembles=2, walkers=64, importance=False
    )


def converged(fit: Fit) -> Fit:
    sampling = {**fit.provenance["sampling"], "converged": True, "missing": [], "verdict": "Converged."}
    return replace(fit, provenance={**fit.provenance, "sampling": sampling})


@cache
def page_of(fit_name: str) -> str:
    fit = short_fit() if fit_name == "short" else converged(short_fit())
    with TemporaryDirectory() as folder:
        return write_report(fit, Path(folder) / "page.html").read_text(encoding="utf-8")


def words(text: str) -> str:
    return re.sub(r"\s+", " ", text)


def test_page_is_well_formed_html() -> None:
    text = page_of("converged")
    assert text.lstrip().startswith("<!DOCTYPE html>")
    page = Page(text)
    assert page.all("html")[0]["lang"] == "en"
    assert len(page.all("h1")) == 1
    identifiers = [a["id"] for _, a in page.elements if "id" in a]
    assert len(identifiers) == len(set(identifiers))
    labelled = [a["aria-labelledby"] for _, a in page.elements if "aria-labelledby" in a]
    assert labelled and set(labelled) <= set(identifiers)


def test_page_needs_nothing_from_elsewhere() -> None:
    text = page_of("converged")
    page = Page(text)
    assert not {"script", "link", "iframe", "object", "embed"} & {tag for tag, _ in page.elements}
    for _, attributes in page.elements:
        assert attributes.get("src", "data:image/").startswith("data:image/")
        assert attributes.get("srcset", "data:image/").startswith("data:image/")
        assert attributes.get("href", "https://doi.org/10.").startswith("https://doi.org/10.")
        assert not [name for name in attributes if name.startswith("on")]
    style = text[text.index("<style>") : text.index("</style>")]
    assert "url(" not in style and "@import" not in style and "&" not in style
    assert len(text.encode()) < 3_000_000


def test_figures_have_alternative_texts_and_captions() -> None:
    page = Page(page_of("converged"))
    images = page.all("img")
    assert len(images) == len(page.all("figure")) == len(page.all("figcaption")) == 5
    assert all(len(image["alt"]) > 30 for image in images)
    assert {f["id"] for f in page.all("figure")} == {
        "predictive", "profile-wavevector", "prior-posterior", "corner", "trace",
    }  # fmt: skip


def test_every_parameter_is_there_with_its_median_and_prior() -> None:
    fit, text = short_fit(), words(Page(page_of("converged")).text)
    for label, row in fit.summary().iterrows():
        assert spoken_name(str(label)) in text
        assert quantity(row["median"], row["unit"]) in text
        assert fit.provenance["priors"][label]["text"] in text
    for label in fit.provenance["fixed"]:
        assert spoken_name(label) in text


def test_provenance_is_complete() -> None:
    fit, text = short_fit(), words(Page(page_of("converged")).text)
    data = fit.provenance["data"]
    assert fit.problem is not None and fit.problem.dataset is not None
    origin = fit.problem.dataset.provenance
    assert origin is not None
    for expected in (*origin.caveats, *origin.doi, *origin.authors, origin.licence, data["sha256"]):
        assert words(expected) in text
    for name, version in fit.provenance["versions"].items():
        assert f"{name} {version}" in text
    for reference in fit.cite():
        assert words(reference) in text
    assert "Seed1 " in text  # term and description
    assert words(fit.provenance["model_text"]) in text


def test_not_converged_is_loud_and_says_what_is_missing() -> None:
    assert not short_fit().converged
    text = page_of("short")
    page = Page(text)
    assert "<title>NOT CONVERGED" in text
    assert page.text.count("NOT CONVERGED") >= 2
    assert any(attributes.get("role") == "alert" for attributes in page.all("div"))
    assert all(image["alt"].startswith("NOT CONVERGED") for image in page.all("img"))
    assert "effective sample size of σf is" in words(page.text)  # the f is set below the line
    assert "NOT CONVERGED" not in page_of("converged")


def test_what_only_the_prior_knows_is_said(tmp_path: Path) -> None:
    fit = converged(short_fit())
    posterior = fit.groups["posterior"].copy(deep=True)
    known = posterior["layer_thickness"]
    known.values = fit.draws("layer_thickness", "prior")[: known.size].reshape(known.shape)
    fit = replace(fit, groups={**fit.groups, "posterior": posterior})
    text = words(Page(write_report(fit, tmp_path / "page.html").read_text(encoding="utf-8")).text)
    learnt = text[text.index("What was learnt") : text.index("What was not learnt")]
    not_learnt = text[text.index("What was not learnt") : text.index("What is known only in combination")]
    assert "Layer thickness d: only the prior speaks" in not_learnt
    assert "Frictional shear stress σf:" in learnt and "Layer thickness" not in learnt
    together = text[text.index("What is known only in combination") : text.index("Parameters")]
    assert "σf / σY (dry)" in together


def test_the_page_opens_with_question_answer_fit_and_one_picture() -> None:
    text = page_of("converged")
    said = words(Page(text).text)
    opening = said[said.index("What do 2 values of friction coefficient") : said.index("What the data say")]
    assert "say about frictional shear stress σf" in opening
    assert re.search(r"σf/(σY|\(E0 s\)) = 0\.\d+ \(90 %: ", opening)
    assert "only the prior speaks" in opening
    assert "Does the model fit? Hardly tested" in opening
    assert text.index("Does the model fit?") < text.index("<figure") < text.index("What the data say")
    # convergence is a line about the computation, not a banner
    assert "The computation converged" in opening and "state good" not in text and "--good" not in text


def test_headings_go_down_one_level_at_a_time() -> None:
    levels = [int(tag[1]) for tag, _ in Page(page_of("converged")).elements if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(deeper <= level + 1 for level, deeper in itertools.pairwise(levels))


def test_phones_get_a_drawing_of_their_own() -> None:
    page = Page(page_of("converged"))
    sources, images = page.all("source"), page.all("img")
    assert len(sources) == len(images)
    for source, image in zip(sources, images, strict=True):
        assert "max-width" in source["media"] and int(source["width"]) < 340 < int(image["width"])


MODEL = """
title = '''{hostile}'''
description = '''{hostile} described'''
forward = "friction"
[data]
file = "data.csv"
observable = "friction_coefficient"
[surface]
name = "paper_reference"
[parameters]
young_modulus_bulk = {{ fixed = "20 kPa", source = '''{hostile} fixed''' }}
layer_thickness = "173 um"
young_modulus_layer = "7 MPa"
frictional_shear_stress = {{ lognormal = ["10 MPa", 1.0], source = '''{hostile} prior''' }}
[noise]
family = "lognormal"
noise_scale = 0.2
[derived.made_up]
product = {{ frictional_shear_stress = 2 }}
symbol = '''{symbol}'''
meaning = '''{hostile} meant'''
"""


def hostile_run(folder: Path) -> Path:
    rows = [f'"{HOSTILE.replace(chr(34), chr(34) * 2)} {i}",{0.7 + 0.1 * i},0.5,0.0003' for i in range(3)]
    header = "person,friction_coefficient [1],normal_force [N],nominal_contact_area [m^2]"
    (folder / "data.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    model = folder / "model.toml"
    model.write_text(MODEL.format(hostile=HOSTILE.replace("'", "`"), symbol="<b>$x_1$</b>"), encoding="utf-8")
    sample(load_problem(model), directory=folder / "run", **BRIEFLY)
    return folder / "run"


def test_everything_from_files_is_escaped(tmp_path: Path) -> None:
    fit = load_fit(hostile_run(tmp_path))
    assert fit.problem is not None
    text = write_report(fit, tmp_path / "page.html").read_text(encoding="utf-8")
    page = Page(text)
    assert not page.all("script") and len(page.all("img")) == 5
    assert not [a for _, a in page.elements if any(name.startswith("on") for name in a)]
    shown = escape(HOSTILE.replace("'", "`"), quote=False)
    for ending in ("", " described", " fixed", " prior", " meant"):
        # Jinja and the standard library write quotes differently
        assert f"{shown}{ending}" in text.replace("&#34;", '"').replace("&quot;", '"').replace("&#39;", "'")
    assert "No provenance was given" in page.text


def test_page_of_a_run_directory_and_of_a_bare_file_agree(tmp_path: Path) -> None:
    sample(load_problem("finger-water"), directory=tmp_path / "run", **BRIEFLY)
    moved = tmp_path / "elsewhere.nc"
    moved.write_bytes((tmp_path / "run" / "result.nc").read_bytes())
    pages = [
        Page(write_report(load_fit(source), tmp_path / f"{i}.html").read_text(encoding="utf-8"))
        for i, source in enumerate((tmp_path / "run", moved))
    ]
    assert words(pages[0].text) == words(pages[1].text)
    # data against the load come first, and eleven rows are enough for residuals against it
    assert pages[1].all("figure")[0]["id"] == "data"
    assert len(pages[1].all("img")) == 7


def test_page_of_a_fit_whose_model_is_gone(tmp_path: Path) -> None:
    fit = replace(short_fit(), problem=None)
    page = Page(write_report(fit, tmp_path / "page.html").read_text(encoding="utf-8"))
    assert len(page.all("img")) == 4
    assert "gone" in page.text
    for label in fit.names:
        assert spoken_name(label) in words(page.text)


def test_page_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "page.html"
    target.write_text("as it was", encoding="utf-8")
    with monkeypatch.context() as patch:
        patch.setattr(
            Path, "replace", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device"))
        )
        patch.setattr("skinbayes.report.page.render", lambda *_: "new")
        with pytest.raises(MachineError, match=r"page\.html: cannot be written"):
            write_report(short_fit(), target)
    assert target.read_text(encoding="utf-8") == "as it was"
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]
    monkeypatch.setattr("skinbayes.report.page.render", lambda *_: "new")
    assert write_report(short_fit(), target) == target
    assert target.read_text(encoding="utf-8") == "new"
    with pytest.raises(InputError, match="cannot be written"):
        write_report(short_fit(), tmp_path / "missing" / "page.html")
