"""``report``: one self-contained page about a run."""

from __future__ import annotations

from pathlib import Path

import click

from skinbayes.cli.options import json_option
from skinbayes.cli.output import print_json, say


@click.command()
@click.argument("run")
@click.option(
    "-o", "--output", metavar="FILE.html", help="Where to write the page.  [default: RUN/report.html]"
)
@click.option(
    "--no-baselines",
    is_flag=True,
    help="Do not fit the models without theory that the model names beside it.",
)
@click.option(
    "--refit",
    is_flag=True,
    help="Of several experiments: sample without each of them where the draws cannot tell whether they agree.",
)
@json_option
def report(run: str, output: str | None, no_baselines: bool, refit: bool, as_json: bool) -> None:
    """Write one HTML page: what was learnt and what was not.

    The page is one file that needs no other, figures included.
    """
    from skinbayes.cli.page import write_page
    from skinbayes.fit.joint_fit import JointFit
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.report import digest, joint_digest

    fit, place = load_any_fit(run), Path(run)
    page = Path(output) if output else place / "report.html" if place.is_dir() else place.with_suffix(".html")
    left_out = fit.left_out(refit) if isinstance(fit, JointFit) else None
    baseline_models = write_page(fit, page, place if place.is_dir() else None, not no_baselines, left_out)
    if as_json:
        print_json(
            {
                "run": run,
                "report": str(page),
                "converged": fit.converged,
                **(joint_digest(fit, left_out or []) if isinstance(fit, JointFit) else digest(fit)),
                "baseline_models": None if baseline_models is None else baseline_models.to_dict(),
            }
        )
    else:
        say(f"report: {page}")
