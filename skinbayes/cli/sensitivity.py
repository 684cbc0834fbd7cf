"""``sensitivity``: would the answer survive another prior."""

from __future__ import annotations

import click

from skinbayes.cli.options import json_option
from skinbayes.cli.output import print_json, print_sentences, print_table, print_text


@click.command()
@click.argument("run")
@click.option(
    "--refit",
    is_flag=True,
    help="Sample anew with the other priors where the draws of the run cannot tell.",
)
@json_option
def sensitivity(run: str, refit: bool, as_json: bool) -> None:
    """Show what evidence and posterior owe to the priors.

    Every prior is made half and twice as wide, alone and with all others, by giving the draws other weights.
    """
    from skinbayes.cli.progress import counted_progress
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.report.sensitivity import EXPLAINED, HEADERS, sensitivity_rows

    fit = load_any_fit(run)
    with counted_progress("other priors") as progress:
        found = fit.prior_sensitivity(refit, progress if refit else None)
    if as_json:
        print_json({"run": run, **found.to_dict()})
        return
    print_table(HEADERS, sensitivity_rows(found), right=range(1, len(HEADERS) - 1))
    print_text(EXPLAINED)
    print_sentences(found.sentences())
