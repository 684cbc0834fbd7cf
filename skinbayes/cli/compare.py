"""``compare``: which of several models predicts the same data better."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from skinbayes.cli.options import json_option
from skinbayes.cli.output import print_json, print_sentences, print_table, print_text

if TYPE_CHECKING:
    from skinbayes.comparison import Comparison


@click.command()
@click.argument("runs", nargs=-1, required=True, metavar="RUN RUN ...")
@click.option(
    "--refit",
    is_flag=True,
    help="Sample anew without a person, a liquid, … where importance sampling cannot leave it out.",
)
@click.option(
    "--sensitivity",
    is_flag=True,
    help="Sample anew with wider priors where the draws cannot tell whether the evidence would still prefer the same model.",
)
@json_option
def compare(runs: tuple[str, ...], refit: bool, sensitivity: bool, as_json: bool) -> None:
    """Compare models by what they predict for data left out.

    Runs on different data are refused.

    Single data are left out one at a time (PSIS-LOO), and where the data have grouping columns all data of one person, or one
    liquid.
    """
    from skinbayes.cli.progress import counted_progress
    from skinbayes.comparison import compare as compare_fits
    from skinbayes.fit import load_fit

    fits = [load_fit(run) for run in runs]
    with counted_progress("widths of priors" if sensitivity and not refit else "refits") as progress:
        result = compare_fits(fits, refit=refit, progress=progress, sensitivity=sensitivity)
    if as_json:
        print_json(result.to_dict())
        return
    rows = [
        (m.name, f"{m.elpd_loo:.2f} ± {m.elpd_loo_se:.2f}", f"{m.elpd_difference:.2f} ± {m.elpd_difference_se:.2f}",
         f"{m.p_loo:.1f}", f"{m.weight:.2f}", str(m.unreliable_rows))
        for m in result.models
    ]  # fmt: skip
    headers = ("model", "elpd", "difference", "p_loo", "weight", "unreliable")
    print_table(headers, rows, right=range(1, 6))
    if result.has_evidence:
        evidence = [
            (m.name, f"{m.log_evidence:.2f} ± {m.log_evidence_se:.2f}", f"{m.probability:.3f}")
            for m in result.by_evidence
        ]
        print_table(("model", "ln evidence", "probability"), evidence, right=range(1, 3))
    for column in result.columns:
        _print_levels(result, column)
    print_text(
        "elpd: expected log predictive density of the data, each left out in turn, ± standard error; more is better. p_loo: "
        "effective number of parameters. weight: share in the mixture of the models that predicts best. unreliable: data that "
        "importance sampling cannot leave out."
    )
    print_sentences(result.sentences())


def _print_levels(result: Comparison, column: str) -> None:
    rows = []
    for model in sorted(result.models, key=lambda model: -model.left_out[column].elpd):
        entry = model.left_out[column]
        pairs = ((entry.elpd, entry.elpd_se), (entry.difference, entry.difference_se))
        said = (f"{value:.2f} ± {error:.2f}" for value, error in pairs)
        rows.append((model.name, *said, str(len(entry.unreliable))))
    headers = ("model", "elpd", "difference", "unreliable")
    print_table(headers, rows, title=f"one {column} left out at a time", right=range(1, 4))
