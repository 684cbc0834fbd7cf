"""Model files: a statistical model written down as text, validated with named errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.modelschema import DerivedBlock, GridBlock, ModelBlock
from skinbayes.files.parameter_block import ParameterSpec, parse_parameter, parse_value
from skinbayes.files.toml_text import explain, line_of, read_toml
from skinbayes.statistics.noise import NOISE_FAMILIES
from skinbayes.vocabulary import LABELS, QUANTITIES, Quantity, suggestions

NOISE_PARAMETERS = ("noise_scale", "degrees_of_freedom", "discrepancy_factor", "discrepancy_scale")
"""Parameters that live in ``[noise]``."""


@dataclass(frozen=True)
class ModelSpec:
    """A validated model file; every number in SI.

    Attributes
    ----------
    name : the shipped name, or the stem of the file
    path : the file
    text : the file as it stands
    title, description, forward : as written
    dataset, rows, observable, spread : the data set (shipped key or path), the rows kept, the column explained, and
        whether its spread column is used; all None or empty for a model without data
    surface_name, surface_file : named surface or tabulated spectrum
    parameters : parameters of the forward model, fixed and free
    noise : name of the noise family, or None
    noise_parameters : parameters of noise and discrepancy
    derived : named products to compute afterwards
    conditions : conditions used by ``predict`` when none are given
    """

    name: str
    path: Path
    text: str
    title: str
    description: str
    forward: str
    parameters: tuple[ParameterSpec, ...]
    dataset: str | None = None
    rows: dict[str, tuple[str, ...]] = field(default_factory=dict)
    observable: str | None = None
    spread: str | None = None
    surface_name: str | None = None
    surface_file: Path | None = None
    noise: str | None = None
    noise_parameters: tuple[ParameterSpec, ...] = ()
    derived: dict[str, DerivedBlock] = field(default_factory=dict)
    conditions: dict[str, FloatArray] = field(default_factory=dict)


def find_model(name: str | Path) -> Path:
    """Return the file of a shipped model, or the given path.

    Raises :class:`InputError` naming the shipped models if there is neither.
    """
    text = str(name)
    shipped = shipped_names("models")
    if text in shipped:
        return shipped_folder("models") / f"{text}.toml"
    path = Path(text)
    try:
        if text.isprintable() and (path.exists() or path.suffix == ".toml"):
            return path
    except OSError:  # a name that no file can have
        pass
    raise InputError(
        f"no model {text[:200]!r}.{suggestions(text[:80], list(shipped))} "
        f"Shipped: {', '.join(shipped)}; or give the path of a TOML file"
    )


def load_model(name: str | Path) -> ModelSpec:
    """Read and validate a model file.

    Parameters
    ----------
    name : shipped name or path

    Raises
    ------
    InputError
        Anything unknown, missing, of the wrong type, without unit or out of range; names file, line and key.
    """
    path = find_model(name)
    content, text = read_toml(path)
    try:
        block = ModelBlock.model_validate(content)
    except ValidationError as error:
        raise InputError(explain(error, path, text, ModelBlock.model_fields)) from None

    def where(*keys: str) -> str:
        line = line_of(text, keys)
        return f"{path}{f', line {line}' if line else ''}: {'.'.join(keys)}"

    _check_printable(content, where)
    parameters = _read_parameters(block.parameters, "parameters", where, _parameter_quantity)
    data, noise = block.data, block.noise
    noise_name: str | None = None
    noise_parameters: tuple[ParameterSpec, ...] = ()
    if data is not None and noise is not None:
        noise_name, noise_parameters = _read_noise(noise, data.observable, where)
    dataset: str | None = None
    if data is not None:
        dataset = data.dataset or str((path.parent / str(data.file)).resolve())
    surface = block.surface
    surface_file = None
    if surface is not None and surface.file is not None:
        surface_file = (path.parent / surface.file).resolve()
    return ModelSpec(
        name=path.stem,
        path=path,
        text=text,
        title=block.title,
        description=block.description.strip(),
        forward=block.forward,
        parameters=parameters,
        dataset=dataset,
        rows={} if data is None else {key: tuple(levels) for key, levels in data.rows.items()},
        observable=None if data is None else data.observable,
        spread=None if data is None else data.spread,
        surface_name=None if surface is None else surface.name,
        surface_file=surface_file,
        noise=noise_name,
        noise_parameters=noise_parameters,
        derived=block.derived,
        conditions={
            key: _read_grid(key, grid, where("conditions", key)) for key, grid in block.conditions.items()
        },
    )


def _check_printable(item: Any, where: Any, keys: tuple[str, ...] = ()) -> None:
    """Refuse control characters: what a model file says is written to terminals, pages and other files."""
    if isinstance(item, dict):
        for key, value in item.items():
            _check_printable(key, where, keys)
            _check_printable(value, where, (*keys, key))
    elif isinstance(item, list):
        for value in item:
            _check_printable(value, where, keys)
    elif isinstance(item, str) and not "".join(item.split()).isprintable():
        raise InputError(f"{where(*keys)}: found {item[:60]!r}; expected printable characters only")


def _parameter_quantity(name: str, where: str) -> Quantity:
    if name in NOISE_PARAMETERS:
        raise InputError(f"{where}: '{name}' belongs into [noise]")
    if name not in QUANTITIES:
        raise InputError(f"{where}: unknown parameter '{name}'.{suggestions(name, list(QUANTITIES))}")
    return QUANTITIES[name]


def _noise_quantity(name: str, where: str) -> Quantity:
    if name not in NOISE_PARAMETERS:
        known = ["family", *NOISE_PARAMETERS]
        raise InputError(
            f"{where}: unknown key '{name}'.{suggestions(name, known)} Expected {', '.join(known)}"
        )
    return QUANTITIES[name]


def _read_parameters(
    block: dict[str, Any], table: str, where: Any, quantity_of: Any, unit: str | None = None
) -> Any:
    specs: list[ParameterSpec] = []
    for name, entry in block.items():
        place = where(table, name)
        quantity = quantity_of(name, place)
        unit_here = unit if name == "noise_scale" else None
        if not (isinstance(entry, dict) and "by" in entry):
            specs.append(parse_parameter(quantity, entry, place, unit_here))
            continue
        column = entry["by"]
        if column not in LABELS:
            raise InputError(f"{place}.by: found {column!r}; expected a grouping column: {', '.join(LABELS)}")
        levels = {key: value for key, value in entry.items() if key != "by"}
        if not levels:
            raise InputError(f"{place}: 'by = \"{column}\"' but no level is given")
        for level, value in levels.items():
            specs.append(
                parse_parameter(quantity, value, where(table, name, level), unit_here, by=column, level=level)
            )
    return tuple(specs)


def _read_noise(block: dict[str, Any], observable: str, where: Any) -> tuple[str, tuple[ParameterSpec, ...]]:
    family = block.get("family")
    names = list(NOISE_FAMILIES)
    if family not in names:
        hint = suggestions(str(family), names)
        raise InputError(
            f"{where('noise', 'family')}: found {family!r}.{hint} Expected one of {', '.join(names)}"
        )
    if observable not in QUANTITIES:
        raise InputError(
            f"{where('data', 'observable')}: unknown quantity '{observable}'.{suggestions(observable, list(QUANTITIES))}"
        )
    noise = NOISE_FAMILIES[str(family)]
    unit = "1" if noise.relative else QUANTITIES[observable].unit
    entries = {key: value for key, value in block.items() if key != "family"}
    parameters = _read_parameters(entries, "noise", where, _noise_quantity, unit)
    given = {parameter.name for parameter in parameters}
    needed = {"noise_scale", "degrees_of_freedom"} if noise.heavy_tailed else {"noise_scale"}
    if missing := sorted(needed - given):
        raise InputError(f"{where('noise')}: noise family '{family}' needs {' and '.join(missing)}")
    if "degrees_of_freedom" in given and "degrees_of_freedom" not in needed:
        raise InputError(
            f"{where('noise', 'degrees_of_freedom')}: noise family '{family}' has no degrees of freedom"
        )
    return str(family), parameters


def _read_grid(name: str, grid: GridBlock, where: str) -> FloatArray:
    if name not in QUANTITIES:
        raise InputError(f"{where}: unknown condition '{name}'.{suggestions(name, list(QUANTITIES))}")
    raw = grid.values or grid.logspace or grid.linspace or []
    numbers = [parse_value(QUANTITIES[name], item, where) for item in raw]
    if grid.logspace is not None:
        if min(numbers) <= 0:
            raise InputError(f"{where}: a 'logspace' needs values > 0")
        return np.geomspace(numbers[0], numbers[1], grid.points or 2)
    if grid.linspace is not None:
        return np.linspace(numbers[0], numbers[1], grid.points or 2)
    return np.array(numbers, dtype=float)
