"""Every shipped model loads, speaks the vocabulary and says where its numbers come from."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np
import pytest
from source_tree import ROOT

import skinbayes as sb
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.modelfile import load_model
from skinbayes.files.noise_block import noise_parameter_names
from skinbayes.files.provenance import load_provenance
from skinbayes.forward import forward_models
from skinbayes.vocabulary import LABELS, QUANTITIES

MODELS = shipped_names("models")
DATASETS = shipped_names("datasets")
TESTS = {path.name: path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py")}


def raw(name: str) -> dict[str, Any]:
    return tomllib.loads((shipped_folder("models") / f"{name}.toml").read_text(encoding="utf-8"))


def test_the_models_of_this_version() -> None:
    assert {"contact-area", "finger-water", "forearm-glass", "forearm-glass-separate"} <= set(MODELS)


def slow_where_a_table_is_built(names: list[str] | tuple[str, ...]) -> list[object]:
    """Half a minute for the table of films; that such models load and evaluate is also held by their own fast tests."""
    return [pytest.param(n, marks=pytest.mark.slow) if n.startswith("finger-stribeck") else n for n in names]


@pytest.mark.parametrize("name", slow_where_a_table_is_built(MODELS))
def test_it_loads_and_predicts(name: str) -> None:
    problem = sb.load_problem(name)
    prediction = problem.predict(problem.prior_medians())
    assert set(prediction) == set(problem.forward.observables)
    for observable, values in prediction.items():
        endless = QUANTITIES[observable].infinite_allowed & (values == np.inf)
        assert (np.isfinite(values) | endless).all() and (values >= 0).all(), observable
    assert (prediction[problem.forward.observables[0]] > 0).all()


@pytest.mark.parametrize("name", MODELS)
def test_its_text_explains_it(name: str) -> None:
    spec = load_model(name)
    assert spec.title
    assert len(spec.description.split()) > 20


@pytest.mark.parametrize("name", MODELS)
def test_its_names_are_words_of_the_vocabulary(name: str) -> None:
    content = raw(name)
    assert set(content["parameters"]) <= set(QUANTITIES)
    assert set(content.get("conditions", {})) <= {*QUANTITIES, *LABELS}
    noise, several = content.get("noise", {}), content.get("data", {}).get("observables")
    assert several is None or set(noise) == set(several)
    for block in noise.values() if several else [noise]:
        assert set(block) <= {"family", *noise_parameter_names()}
    for entry in content["parameters"].values():
        assert not isinstance(entry, dict) or entry.get("by", "state") in LABELS
    derived = {n for model in forward_models().values() for n in model.derived_names}
    for block in content.get("derived", {}).values():
        assert {factor.partition("[")[0] for factor in block["product"]} <= set(QUANTITIES) | derived


@pytest.mark.parametrize("name", MODELS)
def test_every_number_has_a_source(name: str) -> None:
    spec = load_model(name)
    bare = [p.label for p in (*spec.parameters, *spec.noise_parameters) if len(p.source.split()) < 3]
    assert not bare


@pytest.mark.parametrize("name", MODELS)
def test_it_is_tested(name: str) -> None:
    own = "test_shipped_models.py"
    assert [file for file, text in TESTS.items() if f'"{name}"' in text and file != own], (
        f"no test runs '{name}'"
    )


@pytest.mark.parametrize("name", DATASETS)
def test_every_data_set_says_where_it_comes_from(name: str) -> None:
    provenance = load_provenance(shipped_folder("datasets") / name / "provenance.toml")
    assert provenance.licence
    assert len(provenance.where.split()) > 2


def test_every_forward_model_has_a_model_file() -> None:
    used = {load_model(name).forward for name in MODELS}
    assert used == set(forward_models())


def test_inputs_and_observables_of_forward_models_are_words_of_the_vocabulary() -> None:
    for model in forward_models().values():
        names = {*model.input_names(), *model.observables, *model.derived_names}
        assert names <= set(QUANTITIES), f"{model.name}: {sorted(names - set(QUANTITIES))}"
