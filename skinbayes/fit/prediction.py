"""What a fit predicts at rows that were not measured, how probable a statement about them is, and where it holds."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Data
from skinbayes.files.find_dataset import suggestions
from skinbayes.problem.new_conditions import NewConditions, at_new_conditions
from skinbayes.problem.observations import Observation
from skinbayes.units import parse_quantity
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    import pandas

    from skinbayes.fit.result import FitResult
    from skinbayes.problem import Problem

MOST_NUMBERS = 4_000_000
"""Draws times rows that are predicted; of more rows fewer draws, evenly spaced."""

FEWEST_DRAWS = 200
"""Draws without which the ends of an interval are not known."""

STATEMENT = re.compile(r"^\s*(\w+)\s*(<=|>=|<|>)\s*(.+?)\s*$")


@dataclass(frozen=True)
class Prediction:
    """Posterior predictions at new rows.

    Attributes
    ----------
    columns : the rows: quantity to SI values, label column to text, each ``(N,)``
    of_model : observable to predictions of the model, ``(draws, N)``, SI: of a known person or liquid with its effect, of a new
        one as of the median one; NaN where the model has no answer
    of_measurement : the same for one measurement more: with its scatter, and with an effect drawn for each new person or liquid
    notes : sentences on what these predictions do not contain

    Examples
    --------
    Examples of methods go on from this one.

    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    >>> prediction = fit.predict({"person": ["ID01", "new"], "liquid": ["water", "water"], "normal_force": [1.0, 1.0]})
    >>> prediction.of_model["friction_coefficient"].shape
    (500, 2)
    """

    columns: Mapping[str, np.ndarray]
    of_model: Mapping[str, FloatArray]
    of_measurement: Mapping[str, FloatArray]
    notes: tuple[str, ...] = ()

    @property
    def n_rows(self) -> int:
        """Number of rows N."""
        return int(next(iter(self.of_model.values())).shape[1])

    def quantiles(
        self, observable: str, probabilities: ArrayLike = (0.05, 0.5, 0.95), measured: bool = True
    ) -> FloatArray:
        """Quantiles of each row.

        Parameters
        ----------
        observable : name of what is predicted
        probabilities : between 0 and 1, shape ``(P,)``
        measured : of one measurement more, scatter included; False for the model itself

        Returns
        -------
        ndarray
            Shape ``(P, N)``, SI; NaN where the model has no answer in some draws.

        Examples
        --------
        >>> prediction.quantiles("friction_coefficient").shape
        (3, 2)
        """
        draws = (self.of_measurement if measured else self.of_model)[observable]
        return np.asarray(np.quantile(draws, np.asarray(probabilities, dtype=float), axis=0))

    def probability(self, statement: str, measured: bool = True) -> FloatArray:
        """How probable a statement is at each row.

        Parameters
        ----------
        statement : an observable, ``<``, ``<=``, ``>`` or ``>=``, and a value with its unit: ``"friction_coefficient < 0.4"``
        measured : of one measurement more, scatter included; False for the model itself

        Returns
        -------
        ndarray
            Shape ``(N,)``: the fraction of the draws in which it is true; one in which the model has no answer counts as not.

        Raises
        ------
        InputError
            No such statement, quantity or unit.

        Examples
        --------
        >>> prediction.probability("friction_coefficient > 0").tolist()
        [1.0, 1.0]
        """
        name, less, value = self._parsed(statement)
        draws = (self.of_measurement if measured else self.of_model)[name]
        with np.errstate(invalid="ignore"):
            # the values are continuous, so that < and <= are the same
            return np.asarray(((draws < value) if less else (draws > value)).mean(axis=0))

    def holds(
        self, statement: str, along: str, confidence: float = 0.95, measured: bool = True
    ) -> list[tuple[dict[str, str | float], list[tuple[float, float]]]]:
        """Where along a column a statement is as probable as wanted: the loads that keep friction low.

        Between neighbouring rows the probability is taken to be linear in the column, so that rows should lie close where it
        changes; nothing is said beyond them.

        Parameters
        ----------
        statement : see :meth:`probability`
        along : a numeric column of the rows
        confidence : the probability wanted, between 0 and 1
        measured : see :meth:`probability`

        Returns
        -------
        list
            For each combination of the other columns: these, by name, and the intervals ``(from, to)`` of the column, SI, in
            which the statement holds; empty if nowhere.

        Raises
        ------
        InputError
            No such column, or fewer than two values of it.

        Examples
        --------
        >>> rows = {"person": ["x", "x"], "liquid": ["water", "water"], "normal_force": [0.5, 2.0]}
        >>> fit.predict(rows).holds("friction_coefficient > 0", "normal_force")
        [({'person': 'x', 'liquid': 'water'}, [(0.5, 2.0)])]
        """
        if not 0.0 < confidence < 1.0:
            raise InputError(f"confidence: found {confidence:g}; expected a probability between 0 and 1")
        numeric = {name: values for name, values in self.columns.items() if values.dtype.kind == "f"}
        if along not in numeric:
            raise InputError(
                f"'{along}' is no numeric column of the rows; expected one of {', '.join(numeric)}."
                f"{suggestions(along, list(numeric))}"
            )
        probability = self.probability(statement, measured)
        others = [name for name in self.columns if name != along]
        rows: dict[tuple[str | float, ...], list[int]] = {}
        for row in range(self.n_rows):
            key = tuple(self.columns[name][row].item() for name in others)
            rows.setdefault(key, []).append(row)
        found = []
        for key, places in rows.items():
            order = sorted(places, key=lambda row: float(numeric[along][row]))
            x, p = numeric[along][order], probability[order]
            if len(np.unique(x)) < 2:
                where = ", ".join(f"{name} {value}" for name, value in zip(others, key, strict=True))
                raise InputError(
                    f"{along} has one value at {where or 'all rows'}; expected several to look between"
                )
            found.append((dict(zip(others, key, strict=True)), _above(x, p, confidence)))
        return found

    def to_frame(self, statement: str | None = None) -> pandas.DataFrame:
        """The rows with medians and 90 % intervals.

        Parameters
        ----------
        statement : whose probability becomes a column ``probability``, see :meth:`probability`

        Returns
        -------
        pandas.DataFrame
            SI. Of each observable ``NAME_q05``, ``NAME_median``, ``NAME_q95`` of the model, and the same with
            ``NAME_with_noise`` of one measurement more.

        Examples
        --------
        >>> list(prediction.to_frame().columns)[:4]
        ['person', 'liquid', 'normal_force', 'friction_coefficient_q05']
        """
        import pandas

        found = dict(self.columns)
        for name in self.of_model:
            for measured, ending in ((False, ""), (True, "_with_noise")):
                for word, values in zip(
                    ("q05", "median", "q95"), self.quantiles(name, measured=measured), strict=True
                ):
                    found[f"{name}{ending}_{word}"] = values
        if statement is not None:
            found["probability"] = self.probability(statement)
        return pandas.DataFrame(found)

    def _parsed(self, statement: str) -> tuple[str, bool, float]:
        """The observable, whether it is to be less, and the value in SI."""
        match = STATEMENT.match(statement)
        expected = (
            "expected an observable, < or >, and a value with its unit, such as 'friction_coefficient < 0.4'"
        )
        if match is None:
            raise InputError(f"statement: found {statement[:80]!r}; {expected}")
        name, sign, value = match.groups()
        if name not in self.of_model:
            raise InputError(
                f"statement: '{name}' is not predicted here, but {', '.join(self.of_model)} is; {expected}"
            )
        return name, sign[0] == "<", parse_quantity(value, QUANTITIES[name].unit, where=f"statement: {name}")


def predicted(
    fit: FitResult,
    conditions: Data,
    seed: int = 1,
    progress: Callable[[int, int], None] | None = None,
    cores: int = 1,
) -> Prediction:
    """Posterior predictions of a fit at new rows; see :meth:`skinbayes.Fit.predict`."""
    new = new_conditions_of(fit, conditions, progress, cores)
    measured, theta = new.measured, fit.theta()
    most = max(FEWEST_DRAWS, MOST_NUMBERS // new.problem.conditions.n_rows)
    theta = theta[:: -(-len(theta) // most)]
    rng = np.random.default_rng([seed])
    predictions = new.problem.predict(new.of_people(theta))
    made = drawn_measurements(new, theta, predictions, rng)
    of_model = {name: predictions[name] for name in measured.observables}
    if made.effects is not None and made.problem.shared is not None:
        (name,) = of_model
        at_rows = made.problem.shared.at_rows(np.where(new.known < 0, 0.0, made.effects))
        logarithmic = made.problem.observations[0].noise.logarithmic
        of_model[name] = of_model[name] * np.exp(at_rows) if logarithmic else of_model[name] + at_rows
    return Prediction(
        new.dataset.columns,
        of_model,
        made.values,
        (*_about_levels(new), *new.notes, *new.problem.explain(np.median(new.of_people(theta), axis=0))),
    )


def new_conditions_of(
    fit: FitResult, conditions: Data, progress: Callable[[int, int], None] | None = None, cores: int = 1
) -> NewConditions:
    """The problem of a fit at other rows; :class:`InputError` if it is gone or cannot be asked there."""
    if fit.problem is None:
        raise InputError(
            f"{fit.name}: the model or the data of the fit are not at hand any more, so nothing can be predicted with it"
        )
    return at_new_conditions(fit.problem, conditions, progress, cores)


class DrawnMeasurements(NamedTuple):
    """Measurements at new rows that were not made.

    Attributes
    ----------
    problem : the problem at these rows with observations there, of the typical spread
    effects : of all levels, ``(B, K)``: drawn given the data where these have the level, and anew for others; None without any
    values : observable to one measurement for each draw and row, ``(B, N)``, SI
    """

    problem: Problem
    effects: FloatArray | None
    values: dict[str, FloatArray]


def drawn_measurements(
    new: NewConditions, theta: FloatArray, predictions: Mapping[str, FloatArray], rng: np.random.Generator
) -> DrawnMeasurements:
    """One measurement for each draw at each new row about its ``predictions``, each ``(B, N)``, with scatter and effects."""
    observed = tuple(_as_measured(old, predictions[old.name]) for old in new.measured.observations)
    spread = {
        name: np.full(new.problem.conditions.n_rows, float(np.median(values)))
        for name, values in new.measured.input_spread.items()
        if name in new.problem.conditions.values
    }
    problem = replace(new.problem, observations=observed, input_spread=spread)
    problem.__dict__["model"] = new.problem.model
    effects = None
    of_people = new.of_people(theta, rng)
    if new.people:  # others are as the median in predictions of the model, not in measurements
        found = problem.predict(of_people)
        predictions = {name: found[name] for name in predictions}
    if problem.shared is not None:
        known = new.measured.draw_effects(theta, rng)[:, new.known]  # that of a new level is replaced
        anew = problem.shared.draw_new_effects(rng, problem.likelihood.scales(of_people))
        effects = np.where(new.known < 0, anew, known)
    stacked = np.stack([predictions[o.name] for o in observed], axis=1)
    drawn = problem.likelihood.draw_about(of_people, stacked, rng, effects)
    parts = np.split(drawn, len(observed), axis=-1)
    return DrawnMeasurements(
        problem, effects, {o.name: part for o, part in zip(observed, parts, strict=True)}
    )


def _as_measured(old: Observation, predictions: FloatArray) -> Observation:
    """An observation at the new rows about their median prediction, with the spread that the data typically have."""
    with np.errstate(all="ignore"):
        values = np.nanmedian(predictions, axis=0) if np.isfinite(predictions).any() else predictions[0]
    relative = old.noise.logarithmic or old.noise.relative
    typical = (
        float(np.median(old.spread / old.values if relative else old.spread)) if old.spread.any() else 0.0
    )
    return replace(
        old, values=values, spread=np.full(len(values), typical) * (np.abs(values) if relative else 1.0)
    )


def _about_levels(new: NewConditions) -> list[str]:
    said = []
    for column, levels in (new.new_levels | new.new_people).items():
        named = [level for level in levels if level]
        who = (
            f"{column} {', '.join(named[:5])}{' and others' if len(named) > 5 else ''}"
            if named
            else f"the {column} of the rows"
        )
        said.append(
            f"Not measured in the fit: {who}. Predictions of the model are those of the median {column}; those of measurements "
            f"contain how far one {column} differs from another."
        )
    contrasts = {one.contrast.column: one.contrast for one in new.measured.spec.populations if one.contrast}
    said += [
        f"The rows have no {column}; they are predicted for '{contrast.reference}', the reference."
        for column, contrast in contrasts.items()
        if column not in new.problem.conditions.labels
    ]
    return said


def _above(x: FloatArray, p: FloatArray, level: float) -> list[tuple[float, float]]:
    """Intervals of ``x`` in which the line through the points ``p`` is at least ``level``."""
    intervals: list[tuple[float, float]] = []
    start = float(x[0]) if p[0] >= level else None
    for i in range(1, len(x)):
        before, after = p[i - 1] >= level, p[i] >= level
        if before != after:
            cross = float(x[i - 1] + (level - p[i - 1]) / (p[i] - p[i - 1]) * (x[i] - x[i - 1]))
            if start is None:
                start = cross
            else:
                intervals.append((start, cross))
                start = None
    if start is not None:
        intervals.append((start, float(x[-1])))
    return intervals
