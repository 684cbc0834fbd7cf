"""What the rows of a problem share beside its prediction: group effects, the discrepancy, and correlated noise."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec, parse_parameter
from skinbayes.files.scatter_block import DISCREPANCY, ORDER, column_unit
from skinbayes.problem.inputs import Conditions, label_meant
from skinbayes.statistics.correlated_noise import CorrelatedNoise
from skinbayes.statistics.correlated_scatter import CorrelatedScatter
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.smooth_curves import SmoothCurves, nodes_for
from skinbayes.vocabulary import QUANTITIES

FEWEST_VALUES = 5
"""Different values of a column that a curve along it takes."""

DECADE = 10.0
"""A positive column that spans so large a factor is taken on a logarithmic axis."""

LEAST_LENGTH, SPACINGS = 0.1, 2.0
"""Usual least length of a curve: a tenth of the range of its column, and at least two mean spacings of its values."""

LONGEST = 2.0
"""Length of a curve, in ranges of the column, beyond which it is a constant or a slope: what the theory itself predicts."""

TAIL = 0.01
"""Fraction of the prior of a length that may lie beyond its limits at either end."""

MOST_EFFECTS = 500
"""Effects that are integrated out together at most: so many were run."""


@dataclass(frozen=True)
class Axis:
    """A column along which a discrepancy is a curve.

    Attributes
    ----------
    column : its name
    logarithmic : whether ln of it counts
    low, high : its range, SI
    within : label column of separate curves, or None
    levels : its levels; one empty name without it
    """

    column: str
    logarithmic: bool
    low: float
    high: float
    within: str | None
    levels: tuple[str, ...]

    def coordinate(self, values: FloatArray) -> FloatArray:
        """Values of the column as fractions of its range."""
        low, high, x = self.low, self.high, values
        if self.logarithmic:
            low, high, x = np.log(low), np.log(high), np.log(values)
        return np.asarray((x - low) / (high - low))

    def grid(self, count: int) -> FloatArray:
        """Values of the column at equal distances on the axis, SI."""
        space = np.geomspace if self.logarithmic else np.linspace
        return np.asarray(space(self.low, self.high, count))


@dataclass(frozen=True)
class SharedScatter:
    """What rows share, with the names of its parameters.

    Attributes
    ----------
    scatter : its statistics
    parameters : name among the inputs of each of its scales, in their order
    axes : axis of each column of the discrepancy
    series : levels of the label column within which noise is correlated; one empty name without it
    along : columns of curves and of correlated noise, SI, each of shape ``(N,)``; without the order of the rows
    """

    scatter: CorrelatedScatter
    parameters: tuple[str, ...]
    axes: tuple[Axis, ...] = ()
    series: tuple[str, ...] = ()
    along: Mapping[str, FloatArray] = field(default_factory=dict)

    def rows(self, keep: NDArray[np.bool_]) -> SharedScatter:
        """The same for some of the rows."""
        along = {name: values[keep] for name, values in self.along.items()}
        return replace(self, scatter=self.scatter.rows(keep), along=along)

    def curves(self, effects: FloatArray, count: int) -> Iterable[tuple[Axis, FloatArray, FloatArray]]:
        """Each axis, ``count`` values of its column, and the curves there ``(B, levels, count)`` of effects ``(B, K)``."""
        for number, (axis, curve) in enumerate(zip(self.axes, self.scatter.curves, strict=True)):
            own = effects[:, self.scatter.curve_effects(number)].reshape(len(effects), curve.n_levels, -1)
            values = axis.grid(count)
            yield axis, values, own @ curve.interpolation(np.linspace(0.0, 1.0, count)).T


def scatter_parameters(
    spec: ModelSpec, rows: Conditions, columns: dict[str, FloatArray]
) -> tuple[ParameterSpec, ...]:
    """Parameters of discrepancy and correlation, with the usual priors of those that the model file does not give.

    Raises
    ------
    InputError
        a column is missing, has too few values, or the prior of a length makes of a curve a constant or noise
    """
    found: list[ParameterSpec] = []
    if spec.discrepancy is not None:
        given = {p.label: p for p in spec.discrepancy.parameters}
        for axis in _axes(spec, rows, columns):
            found.append(given[f"discrepancy_size[{axis.column}]"])
            spacing = _spacing(spec, axis, rows, columns)
            label = f"discrepancy_length[{axis.column}]"
            if label in given:
                _check_length(spec, given[label], spacing)
                found.append(given[label])
                continue
            least = min(max(LEAST_LENGTH, SPACINGS * spacing), 0.5)
            prior = {
                "loguniform": [float(f"{least:.3g}"), 1.0],
                "source": "usual: from two spacings of the data, at least a tenth of their range, to all of it",
            }
            quantity = QUANTITIES["discrepancy_length"]
            found.append(parse_parameter(quantity, prior, str(spec.path), "1", DISCREPANCY, axis.column))
    if spec.correlation is not None:
        given = {p.name: p for p in spec.correlation.parameters}
        along, unit = spec.correlation.along, column_unit(spec.correlation.along)
        if "correlation_length" not in given:
            values = _column(spec, "noise.correlation.along", along, rows, columns)
            gaps = np.diff(np.unique(values))
            if gaps.size < FEWEST_VALUES:
                raise InputError(
                    f"{spec.path}: noise.correlation: only {gaps.size + 1} different values of {along}"
                )
            ends = [float(f"{end:.3g}") for end in (np.median(gaps) / 2, np.ptp(values) / 4)]
            prior = {
                "loguniform": ends if unit == "1" else [f"{end} {unit}" for end in ends],
                "source": "usual: from half of a spacing of the data to a quarter of their range",
            }
            quantity = QUANTITIES["correlation_length"]
            given["correlation_length"] = parse_parameter(quantity, prior, str(spec.path), unit)
        names = ("correlation_length", "independent_fraction", "drift_scale")
        found += [given[name] for name in names if name in given]
    return tuple(found)


def shared_scatter(
    spec: ModelSpec,
    rows: Conditions,
    columns: dict[str, FloatArray],
    groups: CrossedGroups | None,
    parameters: Iterable[ParameterSpec],
) -> SharedScatter | None:
    """What rows share beyond the effects of groups; None if that is all.

    Raises
    ------
    InputError
        labels are missing, rows of a series coincide, or there are too many effects
    """
    if spec.discrepancy is None and spec.correlation is None:
        return None
    axes = _axes(spec, rows, columns)
    known = {p.label: p for p in parameters}
    curves: list[SmoothCurves] = []
    names = [] if groups is None else [f"group_scale[{column}]" for column in groups.columns]
    for axis in axes:
        label = f"discrepancy_length[{axis.column}]"
        length, prior = known[label].value, known[label].prior
        least = float(length or 1.0) if prior is None else float(prior.quantile(1e-3))
        level, _ = _levels(spec, "discrepancy", axis.within, rows)
        x = axis.coordinate(_column(spec, "discrepancy.along", axis.column, rows, columns))
        curves.append(SmoothCurves(x, level, len(axis.levels), nodes_for(least)))
        names += [f"discrepancy_size[{axis.column}]", label]
    noise, drift, series = None, False, tuple[str, ...]()
    if spec.correlation is not None:
        one = spec.correlation
        level, series = _levels(spec, "noise.correlation", one.within, rows)
        along = _column(spec, "noise.correlation.along", one.along, rows, columns)
        try:
            noise = CorrelatedNoise.of(along, level, one.independent)
        except InputError as error:
            raise InputError(f"{spec.path}: noise.correlation: {error}") from None
        drift = one.drift
        chosen = ("correlation_length", "independent_fraction", "drift_scale")
        names += [name for name, used in zip(chosen, (True, one.independent, drift), strict=True) if used]
    scatter = CorrelatedScatter(rows.n_rows, groups, tuple(curves), noise, drift)
    if scatter.n_effects > MOST_EFFECTS:
        raise InputError(
            f"{spec.path}: groups, curves and drifts are {scatter.n_effects} effects together; expected at most {MOST_EFFECTS}, "
            "with which time and memory were measured: take longer curves, or the same one for all levels"
        )
    used = [axis.column for axis in axes] + ([] if spec.correlation is None else [spec.correlation.along])
    given = {name: columns[name] for name in used if name != ORDER}
    return SharedScatter(scatter, tuple(names), axes, series, given)


def _axes(spec: ModelSpec, rows: Conditions, columns: dict[str, FloatArray]) -> tuple[Axis, ...]:
    if spec.discrepancy is None:
        return ()
    one, found = spec.discrepancy, []
    _, levels = _levels(spec, "discrepancy", one.within, rows)
    for column in one.columns:
        values = _column(spec, "discrepancy.along", column, rows, columns)
        low, high = float(values.min()), float(values.max())
        logarithmic = one.axis == "logarithmic"
        if one.axis is None:
            logarithmic = column != ORDER and low > 0.0 and high / low >= DECADE
        if logarithmic and not low > 0.0:
            raise InputError(
                f'{spec.path}: discrepancy.axis = "logarithmic", but {column} goes down to {low:.3g}; expected values > 0'
            )
        found.append(Axis(column, logarithmic, low, high, one.within, levels))
    return tuple(found)


def _spacing(spec: ModelSpec, axis: Axis, rows: Conditions, columns: dict[str, FloatArray]) -> float:
    """Mean distance of neighbouring values of a column, as a fraction of its range; of the typical level where there are any."""
    level, levels = _levels(spec, "discrepancy", axis.within, rows)
    values = _column(spec, "discrepancy.along", axis.column, rows, columns)
    counts = [np.unique(values[level == i]).size for i in range(len(levels))]
    count = float(np.median(counts))
    if count < FEWEST_VALUES:
        each = f" in the typical {axis.within}" if axis.within else ""
        raise InputError(
            f"{spec.path}: discrepancy.along: {count:.0f} different values of {axis.column}{each}; expected at least "
            f"{FEWEST_VALUES}, since fewer do not tell a curve from noise"
        )
    return 1.0 / (count - 1.0)


def _check_length(spec: ModelSpec, length: ParameterSpec, spacing: float) -> None:
    """Refuse lengths at which a curve is noise, or what the theory itself predicts."""
    if length.prior is None:
        low = high = float(length.value or 0.0)
    else:
        low, high = (float(length.prior.quantile(q)) for q in (TAIL, 1.0 - TAIL))
    if not (low >= spacing and high <= LONGEST):
        raise InputError(
            f"{spec.path}: discrepancy.length: {'the value is' if low == high else '98 % of the prior lie between'} {low:.3g}"
            f"{'' if low == high else f' and {high:.3g}'}; expected at least {spacing:.3g}, the mean spacing of the data, below "
            f"which a curve cannot be told from noise, and at most {LONGEST:g}, beyond which it is a constant. It is a fraction "
            "of the range of the column"
        )


def _levels(
    spec: ModelSpec, key: str, column: str | None, rows: Conditions
) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Number of the level of each row, and all levels; one without name for all rows if there is no column."""
    if column is None:
        return np.zeros(rows.n_rows, dtype=np.intp), ("",)
    if column not in rows.labels:
        raise InputError(
            f"{spec.path}: {key}.within: the data have no column '{column}'."
            f"{label_meant(column, rows.labels)}".rstrip(".")
        )
    place: dict[str, int] = {}
    level = [place.setdefault(label, len(place)) for label in rows.labels[column].tolist()]
    return np.array(level, dtype=np.intp), tuple(place)


def _column(
    spec: ModelSpec, key: str, column: str, rows: Conditions, columns: dict[str, FloatArray]
) -> FloatArray:
    if column == ORDER:
        return np.arange(1.0, rows.n_rows + 1.0)
    if column not in columns:
        known = ", ".join([*columns, ORDER])
        raise InputError(f"{spec.path}: {key}: the data have no column '{column}'; numeric columns: {known}")
    if column in spec.observables:
        raise InputError(
            f"{spec.path}: {key}: '{column}' is what the model explains; expected another column"
        )
    return columns[column]
