"""``compare``: which of several models predicts the same data better."""

from __future__ import annotations

from pathlib import Path

import click

from skinbayes.cli.options import data_option, json_option, number_option
from skinbayes.cli.output import (
    EXIT_DONE,
    EXIT_INTERRUPTED,
    print_json,
    print_sentences,
    print_table,
    print_text,
    say,
)
from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, SEED
from skinbayes.errors import InputError


@click.command()
@click.argument("runs", nargs=-1, required=True, metavar="RUN_OR_MODEL ...")
@data_option
@number_option("--seed", SEED, 0, "Of models that are sampled.")
@number_option("--ess", EFFECTIVE_SAMPLE_SIZE, 10, "Effective sample size wanted of models that are sampled.")
@number_option("--cores", 1, 1, "Worker processes; they do not change the draws.")
@click.option(
    "-o",
    "--output",
    default="runs",
    show_default=True,
    metavar="DIR",
    help="Where the runs of models are, or come to be: DIR/MODEL-seedN.",
)
@click.option(
    "--no-refit",
    is_flag=True,
    help="Do not sample anew without what importance sampling cannot leave out, and without each datum if there are few.",
)
@click.option(
    "--refit",
    is_flag=True,
    help="Sample anew however long it takes; else no more than 8,000 data in all such fits of a model together.",
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
@click.option("--report", metavar="FILE.html", help="Also write a page about the comparison.")
@json_option
def compare(
    runs: tuple[str, ...],
    given: tuple[str, ...],
    seed: int,
    ess: int,
    cores: int,
    output: str,
    no_refit: bool,
    refit: bool,
    leave_out: tuple[str, ...],
    nested: bool,
    sensitivity: bool,
    report: str | None,
    as_json: bool,
) -> int:
    """Compare models by what they predict for data left out.

    Runs on different data are refused. A model that is named instead of a run is sampled, unless that was done
    before; the same command again goes on from where it was interrupted.

    Single data are left out one at a time, and where the data have grouping columns all data of one person, or one liquid: by
    importance sampling, and by sampling anew where that fails.
    """
    from dataclasses import replace

    from skinbayes.cli.page import refuse_other_files
    from skinbayes.cli.progress import counted_progress, named_progress
    from skinbayes.cli.runs import Wanted, fits_of
    from skinbayes.comparison import compare as compare_fits
    from skinbayes.comparison import cross_check
    from skinbayes.comparison.tables import EXPLAINED, comparison_tables
    from skinbayes.report import write_comparison

    if refit and no_refit:
        raise InputError("compare: found --refit and --no-refit; expected one of them")
    anew = True if refit else False if no_refit else None
    page = None if report is None else Path(report)
    if page is not None:
        refuse_other_files(page)
    wanted = Wanted(given, seed, ess, cores, Path(output))
    try:
        fits = fits_of(runs, wanted)
    except KeyboardInterrupt:
        say("interrupted. Repeat the command to go on from here.", err=True)
        return EXIT_INTERRUPTED
    with named_progress("nested sampling of") as told:
        checks = tuple(cross_check(fit, told) for fit in fits if nested)
    with counted_progress("refits") as progress:
        compared = compare_fits(fits, anew, leave_out, progress=progress, sensitivity=sensitivity)
    result = replace(compared, cross_checks=checks)
    if page is not None:
        write_comparison(result, fits, page)
    if as_json:
        print_json(result.to_dict() | {"report": page and str(page)})
        return EXIT_DONE
    for table in comparison_tables(result):
        print_table(table.headers, table.rows, title=table.title, right=range(1, len(table.headers)))
    print_text(EXPLAINED)
    print_sentences(result.sentences())
    if page is not None:
        say(f"report: {page}")
    return EXIT_DONE
