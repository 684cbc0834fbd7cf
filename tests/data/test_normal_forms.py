"""A label is one label in all Unicode normal forms: in data, model files, --set and provenance."""

from __future__ import annotations

import unicodedata
from itertools import product
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files.provenance import load_provenance
from skinbayes.problem import load_problem

MODEL = """
title = "José"
forward = "friction"
[data]
file = "mine.csv"
observable = "friction_coefficient"
rows = { person = ["José", "Zoë"] }
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = { loguniform = ["0.5 MPa", "500 MPa"] }
young_modulus_bulk = "20 kPa"
yield_stress = "inf Pa"
layer_thickness = "20 um"
[parameters.young_modulus_layer]
by = "person"
"José" = "7 MPa"
"Zoë" = "8 MPa"
[noise]
family = "lognormal"
noise_scale = 0.1
"""
DATA = "person,nominal_pressure [kPa],friction_coefficient [1]\nJosé,5,0.5\nZoë,5,0.6\nAnn,5,0.7\n"


@pytest.mark.parametrize(("in_model", "in_data", "in_setting"), [*product(("NFC", "NFD"), repeat=3)])
def test_every_mixture_of_forms(in_model: str, in_data: str, in_setting: str, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(unicodedata.normalize(in_model, MODEL), encoding="utf-8")
    (tmp_path / "mine.csv").write_text(unicodedata.normalize(in_data, DATA), encoding="utf-8")
    setting = unicodedata.normalize(in_setting, "young_modulus_layer[José]")
    problem = load_problem(tmp_path / "mine.toml", settings={setting: "9 MPa"})
    assert problem.conditions.n_rows == 2 and problem.conditions.labels["person"].tolist() == ["José", "Zoë"]
    assert problem.inputs(problem.prior_medians()[None])["young_modulus_layer"].tolist() == [[9e6, 8e6]]


def test_the_line_of_a_key_in_another_form(tmp_path: Path) -> None:
    text = unicodedata.normalize("NFD", MODEL.replace('"7 MPa"', '"7 m"'))
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"line 17: parameters\.young_modulus_layer\.José"):
        load_problem(tmp_path / "mine.toml")


def test_provenance(tmp_path: Path) -> None:
    text = f'''title = "José"
authors = "Zoë"
licence = "x"
kind = "measurements"
where = "x"
how_read = "x"
transformation = "x"
spread = "x"
sha256 = "{"0" * 64}"
'''
    path = tmp_path / "provenance.toml"
    path.write_text(unicodedata.normalize("NFD", text), encoding="utf-8")
    found = load_provenance(path)
    assert (found.title, found.authors) == ("José", ["Zoë"])
