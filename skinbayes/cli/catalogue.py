"""``models``, ``datasets`` and ``show``: what is shipped, and one thing in full."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.options import json_option
from skinbayes.cli.output import print_json, print_sentences, print_table, print_text, say
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.files.provenance import Provenance
    from skinbayes.files.table import CsvTable
    from skinbayes.problem.bound import BoundModel


@click.command()
@json_option
def models(as_json: bool) -> None:
    """List the shipped models."""
    from skinbayes.files.locate import shipped_names
    from skinbayes.files.modelfile import load_model

    specs = [load_model(name) for name in shipped_names("models")]
    if as_json:
        keys = ("name", "title", "forward", "dataset")
        print_json({"models": [{key: getattr(spec, key) for key in keys} for spec in specs]})
        return
    rows = [
        (s.name, "shipped" if s.dataset else "yours" if s.observables else "none", s.title) for s in specs
    ]
    print_table(("model", "data", "title"), rows)
    print_text("data: shipped with the model; yours, with --data; or none, so that the model only predicts")


@click.command()
@json_option
def datasets(as_json: bool) -> None:
    """List the shipped data sets."""
    from skinbayes.files.locate import shipped_names

    found = [(name, *_read(name)) for name in shipped_names("datasets")]
    if as_json:
        print_json({"datasets": [
            {"name": name, "title": p.title, "kind": p.kind, "rows": len(table.rows), "doi": p.doi, "licence": p.licence}
            for name, p, table in found if p
        ]})  # fmt: skip
        return
    rows = [(name, p.kind, str(len(table.rows)), p.title) for name, p, table in found if p]
    print_table(("data set", "kind", "rows", "title"), rows, right=(2,))


@click.command()
@click.argument("name")
@json_option
def show(name: str, as_json: bool) -> None:
    """Show a model or a data set, with its sources."""
    from skinbayes.files.locate import shipped_names

    is_model = name in shipped_names("models") or name.endswith(".toml")
    is_data = name in shipped_names("datasets") or name.endswith(".csv")
    if not is_model and not is_data:
        from skinbayes.vocabulary import suggestions

        known = [*shipped_names("models"), *shipped_names("datasets")]
        raise InputError(
            f"no model or data set {name[:200]!r}.{suggestions(name[:80], known)} See 'skinbayes models' and 'skinbayes datasets'"
        )
    (_show_model if is_model else _show_dataset)(name, as_json)


def _show_model(name: str, as_json: bool) -> None:
    from skinbayes.problem.joint import JointProblem
    from skinbayes.problem.load import load_any_problem
    from skinbayes.units import format_quantity

    problem = load_any_problem(name)
    parameters = [
        {
            "name": p.label,
            "unit": p.unit,
            "prior": p.prior_text if p.prior else None,
            "fixed": p.value,
            **({"tied": p.prior_text} if p.same_as else {}),
            "source": p.source,
        }
        for p in problem.parameters
    ]
    about = {"model": problem.spec.name, "title": problem.spec.title, "description": problem.spec.description}
    several = isinstance(problem, JointProblem)
    told = {experiment: _told(part) for experiment, (part, _) in problem.parts.items()}
    if as_json:
        more = {"experiments": told} if several else told[""]
        print_json({**about, **more, "parameters": parameters})
        return
    print_text(problem.spec.title, "", *_paragraphs(problem.spec.description), "")
    from skinbayes.files.population_block import DEVIATE

    for experiment, (part, _) in problem.parts.items():
        if several:
            print_text(f"experiment:    {experiment}")
        _print_experiment(part)
    rows = [
        (
            p.label,
            p.prior_text
            if p.value is None
            else f"= {format_quantity(p.value, p.unit, written=p.prior_text)}",
            p.source,
        )
        for p in problem.parameters
        if p.name != DEVIATE
    ]
    print_table(("parameter", "prior or value", "source"), rows)


def _told(problem: BoundModel) -> dict[str, Any]:
    from skinbayes.problem.surface_numbers import surface_numbers

    spec = problem.spec
    file = spec.surface_file or spec.surface_posterior
    return {
        "forward": spec.forward, "options": dict(problem.forward.chosen), "dataset": spec.dataset,
        "rows": spec.rows, "observables": spec.observables,
        "noise": spec.noise, "surface": spec.surface_name or (str(file) if file else None),
        "surface_numbers": surface_numbers(problem, problem.prior_medians()),
    }  # fmt: skip


def _print_experiment(problem: BoundModel) -> None:
    from skinbayes.problem.surface_numbers import surface_words

    spec = problem.spec
    print_text(f"forward model: {spec.forward} – {problem.forward.summary}")
    for option, value in problem.forward.chosen.items():
        print_text(f"option:        {option} = {value} ({' or '.join(problem.forward.options[option])})")
    print_text(
        f"data set:      {spec.dataset or ('yours, with --data' if spec.observables else 'none (predict only)')}"
        + (f", rows {spec.rows}" if spec.rows else "")
    )
    for observable, noise in spec.noise.items():
        print_text(f"observable:    {observable}, noise {noise}")
    if spec.rheology:
        print_text(f"flow curves:   {spec.rheology}, by {spec.rheology_by}")
    if words := surface_words(problem, problem.prior_medians()):
        print_text(f"surface:       {words}.")
    for one in spec.populations:
        print_text(f"population:    {one.name}, by {', '.join(one.columns)}")
    for covariate in spec.covariates:
        print_text(f"covariate:     {covariate.column} acts on {covariate.acts_on} as a power")


def _paragraphs(text: str) -> list[str]:
    """Text of a model file without the line breaks inside its paragraphs: the terminal has a width of its own."""
    paragraphs = [" ".join(lines.split()) for lines in re.split(r"\n\s*\n", text)]
    return [line for paragraph in paragraphs for line in (paragraph, "")][:-1]


def _show_dataset(name: str, as_json: bool) -> None:
    from skinbayes.files.provenance import TEXTS

    provenance, table = _read(name)
    if as_json:
        described = None if provenance is None else provenance.model_dump()
        print_json({"dataset": name, "provenance": described, "columns": table.header, "rows": table.rows})
        return
    if provenance is not None:
        print_text(provenance.title, ", ".join(provenance.authors), "")
        for label in ("doi", *TEXTS):
            if value := getattr(provenance, label):
                text = ", ".join(value) if isinstance(value, list) else value
                print_text(f"{label.replace('_', ' ') + ':':16}{text}")
        if provenance.caveats:
            say()
            print_sentences(provenance.caveats, "Caveats")
    print_table(table.header, table.rows)


def _read(name: str) -> tuple[Provenance | None, CsvTable]:
    from skinbayes.files.find_dataset import find_dataset
    from skinbayes.files.provenance import load_provenance
    from skinbayes.files.table import read_table

    _, path, described_in = find_dataset(name)
    return (None if described_in is None else load_provenance(described_in)), read_table(path)
