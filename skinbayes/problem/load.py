"""Bind a model file to its forward model, its surface and its data; refuse what does not fit together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset, as_dataset, find_dataset
from skinbayes.files.modelfile import ModelSpec, load_model
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import ROUGHNESS_INPUTS, ForwardModel, Tables, forward_model
from skinbayes.problem.consistency import check_derived, check_names, check_required, check_scatter
from skinbayes.problem.covariates import check_covariates
from skinbayes.problem.failures import explained
from skinbayes.problem.inputs import plan_inputs
from skinbayes.problem.observations import Observation
from skinbayes.problem.problem import Problem
from skinbayes.problem.rheology import REPLACED, flow_curves_of, load_flow_curves
from skinbayes.problem.rows import (
    crossed_groups,
    data_rows,
    default_rows,
    relative_input_spread,
    used_columns,
    user_rows,
)
from skinbayes.problem.settings import apply_settings
from skinbayes.roughness import TabulatedSpectrum, named_surface
from skinbayes.vocabulary import QUANTITIES


def load_problem(
    name: str | Path,
    data: Data | None = None,
    settings: Mapping[str, str] | None = None,
    conditions: Data | None = None,
    rheology: str | Path | None = None,
) -> Problem:
    """Bind a model to its data.

    Parameters
    ----------
    name : shipped model or path of a model file
    data : a CSV of the user's own (or a data set, a data frame, a mapping of columns) to use instead of the one named in the
        model file; of a :class:`Dataset` all rows are used, whichever the model file selects
    settings : values to fix, as text with unit: ``{"yield_stress": "40 MPa", "surface": "paper_printed"}``;
        ``name[level]`` fixes one level of a parameter that differs by group
    conditions : a CSV (or as ``data``) of rows to predict instead of the data's; such a problem has no likelihood
    rheology : a CSV of flow curves (or a data set) to use instead of the one named in the model file

    Returns
    -------
    Problem

    Raises
    ------
    InputError
        Anything in the model file, the data or the settings that cannot be used; the message says where.

    Examples
    --------
    >>> load_problem("contact-area").dimension
    0
    """
    spec = load_model(name)
    if rheology is not None:
        spec = replace(spec, rheology=str(rheology))
    forward = forward_model(spec.forward, f"{spec.path}: forward")
    rows = None if conditions is None else user_rows(spec, forward, conditions)
    parameters, surface, taken = apply_settings(
        spec, forward, settings or {}, () if rows is None else rows.values
    )
    table, surface_file, roughness = _surface(spec, surface)
    dataset: Dataset | None = None
    observations: tuple[Observation, ...] = ()
    curves = load_flow_curves(spec, forward)
    taken |= {REPLACED} if curves else set()
    if rows is not None:
        bound = rows.without(taken)
    elif not spec.observables:
        if data is not None:
            raise InputError(f"{spec.path}: the model has no [data] block, so data cannot be given to it")
        bound = default_rows(spec, taken)
    elif spec.dataset is None and data is None:
        if not spec.conditions:
            raise InputError(
                f"{spec.path}: '{spec.name}' explains data that you bring: give them with --data FILE.csv "
                f"('skinbayes template {spec.name}' writes the header of such a file)"
            )
        bound = default_rows(spec, taken)
    else:
        dataset = _dataset(spec, forward, data, taken)
        if data is not None and not isinstance(data, Dataset):
            spec = _of_other_data(spec, dataset)
        bound, observations = data_rows(spec, forward, dataset, taken)
    given = {p.name for p in parameters} | set(bound.values)
    if curves and REPLACED in given:
        raise InputError(
            f"{spec.path}: '{REPLACED}' is given twice: as a parameter and by [rheology]; drop one"
        )
    parameters += [p for p in roughness if p.name not in given]
    check_names(spec, forward, parameters, bound)
    given |= {p.name for p in parameters}
    check_covariates(spec, forward)
    check_required(
        spec,
        forward,
        given | ({REPLACED} if curves else set()),
        table,
        () if dataset is None else dataset.units,
    )
    for key, value in forward.optional.items():
        if key not in given:
            parameters.append(
                ParameterSpec(
                    key,
                    QUANTITIES[key].unit,
                    None,
                    None,
                    float(value),
                    None,
                    "default",
                    f"default of {forward.name}",
                )
            )
    parameters += (*spec.covariate_exponents, *spec.noise_parameters, *spec.groups)
    free = tuple(p for p in parameters if p.prior is not None)
    fixed = tuple(p for p in parameters if p.prior is None)
    check_scatter(spec, observations)
    check_derived(spec, forward, parameters, bound, whole_data=dataset is not None and data is None)
    try:
        plan_inputs(fixed, free, bound)
    except InputError as error:
        raise InputError(f"{spec.path}: {error}") from None
    tables = Tables(table, flow_curves_of(curves, spec.rheology_by, bound, spec.path))
    problem = Problem(
        spec=spec,
        forward=forward,
        free=free,
        fixed=fixed,
        conditions=bound,
        dataset=dataset,
        observations=observations,
        input_spread={} if dataset is None else relative_input_spread(spec, dataset, bound),
        groups=crossed_groups(spec, bound) if observations else None,
        tables=tables,
        flow_curves=curves,
        settings=dict(settings or {}),
        surface_file=surface_file,
    )
    if forward.validate is not None:
        try:
            with explained(spec.path, "at the prior medians the forward model cannot be evaluated"):
                forward.validate(problem.inputs(problem.prior_medians()[np.newaxis]), tables)
        except InputError as error:
            if str(error).startswith(f"{spec.path}: "):
                raise
            raise InputError(f"{spec.path}: {'at the prior medians ' if free else ''}{error}") from None
    return problem


def _of_other_data(spec: ModelSpec, dataset: Dataset) -> ModelSpec:
    """The model with a title and a description that do not tell of the data it was written for."""
    name = dataset.path.name
    return replace(
        spec,
        title=f"{name}, with the model '{spec.name}'",
        description=f"The data are the user's own, {name}. Forward model, priors and noise are those of '{spec.name}' "
        f"({spec.title}); whether they suit these data is for the user to say.",
    )


def _surface(
    spec: ModelSpec, override: str | None
) -> tuple[TabulatedSpectrum | None, Path | None, list[ParameterSpec]]:
    name, file = spec.surface_name, spec.surface_file
    if override is not None:
        is_file = override.endswith(".csv") or Path(override).exists()
        name, file = (None, Path(override)) if is_file else (override, None)
    if file is not None:
        from skinbayes.files.spectrum import read_spectrum

        return read_spectrum(file), file.resolve(), []
    if name is None:
        return None, None, []
    try:
        surface = named_surface(name)
    except InputError as error:
        raise InputError(f"{spec.path}: surface.name: {error}") from None
    entries = [
        ParameterSpec(
            key,
            QUANTITIES[key].unit,
            None,
            None,
            float(np.asarray(getattr(surface, key))),
            None,
            "",
            f"surface {name}",
        )
        for key in ROUGHNESS_INPUTS
    ]
    return None, None, entries


def _dataset(spec: ModelSpec, forward: ForwardModel, data: Data | None, taken: set[str]) -> Dataset:
    """The rows of the data that the model selects, without those that lack a value it uses, if they may be dropped."""
    drop = spec.missing == "drop"
    dataset = data if isinstance(data, Dataset) else _selected(spec, data, drop)
    return dataset.complete(used_columns(spec, forward, taken), drop)


def _selected(spec: ModelSpec, data: Data | None, drop: bool) -> Dataset:
    if data is None:
        try:
            find_dataset(str(spec.dataset))
        except InputError as error:
            raise InputError(f"{spec.path}: data: {error}") from None
    dataset = as_dataset(data if data is not None else str(spec.dataset), missing="keep")
    dataset = dataset.complete(spec.rows, drop)
    try:
        return dataset.select(spec.rows) if spec.rows else dataset
    except InputError as error:
        raise InputError(f"{spec.path}: data.rows: {error}") from None
