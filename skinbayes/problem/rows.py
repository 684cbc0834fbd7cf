"""Rows of a problem: from a data set, from a file of conditions, or from the model file's own grid."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.locate import shipped_folder
from skinbayes.files.modelfile import ModelSpec
from skinbayes.forward import ForwardModel
from skinbayes.problem.covariates import covariate_columns
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.observations import Observation
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.noise_families import noise_family
from skinbayes.vocabulary import STANDARD_DEVIATION_SUFFIX

MOST_ROWS = 10_000
"""Rows that a problem may have: so many were run, in less than a gigabyte (benchmarks/rows.py)."""

MOST_ROWS_OF_EXPENSIVE_MODELS = 1_000
"""Rows that a problem may have whose forward model is expensive: a film or a bridge for each of them."""

MOST_LEVELS = 1_000
"""Levels of a column whose rows may share an effect: so many were run."""


def _check_count(path: object, count: int, forward: ForwardModel) -> None:
    most = MOST_ROWS_OF_EXPENSIVE_MODELS if forward.costly else MOST_ROWS
    if count > most:
        raise InputError(
            f"{path}: {count} rows; expected at most {most} for the forward model '{forward.name}', with which time and memory "
            "were measured: average neighbouring rows, or take a part of them"
        )


def user_rows(spec: ModelSpec, forward: ForwardModel, path: str | Path) -> Conditions:
    """Rows of a CSV of the user's; :class:`InputError` if none of its columns is an input of the forward model."""
    dataset = load_dataset(path)
    _check_count(path, dataset.n_rows, forward)
    rows = _columns(dataset, set(forward.input_names()), covariate_columns(spec.covariates, dataset))
    if not rows.values and not any(parameter.by in rows.labels for parameter in spec.parameters):
        raise InputError(
            f"{path}: none of its columns is an input of '{forward.name}', which takes {', '.join(forward.input_names())}"
        )
    return rows


def _columns(dataset: Dataset, names: set[str], covariates: Mapping[str, FloatArray]) -> Conditions:
    values = {key: np.asarray(column, dtype=float) for key, column in dataset.columns.items() if key in names}
    labels = {
        key: column.astype(np.str_) for key, column in dataset.columns.items() if column.dtype.kind == "U"
    }
    return Conditions(values, labels, dataset.n_rows, covariates)


def default_rows(spec: ModelSpec, taken: set[str]) -> Conditions:
    """Rows of the ``[conditions]`` block but for the inputs ``taken``; one row without it."""
    grids = {key: values for key, values in spec.conditions.items() if key not in taken}
    lengths = {len(values) for values in grids.values()}
    if len(lengths) > 1:
        raise InputError(f"{spec.path}: conditions have different lengths: {sorted(lengths)}")
    return Conditions(grids, {}, lengths.pop() if lengths else 1)


def data_rows(
    spec: ModelSpec, forward: ForwardModel, dataset: Dataset, taken: set[str]
) -> tuple[Conditions, tuple[Observation, ...]]:
    """Rows of a data set, without the inputs ``taken``, and what was observed in them.

    Raises :class:`InputError` for observables that are not predicted, not in the data, or impossible for their noise.
    """
    _check_count(dataset.path, dataset.n_rows, forward)
    covariates = covariate_columns(spec.covariates, dataset)
    rows = _columns(dataset, set(forward.input_names()) - taken, covariates)
    return rows, tuple(_observation(spec, forward, dataset, name) for name in spec.observables)


def _observation(spec: ModelSpec, forward: ForwardModel, dataset: Dataset, name: str) -> Observation:
    several = len(spec.observables) > 1
    if name not in forward.observables:
        raise InputError(
            f"{spec.path}: data.{'observables' if several else 'observable'} '{name}' is not predicted by '{forward.name}'; "
            f"expected one of {', '.join(forward.observables)}"
        )
    if name not in dataset.columns:
        raise InputError(f"{dataset.path}: no column '{name} [..]', which the model '{spec.name}' explains")
    values = np.asarray(dataset.columns[name], dtype=float)
    noise = noise_family(spec.noise[name])
    spread_column = name + STANDARD_DEVIATION_SUFFIX
    spread = np.zeros_like(values)
    if spread_column in dataset.columns and spec.spread is None:
        raise InputError(
            f"{spec.path}: the data have a column '{spread_column}'; say in [data] whether it enters the likelihood: "
            'spread = "use" or spread = "ignore"'
        )
    try:
        noise.check_observed(values)
    except InputError as error:
        raise InputError(f"{dataset.path}: {name}: {error}") from None
    if spec.spread == "use":
        if spread_column not in dataset.columns:
            raise InputError(
                f"{spec.path}: data.spread = \"use\", but {dataset.path} has no column '{spread_column}'. "
                f"{_ways_out(spec, dataset, 'spread', f'that column, the standard deviation of each {name}')}"
            )
        spread = np.asarray(dataset.columns[spread_column], dtype=float)
    return Observation(name, values, spread, noise, several)


def _ways_out(spec: ModelSpec, dataset: Dataset, key: str, column: str) -> str:
    """What to do about a spread that the model file uses and the data do not have."""
    where = "the model file"
    if spec.path.parent == shipped_folder("models"):
        copy = f"'skinbayes new {spec.name} --data {dataset.path.name} -o mine.toml'"
        where = f"a copy of the model, such as {copy} writes for these data"
    return f'Either add {column}, or, if it is not known, write {key} = "ignore" under [data] of {where}'


def relative_input_spread(spec: ModelSpec, dataset: Dataset, rows: Conditions) -> dict[str, FloatArray]:
    """Standard deviation over value of the inputs that have a spread column, if it is to be used."""
    found = {}
    for name, values in rows.values.items():
        column = name + STANDARD_DEVIATION_SUFFIX
        if column not in dataset.columns:
            continue
        if spec.input_spread is None:
            raise InputError(
                f"{spec.path}: the data have a column '{column}'; say in [data] whether it enters the likelihood: "
                'input_spread = "use" or input_spread = "ignore"'
            )
        spread = np.asarray(dataset.columns[column], dtype=float)
        if spec.input_spread == "use" and spread.any():
            if not (values > 0).all():
                row = int(np.flatnonzero(~(values > 0))[0])
                raise InputError(
                    f"{dataset.path}: row {row + 1}, {name}: found {values[row]:g}; expected a value > 0, as its spread is "
                    "taken relative to it"
                )
            found[name] = spread / values
    if spec.input_spread == "use" and not any(
        name + STANDARD_DEVIATION_SUFFIX in dataset.columns for name in rows.values
    ):
        raise InputError(
            f'{spec.path}: data.input_spread = "use", but no input among the columns of {dataset.path} has a column '
            f"'<input>{STANDARD_DEVIATION_SUFFIX}'. {_ways_out(spec, dataset, 'input_spread', 'one')}"
        )
    return found


def crossed_groups(spec: ModelSpec, rows: Conditions) -> CrossedGroups | None:
    """The effects that ``[groups]`` asks for; :class:`InputError` for a column that is missing or has one level."""
    if not spec.groups:
        return None
    labels = {}
    for scale in spec.groups:
        column = str(scale.level)
        if column not in rows.labels:
            raise InputError(f"{spec.path}: groups.{column}: the data have no column '{column}'")
        labels[column] = rows.labels[column]
        levels = len(set(labels[column].tolist()))
        if levels > MOST_LEVELS:
            raise InputError(
                f"{spec.path}: groups.{column}: the data have {levels} of them; expected at most {MOST_LEVELS}, with which time "
                "and memory were measured"
            )
        if levels < 2:
            raise InputError(
                f"{spec.path}: groups.{column}: all rows have the same {column}; effects need at least two"
            )
    return CrossedGroups.of_labels(labels)
