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
    "--no-refit",
    is_flag=True,
    help="Do not sample anew without what importance sampling cannot leave out, and without each datum if there are few.",
)
@click.option(
    "--leave-out",
    multiple=True,
    metavar="BLOCKS",
    help="Leave out blocks of rows too: 'normal_force in 3', thirds along a column; 'in 3', along the one that differs most; "
    "'order in 3', as they stand; 'session', by value.",
)
@click.option(
    "--cross-check",
    "nested",
    is_flag=True,
    help="Compute the evidence by nested sampling too (needs dynesty).",
)
@click.option(
    "--sensitivity",
    is_flag=True,
    help="Sample anew with wider priors where the draws cannot tell whether the evidence would still prefer the same model.",
)
@json_option
def compare(
    runs: tuple[str, ...],
    no_refit: bool,
    leave_out: tuple[str, ...],
    nested: bool,
    sensitivity: bool,
    as_json: bool,
) -> None:
    """Compare models by what they predict for data left out.

    Runs on different data are refused.

    Single data are left out one at a time, and where the data have grouping columns all data of one person, or one liquid: by
    importance sampling, and by sampling anew where that fails.
    """
    from dataclasses import replace

    from skinbayes.cli.progress import counted_progress, named_progress
    from skinbayes.comparison import compare as compare_fits
    from skinbayes.comparison import cross_check
    from skinbayes.comparison.verdicts import plus_minus
    from skinbayes.fit.storage import load_any_fit

    fits = [load_any_fit(run) for run in runs]
    with named_progress("nested sampling of") as told:
        checks = tuple(cross_check(fit, told) for fit in fits if nested)
    with counted_progress("refits") as progress:
        compared = compare_fits(fits, not no_refit, leave_out, progress=progress, sensitivity=sensitivity)
    result = replace(compared, cross_checks=checks)
    if as_json:
        print_json(result.to_dict())
        return
    rows = [
        (m.name, plus_minus(m.elpd_loo, m.elpd_loo_se), plus_minus(m.elpd_difference, m.elpd_difference_se),
         f"{m.p_loo:.1f}", "–" if m.weight is None else f"{m.weight:.2f}", str(m.refitted_rows), str(m.unreliable_rows))
        for m in result.models
    ]  # fmt: skip
    headers = ("model", "elpd", "difference", "p_loo", "weight", "refits", "unreliable")
    print_table(headers, rows, right=range(1, 7))
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
        "effective number of parameters. weight: fraction in the mixture of the models that predicts best. refits: data without "
        "which the model was sampled anew. unreliable: data whose number cannot be trusted."
    )
    print_sentences(result.sentences())


def _print_levels(result: Comparison, column: str) -> None:
    from skinbayes.comparison.verdicts import one, plus_minus

    rows = []
    for model in sorted(result.models, key=lambda model: -model.left_out[column].elpd):
        entry = model.left_out[column]
        pairs = ((entry.elpd, entry.elpd_se), (entry.difference, entry.difference_se))
        said = (plus_minus(value, error) for value, error in pairs)
        rows.append((model.name, *said, str(len(entry.refitted)), str(len(entry.unreliable))))
    headers = ("model", "elpd", "difference", "refits", "unreliable")
    print_table(headers, rows, title=f"one {one(column)} left out at a time", right=range(1, 5))
