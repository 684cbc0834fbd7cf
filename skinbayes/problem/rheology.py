"""Measured flow curves of the liquids of the rows."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset, load_dataset
from skinbayes.files.find_dataset import find_dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.forward import FlowCurve, ForwardModel
from skinbayes.problem.inputs import Conditions

REPLACED = "viscosity"
"""Input that flow curves stand for."""


def load_flow_curves(
    spec: ModelSpec, forward: ForwardModel, dataset: Dataset | None = None
) -> dict[str, FlowCurve]:
    """Flow curves of the ``[rheology]`` block by level of its grouping column; empty without such a block.

    They come from the data set that is given, or else from the one that the model names.

    Raises
    ------
    InputError
        The forward model has no use for flow curves, or the data set lacks a column or has a curve that is none.
    """
    if spec.rheology is None or spec.rheology_by is None:
        return {}
    if not forward.uses_flow_curves:
        raise InputError(
            f"{spec.path}: rheology: the forward model '{forward.name}' has no use for flow curves"
        )
    if dataset is None:
        try:
            find_dataset(spec.rheology)
        except InputError as error:
            raise InputError(f"{spec.path}: rheology: {error}") from None
        dataset = load_dataset(spec.rheology)
    for column in (spec.rheology_by, "shear_rate", REPLACED):
        if column not in dataset.columns:
            raise InputError(
                f"{dataset.path}: no column '{column}', which the flow curves of '{spec.name}' need; "
                f"columns: {', '.join(dataset.columns)}"
            )
    labels = dataset.columns[spec.rheology_by]
    curves = {}
    for level in dict.fromkeys(labels.tolist()):
        rows = np.flatnonzero(labels == level)
        rate, viscosity = (
            np.asarray(dataset.columns[c], dtype=float)[rows] for c in ("shear_rate", REPLACED)
        )
        order = np.argsort(rate, kind="stable")
        try:
            curves[str(level)] = FlowCurve(rate[order], viscosity[order])
        except InputError as error:
            raise InputError(f"{dataset.path}: {spec.rheology_by} '{level}': {error}") from None
    return curves


def flow_curves_of(
    curves: Mapping[str, FlowCurve], column: str | None, rows: Conditions, place: object
) -> tuple[FlowCurve, ...] | None:
    """The flow curve of each row, or None if there are no curves.

    Raises :class:`InputError` if the rows lack the grouping column, or have a level without a curve.
    """
    if not curves or column is None:
        return None
    if column not in rows.labels:
        raise InputError(f"{place}: the rows have no column '{column}', which says whose flow curve is meant")
    levels = [str(level) for level in rows.labels[column]]
    if unknown := sorted(set(levels) - set(curves)):
        raise InputError(
            f"{place}: no flow curve of {column} '{unknown[0]}'; there are {', '.join(sorted(curves))}"
        )
    return tuple(curves[level] for level in levels)


def flow_curves_text(curves: Mapping[str, FlowCurve], column: str) -> str:
    """Flow curves as a CSV that :func:`load_flow_curves` reads."""
    points = [
        (level, rate, viscosity)
        for level, curve in curves.items()
        for rate, viscosity in zip(
            np.asarray(curve.shear_rate).tolist(), np.asarray(curve.measured_viscosity).tolist(), strict=True
        )
    ]
    levels, rates, viscosities = zip(*points, strict=True)
    columns = {column: list(levels), "shear_rate": np.array(rates), "viscosity": np.array(viscosities)}
    return Dataset.from_columns(columns, "flow curves").to_csv()
