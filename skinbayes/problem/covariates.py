"""Columns of the data that act as a power on an input of the forward model or on the observable."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.dataset_rows import positive_column
from skinbayes.files.group_block import CovariateSpec
from skinbayes.files.modelfile import ModelSpec
from skinbayes.forward import ForwardModel


def factor_key(observable: str) -> str:
    """Name among the inputs of the factor that covariates put on an observable."""
    return f"factor[{observable}]"


def covariate_columns(covariates: Sequence[CovariateSpec], dataset: Dataset) -> dict[str, FloatArray]:
    """Columns of the covariates by name, shape ``(n_rows,)``, SI.

    Raises :class:`InputError` for a column that the data lack or that is not positive, with its row.
    """
    found = {}
    for covariate in covariates:
        column = covariate.column
        if column not in dataset.columns:
            raise InputError(
                f"{dataset.path}: no column '{column} [..]', which the covariate '{covariate.name}' needs; "
                f"columns: {', '.join(dataset.columns)}"
            )
        found[column] = positive_column(
            dataset, column, f"the covariate '{covariate.name}' enters as a power"
        )
    return found


def check_covariates(spec: ModelSpec, forward: ForwardModel) -> None:
    """Refuse covariates that act on nothing the problem has."""
    for covariate in spec.covariates:
        if covariate.acts_on not in (*forward.input_names(), *spec.observables):
            raise InputError(
                f"{spec.path}: covariates.{covariate.name}.acts_on: '{covariate.acts_on}' is neither an input of "
                f"'{forward.name}' nor what is observed; expected one of {', '.join((*spec.observables, *forward.input_names()))}"
            )


def apply_covariates(
    covariates: Sequence[CovariateSpec],
    columns: Mapping[str, FloatArray],
    values: dict[str, FloatArray],
    observables: Sequence[str],
) -> dict[str, FloatArray]:
    """Multiply inputs by their covariates' factors ``(column/reference)^exponent``.

    Parameters
    ----------
    covariates : which
    columns : their columns, shape ``(N,)``, SI
    values : inputs by name, each ``(B or 1, N or 1)``, exponents included
    observables : factors on these are returned as inputs of their own, see `factor_key`

    Raises
    ------
    InputError
        The rows lack a column.
    """
    for covariate in covariates:
        if covariate.column not in columns:
            raise InputError(
                f"the rows have no column '{covariate.column}', which the covariate '{covariate.name}' needs"
            )
        logarithm = np.log(columns[covariate.column] / covariate.reference)
        factor = np.exp(values[f"covariate_exponent[{covariate.name}]"] * logarithm)
        key = factor_key(covariate.acts_on) if covariate.acts_on in observables else covariate.acts_on
        if key not in values and covariate.acts_on not in observables:
            raise InputError(
                f"the covariate '{covariate.name}' acts on '{covariate.acts_on}', which has no value here"
            )
        values[key] = values.get(key, np.ones((1, 1))) * factor
    return values
