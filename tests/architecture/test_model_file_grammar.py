"""docs/model-files.md and the code know the same words: keys, priors, noise families, surfaces, forward models."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from pydantic import BaseModel
from source_tree import ROOT

import skinbayes as sb
from skinbayes.files import modelschema
from skinbayes.files.noise_block import noise_parameter_names
from skinbayes.forward import forward_models
from skinbayes.roughness import surfaces
from skinbayes.statistics import FAMILIES, NOISE_FAMILIES
from skinbayes.vocabulary import LABELS, QUANTITIES

PAGE = (ROOT / "docs" / "model-files.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def section(title: str) -> str:
    """The text below a heading, up to the next one."""
    match = re.search(rf"^##+ {re.escape(title)}\n(.*?)(?=^##|\Z)", PAGE, re.MULTILINE | re.DOTALL)
    assert match is not None, f"no section '{title}'"
    return match[1]


def first_column(title: str, table: int = 0) -> list[list[str]]:
    """Cells of the rows of a table in a section."""
    tables = re.findall(r"(?:^\|.*\n)+", section(title), re.MULTILINE)
    return [
        [cell.strip() for cell in row.strip().strip("|").split(" | ")]
        for row in tables[table].splitlines()[2:]
    ]


def names(title: str, table: int = 0) -> list[str]:
    return [row[0].strip("`| ") for row in first_column(title, table)]


SECTION_OF = {
    modelschema.ModelBlock: "Top level",
    modelschema.DataBlock: "`[data]`",
    modelschema.SurfaceBlock: "`[surface]`",
    modelschema.DerivedBlock: "`[derived.NAME]`",
    modelschema.GridBlock: "`[conditions]`",
    modelschema.GroupBlock: "`[groups.COLUMN]`",
    modelschema.DiscrepancyBlock: "`[discrepancy]`",
    modelschema.CorrelationBlock: "`[noise.correlation]`",
    modelschema.CovariateBlock: "`[covariates.NAME]`",
    modelschema.RheologyBlock: "`[rheology]`",
}


@pytest.mark.parametrize("block", SECTION_OF)
def test_keys(block: type[BaseModel]) -> None:
    assert sorted(names(SECTION_OF[block])) == sorted(block.model_fields)


def test_every_block_of_the_grammar_is_above() -> None:
    several = {"ExperimentBlock", "JointBlock"}  # of docs/several-experiments.md
    found = {name for name in vars(modelschema) if name.endswith("Block")}
    assert found - several == {b.__name__ for b in SECTION_OF}


def test_priors() -> None:
    rows = first_column("Priors")
    assert [row[0].strip("`") for row in rows] == list(FAMILIES)
    for name, written, units, meaning in rows:
        family = FAMILIES[name.strip("`")]
        assert written == f"`{family.signature()}`"
        assert units == ", ".join(argument.kind for argument in family.arguments)
        assert meaning == family.description


def test_noise() -> None:
    assert sorted(names("`[noise]`")) == sorted(["family", "correlation", *noise_parameter_names()])
    rows = first_column("`[noise]`", 1)
    assert [row[0].strip("`") for row in rows] == list(NOISE_FAMILIES)
    for name, _, _, unit in rows:
        assert (unit == "none") == NOISE_FAMILIES[name.strip("`")].relative


def test_surfaces() -> None:
    assert names("`[surface]`", 1) == list(surfaces.SURFACES)


def test_forward_models() -> None:
    rows = {row[0].strip("`"): row for row in first_column("Forward models")}
    models = forward_models()
    assert set(rows) == set(models)
    text = section("Forward models")
    for name, model in models.items():
        assert re.findall(r"`(\w+)`", rows[name][1]) == list(model.observables)
        for required in (*model.required_names(), *model.optional, *model.accepted):
            assert f"`{required}`" in text, f"{name}: {required} is not mentioned"


def test_every_word_in_code_is_a_word_of_the_vocabulary_or_the_grammar() -> None:
    known = {
        *QUANTITIES,
        *LABELS,
        *FAMILIES,
        *NOISE_FAMILIES,
        *surfaces.SURFACES,
        *noise_parameter_names(),
        *forward_models(),
        *(option for model in forward_models().values() for option in model.options),
    }
    for block in SECTION_OF:
        known |= set(block.model_fields)
    known |= {
        "by",
        "correlation",
        "family",
        "fixed",
        "same_as",
        "times",
        "source",
        "models",
        "check",
        "prior",
        "fit",
        "predict",
        "normal",
        "person_effect",
        "population",
        "contrast",
        "effect",
    }
    words = set(re.findall(r"`([a-z][a-z_-]+)`", PAGE))
    assert words <= known, sorted(words - known)


@pytest.mark.parametrize("block", BLOCKS)
def test_examples_are_toml(block: str) -> None:
    assert tomllib.loads(block)


def test_the_first_example_is_a_model_with_its_data(tmp_path: Path) -> None:
    (tmp_path / "my-model.toml").write_text(BLOCKS[0], encoding="utf-8")
    table = re.search(r"^```\n(body_site.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert table is not None
    (tmp_path / "mine.csv").write_text(table[1], encoding="utf-8")
    problem = sb.load_problem(tmp_path / "my-model.toml")
    assert problem.names == ("frictional_shear_stress", "young_modulus_layer", "noise_scale")
    assert problem.conditions.n_rows == 2


@pytest.mark.parametrize("block", [block for block in BLOCKS if "title" not in tomllib.loads(block)])
def test_other_examples_fit_into_a_model(block: str, tmp_path: Path) -> None:
    base = """
title = "Around an example"
forward = "FORWARD"
surface = { name = "paper_reference" }
DATA
[parameters]
frictional_shear_stress = "15 MPa"
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
"""
    data = """
data = { dataset = "adams2007-forearm-glass", observable = "friction_coefficient" }
noise = { family = "lognormal", noise_scale = 0.1 }
"""
    example = tomllib.loads(block)
    if "data" in example:  # has its own test below
        return
    if "groups" in example or "covariates" in example or "population" in block:
        data = data.replace("adams2007-forearm-glass", "fehlberg2025-finger-stribeck")
    if "discrepancy" in example or "noise" in example:
        rows = [f"{i},{0.01 * 2.0**i},8,0.{3 + i % 2}" for i in range(9)]
        header = "time [s],normal_force [N],sphere_radius [mm],friction_coefficient [1]"
        (tmp_path / "mine.csv").write_text("\n".join([header, *rows]), encoding="utf-8")
        data = 'data = { file = "mine.csv", observable = "friction_coefficient" }'
        block = '[noise]\nfamily = "lognormal"\nnoise_scale = 0.1\n' + block
    grid = "conditions" in example
    text = base.replace("FORWARD", "contact-area" if grid else "friction").replace(
        "DATA", "" if grid else data
    )
    given = example.get("parameters", {})
    lines = [line for line in text.splitlines() if line.partition(" =")[0] not in given]
    if grid:
        lines = [line for line in lines if not line.startswith("frictional")] + ['nominal_pressure = "7 kPa"']
    if "derived" in example:
        lines.append('yield_stress = "50 MPa"')
    added = block.replace("[parameters]\n", "")
    (tmp_path / "example.toml").write_text("\n".join(lines) + "\n" + added, encoding="utf-8")
    problem = sb.load_problem(tmp_path / "example.toml")
    assert len(problem.predict(problem.prior_medians())) > 0


def test_the_example_of_several_observables(tmp_path: Path) -> None:
    (block,) = [block for block in BLOCKS if "observables" in block]
    (tmp_path / "summary.csv").write_text(
        "wet_plateau [1],wet_plateau_standard_deviation [1],peak_width [s],peak_width_standard_deviation [s]\n"
        "1.3,0.1,80,20\n",
        encoding="utf-8",
    )
    model = (ROOT / "models" / "drying.toml").read_text(encoding="utf-8")
    model = model.partition("[conditions]")[0].replace('forward = "drying"', 'forward = "drying-features"')
    (tmp_path / "example.toml").write_text(model + block, encoding="utf-8")
    problem = sb.load_problem(tmp_path / "example.toml")
    assert problem.names == ("noise_scale[peak_width]",)
    assert problem.observables == ("wet_plateau", "peak_width")
    assert problem.predict_data(problem.prior_medians()).shape == (2,)
    assert sb.load_problem(tmp_path / "example.toml").log_likelihood([0.3]) < 0
