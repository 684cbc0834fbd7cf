"""``template``: the header of a CSV for a model."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, model_argument, overwrite_option
from skinbayes.cli.output import print_json, say

if TYPE_CHECKING:
    from skinbayes.problem.template import DataTemplate


@click.command()
@model_argument
@click.option("-o", "--output", metavar="FILE.csv", help="CSV to write; without it the header is printed.")
@overwrite_option
@json_option
def template(model: str, output: str | None, overwrite: bool, as_json: bool) -> None:
    """Write the header of a CSV that the data of a model need.

    It has no rows. A model of several experiments has one CSV for each, FILE-EXPERIMENT.csv. What each column means is said on
    standard error.
    """
    from skinbayes.files.joint_model import is_joint
    from skinbayes.problem.template import data_template, joint_templates

    if is_joint(model):
        each = joint_templates(model)
        files = {name: output and str(Path(output).with_stem(f"{Path(output).stem}-{name}")) for name in each}
    else:
        each, files = {"": data_template(model)}, {"": output}
    if output is not None:
        refuse_existing([Path(file) for file in files.values() if file], overwrite)
        for name, file in files.items():
            write_text(Path(str(file)), f"{each[name].header}\n")
    if as_json:
        documents = {name: _document(found, files[name]) for name, found in each.items()}
        print_json(documents.get("", {"experiments": documents}))
        return
    for name, found in each.items():
        about = f"{name}: " if name else ""
        say(about + (found.header if output is None else f"template: {files[name]}"))
        for column in found.columns:
            say(f"- {column.header}: {column.meaning} ({column.why})", err=True)
        for note in found.notes:
            say(note, err=True)


def _document(found: DataTemplate, file: str | None) -> dict[str, Any]:
    columns = [asdict(column) for column in found.columns]
    return {
        "model": found.model, "file": file, "header": found.header, "columns": columns, "notes": list(found.notes),
    }  # fmt: skip
