"""``fit``: sample the posterior."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.fit_each import print_each
from skinbayes.cli.fit_output import print_fit
from skinbayes.cli.options import (
    data_of,
    data_option,
    json_option,
    model_argument,
    named_values,
    number_option,
    set_option,
    settings_of,
)
from skinbayes.cli.output import EXIT_DONE, EXIT_INTERRUPTED, EXIT_NOT_CONVERGED, print_json, say
from skinbayes.cli.runs import run_directory
from skinbayes.defaults import EFFECTIVE_SAMPLE_SIZE, MAX_STEPS, MOST_DRAWS, SEED
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit


@click.command()
@model_argument
@data_option
@number_option("--seed", SEED, 0, "The same seed gives the same draws.")
@number_option("--ess", EFFECTIVE_SAMPLE_SIZE, 10, "Effective sample size wanted in every parameter.")
@number_option("--cores", 1, 1, "Worker processes; they do not change the draws.")
@click.option(
    "--max-steps",
    type=click.IntRange(100),
    help=f"Stop here, converged or not (emcee).  [default: {MAX_STEPS}]",
)
@click.option(
    "--engine",
    default="emcee",
    show_default=True,
    metavar="NAME",
    help="What samples: emcee, or nested (nested sampling, also gives the evidence).",
)
@click.option(
    "--engine-option",
    "engine_pairs",
    multiple=True,
    metavar="NAME=VALUE",
    help="Option of the engine, such as live_points=500 of nested; can be repeated.",
)
@set_option
@click.option("-o", "--output", metavar="DIR", help="Run directory.  [default: runs/MODEL-seedN]")
@click.option("--resume", is_flag=True, help="Continue the run in the run directory.")
@click.option(
    "--report", "with_report", is_flag=True, help="Also write the report page into the run directory."
)
@click.option(
    "--each",
    metavar="WHAT",
    help="Fit many data sets, each by itself: the labels of a column (person); file, the files that --data names (or a "
    "pattern such as 'data/*.csv'); or the lines of a table of settings, FILE.csv. --cores then share the fits.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="With --each: let the workers of a dask scheduler do it, such as tcp://node1:8786.",
)
@number_option("--draws", MOST_DRAWS, 0, "With --each: posterior draws kept of each fit.")
@click.option("--runs", is_flag=True, help="With --each: also keep a run directory of each fit.")
@json_option
def fit(
    model: str,
    given: tuple[str, ...],
    seed: int,
    ess: int,
    cores: int,
    max_steps: int | None,
    engine: str,
    engine_pairs: tuple[str, ...],
    pairs: tuple[str, ...],
    output: str | None,
    resume: bool,
    with_report: bool,
    each: str | None,
    scheduler: str | None,
    draws: int,
    runs: bool,
    as_json: bool,
) -> int:
    """Sample the posterior until it has converged.

    It has when autocorrelation, effective sample size and R-hat agree that enough has been sampled.

    With --each the same command again goes on from where it was interrupted, and fits again what changed.
    """
    options = _engine_options(engine_pairs)
    if max_steps is not None:
        options = {"max_steps": max_steps} | options
    if each is not None:
        if with_report:
            raise InputError(
                "--report: one page for one fit; with --each keep --runs, and write the page of one of them"
            )
        how = {
            "seed": seed,
            "ess": ess,
            "cores": cores,
            "engine": engine,
            "scheduler": scheduler,
            "draws": draws,
            "runs": runs,
        }
        return print_each(model, each, given, pairs, output, how | options, as_json)
    if scheduler is not None or runs or draws != MOST_DRAWS:
        raise InputError("--scheduler, --draws and --runs are for many fits; expected --each WHAT with them")
    from skinbayes.cli.progress import fit_progress
    from skinbayes.fit import sample
    from skinbayes.problem.load import load_any_problem
    from skinbayes.problem.rows import data_notes

    problem = load_any_problem(model, data_of(model, given), settings=settings_of(pairs))
    directory = Path(output) if output else run_directory(problem.name, seed)
    try:
        with fit_progress() as (count, progress):
            result = sample(
                problem, seed=seed, ess=ess, cores=cores, directory=directory, resume=resume, progress=progress,
                preparing=count, engine=engine, **options,
            )  # fmt: skip
    except KeyboardInterrupt:
        kept = f"; the steps so far are in {directory}" if (directory / "steps").is_dir() else ""
        say(
            f"interrupted{kept}. Repeat the command with --resume to {'continue' if kept else 'begin anew'}.",
            err=True,
        )
        return EXIT_INTERRUPTED
    for name, (part, _) in problem.parts.items():
        for note in data_notes(part):
            say(f"{name}: {note}" if name else note, err=True)
    page = None
    if with_report:
        from skinbayes.cli.page import write_page

        page = directory / "report.html"
        write_page(result, page, directory)
    status = EXIT_DONE if result.converged else EXIT_NOT_CONVERGED
    if as_json:
        print_json(_document(result, directory, page))
        return status
    print_fit(result, directory, page)
    return status


def _engine_options(pairs: tuple[str, ...]) -> dict[str, Any]:
    """Options of the engine by name; it says itself which it has, and in which range."""
    named = named_values("--engine-option", pairs, "live_points=500")
    for name in named:
        if option := {"seed": "--seed", "ess": "--ess", "cores": "--cores"}.get(name):
            raise InputError(f"--engine-option {name}: every engine has it; expected as {option}")
    return {name: _plain_value(text) for name, text in named.items()}


def _plain_value(text: str) -> int | float | bool | str:
    """A number, true or false where the text is one, else the text."""
    for read in (int, float, {"true": True, "false": False}.__getitem__):
        with suppress(ValueError, KeyError):
            return read(text)
    return text


def _document(result: Fit | JointFit, directory: Path, page: Path | None) -> dict[str, Any]:
    from skinbayes.fit.joint_fit import JointFit
    from skinbayes.report import digest, joint_digest

    sampling = result.provenance["sampling"]
    summary = result.summary()
    columns = [name for name in summary if not str(name).startswith("prior_")]
    evidence, error = sampling["log_evidence"] or (None, None)
    return {
        "run": str(directory),
        "model": result.name,
        "converged": result.converged,
        "verdict": sampling["verdict"],
        "seed": sampling["seed"],
        "parameters": summary[columns].to_dict(orient="index"),
        "engine": sampling["engine"],
        "log_evidence": evidence,
        "log_evidence_error": error,
        "log_likelihood_evaluations": sampling.get("evaluations"),
        "steps": sampling.get("steps"),
        "seconds": result.provenance["seconds"]["total"],
        "report": page and str(page),
        **(joint_digest(result, result.left_out()) if isinstance(result, JointFit) else digest(result)),
    }
