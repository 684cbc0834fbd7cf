"""``table``: tables of a run for a paper."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from skinbayes.cli.new_file import format_of, refuse_existing, write_text
from skinbayes.cli.options import json_option, overwrite_option
from skinbayes.cli.output import print_json, say

SUFFIXES = {".csv": "csv", ".tex": "latex", ".md": "markdown"}


@click.command()
@click.argument("run")
@click.argument("name", default="parameters", metavar="[parameters|derived|fixed|predictions]")
@click.option(
    "--format",
    "form",
    metavar="csv|latex|markdown",
    help="How it is written.  [default: as -o says, else markdown]",
)
@click.option("-o", "--output", metavar="FILE", help="Write it to a file instead of printing it.")
@overwrite_option
@json_option
def table(run: str, name: str, form: str | None, output: str | None, overwrite: bool, as_json: bool) -> None:
    """Print a table of a run for a paper.

    Parameters with their priors, medians and 90 % intervals.

    'derived' has the quantities that follow from the parameters, 'fixed' what was not inferred, 'predictions' each datum beside
    its prediction. Of several experiments these are named EXPERIMENT.derived and EXPERIMENT.predictions.

    Markdown and LaTeX have rounded numbers in units that suit them, CSV has SI without rounding. The LaTeX needs booktabs only.
    """
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.report.paper_tables import FORMATS, chosen_table

    form = format_of(form, output, FORMATS, SUFFIXES, "markdown")
    if output is not None:
        refuse_existing([Path(output)], overwrite)
    fit = load_any_fit(run)
    made = chosen_table(fit, name)
    if output is not None:
        write_text(Path(output), made.text(form))
        say(f"{name}: {output}", err=as_json)
    if as_json:
        rows: list[dict[str, Any]] = [dict(zip(made.columns, row, strict=True)) for row in made.values]
        print_json({"run": run, "table": name, "converged": fit.converged, "rows": rows})
    elif output is None:
        say(made.text(form).rstrip("\n"))
    if made.note and form == "csv" and not as_json:
        say(f"skinbayes: {made.note}", err=True)
