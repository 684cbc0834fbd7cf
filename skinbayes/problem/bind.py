"""Bind a model to its forward model, its surface and its data; refuse what does not fit together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.surface_draws import SurfaceDraws
from skinbayes.forward import FlowCurve, ForwardModel, Tables, forward_model
from skinbayes.problem.consistency import (
    check_derived,
    check_names,
    check_populations,
    check_required,
    check_scatter,
)
from skinbayes.problem.covariates import check_covariates
from skinbayes.problem.failures import explained
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.observations import Observation
from skinbayes.problem.populations import Populations, population_parameters
from skinbayes.problem.problem import Problem
from skinbayes.problem.rheology import REPLACED, flow_curves_of, load_flow_curves
from skinbayes.problem.rows import (
    crossed_groups,
    data_rows,
    default_rows,
    relative_input_spread,
    selected_dataset,
    used_columns,
    user_rows,
)
from skinbayes.problem.settings import apply_settings
from skinbayes.problem.shared_scatter import scatter_parameters, shared_scatter
from skinbayes.problem.surface import Surface, choose_surface
from skinbayes.problem.surface_prior import SurfacePrior, surface_prior
from skinbayes.problem.tied import resolve_ties
from skinbayes.roughness import TabulatedSpectrum


@dataclass(frozen=True)
class _Rows:
    """Rows of a problem, the data set that they come from, and what was observed in them."""

    conditions: Conditions
    dataset: Dataset | None = None
    observations: tuple[Observation, ...] = ()

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Numeric columns of the data, SI."""
        columns = {} if self.dataset is None else self.dataset.columns
        return {name: np.asarray(v, dtype=float) for name, v in columns.items() if v.dtype.kind == "f"}


def bind(
    spec: ModelSpec,
    data: Dataset | None = None,
    *,
    forward: ForwardModel | None = None,
    surface: TabulatedSpectrum | SurfaceDraws | None = None,
    rheology: Dataset | None = None,
    settings: Mapping[str, str] | None = None,
    conditions: Data | None = None,
    other_data: bool = False,
) -> Problem:
    """Make a problem of a validated model.

    Parameters
    ----------
    spec : the model
    data : all its rows are used; without it those of the data set that the model names
    forward : the forward model, if not the one of the name that the model gives
    surface : a measured spectrum, or draws of a surface, in place of the surface of the model
    rheology : flow curves in place of those that the model names
    settings : values to fix, as :func:`skinbayes.load_problem` takes them
    conditions : rows to predict instead of the data's
    other_data : True if the data are not those that the model was written for, so that they may lack rows it speaks of

    Raises
    ------
    InputError
        Anything that does not fit together; the message says where.
    """
    if forward is None:
        forward = forward_model(spec.forward, f"{spec.path}: forward")
    settings = dict(settings or {})
    options = {name: settings.pop(name) for name in list(settings) if name in forward.options}
    forward = forward.with_options(spec.options | options, f"{spec.path}: options")
    asked = None if conditions is None else user_rows(spec, forward, conditions)
    written, chosen, taken = apply_settings(spec, forward, settings, () if asked is None else asked.values)
    found = choose_surface(spec, chosen or surface)
    spec = replace(
        spec,
        surface_name=found.name,
        surface_file=found.file,
        surface_stated=found.stated,
        surface_posterior=None if found.draws is None else found.draws.file,
    )
    curves = load_flow_curves(spec, forward, rheology)
    taken |= {REPLACED} if curves else set()
    rows = _rows(spec, forward, data, taken) if asked is None else _Rows(asked.without(taken))
    prior = surface_prior(
        found.draws, {p.name for p in written} | set(rows.conditions.values), str(spec.path)
    )
    parameters = _completed(spec, forward, written, found, prior, rows, bool(curves))
    check_scatter(spec, rows.observations)
    check_derived(
        spec, forward, parameters, rows.conditions, whole_data=rows.dataset is not None and not other_data,
        further=() if prior is None else prior.names,
    )  # fmt: skip
    problem = _problem(spec, forward, parameters, found.spectrum, prior, rows, curves, settings | options)
    _check_medians(problem)
    return problem


def _rows(spec: ModelSpec, forward: ForwardModel, data: Dataset | None, taken: set[str]) -> _Rows:
    """Rows of the data, or of the model's own conditions where it has no data."""
    if not spec.observables:
        return _Rows(default_rows(spec, taken))
    if spec.dataset is None and data is None:
        if not spec.conditions:
            raise InputError(
                f"{spec.path}: '{spec.name}' explains data that you bring: give them with --data FILE.csv "
                f"('skinbayes template {spec.name}' writes the header of such a file)"
            )
        return _Rows(default_rows(spec, taken))
    dataset = selected_dataset(spec) if data is None else data
    dataset = dataset.complete(used_columns(spec, forward, taken), spec.missing == "drop")
    conditions, observations = data_rows(spec, forward, dataset, taken)
    return _Rows(conditions, dataset, observations)


def _completed(
    spec: ModelSpec,
    forward: ForwardModel,
    parameters: list[ParameterSpec],
    surface: Surface,
    prior: SurfacePrior | None,
    rows: _Rows,
    has_curves: bool,
) -> tuple[ParameterSpec, ...]:
    """All parameters: those of the model, of its surface, the defaults of the forward model, and those of noise and groups."""
    given = {p.name for p in parameters} | set(rows.conditions.values)
    if has_curves and REPLACED in given:
        raise InputError(
            f"{spec.path}: '{REPLACED}' is given twice: as a parameter and by [rheology]; drop one"
        )
    parameters = parameters + [p for p in surface.parameters if p.name not in given]
    check_names(spec, forward, parameters, rows.conditions)
    given |= {p.name for p in parameters} | set(() if prior is None else prior.names)
    check_covariates(spec, forward)
    columns = () if rows.dataset is None else rows.dataset.units
    check_required(spec, forward, given | ({REPLACED} if has_curves else set()), surface.spectrum, columns)
    defaults = [
        ParameterSpec.of_value(key, value, f"default of {forward.name}")
        for key, value in forward.defaults(given).items()
    ]
    inputs = resolve_ties([*parameters, *defaults], str(spec.path), rows.conditions.values)
    shared = scatter_parameters(spec, rows.conditions, rows.columns) if rows.observations else ()
    inputs += () if prior is None else prior.parameters
    check_populations(spec, inputs)
    # without data nobody is known, and predictions are those of the median
    people = population_parameters(spec.populations, rows.conditions, spec.path) if rows.observations else ()
    return (*inputs, *spec.covariate_exponents, *spec.noise_parameters, *spec.groups, *shared, *people)


def _problem(
    spec: ModelSpec,
    forward: ForwardModel,
    parameters: tuple[ParameterSpec, ...],
    spectrum: TabulatedSpectrum | None,
    prior: SurfacePrior | None,
    rows: _Rows,
    curves: Mapping[str, FlowCurve],
    settings: Mapping[str, str],
) -> Problem:
    flow_curves = flow_curves_of(curves, spec.rheology_by, rows.conditions, spec.path)
    groups, shared = None, None
    if rows.observations:
        groups = crossed_groups(spec, rows.conditions)
        shared = shared_scatter(spec, rows.conditions, rows.columns, groups, parameters)
    free = tuple(p for p in parameters if p.prior is not None)
    fixed = tuple(p for p in parameters if p.value is not None)
    problem = Problem(
        spec=spec,
        forward=forward,
        free=free,
        fixed=fixed,
        tied=tuple(p for p in parameters if p.same_as is not None),
        conditions=rows.conditions,
        dataset=rows.dataset,
        observations=rows.observations,
        input_spread={}
        if rows.dataset is None
        else relative_input_spread(spec, rows.dataset, rows.conditions),
        groups=groups,
        tables=Tables(spectrum, flow_curves),
        flow_curves=curves,
        settings=settings,
        correlated=shared,
        surface_prior=prior,
        populations=Populations.of(spec.populations, free, fixed)
        if spec.populations and rows.observations
        else None,
    )
    try:
        _ = problem.plan
    except InputError as error:
        raise InputError(f"{spec.path}: {error}") from None
    return problem


def _check_medians(problem: Problem) -> None:
    """Let the forward model say in words what it cannot be evaluated with, before NaN says it without."""
    path, validate = problem.spec.path, problem.forward.validate
    if validate is None:
        return
    try:
        with explained(path, "at the prior medians the forward model cannot be evaluated"):
            validate(problem.inputs(problem.prior_medians()[np.newaxis]), problem.tables)
    except InputError as error:
        if str(error).startswith(f"{path}: "):
            raise
        raise InputError(f"{path}: {'at the prior medians ' if problem.free else ''}{error}") from None
