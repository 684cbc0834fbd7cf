"""Arguments and options that several commands have, and the NAME=VALUE pairs of some."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import click

from skinbayes.errors import InputError

model_argument = click.argument("model")
data_option = click.option(
    "--data",
    "given",
    multiple=True,
    metavar="FILE.csv",
    help="Your own data instead of the model's; of several experiments EXPERIMENT=FILE.csv, which can be repeated.",
)
set_option = click.option(
    "--set", "pairs", multiple=True, metavar="NAME=VALUE", help="Fix a parameter or condition, with its unit."
)
overwrite_option = click.option("--overwrite", is_flag=True, help="Overwrite the file if it exists.")
json_option = click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print one JSON document (SI values) on standard output, nothing else.",
)


def number_option(
    name: str, default: int, least: int, meaning: str, most: int | None = None
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """An option that takes a whole number."""
    return click.option(
        name, default=default, show_default=True, type=click.IntRange(least, most), help=meaning
    )


def named_values(option: str, pairs: Iterable[str], example: str) -> dict[str, str]:
    """Split the ``NAME=VALUE`` pairs of an option; :class:`InputError` for a pair without ``=`` or a name given twice."""
    found: dict[str, str] = {}
    for pair in pairs:
        name, _, value = (part.strip() for part in pair.partition("="))
        if not name or not value:
            raise InputError(f"{option} {pair[:80]}: expected NAME=VALUE, for example {option} {example}")
        if name in found:
            raise InputError(f"{option} {name}: set twice")
        found[name] = value
    return found


def settings_of(pairs: Iterable[str]) -> dict[str, str]:
    """What ``--set`` says, by name."""
    return named_values("--set", pairs, 'yield_stress="50 MPa"')


def data_of(model: str, given: tuple[str, ...]) -> Any:
    """What ``--data`` says: nothing, a file, or a file for each of several experiments by its name."""
    from skinbayes.files.joint_model import is_joint, load_joint_model

    if not given:
        return None
    if not is_joint(model):
        if len(given) > 1:
            raise InputError(
                f"--data: found {len(given)} files; expected one, as the model is of one experiment"
            )
        return given[0]
    experiments = load_joint_model(model).experiments
    for pair in given:
        if pair.partition("=")[0].strip() not in experiments:
            expected = " or ".join(f"--data {name}=FILE.csv" for name in experiments)
            raise InputError(
                f"--data {pair[:80]}: the model is of several experiments; expected which of them the data belong to: {expected}"
            )
    return named_values("--data", given, f"{next(iter(experiments))}=FILE.csv")
