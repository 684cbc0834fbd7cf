"""Rows of a problem: from a data set, from a file of conditions, or from the model file's own grid."""

from __future__ import annotations

from collections.abc import Collection, Mapping

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset, as_dataset
from skinbayes.files.dataset_rows import place_of_row, positive_column
from skinbayes.files.find_dataset import find_dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import RESERVED_NAMES
from skinbayes.forward import ForwardModel
from skinbayes.problem.bound import BoundModel
from skinbayes.problem.consistency import near_miss
from skinbayes.problem.covariates import covariate_columns
from skinbayes.problem.inputs import Conditions, label_meant
from skinbayes.problem.observations import Observation
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.noise_families import noise_family
from skinbayes.vocabulary import (
    STANDARD_DEVIATION_SUFFIX,
    STANDARD_ERROR_SUFFIX,
    lookup,
    spread_of,
    suggestions,
)

MOST_ROWS = 10_000
"""Rows that a problem may have: so many were run, in less than a gigabyte (benchmarks/rows.py)."""

MOST_ROWS_OF_EXPENSIVE_MODELS = 1_000
"""Rows that a problem may have whose forward model is expensive: a film or a bridge for each of them."""

MOST_LISTED = 20
"""Lines that a sentence lists."""

ROUNDING = 0.1
"""Relative difference between a standard error and the standard deviation over sqrt(n) that rounding may make."""

SPREAD_SUFFIXES = (STANDARD_DEVIATION_SUFFIX, STANDARD_ERROR_SUFFIX)

MOST_LEVELS = 1_000
"""Levels of a column whose rows may share an effect: so many were run."""


def _check_count(path: object, count: int, forward: ForwardModel) -> None:
    most = MOST_ROWS_OF_EXPENSIVE_MODELS if forward.expensive else MOST_ROWS
    if count > most:
        raise InputError(
            f"{path}: {count} rows; expected at most {most} for the forward model '{forward.name}', with which time and memory "
            "were measured: average neighbouring rows, or take a part of them"
        )


def given_rows(spec: ModelSpec, forward: ForwardModel, dataset: Dataset) -> Conditions:
    """Rows with those of their columns that the model uses; :class:`InputError` if there are too many of them."""
    _check_count(dataset.path, dataset.n_rows, forward)
    return _columns(dataset, set(forward.input_names()), covariate_columns(spec.covariates, dataset))


def user_rows(spec: ModelSpec, forward: ForwardModel, data: Data) -> Conditions:
    """Rows of a CSV of the user's; :class:`InputError` if none of its columns is an input of the forward model."""
    dataset = as_dataset(data)
    path, rows = dataset.path, given_rows(spec, forward, dataset)
    if not rows.values and not any(parameter.by in rows.labels for parameter in spec.parameters):
        raise InputError(
            f"{path}: none of its columns is an input of '{forward.name}', which takes {', '.join(forward.input_names())}"
        )
    return rows


def _columns(dataset: Dataset, names: set[str], covariates: Mapping[str, FloatArray]) -> Conditions:
    values = {key: np.asarray(column, dtype=float) for key, column in dataset.columns.items() if key in names}
    labels = {
        key: column.astype(np.str_)
        for key, column in dataset.columns.items()
        # a column with empty labels is one that the model does not name; some names cannot stand in results
        if column.dtype.kind == "U" and (column != "").all() and key not in RESERVED_NAMES and "/" not in key
    }
    return Conditions(values, labels, dataset.n_rows, covariates)


def default_rows(spec: ModelSpec, taken: set[str]) -> Conditions:
    """Rows of the ``[conditions]`` block but for the inputs ``taken``; one row without it."""
    grids = {key: values for key, values in spec.conditions.items() if key not in taken}
    lengths = {len(values) for values in grids.values()}
    if len(lengths) > 1:
        raise InputError(f"{spec.path}: conditions have different lengths: {sorted(lengths)}")
    values = {
        key: np.asarray(column, dtype=float) for key, column in grids.items() if column.dtype.kind == "f"
    }
    labels = {
        key: np.asarray(column, dtype=np.str_) for key, column in grids.items() if column.dtype.kind == "U"
    }
    acting = {entry.column: values[entry.column] for entry in spec.covariates if entry.column in values}
    return Conditions(values, labels, lengths.pop() if lengths else 1, acting)


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


def selected_dataset(spec: ModelSpec, data: Data | None = None) -> Dataset:
    """Those rows of the data, or of the data set that the model names, which the model takes.

    Raises :class:`InputError` for data that cannot be read, or without such rows.
    """
    if data is None:
        try:
            find_dataset(str(spec.dataset))
        except InputError as error:
            raise InputError(f"{spec.path}: data: {error}") from None
    dataset = as_dataset(str(spec.dataset) if data is None else data, missing="keep")
    dataset = dataset.complete(spec.rows, spec.missing == "drop")
    try:
        return dataset.select(spec.rows) if spec.rows else dataset
    except InputError as error:
        raise InputError(f"{spec.path}: data.rows: {error}") from None


def used_columns(spec: ModelSpec, forward: ForwardModel, taken: Collection[str]) -> set[str]:
    """Names of the columns of data that a model uses where the data have them; the inputs ``taken`` come from elsewhere."""
    inputs = set(forward.input_names()) - set(taken)
    spreads = [
        *(inputs if spec.input_spread == "use" else ()),
        *(spec.observables if spec.spread == "use" else ()),
    ]
    labels = {p.by for p in (*spec.parameters, *spec.noise_parameters) if p.by_column}
    labels |= {column for population in spec.populations for column in population.columns}
    labels |= {scale.level for scale in spec.groups} | {spec.rheology_by, *spec.rows}
    if spec.discrepancy is not None:
        labels |= {spec.discrepancy.within, *spec.discrepancy.columns}
    if spec.correlation is not None:
        labels |= {spec.correlation.within, spec.correlation.along}
    labels |= {column for block in spec.derived.values() for column in block.rows}
    found = inputs | set(spec.observables) | {covariate.column for covariate in spec.covariates} | labels
    return {name for name in found if name} | {
        name + suffix for name in spreads for suffix in SPREAD_SUFFIXES
    }


def data_notes(problem: BoundModel) -> list[str]:
    """Sentences on rows of the data that were left out and columns that the model does not use."""
    dataset, spec = problem.dataset, problem.spec
    if dataset is None:
        return []
    said = []
    if dataset.dropped:
        count = len(dataset.dropped)
        word = dataset.row_word + ("s" if count > 1 else "")
        listed = ", ".join(str(line) for line in dataset.dropped[:MOST_LISTED])
        more = f" and {count - MOST_LISTED} more" if count > MOST_LISTED else ""
        said.append(
            f"{count} {'row was' if count == 1 else 'rows were'} left out, without a value in a column that the model uses: "
            f"{word} {listed}{more}."
        )
    used = {
        *problem.conditions.values,
        *problem.conditions.covariates,
        *spec.observables,
        "number_of_measurements",
    }
    if "friction_coefficient" in used:
        used |= {"friction_force", "normal_force"}
    wanted = {*problem.forward.input_names(), *spec.observables} - used
    unused = []
    for name, unit in dataset.units.items():
        if (spread_of(name) or name) not in used:
            guess = suggestions(name, wanted).strip() if lookup(name) is None else ""
            unused.append(f"{name} [{unit}]" + (f" ({guess})" if guess else ""))
    if unused:
        said.append(f"Columns of the data that the model does not use: {', '.join(unused)}.")
    return said


def _observation(spec: ModelSpec, forward: ForwardModel, dataset: Dataset, name: str) -> Observation:
    several = len(spec.observables) > 1
    if name not in forward.observables:
        raise InputError(
            f"{spec.path}: data.{'observables' if several else 'observable'} '{name}' is not predicted by '{forward.name}'; "
            f"expected one of {', '.join(forward.observables)}"
        )
    if name not in dataset.columns:
        force = (
            " A friction force needs a column 'normal_force' beside it."
            if "friction_force" in dataset.columns
            else ""
        )
        raise InputError(
            f"{dataset.path}: no column '{name} [..]', which the model '{spec.name}' explains.{force}"
            f"{near_miss(dataset.units, [name])}".rstrip(".")
        )
    values = np.asarray(dataset.columns[name], dtype=float)
    noise = noise_family(spec.noise[name])
    spread = np.zeros_like(values)
    spread_column = _spread_column(dataset, name)
    if spread_column:
        _check_said(spec, dataset, "spread", spread_column)
    try:
        noise.check_observed(values)
    except InputError as error:
        raise InputError(f"{dataset.path}: {name}: {error}") from None
    if spec.spread == "use":
        if not spread_column:
            raise InputError(
                f"{spec.path}: data.spread = \"use\", but {dataset.path} has no column '{name}{STANDARD_DEVIATION_SUFFIX}'. "
                f"{_ways_out(spec, dataset, 'spread', f'that column, the standard deviation of each {name}')}"
            )
        spread = np.asarray(dataset.columns[spread_column], dtype=float)
    return Observation(name, values, spread, noise, several)


def _check_said(spec: ModelSpec, dataset: Dataset, key: str, column: str) -> None:
    """Refuse a spread of the data of which the model file does not say whether it is used."""
    if getattr(spec, key) is None:
        where = (
            f", in a copy of the model such as {_copy(spec, dataset)} writes for these data"
            if spec.shipped
            else ""
        )
        raise InputError(
            f"{spec.path}: the data have a column '{column}'; say in [data] whether it enters the likelihood: "
            f'{key} = "use" or {key} = "ignore"{where}'
        )


def _spread_column(dataset: Dataset, name: str) -> str:
    """The column with the standard deviation of each datum ``name``: its standard error, if the datum is a mean; or ``""``.

    Raises :class:`InputError` if there is a standard deviation too that does not belong to it.
    """
    deviation, error = (name + suffix for suffix in SPREAD_SUFFIXES)
    if error not in dataset.columns:
        return deviation if deviation in dataset.columns else ""
    if deviation in dataset.columns:
        if "number_of_measurements" not in dataset.columns:
            raise InputError(
                f"{dataset.path}: found '{deviation}' and '{error}'; expected one of them, or a column 'n' with the number of "
                "measurements that each row is the mean of"
            )
        of_mean, of_one, number = (
            np.asarray(dataset.columns[column], dtype=float)
            for column in (error, deviation, "number_of_measurements")
        )
        ratio = of_mean * np.sqrt(number) / of_one
        if (apart := np.flatnonzero(np.abs(ratio - 1) > ROUNDING)).size:
            row = int(apart[0])
            raise InputError(
                f"{place_of_row(dataset, row)}, {error}: found {ratio[row]:.3g} times {deviation}/sqrt(n); expected the same "
                f"within {ROUNDING:.0%}"
            )
    return error


def _ways_out(spec: ModelSpec, dataset: Dataset, key: str, column: str) -> str:
    """What to do about a spread that the model file uses and the data do not have."""
    where = "the model file"
    if spec.shipped:
        where = f"a copy of the model, such as {_copy(spec, dataset)} writes for these data"
    return f'Either add {column}, or, if it is not known, write {key} = "ignore" under [data] of {where}'


def _copy(spec: ModelSpec, dataset: Dataset) -> str:
    return f"'skinbayes new {spec.name} --data {dataset.path.name} -o mine.toml'"


def relative_input_spread(spec: ModelSpec, dataset: Dataset, rows: Conditions) -> dict[str, FloatArray]:
    """Standard deviation over value of the inputs that have a spread column, if it is to be used."""
    found = {}
    columns = {name: column for name in rows.values if (column := _spread_column(dataset, name))}
    for name, column in columns.items():
        _check_said(spec, dataset, "input_spread", column)
        spread = np.asarray(dataset.columns[column], dtype=float)
        if spec.input_spread == "use" and spread.any():
            found[name] = spread / positive_column(dataset, name, "its spread is taken relative to it")
    if spec.input_spread == "use" and not columns:
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
            raise InputError(
                f"{spec.path}: groups.{column}: the data have no column '{column}'.{label_meant(column, rows.labels)}".rstrip(
                    "."
                )
            )
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
