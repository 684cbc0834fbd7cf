"""``calibrate``: are posteriors, intervals and probabilities of models right as often as they say."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from skinbayes.cli.options import (
    data_of,
    data_option,
    json_option,
    model_argument,
    number_option,
    set_option,
    settings_of,
)
from skinbayes.cli.output import (
    EXIT_DONE,
    EXIT_INTERRUPTED,
    print_json,
    print_sentences,
    print_table,
    print_text,
    say,
)
from skinbayes.cli.runs import RUNS
from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, SEED

if TYPE_CHECKING:
    from skinbayes.calibration import Calibration, OddsCalibration


@click.command()
@model_argument
@click.argument("other", required=False)
@number_option("--simulations", 200, 1, "How many data sets are simulated and fitted.")
@data_option
@number_option("--seed", SEED, 0, "The same seed gives the same numbers.")
@number_option("--ess", EFFECTIVE_SAMPLE_SIZE, 10, "Effective sample size wanted of each fit.")
@number_option("--cores", 1, 1, "Processes that share the simulations; they do not change the numbers.")
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Let the workers of a dask scheduler do it, such as tcp://node1:8786.",
)
@click.option("--engine", default="emcee", show_default=True, metavar="NAME", help="What samples, as of fit.")
@set_option
@click.option(
    "-o",
    "--output",
    metavar="DIR",
    help="Where simulations are kept.  [default: runs/MODEL-calibration-seedN]",
)
@click.option("--report", metavar="FILE.html", help="Also write a page about it.")
@json_option
def calibrate(
    model: str,
    other: str | None,
    simulations: int,
    given: tuple[str, ...],
    seed: int,
    ess: int,
    cores: int,
    scheduler: str | None,
    engine: str,
    pairs: tuple[str, ...],
    output: str | None,
    report: str | None,
    as_json: bool,
) -> int:
    """Simulate data from the model itself, fit them, and count.

    Parameters are drawn from the prior, data are simulated with them at the conditions of the model's own data, and fitted as
    any data are. Of a calibrated model the truth is a draw of the posterior like any other, and intervals hold it as often as
    they say.

    With OTHER, another model of the same data, data are drawn from both, and it is asked whether each is right as often as its
    probability says.

    The same command again goes on from where it was interrupted, also with more simulations.
    """
    from skinbayes.calibration import calibrate as run
    from skinbayes.cli.page import refuse_other_files
    from skinbayes.cli.progress import counted_progress
    from skinbayes.problem.load import load_any_problem

    page = None if report is None else Path(report)
    if page is not None:
        refuse_other_files(page)
    first, second = (
        None if name is None else load_any_problem(name, data_of(name, given), settings=settings_of(pairs))
        for name in (model, other)
    )
    assert first is not None
    names = first.name if second is None else f"{first.name}-{second.name}"
    directory = Path(output) if output else RUNS / f"{names}-calibration-seed{seed}"
    try:
        with counted_progress("tables") as preparing, counted_progress("simulations") as progress:
            result = run(
                first, second, simulations=simulations, seed=seed, ess=ess, cores=cores, scheduler=scheduler, directory=directory,
                progress=progress, preparing=preparing, engine=engine,
            )  # fmt: skip
    except KeyboardInterrupt:
        say(f"interrupted; the simulations so far are in {directory}. Repeat the command to go on.", err=True)
        return EXIT_INTERRUPTED
    if page is not None:
        from skinbayes.report import write_calibration

        write_calibration(result, page)
    if as_json:
        print_json(result.to_dict() | {"run": str(directory), "report": page and str(page)})
        return EXIT_DONE
    _print(result)
    say(f"simulations: {directory}")
    if page is not None:
        say(f"report: {page}")
    return EXIT_DONE


def _print(result: Calibration | OddsCalibration) -> None:
    from skinbayes.calibration import Calibration
    from skinbayes.report.calibration_page import (
        HEADERS,
        ODDS_EXPLAINED,
        ODDS_HEADERS,
        odds_rows,
        remarks,
        table_rows,
    )

    if isinstance(result, Calibration):
        print_table(HEADERS, table_rows(result), right=range(1, len(HEADERS)))
        print_sentences([result.sentence(), *remarks(result)])
        return
    print_table(
        ODDS_HEADERS,
        odds_rows(result),
        title=f"probability of {result.models[1]}",
        right=range(len(ODDS_HEADERS)),
    )
    print_sentences([result.sentence()])
    print_text(ODDS_EXPLAINED)
