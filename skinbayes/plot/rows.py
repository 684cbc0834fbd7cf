"""What figures and pages know about the rows of a fit: predictions, effects of groups, residuals and their abscissa."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import row_names

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult
    from skinbayes.forward import Profile
    from skinbayes.problem import Problem

DRAWS = 400
"""Posterior draws that bands and residuals are made of."""


@dataclass(frozen=True)
class RowPredictions:
    """Predictions at the rows of the data, for some of the posterior draws.

    Attributes
    ----------
    values : observable to predictions of the median group, shape ``(S, N)``, SI
    effects : grouping column to its effect at each row, shape ``(S, N)``; columns without effects are absent
    logarithmic : observable to True if effects and residuals are those of ln
    """

    values: dict[str, FloatArray]
    effects: dict[str, FloatArray]
    logarithmic: dict[str, bool]

    def with_effects(self, observable: str, *columns: str) -> FloatArray:
        """Predictions with the effects of some columns, shape ``(S, N)``, SI."""
        values = self.values[observable]
        total = sum((self.effects[c] for c in columns if c in self.effects), start=np.zeros_like(values))
        return values * np.exp(total) if self.logarithmic[observable] else values + total

    def residuals(self, observable: str, observed: FloatArray, *columns: str) -> FloatArray:
        """Posterior median of observed less predicted, of ln where the noise is logarithmic, shape ``(N,)``.

        Effects of ``columns`` count as predicted.
        """
        predicted = self.with_effects(observable, *columns)
        with np.errstate(all="ignore"):
            found = np.log(observed / predicted) if self.logarithmic[observable] else observed - predicted
        return np.asarray(np.nanmedian(found, axis=0))


def row_predictions(fit: FitResult, problem: Problem) -> RowPredictions:
    """Predict the rows of the data for some of the posterior draws, with the effects of groups drawn with them."""
    theta = fit.theta()
    step = max(1, len(theta) // DRAWS)
    predicted = problem.predict(theta[::step])
    logarithmic = problem.noise_is_logarithmic.reshape(len(problem.observables), -1)[:, 0]
    return RowPredictions(
        {name: predicted[name] for name in problem.observables},
        {column: effect_at_rows(fit, column, step) for column in group_columns(fit)},
        {name: bool(flag) for name, flag in zip(problem.observables, logarithmic, strict=True)},
    )


def effect_draws(fit: FitResult, column: str) -> tuple[list[str], FloatArray]:
    """Levels of a grouping column and the posterior draws of their effects, shape ``(draws, levels)``."""
    variable = fit.groups["posterior"][f"{column}_effect"]
    levels = [str(level) for level in variable[f"{column}_level"].values]
    return levels, np.asarray(variable.values, dtype=float).reshape(-1, len(levels))


def effect_at_rows(fit: FitResult, column: str, step: int = 1) -> FloatArray:
    """One in ``step`` posterior draws of the effect of a grouping column at each row, shape ``(draws, N)``."""
    levels, draws = effect_draws(fit, column)
    place = {level: i for i, level in enumerate(levels)}
    return draws[::step, [place[level] for level in levels_of_rows(fit, column)]]


def group_columns(fit: FitResult) -> list[str]:
    """Grouping columns whose levels have an effect in this fit."""
    return [
        str(name).removesuffix("_effect")
        for name, variable in fit.groups["posterior"].data_vars.items()
        if variable.attrs.get("kind") == "effect"
    ]


def levels_of_rows(fit: FitResult, column: str) -> NDArray[np.str_]:
    """Level of each row in a column of labels."""
    return np.asarray(fit.groups["constant_data"][column].values).astype(np.str_)


def label_columns(fit: FitResult) -> list[str]:
    """Columns of labels of the rows of a fit."""
    if "constant_data" not in fit.groups:
        return []
    return [
        str(name)
        for name, found in fit.groups["constant_data"].data_vars.items()
        if found.dtype.kind not in "fiub"
    ]


def telling_columns(fit: FitResult) -> list[str]:
    """Columns of labels by which data can be looked at: those with effects, and others of several levels of several rows."""
    effects, rows = group_columns(fit), len(row_names(fit))
    others = [c for c in label_columns(fit) if c not in effects and c != "row_label"]
    return effects + [c for c in others if 1 < len(set(levels_of_rows(fit, c))) <= rows // 2]


def followed_profile(problem: Problem, middle: FloatArray) -> tuple[Profile, FloatArray] | None:
    """The curve of the forward model on which the data lie, and the abscissa of each row, shape ``(N,)``, SI.

    That is the first one whose ordinate was observed and whose abscissa is an input that varies between rows, or is what the
    forward model makes of its inputs (viscosity times speed). None if there is no such curve.
    """
    for profile in problem.profiles:
        if profile.ordinate in problem.observables:
            along = abscissa_of_rows(problem, profile, middle)
            if along is not None:
                return profile, along
    return None


def abscissa_of_rows(problem: Problem, profile: Profile, middle: FloatArray) -> FloatArray | None:
    """Abscissa of each row on a curve of the forward model, shape ``(N,)``, SI; None if rows have none or all the same."""
    inputs, model = problem.inputs(middle[np.newaxis]), problem.model
    values = inputs.get(profile.abscissa)
    if values is None and model.abscissa is not None and profile.abscissa == model.profiles[0].abscissa:
        values = model.abscissa(inputs, problem.tables)
    if values is None:
        return None
    along = np.broadcast_to(np.atleast_2d(values), (1, problem.conditions.n_rows))[0]
    return np.array(along, dtype=float) if np.ptp(along) > 0.0 else None


def varying(fit: FitResult) -> tuple[str, FloatArray] | None:
    """Name and values of what data are drawn against: the abscissa of their curve, else the condition that varies most.

    None if all conditions are the same in all rows, or the problem is gone. Shape of the values ``(N,)``, SI.
    """
    if fit.problem is None:
        return None
    followed = followed_profile(fit.problem, np.median(fit.theta(), axis=0))
    if followed is not None:
        return followed[0].abscissa, followed[1]
    return next(iter(varying_conditions(fit.problem).items()), None)


def varying_conditions(problem: Problem) -> dict[str, FloatArray]:
    """Conditions that differ between rows, the one of the widest range (of ln, if positive) first; ``(N,)`` each, SI."""
    found = {name: values for name, values in problem.conditions.values.items() if np.ptp(values) > 0.0}

    def width(name: str) -> float:
        values = found[name]
        return (
            float(np.ptp(np.log(values)))
            if (values > 0.0).all()
            else float(np.ptp(values) / np.abs(values).max())
        )

    return {name: found[name] for name in sorted(found, key=width, reverse=True)}
