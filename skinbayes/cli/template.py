"""``template``: the header of a CSV for a model."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import click

from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, model_argument, overwrite_option
from skinbayes.cli.output import print_json, say


@click.command()
@model_argument
@click.option("-o", "--output", metavar="FILE.csv", help="CSV to write; without it the header is printed.")
@overwrite_option
@json_option
def template(model: str, output: str | None, overwrite: bool, as_json: bool) -> None:
    """Write the header of a CSV that the data of a model need.

    It has no rows. What each column means is said on standard error.
    """
    from skinbayes.problem.template import data_template

    found = data_template(model)
    if output is not None:
        refuse_existing([Path(output)], overwrite)
        write_text(Path(output), f"{found.header}\n")
    if as_json:
        columns = [asdict(column) for column in found.columns]
        print_json({
            "model": found.model, "file": output, "header": found.header, "columns": columns, "notes": list(found.notes),
        })  # fmt: skip
        return
    say(found.header if output is None else f"template: {output}")
    for column in found.columns:
        say(f"- {column.header}: {column.meaning} ({column.why})", err=True)
    for note in found.notes:
        say(note, err=True)
