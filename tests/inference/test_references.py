"""What a fit asks to be cited: the theory that entered, the data, the methods and the software; as text and as BibTeX."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import skinbayes
from skinbayes.errors import InputError
from skinbayes.fit import load_fit, sample
from skinbayes.fit.bibliography import Reference
from skinbayes.fit.references import references
from skinbayes.problem import load_problem

BRIEFLY = {"max_steps": 100, "ensembles": 2, "walkers": 32}
YANG_PERSSON = "10.1088/0953-8984/20/21/215214"
ELASTOPLASTIC = "10.1103/PhysRevLett.87.116101"
CAPILLARY = "10.1088/0953-8984/20/31/315007"
STRIBECK = "10.1088/0953-8984/21/18/185002"
EMCEE = "10.1086/670067"


def cited(name: str | Path) -> set[str]:
    return {doi for reference in references(load_problem(name)) for doi in reference.doi}


@pytest.mark.parametrize(
    ("model", "used", "unused"),
    [
        ("forearm-glass", {YANG_PERSSON, ELASTOPLASTIC}, {CAPILLARY, STRIBECK}),
        ("finger-water", {YANG_PERSSON}, {ELASTOPLASTIC, CAPILLARY, STRIBECK}),
        ("drying-glass", {YANG_PERSSON, CAPILLARY}, {STRIBECK}),
        ("finger-stribeck", {YANG_PERSSON, STRIBECK}, {CAPILLARY, ELASTOPLASTIC}),
        ("finger-null", set(), {YANG_PERSSON, ELASTOPLASTIC, CAPILLARY, STRIBECK, "10.1063/1.1388626"}),
    ],
)
def test_the_theory_that_entered_is_cited_and_no_other(model: str, used: set[str], unused: set[str]) -> None:
    found = cited(model)
    assert used <= found and not unused & found
    assert EMCEE in found
    assert "skinbayes" in [reference.key for reference in references(load_problem(model))]


def test_plain_theory_does_not_cite_the_correction(tmp_path: Path) -> None:
    text = load_problem("finger-water").spec.text
    plain = tmp_path / "plain.toml"
    plain.write_text(
        text.replace("[noise]", '[parameters.area_correction]\nfixed = 1\nsource = "plain"\n[noise]'),
        encoding="utf-8",
    )
    assert YANG_PERSSON not in cited(plain) and YANG_PERSSON in cited("finger-water")


def test_text_and_bibtex_survive_a_file(tmp_path: Path) -> None:
    fit = sample(load_problem("finger-water"), directory=tmp_path / "run", **BRIEFLY)
    again = load_fit(tmp_path / "run")
    text, entries = again.cite(), again.cite("bibtex")
    assert text == fit.cite() and entries == fit.cite("bibtex") and len(text) == len(entries)
    assert any("10.1007/s11249-025-02024-w" in line and "(data)" in line for line in text)
    assert f"version {skinbayes.__version__} (this software)" in text[-1]
    keys = [re.match(r"@(article|software|misc)\{([\w-]+),\n", entry)[2] for entry in entries]  # type: ignore[index]
    assert len(set(keys)) == len(keys)
    for entry in entries:
        assert entry.count("{") == entry.count("}") and "author = " in entry and "title = " in entry
        assert entry.startswith("@article") == ("journal = " in entry)
    assert "author = {Persson, B. N. J. and Kovalev, A. and Gorb, S. N.}" in "\n".join(entries)
    assert "author = {ter Braak, C. J. F.}" in "\n".join(entries)
    with pytest.raises(InputError, match="expected 'text' or 'bibtex'"):
        fit.cite("ris")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "hostile", ["}, evil = {x", "a\\input{b}", "50 % & more_than $5 #1 ~^", "line\nbreak"]
)
def test_any_text_can_stand_in_bibtex(hostile: str) -> None:
    entry = Reference("data", (hostile,), hostile, "data", doi=("10.1/" + hostile,)).bibtex()
    bare = re.sub(r"\\[&%$#_{}]|\\text\w+\{\}", "", entry)
    assert bare.count("{") == bare.count("}")
    assert re.findall(r"^  (\w+) = ", entry, re.MULTILINE) == ["author", "title", "doi", "note"]
    fields = re.findall(r"^  (?:author|title) = \{(.*)\},$", bare, re.MULTILINE)
    assert len(fields) == 2 and not re.search(r"[%&$#\\]", "".join(fields))
