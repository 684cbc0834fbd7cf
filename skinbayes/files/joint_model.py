"""Model files of several experiments on one skin: a table for each experiment, parameters for all of them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec, find_model, read_block, read_parameters
from skinbayes.files.modelschema import ExperimentBlock, JointBlock, ModelBlock
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.population_block import read_populations
from skinbayes.files.stated_surface import StatedSurface, stated_about
from skinbayes.files.toml_text import Places, read_tables, read_toml, shortened
from skinbayes.plugins import installed_forward_models

EXPERIMENTS = "experiments"
"""Table of a model file by which it is one of several experiments."""

EXPERIMENT = "experiment"
"""What parameters differ by that are not the same in all experiments."""


@dataclass(frozen=True)
class JointSpec:
    """A validated model file of several experiments; every number in SI.

    Attributes
    ----------
    name, path, text, title, description : as those of a :class:`~skinbayes.files.modelfile.ModelSpec`
    experiments : name to what a model file of this experiment alone would say, without parameters and surface
    parameters : inputs of the forward models: shared by all experiments that take them, or one for each experiment
    surface_name, surface_file : named surface or tabulated spectrum
    surface_stated : what is said about the spectrum
    surface_posterior : run, or CSV, whose draws say what is known of the surface
    """

    name: str
    path: Path
    text: str
    title: str
    description: str
    experiments: Mapping[str, ModelSpec]
    parameters: tuple[ParameterSpec, ...]
    surface_name: str | None = None
    surface_file: Path | None = None
    surface_stated: StatedSurface | None = None
    surface_posterior: Path | None = None

    @property
    def shared(self) -> frozenset[str]:
        """Names of the parameters that are the same in all experiments."""
        return frozenset(p.name for p in self.parameters if p.by != EXPERIMENT)

    @property
    def baseline_models(self) -> tuple[str, ...]:
        """None: baseline models explain the data of one experiment."""
        return ()


def is_joint(name: str | Path) -> bool:
    """Whether a model file is one of several experiments; raises what reading it raises."""
    return EXPERIMENTS in read_toml(find_model(name))[0]


def load_joint_model(name: str | Path) -> JointSpec:
    """Read and validate a model file of several experiments; :class:`InputError` as `load_model` raises it."""
    installed_forward_models()  # whose quantities the file may name
    path = find_model(name)
    content, text = read_toml(path)
    return read_joint_model(content, path, text)


def read_joint_model(content: Mapping[str, Any], path: Path, text: str) -> JointSpec:
    """Validate the content of a model file of several experiments.

    Parameters
    ----------
    content : tables and values, as TOML has them
    path : the file, or a name that stands for it in messages
    text : the file as it stands, in which messages count lines
    """
    return read_tables(JointBlock, content, path, text, _read)


def _read(block: JointBlock, path: Path, text: str, where: Places) -> JointSpec:
    names = list(block.experiments)
    if len(names) < 2:
        raise InputError(
            f"{where(EXPERIMENTS)}: found {len(names)} experiment; expected at least two: the tables of a single one stand at "
            "the top of the file"
        )
    if odd := next((name for name in names if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name)), None):
        raise InputError(
            f"{where(EXPERIMENTS, odd)}: found {shortened(odd)!r}; expected a name of letters, digits, '_' and '-' that begins "
            "with a letter"
        )
    surface = block.surface
    if populations := read_populations(block.parameters, where):
        raise InputError(
            f"{where('parameters', populations[0].name, 'population')}: populations are for models of one experiment; give "
            "one value for all, or one for each level"
        )
    parameters = read_parameters(block.parameters, where)
    for p in parameters:
        if p.by == EXPERIMENT and p.level not in names:
            raise InputError(
                f"{where('parameters', p.name, str(p.level))}: no experiment {shortened(str(p.level))!r}; expected "
                f"{' or '.join(names)}"
            )
    return JointSpec(
        name=path.stem,
        path=path,
        text=text,
        title=block.title,
        description=block.description.strip(),
        experiments={name: _experiment(name, block, path, text, where) for name in names},
        parameters=parameters,
        surface_name=None if surface is None else surface.name,
        surface_file=None
        if surface is None or surface.file is None
        else (path.parent / surface.file).resolve(),
        surface_stated=stated_about(surface, where),
        surface_posterior=None
        if surface is None or surface.posterior is None
        else (path.parent / surface.posterior).resolve(),
    )


def _experiment(name: str, block: JointBlock, path: Path, text: str, where: Places) -> ModelSpec:
    """One experiment as a model of its own, still without parameters."""
    one = block.experiments[name]
    tables = {key: getattr(one, key) for key in ExperimentBlock.model_fields}
    alone = ModelBlock.model_validate({"title": f"{block.title}: {name}", "parameters": {}, **tables})
    found = read_block(alone, path, text, lambda *keys: where(EXPERIMENTS, name, *keys))
    return replace(found, name=f"{path.stem}, {name}")
