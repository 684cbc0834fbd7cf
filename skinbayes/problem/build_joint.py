"""Problems of several experiments from values of Python."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.joint_model import EXPERIMENTS, read_joint_model
from skinbayes.files.noise_block import unusable_noise_families
from skinbayes.files.surface_draws import SurfaceDraws
from skinbayes.files.toml_text import toml_text
from skinbayes.forward import ForwardModel, forward_model
from skinbayes.problem.build import common_tables, tables_of
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.joint_bind import bind_joint
from skinbayes.problem.rows import selected_dataset
from skinbayes.roughness import TabulatedSpectrum


def build_joint_problem(
    experiments: Mapping[str, Mapping[str, Any]],
    *,
    parameters: Mapping[str, Any],
    surface: str | Path | TabulatedSpectrum | SurfaceDraws | None = None,
    name: str = "my-model",
    title: str = "",
    description: str = "",
) -> JointProblem:
    """Make one problem of several experiments on one skin, from values.

    Parameters
    ----------
    experiments : name to ``forward``, ``data``, ``noise`` and whatever else :func:`build_problem` takes for one experiment:
        ``observable``, ``rows``, ``spread``, ``input_spread``, ``missing``, ``groups``, ``discrepancy``, ``covariates``,
        ``rheology``, ``derived``, ``options``
    parameters : as for :func:`build_problem`; each is shared by all experiments that take it, unless it is
        ``{"by": "experiment", "friction": …, "indentation": …}``
    surface : of all experiments that have a rough surface, as for :func:`build_problem`
    name, title, description : what the problem is called, and what it is about

    Returns
    -------
    JointProblem

    Raises
    ------
    InputError
        Anything that does not fit together; the message names experiment, argument and key.

    Examples
    --------
    >>> problem = build_joint_problem(
    ...     {
    ...         "press": {
    ...             "forward": "indentation",
    ...             "data": {"indentation_depth": [2e-4, 4e-4], "sphere_radius": [2e-3, 2e-3], "indentation_force": [4e-3, 0.01]},
    ...             "noise": {"family": "lognormal", "noise_scale": 0.1},
    ...         },
    ...         "slide": {
    ...             "forward": "constant",
    ...             "data": {"friction_coefficient": [0.4, 0.5]},
    ...             "noise": {"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
    ...         },
    ...     },
    ...     parameters={"young_modulus_bulk": {"lognormal": ["20 kPa", 1.0]}, "typical_friction_coefficient": 0.45},
    ... )
    >>> problem.names
    ('young_modulus_bulk', 'noise_scale[slide]')
    """
    unusable_noise_families()  # makes those that can be used known
    models: dict[str, ForwardModel] = {}
    data: dict[str, Dataset] = {}
    curves: dict[str, Dataset] = {}
    tables: dict[str, Any] = {}
    for key, given in experiments.items():
        one = dict(given)
        if missing := [word for word in ("forward", "data", "noise") if word not in one]:
            raise InputError(f"{name}: {EXPERIMENTS}.{key}: {missing[0]} is missing")
        forward = one.pop("forward")
        models[key] = forward_model(forward) if isinstance(forward, str) else forward
        try:
            tables[key], dataset, flow = tables_of(models[key], one.pop("data"), f"{name}-{key}", **one)
        except TypeError as error:
            raise InputError(f"{name}: {EXPERIMENTS}.{key}: {error}") from None
        if dataset is not None:
            data[key] = dataset
        if flow is not None:
            curves[key] = flow
    content: dict[str, Any] = {"format": 1, "title": title or name, "description": description}
    content |= {EXPERIMENTS: tables, **common_tables(name, surface, parameters)}
    spec = replace(read_joint_model(content, Path(name), ""), text=toml_text(content))
    spectrum = surface if isinstance(surface, TabulatedSpectrum | SurfaceDraws) else None
    chosen = {key: selected_dataset(spec.experiments[key], dataset) for key, dataset in data.items()}
    return bind_joint(spec, chosen, forwards=models, surface=spectrum, rheologies=curves)
