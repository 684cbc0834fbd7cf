"""Problems from values of Python: no file is needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.files.dataset import Dataset, as_dataset
from skinbayes.files.locate import shipped_names
from skinbayes.files.modelfile import read_model
from skinbayes.files.noise_block import unusable_noise_families
from skinbayes.files.surface_draws import SurfaceDraws, holds_draws
from skinbayes.files.toml_text import toml_text
from skinbayes.files.written import written_parameter, written_value
from skinbayes.forward import ForwardModel, forward_model
from skinbayes.problem.bind import bind
from skinbayes.problem.problem import Problem
from skinbayes.problem.rows import selected_dataset
from skinbayes.roughness import SURFACES, TabulatedSpectrum
from skinbayes.statistics.noise_families import NOISE_FAMILIES
from skinbayes.vocabulary import QUANTITIES


def build_problem(
    forward: str | ForwardModel,
    data: Any = None,
    *,
    parameters: Mapping[str, Any],
    noise: Mapping[str, Any] | None = None,
    observable: str | Sequence[str] | None = None,
    rows: Mapping[str, Sequence[str]] | None = None,
    spread: str | None = None,
    input_spread: str | None = None,
    missing: str | None = None,
    surface: str | Path | TabulatedSpectrum | SurfaceDraws | None = None,
    groups: Mapping[str, Any] | None = None,
    discrepancy: Mapping[str, Any] | None = None,
    covariates: Mapping[str, Mapping[str, Any]] | None = None,
    rheology: Mapping[str, Any] | None = None,
    derived: Mapping[str, Mapping[str, Any]] | None = None,
    conditions: Mapping[str, Any] | None = None,
    options: Mapping[str, str] | None = None,
    name: str = "my-model",
    title: str = "",
    description: str = "",
) -> Problem:
    """Make a problem of values; the arguments are the tables of a model file.

    Every number is one in SI, a quantity of `pint`, or text with a unit. :meth:`Problem.to_toml` writes the model file.

    Parameters
    ----------
    forward : a forward model, or the name of one
    data : what was measured: a pandas data frame or a mapping of arrays with headers as a CSV has them, a
        :class:`~skinbayes.Dataset`, the name of a shipped data set, or the path of a CSV; None for a model that only predicts
    parameters : name to a fixed value, or to a prior such as ``{"lognormal": ["15 MPa", 0.5], "source": "…"}``, or to one of
        these for each level: ``{"by": "state", "dry": …, "wet": …}``; or to a multiple of another parameter:
        ``{"same_as": "young_modulus_layer", "times": 0.5}``
    noise : its ``family`` and parameters, and a ``correlation`` if rows follow each other; with several observables one such
        mapping for each
    observable : column (or columns) that the model explains; the first of the forward model if not given
    rows : label column to the labels of the rows that are used
    spread, input_spread : ``"use"`` or ``"ignore"`` the columns ``…_standard_deviation`` of observables, and of inputs
    missing : ``"drop"`` to leave out rows without a value in a column that is used
    surface : a named surface, the path of a spectrum, a spectrum, or what an earlier fit found: the path of its run, or
        ``fit.surface()``
    groups : label column to the prior of the scale of the effects that its rows share
    discrepancy : ``along`` which column or columns the theory misses smooth curves; ``within`` which label, on which ``axis``,
        and the priors of ``size`` and ``length`` if they are not the usual ones
    covariates : name to ``column``, ``acts_on``, ``reference`` and ``exponent``
    rheology : ``by`` (a label column) and ``data``, flow curves of the liquids, in any form that data have
    derived : name to ``product`` and, if wanted, ``rows``, ``symbol``, ``meaning``
    conditions : inputs at which a model without data is evaluated, each a list of values
    options : options of the forward model, such as ``{"closure": "sharp"}``
    name, title, description : what the problem is called, and what it is about

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Anything that does not fit together; the message names the argument and key.

    Examples
    --------
    >>> problem = build_problem(
    ...     "constant",
    ...     {"friction_coefficient": [0.31, 0.27, 0.33]},
    ...     parameters={"typical_friction_coefficient": {"lognormal": [0.5, 1.0], "source": "weak on purpose"}},
    ...     noise={"family": "lognormal", "noise_scale": {"half_normal": 0.3}},
    ... )
    >>> problem.names, problem.dimension
    (('typical_friction_coefficient', 'noise_scale'), 2)
    """
    unusable_noise_families()  # makes those that can be used known
    model = forward_model(forward) if isinstance(forward, str) else forward
    tables, dataset, curves = tables_of(
        model, data, name, noise=noise, observable=observable, rows=rows, spread=spread, input_spread=input_spread,
        missing=missing, groups=groups, discrepancy=discrepancy, covariates=covariates, rheology=rheology, derived=derived,
        options=options,
    )  # fmt: skip
    content: dict[str, Any] = {"format": 1, "title": title or name, "description": description, **tables}
    content |= common_tables(name, surface, parameters)
    content["conditions"] = {
        key: {"values": [written_value(v, _unit(key), f"{name}: conditions.{key}") for v in np.atleast_1d(values).tolist()]}
        for key, values in (conditions or {}).items()
    }  # fmt: skip
    spec = replace(read_model(content, Path(name), ""), text=toml_text(content))
    dataset = None if dataset is None else selected_dataset(spec, dataset)
    spectrum = surface if isinstance(surface, TabulatedSpectrum | SurfaceDraws) else None
    return bind(spec, dataset, forward=model, surface=spectrum, rheology=curves)


def common_tables(
    name: str, surface: str | Path | TabulatedSpectrum | SurfaceDraws | None, parameters: Mapping[str, Any]
) -> dict[str, Any]:
    """``[surface]`` and ``[parameters]`` of a model file from values."""
    content: dict[str, Any] = {}
    if isinstance(surface, TabulatedSpectrum):
        content["surface"] = {"file": f"{name}-spectrum.csv"}
    elif isinstance(surface, SurfaceDraws):
        content["surface"] = {"posterior": str(surface.file or f"{name}-surface.csv")}
    elif surface is not None:
        kind = "name" if str(surface) in SURFACES else "posterior" if holds_draws(Path(surface)) else "file"
        content["surface"] = {kind: str(surface)}
    content["parameters"] = {
        key: written_parameter(entry, _unit(key), f"{name}: parameters.{key}")
        for key, entry in parameters.items()
    }
    return content


def tables_of(
    model: ForwardModel,
    data: Any,
    name: str,
    *,
    noise: Mapping[str, Any] | None = None,
    observable: str | Sequence[str] | None = None,
    rows: Mapping[str, Sequence[str]] | None = None,
    spread: str | None = None,
    input_spread: str | None = None,
    missing: str | None = None,
    groups: Mapping[str, Any] | None = None,
    discrepancy: Mapping[str, Any] | None = None,
    covariates: Mapping[str, Mapping[str, Any]] | None = None,
    rheology: Mapping[str, Any] | None = None,
    derived: Mapping[str, Mapping[str, Any]] | None = None,
    options: Mapping[str, str] | None = None,
) -> tuple[dict[str, Any], Dataset | None, Dataset | None]:
    """The tables of one experiment from values, as `build_problem` takes them; its data, and its flow curves."""
    observables = _observables(model, observable)
    several = not (observable is None or isinstance(observable, str))
    dataset = None if data is None else _as_dataset(data, f"{name}-data")
    content: dict[str, Any] = {"forward": model.name}
    content["options"] = dict(options or {})
    if dataset is not None:
        content["data"] = _without_none({
            **_source(data, dataset), "observables" if several else "observable": observables if several else observables[0],
            "rows": None if rows is None else {key: list(levels) for key, levels in rows.items()},
            "spread": spread,
            "input_spread": input_spread, "missing": missing,
        })  # fmt: skip
    if noise is not None:
        places = {one: noise.get(one, {}) for one in observables} if several else {observables[0]: noise}
        blocks = {one: _noise(one, block, f"{name}: noise") for one, block in places.items()}
        content["noise"] = blocks if several else blocks[observables[0]]
    unit = _noise_unit(observables[0], content.get("noise", {})) if observables and not several else "1"
    content["groups"] = {
        column: {"scale": written_parameter(_scale(entry), unit, f"{name}: groups.{column}")}
        for column, entry in (groups or {}).items()
    }
    if discrepancy is not None:
        units = {"size": unit, "length": "1"}
        content["discrepancy"] = {
            key: written_parameter(entry, units[key], f"{name}: discrepancy.{key}") if key in units else entry
            for key, entry in discrepancy.items()
        }
    content["covariates"] = {
        key: {
            **block,
            "reference": written_value(block.get("reference"), _unit(str(block.get("column"))), f"{name}: covariates.{key}"),
            "exponent": written_parameter(block.get("exponent"), "1", f"{name}: covariates.{key}"),
        }
        for key, block in (covariates or {}).items()
    }  # fmt: skip
    curves = None
    if rheology is not None:
        given = rheology.get("data")
        curves = _as_dataset(given, f"{name}-rheology")
        content["rheology"] = {**_source(given, curves), "by": rheology.get("by")}
    content["derived"] = {key: dict(block) for key, block in (derived or {}).items()}
    return content, dataset, curves


def _observables(model: ForwardModel, given: str | Sequence[str] | None) -> list[str]:
    if given is None:
        return list(model.observables[:1])
    return [given] if isinstance(given, str) else list(given)


def _as_dataset(given: Any, name: str) -> Dataset:
    """A data set of what stands for one; cells without a value are kept until it is known whether they matter."""
    if not isinstance(given, Dataset) and hasattr(given, "items"):
        return Dataset.from_columns(given, name, missing="keep")
    return as_dataset(given, missing="keep")


def _source(given: Any, dataset: Dataset) -> dict[str, str]:
    """Where a model file finds a data set."""
    if isinstance(given, str) and given in shipped_names("datasets"):
        return {"dataset": given}
    return {"file": f"{dataset.path}.csv" if dataset.in_memory else str(dataset.path.resolve())}


def _unit(name: str) -> str:
    """SI unit of a quantity; names that are not known are refused where the content is read."""
    return QUANTITIES[name].unit if name in QUANTITIES else "1"


def _noise(observable: str, block: Mapping[str, Any], where: str) -> dict[str, Any]:
    unit = _noise_unit(observable, block)
    found = {
        key: value
        if key in ("family", "correlation")
        else written_parameter(value, unit if key == "noise_scale" else _unit(key), f"{where}.{key}")
        for key, value in block.items()
    }
    if isinstance(found.get("correlation"), Mapping):
        one = found["correlation"]
        units = {"length": _unit(str(one.get("along"))), "independent": "1", "drift": unit}
        found["correlation"] = {
            key: written_parameter(entry, units[key], f"{where}.correlation.{key}") if key in units else entry
            for key, entry in one.items()
        }
    return found


def _noise_unit(observable: str, block: Mapping[str, Any]) -> str:
    family = NOISE_FAMILIES.get(str(block.get("family")))
    return _unit(observable) if family is not None and not family.relative else "1"


def _scale(entry: Any) -> Any:
    """The prior of a scale, given as it is or under ``scale`` as in a model file."""
    return entry["scale"] if isinstance(entry, Mapping) and set(entry) == {"scale"} else entry


def _without_none(block: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in block.items() if value is not None}
