"""``reduce``: recordings of a tribometer become the table of friction that a fit takes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, overwrite_option
from skinbayes.cli.output import print_json, print_sentences, print_table, say
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.files.reduced import ReducedRecordings
    from skinbayes.recordings import FrictionRow, ReducedRecording

MOST_TOLD = 12
"""Recordings about which sentences are printed; the page has all."""


@click.command()
@click.argument("files", nargs=-1)
@click.option("--recipe", metavar="FILE.toml", help="How strokes are found and friction is taken.")
@click.option(
    "--template", is_flag=True, help="Write a commented recipe, with the columns of the first of FILES."
)
@click.option(
    "-o", "--output", metavar="FILE", help="CSV to write, or a folder for data.csv; of --template the recipe."
)
@click.option(
    "--report",
    "page",
    metavar="FILE.html",
    help="The page elsewhere.  [default: recordings.html beside the CSV]",
)
@overwrite_option
@json_option
def reduce(
    files: tuple[str, ...],
    recipe: str | None,
    template: bool,
    output: str | None,
    page: str | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Reduce force-time recordings to friction.

    FILES are delimited exports of a tribometer, one recording each. With -o a CSV with a row for each stroke is written, its
    provenance with the recipe, and a page with a picture of each recording; without it what comes out is printed only.
    """
    if template:
        _template(files, recipe, output, overwrite, as_json)
        return
    if not files or recipe is None:
        raise InputError(
            "reduce: expected FILES and --recipe FILE.toml; skinbayes reduce FILE --template -o recipe.toml writes one to "
            "start with"
        )
    from skinbayes.cli.progress import counted_progress
    from skinbayes.files.reduced import reduce_recordings, targets
    from skinbayes.report.recordings_page import write_recordings_page

    data, described = targets(output) if output is not None else (None, None)
    where = Path(page) if page is not None else None if data is None else data.with_name("recordings.html")
    written = [path for path in (data, described, where) if path is not None]
    refuse_existing(written, overwrite)
    with counted_progress("recordings") as progress:
        reduced = reduce_recordings(files, recipe, progress=progress)
    if data is not None:
        reduced.save(data)
    if where is not None:
        write_recordings_page(reduced, where)
    if as_json:
        print_json(document(reduced) | {"written": [str(path) for path in written]})
        return
    _show(reduced)
    for label, path in (("data", data), ("provenance", described), ("page", where)):
        if path is not None:
            rows = f" ({len(reduced.rows)} rows)" if label == "data" else ""
            say(f"{label + ':':12}{path}{rows}")


def _template(
    files: tuple[str, ...], recipe: str | None, output: str | None, overwrite: bool, as_json: bool
) -> None:
    from skinbayes.files.recipe_template import recipe_template

    if recipe is not None:
        raise InputError("--template writes a recipe; expected no --recipe beside it")
    text = recipe_template(output or "recipe.toml", files[0] if files else None)
    if output is not None:
        refuse_existing([Path(output)], overwrite)
        write_text(Path(output), text)
    if as_json:
        print_json({"file": output, "recipe": text})
        return
    say(text.rstrip("\n") if output is None else f"recipe: {output}")
    if output is not None:
        say(
            f"Next: complete what stands between “ ” in {output}; then: skinbayes reduce FILES... --recipe {output} -o FOLDER",
            err=True,
        )


def _show(reduced: ReducedRecordings) -> None:
    from skinbayes.recordings.words import recording_sentences
    from skinbayes.report.recordings_page import HEADERS, recording_row

    print_table(HEADERS, [recording_row(one) for one in reduced.recordings], right=range(1, 8))
    for one in reduced.recordings[:MOST_TOLD]:
        print_sentences(recording_sentences(one), one.name)


def document(reduced: ReducedRecordings) -> dict[str, Any]:
    """What ``--json`` prints."""
    return {
        "rows": len(reduced.rows),
        "recordings": [_recording(one, reduced.sources[one.name]) for one in reduced.recordings],
        "columns": {name: values.tolist() for name, values in reduced.dataset.columns.items()},
        "units": dict(reduced.dataset.units),
    }


def _recording(one: ReducedRecording, sha256: str) -> dict[str, Any]:
    from skinbayes.recordings.words import recording_sentences

    trend = one.trend
    return {
        "name": one.name,
        "sha256": sha256,
        "samples": one.samples,
        "duration": one.duration,
        "tangential_zero": vars(one.tangential_zero),
        "normal_zero": vars(one.normal_zero),
        "memory": one.memory,
        "period": one.period,
        "trend": None if trend is None else vars(trend),
        "strokes": [_stroke(one, row) for row in one.rows],
        "sentences": recording_sentences(one),
    }


def _stroke(one: ReducedRecording, row: FrictionRow) -> dict[str, Any]:
    return {
        "stroke": row.stroke,
        "direction": row.direction,
        "load_bin": row.load_bin,
        "from": one.times[row.start],
        "to": one.times[row.stop],
        "steady_from": one.times[row.begin],
        "steady_to": one.times[row.end],
        "friction_coefficient": row.friction_coefficient,
        "standard_error": row.standard_error,
        "own_error": row.own_error,
        "static_friction": row.static_friction_coefficient,
        "effective_samples": row.effective_samples,
        "notes": list(row.notes),
        "left_out": row.left_out or None,
        "by_recipe": row.by_recipe,
    }
