"""``fit --each``: one model, many data sets."""

from __future__ import annotations

from glob import glob
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.cli.options import data_of, settings_of
from skinbayes.cli.output import (
    EXIT_DONE,
    EXIT_INTERRUPTED,
    EXIT_NOT_CONVERGED,
    print_json,
    print_sentences,
    print_table,
    say,
)
from skinbayes.cli.runs import RUNS
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.each import EachFit

FILE = "file"
"""What ``--each`` says if each file is a data set."""

MOST_LISTED = 10
"""Fits listed that did not converge or ended in an error."""


def print_each(
    model: str,
    each: str,
    given: tuple[str, ...],
    pairs: tuple[str, ...],
    output: str | None,
    options: dict[str, Any],
    as_json: bool,
) -> int:
    """Fit many data sets and print what came of it; returns the exit status."""
    from skinbayes.cli.progress import counted_progress
    from skinbayes.each import fit_each, problems_of_each
    from skinbayes.files.modelfile import find_model

    what: dict[str, Any]
    if each == FILE:
        what = {"data": _files(given)}
    else:
        data = data_of(model, given)
        what = {"data": data, "table" if each.endswith(".csv") else "column": each}
    problems = problems_of_each(model, **what, settings=settings_of(pairs))
    named = Path(each).stem
    directory = (
        Path(output) if output else RUNS / f"{find_model(model).stem}-each-{named}-seed{options['seed']}"
    )
    try:
        with counted_progress("tables") as preparing, counted_progress("fits") as progress:
            result = fit_each(
                problems, **options, directory=directory, progress=progress, preparing=preparing
            )
    except KeyboardInterrupt:
        say(f"interrupted; the fits so far are in {directory}. Repeat the command to go on.", err=True)
        return EXIT_INTERRUPTED
    if as_json:
        print_json(_document(result, directory))
    else:
        _print(result, directory)
    return EXIT_DONE if result.converged else EXIT_NOT_CONVERGED


def _files(given: tuple[str, ...]) -> list[str]:
    """The files that ``--data`` names, patterns written out."""
    if not given:
        raise InputError(f"--each {FILE}: expected the files, --data 'FOLDER/*.csv'")
    files: list[str] = []
    for pattern in given:
        found = [pattern] if Path(pattern).exists() else sorted(glob(pattern, recursive=True))  # noqa: PTH207 - it may be absolute
        if not found:
            raise InputError(
                f"--data {pattern}: no such file; expected files, or a pattern such as 'FOLDER/*.csv'"
            )
        files += found
    return list(dict.fromkeys(files))


def _print(result: EachFit, directory: Path) -> None:
    from skinbayes.each.result import TABLE
    from skinbayes.units import format_quantity

    table, units = result.table(), result.units()
    rows = []
    for label, unit in units.items():
        middles = table[label].dropna()
        values = [format_quantity(float(middles.quantile(share)), unit) for share in (0.5, 0.05, 0.95)]
        wide = (table[f"{label}_q95"] / table[f"{label}_q05"]).median()
        rows.append([label, *values, f"{wide:.3g}" if (table[f"{label}_q05"].dropna() > 0).all() else ""])
    if rows:
        headers = ("medians of the fits", "middle", "5 %", "95 %", "95 %/5 % in one fit")
        print_table(
            headers, rows, title=f"{result.model}, {len(result.fits):,} fits", right=range(1, len(headers))
        )
    print_sentences([result.sentence()])
    open_ = [one for one in result.fits if not one.converged]
    for one in open_[:MOST_LISTED]:
        say(f"  {one.name}: {one.failure or one.verdict}")
    if len(open_) > MOST_LISTED:
        say(f"  and {len(open_) - MOST_LISTED} more, see the table")
    say(f"results: {directory / TABLE}")


def _document(result: EachFit, directory: Path) -> dict[str, Any]:
    return {
        "run": str(directory),
        "model": result.model,
        "converged": result.converged,
        "sentence": result.sentence(),
        "units": result.units(),
        "fits": [one.to_dict() for one in result.fits],
    }
