"""``new``: a shipped model as a file of the user's own."""

from __future__ import annotations

from pathlib import Path

import click

from skinbayes.atomic import write_atomically
from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, model_argument, overwrite_option
from skinbayes.cli.output import print_json, say
from skinbayes.errors import InputError


@click.command()
@model_argument
@click.option("-o", "--output", metavar="FILE.toml", required=True, help="Model file to write.")
@click.option("--data", metavar="FILE.csv", help="Your own data, which the copy explains.")
@overwrite_option
@json_option
def new(model: str, output: str, data: str | None, overwrite: bool, as_json: bool) -> None:
    """Copy a shipped model into a file of your own, to be changed."""
    from skinbayes.files.model_copy import copy_model
    from skinbayes.files.modelfile import load_model

    target = Path(output)
    if target.suffix != ".toml":
        raise InputError(f"--output: found {output[:80]!r}; expected a file that ends in .toml")
    refuse_existing([target], overwrite)
    copy = copy_model(model, target, data)
    before = target.read_bytes() if target.exists() else None
    write_text(target, copy.text)
    try:
        spec = load_model(target)
    except InputError:  # such as a file called as one of its baseline models
        target.unlink() if before is None else write_atomically(target, before)
        raise
    if as_json:
        print_json({"model": model, "file": output, "data": data, "changes": list(copy.changes)})
        return
    say(f"model: {output}")
    for change in copy.changes:
        say(f"- {change}", err=True)
    if data is None and spec.observables:
        csv = target.with_suffix(".csv").name
        say(
            f"Next: write your data under the header that 'skinbayes template {output}' prints, and name the file under [data], "
            f'file = "{csv}", instead of a dataset.',
            err=True,
        )
    say(f"Next: change in {output} what you know better, and why; then: skinbayes check {output}", err=True)
