"""``reproduce``: everything that the paper states, beside what is computed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from skinbayes.cli.options import json_option
from skinbayes.cli.output import EXIT_DONE, print_json, print_sentences, print_table, print_text, say

if TYPE_CHECKING:
    from skinbayes.reproduce import Compared, Paper

HEADERS = ("what and where", "paper", "skinbayes", "off by", "agrees")


@click.command()
@click.option("--figures", metavar="DIR", help="Also draw the paper's figures into a folder (PDF and PNG).")
@click.option(
    "-o", "--output", metavar="FILE.html", help="Also write a page with everything, figures included."
)
@json_option
def reproduce(figures: str | None, output: str | None, as_json: bool) -> int:
    """Compare what the paper states with what is computed.

    The paper is Persson, Kovalev & Gorb, Tribology Letters 50 (2013) 17. A number agrees if it is within what its
    digits and signs allow; the rules are printed with the page and the JSON document.
    """
    from skinbayes.cli.page import refuse_other_files
    from skinbayes.cli.progress import counted_progress
    from skinbayes.reproduce import Paper, demonstrations, reproduction

    page = None if output is None else Path(output)
    if page is not None:
        refuse_other_files(page)
    paper = Paper()
    with counted_progress("statements") as progress:
        rows = reproduction(paper, progress)
    shown = demonstrations(paper)
    drawn = [] if figures is None else _draw(paper, Path(figures))
    if page is not None:
        from skinbayes.report import write_reproduction

        with counted_progress("figures") as progress:
            write_reproduction(rows, shown, paper, page, progress)
    if as_json:
        from skinbayes.reproduce.document import document

        files = {"figures": [str(path) for path in drawn], "report": page and str(page)}
        print_json(document(rows, shown) | files)
        return EXIT_DONE
    _print(rows)
    for path in drawn:
        say(f"figure: {path}")
    if page is not None:
        say(f"report: {page}")
    return EXIT_DONE


def _print(rows: list[Compared]) -> None:
    from skinbayes.reproduce.shown import (
        computed_text,
        count_sentence,
        difference_text,
        paper_text,
        verdict,
    )

    groups = list(dict.fromkeys(row.statement.group for row in rows))
    for group in groups:
        cells = [
            (
                f"{row.statement.description} ({row.statement.where})",
                paper_text(row),
                computed_text(row),
                difference_text(row),
                verdict(row),
            )
            for row in rows
            if row.statement.group == group
        ]
        print_table(HEADERS, cells, title=group, right=(3,))
    missed = [row for row in rows if not row.agrees]
    print_sentences(
        [f"{row.statement.description} ({row.statement.where}): {row.note}".rstrip(": ") for row in missed],
        "What does not agree, and why",
    )
    print_text("", count_sentence(rows))


def _draw(paper: Paper, folder: Path) -> list[Path]:
    from skinbayes.cli.progress import counted_progress
    from skinbayes.plot.paper import save_figures

    with counted_progress("figures") as progress:
        return save_figures(paper, folder, progress)
