"""A table of settings: a line for each fit."""

from __future__ import annotations

from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.table import quoted, read_table

NAME = "name"
"""Column that says what a line is called."""


def read_settings(path: Path) -> dict[str, dict[str, str]]:
    """Lines of a table of settings.

    Parameters
    ----------
    path : a CSV whose columns are parameters, conditions or options of a model: numbers with the unit in the header
        (``young_modulus_bulk [kPa]``), or text with its unit in each cell. An empty cell leaves the model's own

    Returns
    -------
    dict
        Name of each line, from the column ``name`` or its number, to what it sets, as text with unit.

    Raises
    ------
    InputError
        The file cannot be read, two lines have the same name, a line sets nothing, or two columns are of the same name.
    """
    table = read_table(path)
    keys = [header.partition("[") for header in table.header]
    names = [key.strip() for key, _, _ in keys]
    units = [unit.strip().removesuffix("]").strip() for _, _, unit in keys]
    if twice := sorted({key for key in names if names.count(key) > 1}):
        raise InputError(f"{table.header_place}: column {quoted(twice[0])} twice; expected each once")
    if set(names) <= {NAME}:
        raise InputError(
            f"{table.header_place}: no column of settings; expected some, such as 'young_modulus_bulk [kPa]'"
        )
    found: dict[str, dict[str, str]] = {}
    for count, (line, cells) in enumerate(zip(table.lines, table.rows, strict=True), 1):
        given = {
            key: f"{cell.strip()} {unit}".strip()
            for key, unit, cell in zip(names, units, cells, strict=True)
            if cell.strip()
        }
        name = given.pop(NAME, str(count))
        if name in found:
            raise InputError(
                f"{path}, line {line}: a second line is called {quoted(name)}; expected a name of its own"
            )
        if not given:
            raise InputError(f"{path}, line {line}: sets nothing; expected a value in at least one column")
        found[name] = given
    return found
