"""``plot``: figures of a run as files for a journal."""

from __future__ import annotations

import re
from pathlib import Path

import click

from skinbayes.cli.new_file import format_of, refuse_existing, write_bytes
from skinbayes.cli.options import json_option, overwrite_option
from skinbayes.cli.output import print_json, print_sentences, print_table, say
from skinbayes.errors import InputError


@click.command()
@click.argument("run")
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Where to write the figure; a folder for several.  [default: RUN/figures/NAME.pdf]",
)
@click.option(
    "--format", "form", metavar="pdf|svg|png", help="Kind of file.  [default: that of -o, else pdf]"
)
@click.option(
    "--width", default="84 mm", show_default=True, help="Width on paper, with its unit, such as 174mm."
)
@click.option("--against", metavar="COLUMN", help="Of 'data': the condition along the axis.")
@overwrite_option
@json_option
def plot(
    run: str,
    names: tuple[str, ...],
    output: str | None,
    form: str | None,
    width: str,
    against: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write figures of a run at the width of a journal's column.

    NAME is one of those that 'skinbayes plot RUN' lists, or 'all'. Letters have 7 to 9 points on paper, PDF files have their
    fonts in them, and there is no title: what to write below a figure is printed with its file.
    """
    from skinbayes.fit.storage import load_any_fit
    from skinbayes.plot.journal import journal_file
    from skinbayes.plot.style import inches
    from skinbayes.report.named_figures import chosen_figures, named_figures

    inches(width)
    form = _form(form, output if len(names) == 1 and names[0] != "all" else None)
    fit = load_any_fit(run)
    if not names:
        known = named_figures(fit)
        if as_json:
            print_json(
                {"run": run, "figures": {name: drawing.heading for name, (_, drawing) in known.items()}}
            )
        else:
            print_table(["figure", "what it shows"], [[name, d.heading] for name, (_, d) in known.items()])
        return
    chosen = chosen_figures(fit, names, against)
    several, place = len(chosen) > 1 or "all" in names, Path(run)
    folder = (place if place.is_dir() else place.parent) / "figures"
    if output is not None and not several:
        files = {name: Path(output) for name in chosen}
    else:
        folder = folder if output is None else Path(output)
        if folder.exists() and not folder.is_dir():
            raise InputError(f"{folder}: a file; expected a folder for {len(chosen)} figures")
        files = {name: folder / f"{_file_name(name)}.{form}" for name in chosen}
    if len(set(files.values())) < len(files):
        raise InputError(
            f"{', '.join(chosen)}: two of these figures would have the same file; write them one by one with -o"
        )
    refuse_existing(list(files.values()), overwrite)
    written = {}
    for name, (one, drawing, arguments) in chosen.items():
        write_bytes(files[name], journal_file(drawing.draw(one, width=width, **arguments), form))
        written[name] = {"file": str(files[name]), "heading": drawing.heading, "caption": drawing.caption}
        if not as_json:
            say(f"{name}: {files[name]}")
            print_sentences([f"{drawing.heading}. {drawing.caption}"])
    if not fit.converged:
        say("skinbayes: the run has not converged, and its figures say so", err=True)
    if as_json:
        print_json(
            {"run": run, "width": width, "format": form, "converged": fit.converged, "figures": written}
        )


def _form(form: str | None, output: str | None) -> str:
    """Kind of file: what was asked for, else what the name of the file says, else PDF."""
    from skinbayes.plot.journal import FORMATS

    kinds = {f".{kind}": kind for kind in FORMATS}
    found = format_of(None if form is None else form.removeprefix("."), output, FORMATS, kinds, FORMATS[0])
    written = None if output is None else kinds.get(Path(output).suffix.lower())
    if written not in (None, found):
        raise InputError(f"-o {output}: the name of a file of the kind {written}, but --format is {found}")
    return found


def _file_name(name: str) -> str:
    """A figure's name as that of a file: names of columns and experiments may hold anything."""
    return re.sub(r"[^\w.-]+", "-", name).strip(".-") or "figure"
