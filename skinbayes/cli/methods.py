"""``methods``: the methods paragraph of a paper."""

from __future__ import annotations

from pathlib import Path

import click

from skinbayes.cli.new_file import format_of, refuse_existing, write_text
from skinbayes.cli.options import json_option, overwrite_option
from skinbayes.cli.output import print_json, say

SUFFIXES = {".txt": "text", ".md": "markdown", ".tex": "latex", ".bib": "bibtex"}


@click.command()
@click.argument("run")
@click.option(
    "--format",
    "form",
    metavar="text|markdown|latex|bibtex",
    help="How it is written; bibtex: the works that it cites.  [default: as -o says, else text]",
)
@click.option("-o", "--output", metavar="FILE", help="Write it to a file instead of printing it.")
@overwrite_option
@json_option
def methods(run: str, form: str | None, output: str | None, overwrite: bool, as_json: bool) -> None:
    """Print the methods of a run as text for a paper.

    Data, model, theory, priors with sources, scatter, sampling and convergence, agreement, versions and seed, from what the run
    stores, with what to cite: numbered in text, [@key] in Markdown, \\cite in LaTeX with the keys of the BibTeX entries.
    """
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.report.methods import FORMATS, methods_text

    form = format_of(form, output, FORMATS, SUFFIXES, "text")
    if output is not None:
        refuse_existing([Path(output)], overwrite)
    fit = load_any_fit(run)
    text = methods_text(fit, form)
    if output is not None:
        write_text(Path(output), text)
        say(f"methods: {output}", err=as_json)
    if as_json:
        print_json(
            {
                "run": run,
                "converged": fit.converged,
                "format": form,
                "methods": text,
                "bibtex": fit.cite("bibtex"),
            }
        )
    elif output is None:
        say(text.rstrip("\n"))
