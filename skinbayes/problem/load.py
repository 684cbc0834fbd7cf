"""Bind a model file to its forward model, its surface and its data; refuse what does not fit together."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.modelfile import ModelSpec, load_model
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import ROUGHNESS_INPUTS, ForwardModel, forward_model
from skinbayes.problem.inputs import Conditions, plan_inputs
from skinbayes.problem.problem import Problem
from skinbayes.problem.settings import apply_settings
from skinbayes.roughness import PowerSpectrum, named_surface
from skinbayes.statistics.noise import noise_family
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX, suggestions


def load_problem(
    name: str | Path,
    data: str | Path | None = None,
    settings: Mapping[str, str] | None = None,
    conditions: str | Path | None = None,
) -> Problem:
    """Bind a model to its data.

    Parameters
    ----------
    name : shipped model or path of a model file
    data : a CSV of the user's own (or a data set) to use instead of the one named in the model file
    settings : values to fix, as text with unit: ``{"yield_stress": "40 MPa", "surface": "paper_printed"}``;
        ``name[level]`` fixes one level of a parameter that differs by group
    conditions : a CSV of rows to predict instead of the data's; such a problem has no likelihood

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
    forward = forward_model(spec.forward, f"{spec.path}: forward")
    rows = None if conditions is None else _user_rows(forward, conditions)
    parameters, surface, taken = apply_settings(
        spec, forward, settings or {}, () if rows is None else rows.values
    )
    table, roughness = _surface(spec, surface)
    dataset, observed, spread = None, None, None
    if rows is not None:
        bound = rows.without(taken)
    elif spec.observable is None:
        if data is not None:
            raise InputError(f"{spec.path}: the model has no [data] block, so data cannot be given to it")
        bound = _default_rows(spec, taken)
    else:
        dataset = _dataset(spec, data)
        bound, observed, spread = _data_rows(spec, forward, dataset, taken)
    given = {p.name for p in parameters} | set(bound.values)
    parameters += [p for p in roughness if p.name not in given]
    _check_names(spec, forward, parameters, bound)
    given |= {p.name for p in parameters}
    _check_required(spec, forward, given, table)
    for key, value in forward.optional.items():
        if key not in given:
            parameters.append(
                ParameterSpec(
                    key, "", None, None, float(value), None, "default", f"default of {forward.name}"
                )
            )
    parameters += spec.noise_parameters
    free = tuple(p for p in parameters if p.prior is not None)
    fixed = tuple(p for p in parameters if p.prior is None)
    _check_derived(spec, forward, parameters, bound)
    try:
        plan = plan_inputs(fixed, free, bound)
    except InputError as error:
        raise InputError(f"{spec.path}: {error}") from None
    data_digest = _digest_data(spec, dataset, observed, spread)
    return Problem(
        spec=spec,
        forward=forward,
        free=free,
        fixed=fixed,
        conditions=bound,
        dataset=dataset,
        observed=observed,
        observed_spread=spread,
        table=table,
        fingerprint=_digest_model(spec, free, fixed, table, data_digest),
        data_fingerprint=data_digest,
        _plan=plan,
    )


def _surface(spec: ModelSpec, override: str | None) -> tuple[PowerSpectrum | None, list[ParameterSpec]]:
    name, file = spec.surface_name, spec.surface_file
    if override is not None:
        is_file = override.endswith(".csv") or Path(override).exists()
        name, file = (None, Path(override)) if is_file else (override, None)
    if file is not None:
        from skinbayes.files.spectrum import read_spectrum

        return read_spectrum(file), []
    if name is None:
        return None, []
    try:
        surface = named_surface(name)
    except InputError as error:
        raise InputError(f"{spec.path}: surface.name: {error}") from None
    entries = [
        ParameterSpec(
            key, "", None, None, float(np.asarray(getattr(surface, key))), None, "", f"surface {name}"
        )
        for key in ROUGHNESS_INPUTS
    ]
    return None, entries


def _dataset(spec: ModelSpec, data: str | Path | None) -> Dataset:
    dataset = load_dataset(data if data is not None else str(spec.dataset))
    try:
        return dataset.select(spec.rows) if spec.rows else dataset
    except InputError as error:
        raise InputError(f"{spec.path}: data.rows: {error}") from None


def _columns(dataset: Dataset, names: set[str]) -> Conditions:
    values = {key: np.asarray(column, dtype=float) for key, column in dataset.columns.items() if key in names}
    labels = {
        key: column.astype(np.str_) for key, column in dataset.columns.items() if column.dtype.kind == "U"
    }
    return Conditions(values, labels, dataset.n_rows)


def _user_rows(forward: ForwardModel, path: str | Path) -> Conditions:
    return _columns(load_dataset(path), set(forward.input_names()))


def _default_rows(spec: ModelSpec, taken: set[str]) -> Conditions:
    grids = {key: values for key, values in spec.conditions.items() if key not in taken}
    lengths = {len(values) for values in grids.values()}
    if len(lengths) > 1:
        raise InputError(f"{spec.path}: conditions have different lengths: {sorted(lengths)}")
    return Conditions(grids, {}, lengths.pop() if lengths else 1)


def _data_rows(
    spec: ModelSpec, forward: ForwardModel, dataset: Dataset, taken: set[str]
) -> tuple[Conditions, FloatArray, FloatArray]:
    observable = spec.observable or ""
    if observable not in forward.observables:
        raise InputError(
            f"{spec.path}: data.observable '{observable}' is not predicted by '{forward.name}'; "
            f"expected one of {', '.join(forward.observables)}"
        )
    if observable not in dataset.columns:
        raise InputError(
            f"{dataset.path}: no column '{observable} [..]', which the model '{spec.name}' explains"
        )
    rows = _columns(dataset, set(forward.input_names()) - taken)
    observed = np.asarray(dataset.columns[observable], dtype=float)
    spread_column = observable + STANDARD_DEVIATION_SUFFIX
    spread = np.zeros_like(observed)
    if spread_column in dataset.columns and spec.spread is None:
        raise InputError(
            f"{spec.path}: the data have a column '{spread_column}'; say in [data] whether it enters the likelihood: "
            'spread = "use" or spread = "ignore"'
        )
    try:
        noise_family(str(spec.noise)).check_observed(observed)
    except InputError as error:
        raise InputError(f"{dataset.path}: {observable}: {error}") from None
    if spec.spread == "use":
        if spread_column not in dataset.columns:
            raise InputError(
                f"{spec.path}: data.spread = \"use\", but {dataset.path} has no column '{spread_column}'"
            )
        spread = np.asarray(dataset.columns[spread_column], dtype=float)
    return rows, observed, spread


def _check_names(
    spec: ModelSpec, forward: ForwardModel, parameters: list[ParameterSpec], conditions: Conditions
) -> None:
    known = forward.input_names()
    for parameter in parameters:
        if parameter.name not in known:
            raise InputError(
                f"{spec.path}: parameters.{parameter.name}: the forward model '{forward.name}' has no such input."
                f"{suggestions(parameter.name, list(known))} It takes {', '.join(known)}"
            )
        if parameter.name in conditions.values:
            raise InputError(
                f"{spec.path}: '{parameter.name}' is given twice: as a parameter and as a column of the data; drop one"
            )


def _check_required(
    spec: ModelSpec, forward: ForwardModel, given: set[str], table: PowerSpectrum | None
) -> None:
    for entry in forward.required:
        if isinstance(entry, str):
            if entry not in given:
                raise InputError(
                    f"{spec.path}: '{forward.name}' needs {entry}: give it in [parameters] or as a column of the data"
                )
        elif not any(set(names) <= given for names in entry):
            options = "; or ".join(" and ".join(names) for names in entry)
            raise InputError(
                f"{spec.path}: '{forward.name}' needs {options}: in [parameters] or as columns of the data"
            )
    if (
        forward.uses_surface
        and table is None
        and (missing := [n for n in ROUGHNESS_INPUTS if n not in given])
    ):
        raise InputError(
            f"{spec.path}: the roughness is incomplete: {', '.join(missing)} missing; name a surface in [surface], or give "
            "all five roughness parameters"
        )


def _check_derived(
    spec: ModelSpec, forward: ForwardModel, parameters: list[ParameterSpec], conditions: Conditions
) -> None:
    if not spec.derived:
        return
    known = {p.name for p in parameters} | set(conditions.values) | set(forward.derived_names)
    for name, block in spec.derived.items():
        for column, levels in block.rows.items():
            unknown = set(levels) - set(conditions.labels.get(column, ()))
            if unknown and conditions.n_rows > 1:
                raise InputError(
                    f"{spec.path}: derived.{name}.rows: no row has {column} = {sorted(unknown)[0]!r}"
                )
        for factor in block.product:
            if factor not in known:
                raise InputError(
                    f"{spec.path}: derived.{name}: unknown factor '{factor}'.{suggestions(factor, sorted(known))} "
                    f"Expected one of {', '.join(sorted(known))}"
                )


def _digest_data(
    spec: ModelSpec, dataset: Dataset | None, observed: FloatArray | None, spread: FloatArray | None
) -> str:
    digest = hashlib.sha256()
    if dataset is not None and observed is not None and spread is not None:
        digest.update(json.dumps([spec.observable, list(dataset.columns)]).encode())
        for column in dataset.columns.values():
            digest.update(column.astype(str).tobytes() if column.dtype.kind == "U" else column.tobytes())
        digest.update(spread.tobytes())
    return digest.hexdigest()


def _digest_model(
    spec: ModelSpec,
    free: tuple[ParameterSpec, ...],
    fixed: tuple[ParameterSpec, ...],
    table: PowerSpectrum | None,
    data_digest: str,
) -> str:
    from skinbayes import __version__

    content = {
        "version": __version__,
        "forward": spec.forward,
        "observable": spec.observable,
        "noise": spec.noise,
        "free": [(p.label, repr(p.prior)) for p in free],
        "fixed": sorted((p.label, repr(p.value)) for p in fixed),
        "data": data_digest,
        "table": repr(table and (table.wavevector_min, table.wavevector_max, np.asarray(table.power(np.geomspace(
            float(np.min(table.wavevector_min)), float(np.max(table.wavevector_max)), 50))).tolist())),
    }  # fmt: skip
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
