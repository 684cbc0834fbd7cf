"""``fit``: sample the posterior."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.output import (
    EXIT_DONE,
    EXIT_INTERRUPTED,
    EXIT_NOT_CONVERGED,
    json_option,
    print_json,
    print_sentences,
    print_table,
    say,
)

if TYPE_CHECKING:
    from skinbayes.fit import Fit

MOST_ROWS = 4
"""Derived quantities that differ over more rows than this are left to the summary file."""


@click.command()
@click.argument("model")
@click.option("--data", metavar="FILE.csv", help="Your own data instead of the model's.")
@click.option(
    "--seed", default=1, show_default=True, type=click.IntRange(0), help="The same seed gives the same draws."
)
@click.option(
    "--ess",
    default=2000,
    show_default=True,
    type=click.IntRange(10),
    help="Effective sample size wanted in every parameter.",
)
@click.option(
    "--cores",
    default=1,
    show_default=True,
    type=click.IntRange(1),
    help="Worker processes; they do not change the draws.",
)
@click.option(
    "--max-steps",
    default=10_000,
    show_default=True,
    type=click.IntRange(100),
    help="Stop here, converged or not.",
)
@click.option("-o", "--output", metavar="DIR", help="Run directory.  [default: runs/MODEL-seedN]")
@click.option("--resume", is_flag=True, help="Continue the run in the run directory.")
@click.option(
    "--report", "with_report", is_flag=True, help="Also write the report page into the run directory."
)
@json_option
def fit(
    model: str,
    data: str | None,
    seed: int,
    ess: int,
    cores: int,
    max_steps: int,
    output: str | None,
    resume: bool,
    with_report: bool,
    as_json: bool,
) -> int:
    """Sample the posterior until autocorrelation, effective sample size and R-hat agree that it is enough."""
    from skinbayes.cli.progress import fit_progress
    from skinbayes.fit import sample
    from skinbayes.problem import load_problem

    problem = load_problem(model, data=data)
    directory = Path(output) if output else Path("runs") / f"{problem.name}-seed{seed}"
    try:
        with fit_progress() as (count, progress):
            result = sample(
                problem, seed=seed, ess=ess, cores=cores, directory=directory, resume=resume, progress=progress,
                preparing=count, max_steps=max_steps,
            )  # fmt: skip
    except KeyboardInterrupt:
        say(
            f"interrupted; the steps so far are in {directory}. Repeat the command with --resume to continue.",
            err=True,
        )
        return EXIT_INTERRUPTED
    page = None
    if with_report:
        from skinbayes.cli.page import write_page

        page = directory / "report.html"
        write_page(result, page, directory)
    status = EXIT_DONE if result.converged else EXIT_NOT_CONVERGED
    if as_json:
        print_json(_document(result, directory, page))
        return status
    _print(result, directory, page)
    return status


def _document(result: Fit, directory: Path, page: Path | None) -> dict[str, Any]:
    from skinbayes.report import digest

    sampling = result.provenance["sampling"]
    summary = result.summary()
    columns = ["unit", "median", "q05", "q95", "ess_bulk", "ess_tail", "r_hat"]
    return {
        "run": str(directory),
        "model": result.name,
        "converged": result.converged,
        "verdict": sampling["verdict"],
        "seed": sampling["seed"],
        "parameters": summary[columns].to_dict(orient="index"),
        "log_evidence": None,
        "log_likelihood_evaluations": sampling["evaluations"],
        "steps": sampling["steps"],
        "seconds": result.provenance["seconds"]["total"],
        "report": page and str(page),
        **digest(result),
    }


def _print(result: Fit, directory: Path, page: Path | None) -> None:
    from skinbayes.fit.manifest import SUMMARY
    from skinbayes.units import format_quantity

    title = result.provenance["title"] + ("" if result.converged else "   – NOT CONVERGED")
    free = result.summary()
    everything = result.summary(derived=True)
    # a quantity that differs by row is listed here for a few rows only; the file has them all
    crowded = {
        name
        for name, count in Counter(label.partition("[")[0] for label in everything.index).items()
        if count > MOST_ROWS
    }
    rows = []
    for label, row in zip(everything.index.astype(str), everything.to_dict("records"), strict=True):
        if label not in free.index and label.partition("[")[0] in crowded:
            continue
        values = [format_quantity(row[key], row["unit"]) for key in ("median", "q05", "q95")]
        convergence = [f"{row['ess_bulk']:.0f}", f"{row['r_hat']:.3f}"] if label in free.index else ["", ""]
        rows.append([label, *values, *convergence])
    print_table(
        ("parameter", "median", "5 %", "95 %", "ESS", "R-hat"), rows, title=title, right=(1, 2, 3, 4, 5)
    )
    print_sentences([result.provenance["sampling"]["verdict"]])
    if crowded:
        say(f"row by row in {directory / SUMMARY}: {', '.join(sorted(crowded))}")
    say(f"run: {directory}" + (f"\nreport: {page}" if page else f"\nreport: skinbayes report {directory}"))
