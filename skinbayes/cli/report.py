"""``report``: one self-contained page about a run."""

from __future__ import annotations

from pathlib import Path

import click

from skinbayes.cli.output import json_option, print_json


@click.command()
@click.argument("run")
@click.option(
    "-o", "--output", metavar="FILE.html", help="Where to write the page.  [default: RUN/report.html]"
)
@json_option
def report(run: str, output: str | None, as_json: bool) -> None:
    """Write one self-contained HTML page: what was learnt and what was not, with figures."""
    from skinbayes.fit import load_fit
    from skinbayes.report import write_report

    fit = load_fit(run)
    beside = Path(run) / "report.html" if Path(run).is_dir() else Path(run).with_suffix(".html")
    written = write_report(fit, Path(output) if output else beside)
    if as_json:
        print_json({"run": run, "report": str(written), "converged": fit.converged})
    else:
        click.echo(f"report: {written}")
