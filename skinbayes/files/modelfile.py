"""Model files: a statistical model written down as text, validated with named errors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.group_block import CovariateSpec, read_covariates, read_groups
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.files.modelschema import DataBlock, DerivedBlock, GridBlock, ModelBlock, RheologyBlock
from skinbayes.files.noise_block import noise_parameter_names, read_noise
from skinbayes.files.parameter_block import ParameterSpec, label_column, parse_levels, parse_value
from skinbayes.files.population_block import (
    POPULATION_PARAMETERS,
    PopulationSpec,
    location_entry,
    read_populations,
)
from skinbayes.files.scatter_block import (
    SCATTER_PARAMETERS,
    CorrelationSpec,
    DiscrepancySpec,
    read_correlation,
    read_discrepancy,
)
from skinbayes.files.stated_surface import StatedSurface, stated_about
from skinbayes.files.toml_text import read_tables, read_toml, shortened
from skinbayes.plugins import installed_forward_models
from skinbayes.vocabulary import LABELS, QUANTITIES, Quantity, suggestions


@dataclass(frozen=True)
class ModelSpec:
    """A validated model file; every number in SI.

    Attributes
    ----------
    name : the shipped name, or the stem of the file
    path : the file
    text : the file as it stands
    title, description, forward : as written
    options : of the forward model, as written
    dataset, rows, observables : the data set (shipped key or path; None if the user brings it), the rows kept, the columns
        explained (empty for a model without data)
    spread, input_spread : whether spread columns of the observables, and of the inputs, are used; None if not said
    missing : ``"drop"`` if rows without a value in a column that is used are left out
    surface_name, surface_file : named surface or tabulated spectrum
    surface_stated : what is said about the spectrum
    surface_posterior : run, or CSV, whose draws say what is known of the surface
    parameters : parameters of the forward model, fixed and free; of one with a population its median
    populations : parameters that differ from level to level of a label column as a population does
    noise : observable to the name of its noise family
    noise_parameters : parameters of noise and discrepancy
    groups : scales of group effects, ``group_scale[person]``
    discrepancy, correlation : smooth curves that the theory misses, and how noise is correlated; None without them
    covariates, covariate_exponents : columns that act as a power on an input or the observable, and their exponents
    rheology, rheology_by : data set of flow curves (shipped key or path) and the grouping column they belong to, or None
    derived : named products to compute afterwards
    conditions : conditions used by ``predict`` when none are given
    baseline_models : models beside which a fit is always shown, shipped names or paths
    """

    name: str
    path: Path
    text: str
    title: str
    description: str
    forward: str
    parameters: tuple[ParameterSpec, ...]
    options: dict[str, str] = field(default_factory=dict)
    dataset: str | None = None
    rows: dict[str, tuple[str, ...]] = field(default_factory=dict)
    observables: tuple[str, ...] = ()
    spread: str | None = None
    input_spread: str | None = None
    missing: str | None = None
    surface_name: str | None = None
    surface_file: Path | None = None
    surface_stated: StatedSurface | None = None
    surface_posterior: Path | None = None
    noise: dict[str, str] = field(default_factory=dict)
    noise_parameters: tuple[ParameterSpec, ...] = ()
    groups: tuple[ParameterSpec, ...] = ()
    discrepancy: DiscrepancySpec | None = None
    correlation: CorrelationSpec | None = None
    covariates: tuple[CovariateSpec, ...] = ()
    covariate_exponents: tuple[ParameterSpec, ...] = ()
    populations: tuple[PopulationSpec, ...] = ()
    rheology: str | None = None
    rheology_by: str | None = None
    derived: dict[str, DerivedBlock] = field(default_factory=dict)
    conditions: dict[str, FloatArray | NDArray[np.str_]] = field(default_factory=dict)
    baseline_models: tuple[str, ...] = ()

    @property
    def shipped(self) -> bool:
        """Whether it is one of the models that come with skinbayes."""
        return self.path.parent == shipped_folder("models")


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
    installed_forward_models()  # whose quantities the file may name
    path = find_model(name)
    content, text = read_toml(path)
    return read_model(content, path, text)


def read_model(content: Mapping[str, Any], path: Path, text: str) -> ModelSpec:
    """Validate the content of a model file.

    Parameters
    ----------
    content : tables and values, as TOML has them
    path : the file, or a name that stands for it in messages
    text : the file as it stands, in which messages count lines

    Raises
    ------
    InputError
        as :func:`load_model`
    """
    return read_tables(ModelBlock, content, path, text, read_block)


def read_block(block: ModelBlock, path: Path, text: str, where: Callable[..., str]) -> ModelSpec:
    """A model of its tables; ``where`` gives the place of a key, for messages."""
    if broken := installed_forward_models()[1].get(block.forward):
        raise InputError(f"{where('forward')}: the forward model '{block.forward}' is {broken}")
    data, surface, rheology = block.data, block.surface, block.rheology
    families: dict[str, str] = {}
    noise_parameters: tuple[ParameterSpec, ...] = ()
    of_data: dict[str, Any] = {}
    if data is not None and block.noise is not None:
        names, several = data.names(), data.observables is not None
        families, noise_parameters = read_noise(block.noise.model_extra or {}, names, several, where)
        rows = {key: tuple(levels) for key, levels in data.rows.items()}
        of_data = data.model_dump(include={"spread", "input_spread", "missing"})
        of_data |= {"observables": tuple(names), "rows": rows}
        of_data["correlation"] = read_correlation(
            block.noise.correlation, families, noise_parameters, (data.spread, data.input_spread), where
        )
    covariates, exponents = read_covariates(block.covariates, where)

    def resolved(table: DataBlock | RheologyBlock | None) -> str | None:
        if table is None or table.file is None:
            return None if table is None else table.dataset
        return str((path.parent / table.file).resolve())

    if rheology is not None:
        label_column(rheology.by, where("rheology", "by"))
    return ModelSpec(
        name=path.stem,
        path=path,
        text=text,
        title=block.title,
        description=block.description.strip(),
        forward=block.forward,
        options=block.options,
        parameters=read_parameters(block.parameters, where),
        dataset=resolved(data),
        surface_name=None if surface is None else surface.name,
        surface_file=None
        if surface is None or surface.file is None
        else (path.parent / surface.file).resolve(),
        surface_stated=stated_about(surface, where),
        surface_posterior=None
        if surface is None or surface.posterior is None
        else (path.parent / surface.posterior).resolve(),
        noise=families,
        noise_parameters=noise_parameters,
        groups=read_groups(block.groups, families, where),
        discrepancy=read_discrepancy(block.discrepancy, families, where),
        covariates=covariates,
        covariate_exponents=exponents,
        populations=read_populations(block.parameters, where),
        rheology=resolved(rheology),
        rheology_by=None if rheology is None else rheology.by,
        derived=block.derived,
        conditions={
            key: _read_grid(key, grid, where("conditions", key)) for key, grid in block.conditions.items()
        },
        baseline_models=_read_baseline_models(block, path, where("baseline_models")),
        **of_data,
    )


def _read_baseline_models(block: ModelBlock, path: Path, where: str) -> tuple[str, ...]:
    """Shipped names as they are, paths relative to the model file; whether a file is there is seen when it is used."""
    shipped = shipped_names("models")
    found = []
    for text in block.baseline_models:
        if text not in shipped and Path(text).suffix != ".toml":
            raise InputError(
                f"{where}: no model {text[:80]!r}.{suggestions(text[:80], list(shipped))} Expected a shipped model, or the path "
                "of a TOML file relative to this one"
            )
        found.append(text if text in shipped else str((path.parent / text).resolve()))
    stems = [Path(name).stem for name in found]
    if len({path.stem, *stems}) <= len(stems):
        raise InputError(
            f"{where}: found {', '.join(block.baseline_models)}; expected other models than '{path.stem}', each once"
        )
    if found and block.data is None:
        raise InputError(f"{where}: a model without data has nothing to be compared on; leave them out")
    return tuple(found)


def _parameter_quantity(name: str, where: str) -> Quantity:
    if name in noise_parameter_names():
        raise InputError(f"{where}: '{name}' belongs into [noise]")
    if name in SCATTER_PARAMETERS:
        raise InputError(f"{where}: '{name}' belongs into [groups], [discrepancy] or [noise.correlation]")
    if name in POPULATION_PARAMETERS:
        raise InputError(f"{where}: '{name}' belongs into the 'population' of a parameter")
    if name not in QUANTITIES:
        raise InputError(
            f"{where}: unknown parameter '{shortened(name)}'.{suggestions(name, list(QUANTITIES))}"
        )
    return QUANTITIES[name]


def read_parameters(block: dict[str, Any], where: Callable[..., str]) -> tuple[ParameterSpec, ...]:
    """Read ``[parameters]``; ``where`` gives the place of a key, for messages."""
    specs: list[ParameterSpec] = []
    for name, entry in block.items():
        quantity = _parameter_quantity(name, where("parameters", name))

        def place(*keys: str, name: str = name) -> str:
            return str(where("parameters", name, *keys))

        specs += parse_levels(quantity, location_entry(entry), place, may_be_tied=True)
    return tuple(specs)


def _read_grid(name: str, grid: GridBlock, where: str) -> FloatArray | NDArray[np.str_]:
    if name in LABELS:
        if grid.values is None or not all(isinstance(item, str) for item in grid.values):
            raise InputError(f"{where}: '{name}' is a label; expected values = [\"…\", …]")
        return np.array(grid.values, dtype=np.str_)
    if name not in QUANTITIES:
        raise InputError(
            f"{where}: unknown condition '{shortened(name)}'.{suggestions(name, list(QUANTITIES))}"
        )
    raw = grid.values or grid.logspace or grid.linspace or []
    numbers = [parse_value(QUANTITIES[name], item, where) for item in raw]
    if grid.logspace is not None:
        if min(numbers) <= 0:
            raise InputError(f"{where}: a 'logspace' needs values > 0")
        return np.geomspace(numbers[0], numbers[1], grid.points or 2)
    if grid.linspace is not None:
        return np.linspace(numbers[0], numbers[1], grid.points or 2)
    return np.array(numbers, dtype=float)
