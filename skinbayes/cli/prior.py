"""``prior``: what the priors alone predict, beside the data."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from skinbayes.cli.options import data_of, data_option, json_option, model_argument, number_option
from skinbayes.cli.output import MOST_ROWS, print_json, print_sentences, print_table
from skinbayes.defaults import SEED

if TYPE_CHECKING:
    from skinbayes.problem.prior_predictive import PriorPredictive


@click.command()
@model_argument
@data_option
@number_option("--seed", SEED, 0, "Seed of the draws.")
@number_option("--draws", 4000, 100, "Number of prior draws.", most=1_000_000)
@json_option
def prior(model: str, given: tuple[str, ...], seed: int, draws: int, as_json: bool) -> None:
    """Compare what the priors predict with the data, row by row."""
    from skinbayes.problem.joint import JointProblem
    from skinbayes.problem.load import load_any_problem
    from skinbayes.problem.prior_predictive import prior_predictive

    problem = load_any_problem(model, data_of(model, given))
    if not isinstance(problem, JointProblem):
        result = prior_predictive(problem, seed=seed, draws=draws)
        if as_json:
            print_json(result.to_dict())
        else:
            _print(result)
        return
    each = {name: prior_predictive(one, seed=seed, draws=draws) for name, one in problem.experiments.items()}
    if as_json:
        print_json(
            {"model": problem.name, "experiments": {name: one.to_dict() for name, one in each.items()}}
        )
        return
    for name, one in each.items():
        _print(one, f"{name}: ")


def _print(result: PriorPredictive, before: str = "") -> None:
    from skinbayes.units import format_quantity
    from skinbayes.vocabulary import QUANTITIES

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
                    right=(1, 2, 3, 4, 5), title=before + observable)  # fmt: skip
    said = result.sentences()
    if len(shown) < len(result.rows):
        said.insert(
            0,
            f"Listed are the {len(shown)} of {len(result.rows)} data that the priors expect least; --json gives all.",
        )
    print_sentences(said)
