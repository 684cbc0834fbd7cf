"""``digitised``: points read off a figure become a data set with reading errors."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, named_values, overwrite_option
from skinbayes.cli.output import print_json, print_sentences, print_table, say
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.files.digitised import DigitisedFile, DigitisedSet


def axis_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """What an axis of the figure shows, and how well it was read."""
    for axis, letter in (("ordinate", "y"), ("abscissa", "x")):  # the last decorator is listed first
        for option in (
            click.option(
                f"--logarithmic-{axis}", is_flag=True, help=f"The export holds log10 of the {letter} values."
            ),
            click.option(
                f"--{axis}-error",
                metavar="ERROR",
                help=f"Reading error of the {letter} axis: '2 %' of the value, or in a unit.",
            ),
            click.option(
                f"--{axis}",
                metavar="'NAME [UNIT]'",
                help=f"What the {letter} axis shows, with the unit of the axis.",
            ),
        ):
            command = option(command)
    return command


@click.command()
@click.argument("file")
@axis_options
@click.option(
    "--set-name",
    "names",
    multiple=True,
    metavar="NAME[=LABEL]",
    help="Use this data set of the export; can be repeated.",
)
@click.option(
    "--label-column", metavar="COLUMN", help="Label column that tells the data sets apart, such as liquid."
)
@click.option("--constant", "pairs", multiple=True, metavar="NAME=VALUE", help="Add a column with one value.")
@click.option(
    "--pixel-error",
    type=click.FloatRange(0, min_open=True),
    metavar="N",
    help="Reading error in pixels of a project file's picture.  [default: 1]",
)
@click.option("-o", "--output", metavar="FILE.csv", help="CSV to write, or a folder for data.csv.")
@overwrite_option
@json_option
def digitised(
    file: str,
    names: tuple[str, ...],
    label_column: str | None,
    pairs: tuple[str, ...],
    pixel_error: float | None,
    output: str | None,
    overwrite: bool,
    as_json: bool,
    **axes: Any,
) -> None:
    """Turn points digitised with WebPlotDigitizer into a data set.

    FILE is a project (JSON or tar) or a CSV export. Alone, its data sets are listed. A project holds the calibration of
    the axes, from which the reading errors follow; for a CSV state them.
    """
    from skinbayes.files.dataset import load_dataset
    from skinbayes.files.digitised import read_digitised
    from skinbayes.files.digitised_axes import parse_axis
    from skinbayes.files.digitised_columns import digitised_table
    from skinbayes.files.digitised_provenance import provenance_template

    export = read_digitised(file)
    asked = {"--abscissa": axes["abscissa"], "--ordinate": axes["ordinate"], "--output": output}
    if not any(asked.values()):
        _list(export, as_json)
        return
    if missing := [option for option, value in asked.items() if value is None]:
        raise InputError(
            f"{file}: {' and '.join(missing)} missing; expected what both axes show and where to write"
        )
    first, second = (
        parse_axis(
            axes[axis], f"--{axis}", logarithmic=axes[f"logarithmic_{axis}"], error=axes[f"{axis}_error"]
        )
        for axis in ("abscissa", "ordinate")
    )
    meanings = first, second
    sets = _chosen(export, names)
    if pixel_error is not None:
        _check_pixel_error(export, all(meaning.error is not None for meaning in meanings))
    target, described_in = _targets(str(output))
    if target.exists() and target.samefile(export.path):
        raise InputError(f"{target}: this is the export itself; expected another file to write")
    constants = named_values("--constant", pairs, 'sphere_radius="8 mm"')
    table = digitised_table(
        sets,
        meanings,
        str(export.path),
        pixel_error=pixel_error or 1.0,
        label_column=label_column,
        constants=constants,
    )
    refuse_existing([target, described_in], overwrite)
    write_text(target, table.csv_text())
    sha256 = load_dataset(target).sha256  # as any data set
    kept = described_in.exists()
    if not kept:
        chosen = [one.name for one in sets.values()]
        write_text(described_in, provenance_template(export, chosen, meanings, table, constants, sha256))
    rows = {label: len(one.places) for label, one in sets.items()}
    if as_json:
        print_json({
            "file": str(target), "provenance": str(described_in), "provenance_kept": kept, "sha256": sha256,
            "source": export.kind, "rows": sum(rows.values()), "sets": rows, "errors": list(table.errors),
            "units": dict(table.units), "columns": dict(table.columns),
        })  # fmt: skip
        return
    say(f"data:       {target} ({sum(rows.values())} rows)")
    say(f"provenance: {described_in} ({'kept as it was' if kept else 'to be completed'})\n")
    print_sentences(table.errors, "Reading errors, one standard deviation")
    if kept:
        say(f"\nThe sha256 of the data is now {sha256}; the provenance has to say so.")


def _list(export: DigitisedFile, as_json: bool) -> None:
    sets = [
        {
            "name": one.name,
            "points": len(one.places),
            "minimum": one.values.min(axis=0),
            "maximum": one.values.max(axis=0),
            "axes": None
            if one.axes is None
            else ["log" if flag else "linear" for flag in one.axes.logarithmic],
        }
        for one in export.sets
    ]
    if as_json:
        print_json(
            {"file": str(export.path), "source": export.kind, "sets": sets, "left_out": dict(export.left_out)}
        )
        return
    say(f"{export.path}: {export.kind}")
    rows = [
        (
            one["name"],
            str(one["points"]),
            *(f"{low:.4g} to {high:.4g}" for low, high in zip(one["minimum"], one["maximum"], strict=True)),
            ", ".join(one["axes"] or ["not known"]),
        )
        for one in sets
    ]
    print_table(("data set", "points", "abscissa", "ordinate", "axes"), rows, right=(1,))
    if export.left_out:
        print_sentences(
            [f"{name or 'without name'}: {why}" for name, why in export.left_out.items()], "Not usable"
        )


def _chosen(export: DigitisedFile, names: tuple[str, ...]) -> dict[str, DigitisedSet]:
    """Label to data set. ``NAME=LABEL`` is split at the last equals sign, unless a data set has that very name."""
    known = {one.name for one in export.sets} | set(export.left_out)
    wanted: list[tuple[str, str]] = []
    for text in names:
        name, equals, label = text.rpartition("=")
        wanted.append((name.strip(), label.strip()) if equals and text not in known else (text, text))
    sets = export.select([name for name, _ in wanted])
    labels = [label for _, label in wanted] or [one.name for one in sets]
    if len(set(labels)) < len(labels):
        raise InputError(
            f"{export.path}: two data sets have the same label; expected different ones: --set-name NAME=LABEL"
        )
    return dict(zip(labels, sets, strict=True))


def _check_pixel_error(export: DigitisedFile, all_stated: bool) -> None:
    if all_stated:
        raise InputError(
            "--pixel-error: the errors of both axes are stated as well; expected one or the other"
        )
    if any(one.axes is None for one in export.sets):
        raise InputError(
            f"--pixel-error: {export.path} is a CSV, which holds no pixels; expected --abscissa-error and --ordinate-error"
        )


def _targets(output: str) -> tuple[Path, Path]:
    """The CSV and its provenance; a folder gets both under the names that make it a data set."""
    path = Path(output)
    if path.suffix.lower() != ".csv":
        if path.suffix or path.is_file():
            raise InputError(
                f"--output: found {output[:200]}; expected a file that ends in .csv, or a folder"
            )
        path = path / "data.csv"
    name = "provenance.toml" if path.name == "data.csv" else f"{path.stem}.provenance.toml"
    return path, path.with_name(name)
