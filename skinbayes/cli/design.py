"""``design``: which further rows would tell most."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from skinbayes.cli.new_file import refuse_existing
from skinbayes.cli.options import json_option, number_option, overwrite_option
from skinbayes.cli.output import MOST_ROWS, print_json, print_sentences, print_table, quantity_text, say
from skinbayes.defaults import SEED
from skinbayes.errors import InputError

if TYPE_CHECKING:
    import pandas

    from skinbayes.fit import Fit

PRIOR_DRAWS = 6000
"""Draws of the prior that stand for what is known before any data."""


@click.command()
@click.argument("run_or_model")
@click.option(
    "--candidates",
    required=True,
    metavar="FILE.csv",
    help="Rows that could be measured, with a unit in each header.",
)
@click.option(
    "--parameter",
    "parameters",
    multiple=True,
    metavar="NAME",
    help="Ask about this parameter alone; up to three. All if absent.",
)
@click.option("--against", metavar="RUN", help="Ask which of two models of the same quantity is right.")
@number_option("--rows", 1, 1, "How many rows to choose, each the best beside those before it.")
@click.option("--cost", metavar="COLUMN", help="Column of the candidates with the cost of a row.")
@number_option("--seed", SEED, 0, "The same seed gives the same answer.")
@click.option("-o", "--output", metavar="FILE.svg", help="Draw the candidates (svg, pdf or png).")
@overwrite_option
@json_option
def design(
    run_or_model: str,
    candidates: str,
    parameters: tuple[str, ...],
    against: str | None,
    rows: int,
    cost: str | None,
    seed: int,
    output: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Say which further rows would tell most.

    Of a RUN, beside the data that it has; of a MODEL before any data, from its priors.
    """
    from skinbayes.cli.progress import counted_progress

    if output is not None:
        refuse_existing([Path(output)], overwrite)
        if Path(output).suffix not in (".svg", ".pdf", ".png"):
            raise InputError(f"{output}: expected a name that ends in .svg, .pdf or .png")
    fit = _fit(run_or_model)
    with counted_progress("table") as progress:
        found = fit.design(
            candidates, parameters, None if against is None else _fit(against), rows, cost, seed, progress
        )
    table = found.to_frame()
    if output is not None:
        from skinbayes.plot.design import plot_design

        plot_design(found).savefig(output)
    if as_json:
        listed = [
            {
                "row": int(row),
                "information": float(found.information[row - 1]),
                "information_se": float(found.errors[row - 1]),
            }
            for row in table.index
        ]
        chosen = [
            {"row": one.row + 1, "information": one.information, "information_se": one.error}
            for one in found.chosen
        ]
        print_json(
            {
                "run": run_or_model,
                "about": found.about,
                "candidates": listed,
                "chosen": chosen,
                "sentence": found.sentence(),
            }
        )
    else:
        _print(table, found.sentence())
    if output is not None:
        say(f"figure: {output}", err=as_json)


def _fit(name: str) -> Fit:
    """The fit of a run, or the prior of a model."""
    import numpy as np

    from skinbayes.cli.runs import is_run
    from skinbayes.fit import Fit
    from skinbayes.fit.storage import load_fit
    from skinbayes.problem.load import load_problem

    if is_run(name):
        return load_fit(name)
    problem = load_problem(name)
    say(f"note: {name} is a model: what is known is its prior, without its data", err=True)
    return Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(SEED), PRIOR_DRAWS))


def _print(table: pandas.DataFrame, sentence: str) -> None:
    headers = ["row", *(str(name) for name in table.columns[:-2]), "information", "±"]
    cells = [
        [
            str(row),
            *(quantity_text(str(name), value) for name, value in values[:-2].items()),
            *(f"{v:.3f}" for v in values[-2:]),
        ]
        for row, values in table.head(MOST_ROWS).iterrows()
    ]
    print_table(headers, cells, right=range(1, len(headers)))
    print_sentences(
        [
            sentence,
            "Information in nats: ln of the factor by which the width of what is known shrinks, on average.",
        ]
    )
