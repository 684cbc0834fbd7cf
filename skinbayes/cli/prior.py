"""``prior``: what the priors alone predict, beside the data."""

from __future__ import annotations

import click

from skinbayes.cli.options import data_option, json_option, model_argument, number_option
from skinbayes.cli.output import MOST_ROWS, print_json, print_sentences, print_table
from skinbayes.defaults import SEED


@click.command()
@model_argument
@data_option
@number_option("--seed", SEED, 0, "Seed of the draws.")
@number_option("--draws", 4000, 100, "Number of prior draws.", most=1_000_000)
@json_option
def prior(model: str, data: str | None, seed: int, draws: int, as_json: bool) -> None:
    """Compare what the priors predict with the data, row by row."""
    from skinbayes.problem import load_problem
    from skinbayes.problem.prior_predictive import prior_predictive
    from skinbayes.units import format_quantity
    from skinbayes.vocabulary import QUANTITIES

    result = prior_predictive(load_problem(model, data=data), seed=seed, draws=draws)
    if as_json:
        print_json(result.to_dict())
        return
    shown = result.most_surprising(MOST_ROWS)
    for observable in result.observables:
        unit = QUANTITIES[observable].unit
        rows = [
            (
                row.label,
                *(format_quantity(v, unit) for v in (row.observed, row.q05, row.median, row.q95)),
                f"{100 * row.fraction_below:.0f} %",
            )
            for row in shown
            if row.observable == observable
        ]
        print_table(("row", "observed", "prior 5 %", "prior median", "prior 95 %", "draws below"), rows,
                    right=(1, 2, 3, 4, 5), title=observable)  # fmt: skip
    said = result.sentences()
    if len(shown) < len(result.rows):
        said.insert(
            0,
            f"Listed are the {len(shown)} of {len(result.rows)} data that the priors expect least; --json gives all.",
        )
    print_sentences(said)
