"""Parameters that differ from person to person as a population does, bound to rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.population_block import DEVIATE, POPULATION, PopulationSpec, of_level
from skinbayes.problem.inputs import Conditions, label_meant
from skinbayes.statistics.hierarchy import Grouping, Hierarchy, Term
from skinbayes.statistics.priors import make_prior
from skinbayes.statistics.transforms import Transform
from skinbayes.vocabulary import QUANTITIES


@dataclass(frozen=True)
class Part:
    """One term of a value: ``location + scale · deviate`` in some rows.

    Attributes
    ----------
    location : label of the effect of a treatment, or None
    scale : label of the standard deviation of the deviates, or None without any
    deviates : label of the deviate of each level that has one
    level : number of the deviate of each row, −1 for none; shape ``(N,)``
    active : rows in which the location is added, shape ``(N,)``
    """

    location: str | None
    scale: str | None
    deviates: tuple[str, ...]
    level: NDArray[np.intp]
    active: NDArray[np.bool_]


class Named(NamedTuple):
    """A quantity of each level.

    Attributes
    ----------
    name : such as ``person_young_modulus_layer``, or ``young_modulus_layer_ratio`` of a treatment
    levels : names
    values : ``(B, J)``, SI
    unit : SI unit
    """

    name: str
    levels: tuple[str, ...]
    values: FloatArray
    unit: str


def both_ways(spec: PopulationSpec, labels: Mapping[str, NDArray[np.str_]]) -> dict[str, int]:
    """How many people were measured with each treatment and without any; empty if the parameter has no contrast."""
    contrast = spec.contrast
    if contrast is None:
        return {}
    seen: dict[str, set[str]] = {}
    for who, treatment in zip(labels[spec.by].tolist(), labels[contrast.column].tolist(), strict=True):
        seen.setdefault(str(treatment), set()).add(str(who))
    without = seen.pop(contrast.reference)
    return {treatment: len(who & without) for treatment, who in seen.items()}


def population_parameters(
    specs: Sequence[PopulationSpec], conditions: Conditions, where: object
) -> tuple[ParameterSpec, ...]:
    """Scales, effects of treatments and the deviates of all levels, for rows that have the label columns.

    Raises
    ------
    InputError
        The rows lack a column, have a single level, or none with and without a treatment.
    """
    found: list[ParameterSpec] = []
    deviates: list[ParameterSpec] = []
    for spec in specs:
        place = f"{where}: parameters.{spec.name}.population"
        for column in spec.columns:
            if column not in conditions.labels:
                raise InputError(
                    f"{place}: the data have no column '{column}'.{label_meant(column, conditions.labels)}".rstrip(
                        "."
                    )
                )
        if len(set(conditions.labels[spec.by].tolist())) < 2:
            raise InputError(
                f"{place}: all rows have one {spec.by}; a population takes several: drop it, or give further data"
            )
        found.append(spec.scale)
        found += [spec.within_scale] if spec.within_scale is not None else []
        if (contrast := spec.contrast) is not None:
            levels = _levels(conditions.labels[contrast.column])
            if contrast.reference not in levels or len(levels) < 2:
                raise InputError(
                    f"{place}.contrast: the column '{contrast.column}' has {', '.join(levels)}; expected '{contrast.reference}', "
                    "the reference, and at least one other"
                )
            for level in levels:
                if level != contrast.reference:
                    label = f"{spec.name}, {level}"
                    found.append(of_level(contrast.effect, label))
                    found += [] if contrast.scale is None else [of_level(contrast.scale, label)]
        for part in parts(spec, conditions):
            deviates += [_deviate(label) for label in part.deviates]
    return (*found, *deviates)


def _deviate(label: str) -> ParameterSpec:
    level = label.partition("[")[2].removesuffix("]")
    return ParameterSpec(
        DEVIATE, "1", POPULATION, level, None, make_prior("normal", [0.0, 1.0]), {"normal": [0, 1]},
        "the population is normal",
    )  # fmt: skip


def parts(spec: PopulationSpec, conditions: Conditions, known: Sequence[str] | None = None) -> list[Part]:
    """The terms of a parameter at rows.

    Parameters
    ----------
    spec : the parameter
    conditions : rows; a column that they lack is one of levels that nobody knows
    known : labels of the deviates that there are; rows of others have none. All if omitted
    """
    rows = conditions.n_rows
    everywhere, nobody = np.ones(rows, dtype=bool), np.full(rows, "", dtype=str)
    by = conditions.labels.get(spec.by, nobody)
    found = [_part(None, spec.scale.label, [f"{spec.name}, {a}" for a in by], everywhere, everywhere, known)]
    if spec.within is not None and spec.within_scale is not None:
        nested = conditions.labels.get(spec.within, nobody)
        keys = [f"{spec.name}, {a}, {b}" for a, b in zip(by, nested, strict=True)]
        found.append(_part(None, spec.within_scale.label, keys, everywhere, everywhere, known))
    if (contrast := spec.contrast) is not None:
        treatment = conditions.labels.get(contrast.column, np.full(rows, contrast.reference))
        for level in _levels(treatment):
            if level != contrast.reference:
                here, label = treatment == level, f"{spec.name}, {level}"
                scale = None if contrast.scale is None else of_level(contrast.scale, label).label
                keys = [f"{spec.name}, {a}, {contrasted(level, contrast.reference)}" for a in by]
                effect = of_level(contrast.effect, label).label
                found.append(_part(effect, scale, keys, here, here & (scale is not None), known))
    return found


def contrasted(level: str, reference: str) -> str:
    """How a level is said beside its reference."""
    return f"{level}/{reference}"


def new_people(populations: Populations, conditions: Conditions) -> tuple[ParameterSpec, ...]:
    """Deviates of people at rows that are not among the parameters."""
    wanted = [
        label for spec in populations.specs for part in parts(spec, conditions) for label in part.deviates
    ]
    return tuple(_deviate(label) for label in wanted if label not in populations.free)


def _part(
    location: str | None,
    scale: str | None,
    keys: Sequence[str],
    active: NDArray[np.bool_],
    deviating: NDArray[np.bool_],
    known: Sequence[str] | None,
) -> Part:
    labels = [f"{DEVIATE}[{key}]" for key in keys]
    used = dict.fromkeys(label for label, on in zip(labels, deviating, strict=True) if on)
    among = None if known is None else set(known)
    deviates = tuple(label for label in used if among is None or label in among)
    place = {label: i for i, label in enumerate(deviates)}
    level = np.array(
        [place.get(label, -1) if on else -1 for label, on in zip(labels, deviating, strict=True)]
    )
    return Part(location, scale, deviates, level.astype(np.intp), np.asarray(active))


def _levels(labels: NDArray[np.str_]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(labels.tolist()))


@dataclass(frozen=True, eq=False)
class Populations:
    """All parameters of a problem that have a population.

    Attributes
    ----------
    specs : the parameters
    free, fixed : labels of the parameters of the problem in their order, and values of fixed ones by label
    """

    specs: tuple[PopulationSpec, ...]
    free: tuple[str, ...]
    fixed: Mapping[str, float]

    @cached_property
    def _places(self) -> dict[str, int]:
        return {label: place for place, label in enumerate(self.free)}

    @classmethod
    def of(
        cls, specs: Sequence[PopulationSpec], free: Sequence[ParameterSpec], fixed: Sequence[ParameterSpec]
    ) -> Populations:
        """Those of a problem."""
        values = {p.label: float(p.value) for p in fixed if p.value is not None}
        return cls(tuple(specs), tuple(p.label for p in free), values)

    def at(self, conditions: Conditions) -> list[tuple[PopulationSpec, list[Part]]]:
        """The terms of each parameter at rows; people who are not among the parameters are as the median."""
        return [(spec, parts(spec, conditions, self.free)) for spec in self.specs]

    def inputs(
        self,
        theta: FloatArray,
        values: Mapping[str, FloatArray],
        bound: Sequence[tuple[PopulationSpec, list[Part]]],
    ) -> dict[str, FloatArray]:
        """Values of the parameters at rows, ``(B or 1, N)``, SI.

        Parameters
        ----------
        theta : ``(B, D)``
        values : medians of the populations among the inputs, ``(B or 1, 1)``
        bound : from :meth:`at`
        """
        found = {}
        for spec, of_spec in bound:
            natural = spec.natural
            place = natural.forward(values[spec.name])
            for part in of_spec:
                if part.location is not None and part.active.any():
                    place = place + np.where(part.active, self._column(theta, part.location), 0.0)
                if part.scale is not None and part.deviates:
                    # a column of zeros last, for rows without a deviate
                    scores = np.concatenate([self._scores(theta, part), np.zeros((len(theta), 1))], axis=1)
                    place = place + scores.take(part.level, axis=1)
            found[spec.name] = np.ascontiguousarray(natural.inverse(place))
        return found

    def _column(self, theta: FloatArray, label: str) -> FloatArray:
        """A parameter of the batch, ``(B, 1)``, or ``(1, 1)`` if it is fixed."""
        if label in self.fixed:
            return np.full((1, 1), self.fixed[label])
        return theta[:, [self._places[label]]]

    def people(self, theta: FloatArray, conditions: Conditions) -> list[Named]:
        """Values of all levels, and what treatments do, for parameter vectors ``(B, D)``."""
        found = []
        for spec, of_spec in self.at(conditions):
            natural, quantity = spec.natural, QUANTITIES[spec.name]
            median = self._column(theta, spec.name)
            base = natural.forward(median)
            for number, part in enumerate(of_spec):
                scores = self._scores(theta, part)
                levels = tuple(
                    label.partition(f"[{spec.name}, ")[2].removesuffix("]") for label in part.deviates
                )
                if part.location is None:
                    place = base + scores
                    if number:  # nested: on top of the level that it is in
                        first = [
                            int(of_spec[0].level[np.argmax(part.level == i)]) for i in range(len(levels))
                        ]
                        place = base + self._scores(theta, of_spec[0])[:, first] + scores
                    column = "_".join(spec.columns[: 1 + (number > 0)])
                    found.append(
                        Named(f"{column}_{spec.name}", levels, natural.inverse(place), quantity.unit)
                    )
                    continue
                effect = self._column(theta, part.location)
                ratio = natural.kind == "log"
                word, unit = ("ratio", "1") if ratio else ("difference", quantity.unit)
                against = part.location.rpartition(", ")[2].removesuffix("]")
                contrast = spec.contrast
                assert contrast is not None
                whole = np.exp(effect) if ratio else natural.inverse(base + effect) - median
                said = contrasted(against, contrast.reference)
                found.append(Named(f"{spec.name}_{word}", (said,), whole, unit))
                if levels:
                    each = effect + scores
                    own = np.exp(each) if ratio else natural.inverse(base + each) - median
                    found.append(Named(f"{spec.by}_{spec.name}_{word}", levels, own, unit))
        return found

    def _scores(self, theta: FloatArray, part: Part) -> FloatArray:
        """Deviates of a term times their scale, ``(B, J)``."""
        if part.scale is None or not part.deviates:
            return np.zeros((len(theta), 0))
        scores = theta[:, [self._places[label] for label in part.deviates]]
        return np.asarray(self._column(theta, part.scale) * scores)

    def levels_of_rows(self, conditions: Conditions) -> dict[str, NDArray[np.intp]]:
        """What tells rows of different people apart: a number for each row and term."""
        return {
            f"{spec.name} {i}": part.level + (part.active.astype(np.intp) << 32)
            for spec, of_spec in self.at(conditions)
            for i, part in enumerate(of_spec)
        }

    def hierarchy(self, conditions: Conditions, observations: int) -> Hierarchy:
        """The structure for moves that go level by level; data are ``observations`` of all rows, one after the other."""
        terms: list[Term] = []
        of_column: dict[str, dict[str, list[tuple[int, int]]]] = {}
        for spec, of_spec in self.at(conditions):
            labels = conditions.labels[spec.by]
            blocks = of_column.setdefault(spec.by, {level: [] for level in _levels(labels)})
            for number, part in enumerate(of_spec):
                if part.scale is None or not part.deviates:
                    continue
                location = spec.name if number == 0 else part.location
                places = np.array([self._places[label] for label in part.deviates])
                natural = spec.natural if number == 0 else Transform()
                terms.append(self._term(places, location, natural, part.scale))
                for i, place in enumerate(places.tolist()):
                    owner = str(labels[np.argmax(part.level == i)])
                    blocks[owner].append((place, len(terms) - 1))
        groupings = []
        for column, levels in of_column.items():
            width = max(map(len, levels.values()))
            padded = np.array([[*block, *[(-1, 0)] * (width - len(block))] for block in levels.values()])
            names = list(levels)
            level = np.array([names.index(label) for label in conditions.labels[column].tolist()])
            groupings.append(Grouping(column, padded[..., 0], padded[..., 1], np.tile(level, observations)))
        return Hierarchy(tuple(terms), tuple(groupings), len(self.free))

    def _term(self, places: NDArray[np.intp], location: str | None, transform: Transform, scale: str) -> Term:
        at, value = -1, 0.0
        if location is not None and location in self.fixed:
            value = float(transform.forward(self.fixed[location]))
        elif location is not None:
            at = self._places[location]
        fixed = scale in self.fixed
        return Term(
            places,
            at,
            value,
            transform,
            -1 if fixed else self._places[scale],
            self.fixed[scale] if fixed else 0.0,
        )
