"""``compare``: which of several models predicts the same data better."""

from __future__ import annotations

import click

from skinbayes.cli.output import json_option, print_json, print_sentences, print_table


@click.command()
@click.argument("runs", nargs=-1, required=True, metavar="RUN RUN ...")
@json_option
def compare(runs: tuple[str, ...], as_json: bool) -> None:
    """Compare models by leave-one-out cross-validation (PSIS-LOO); runs on different data are refused."""
    from skinbayes.comparison import compare as compare_fits
    from skinbayes.fit import load_fit

    result = compare_fits([load_fit(run) for run in runs])
    if as_json:
        print_json(result.to_dict())
        return
    rows = [
        (m.name, f"{m.elpd_loo:.2f}", f"{m.elpd_loo_se:.2f}", f"{m.elpd_difference:.2f}", f"{m.elpd_difference_se:.2f}",
         f"{m.p_loo:.1f}", f"{m.weight:.2f}", str(m.unreliable_rows))
        for m in result.models
    ]  # fmt: skip
    headers = ("model", "elpd", "se", "difference", "se", "p_loo", "weight", "unreliable rows")
    print_table(headers, rows, right=range(1, 8))
    print_sentences(result.sentences())
