"""What a fit says about populations: the median person, how people differ, each of them, and what a treatment does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.files.population_block import DEVIATE, PopulationSpec
from skinbayes.problem.populations import both_ways
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    import pandas

    from skinbayes.fit.result import FitResult

QUANTILES = (0.05, 0.5, 0.95)

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Person:
    """One level of a population.

    Attributes
    ----------
    level : name
    value : 5, 50 and 95 % quantiles, SI
    shrinkage : how much of what is said is that of the population, from 0 to 1: the variance of the normal score, which is 1
        without data
    """

    level: str
    value: Triple
    shrinkage: float


@dataclass(frozen=True)
class Contrast:
    """What a treatment does to a parameter.

    Attributes
    ----------
    parameter : its name
    column : label column of the treatment
    level, reference : what is compared with what
    kind : ``"ratio"`` of a parameter that is positive, else ``"difference"``
    unit : SI unit
    value : 5, 50 and 95 % quantiles for the median person
    probability_lower : posterior probability that the treatment lowers the parameter of the median person
    spread : 5, 50 and 95 % quantiles of the standard deviation of the effect between people; None if it is the same for all
    people : the same of each person, and the probability that it is lowered
    both_ways : how many were measured with and without it; with none the contrast is one between different people
    """

    parameter: str
    column: str
    level: str
    reference: str
    kind: str
    unit: str
    value: Triple
    probability_lower: float
    spread: Triple | None
    people: dict[str, tuple[Triple, float]]
    both_ways: int


@dataclass(frozen=True)
class PopulationFinding:
    """A parameter with a population.

    Attributes
    ----------
    parameter, by, unit : its name, the label column and its SI unit
    median : 5, 50 and 95 % quantiles of the median of the population
    scale : the same of the standard deviation between people
    scale_of : ``"ln"``, ``"logit"`` or ``""``: of what
    pooling : 1 if the data tell nobody apart, 0 if the population says nothing about anybody: one less the variance between
        people of their mean scores over the mean of the variance between their scores (Gelman & Pardoe 2006,
        doi 10.1198/004017005000000517)
    people : each level
    nested : each level of a second column within the first
    contrasts : what treatments do
    """

    parameter: str
    by: str
    unit: str
    median: Triple
    scale: Triple
    scale_of: str
    pooling: float
    people: tuple[Person, ...]
    nested: tuple[Person, ...]
    contrasts: tuple[Contrast, ...]

    def to_dict(self) -> dict[str, Any]:
        """As plain types."""
        return asdict(self)


def population_findings(fit: FitResult) -> tuple[PopulationFinding, ...]:
    """What is to be said of each parameter with a population; none if the model is gone."""
    if fit.problem is None or fit.problem.populations is None:
        return ()
    return tuple(_finding(fit, spec) for spec in fit.problem.spec.populations)


def _triple(draws: FloatArray) -> Triple:
    low, middle, high = np.quantile(draws, QUANTILES)
    return float(low), float(middle), float(high)


def _draws(fit: FitResult, label: str) -> FloatArray:
    """Of a parameter that may be fixed."""
    if label in fit.names:
        return fit.draws(label)
    return np.array([float(fit.provenance["fixed"][label]["value"])])


def _levels(fit: FitResult, name: str) -> list[str]:
    variable = fit.groups["posterior"].get(name)
    return [] if variable is None else [str(level) for level in variable[variable.dims[-1]].values]


def _people(fit: FitResult, spec: PopulationSpec, name: str) -> tuple[Person, ...]:
    return tuple(
        Person(
            level,
            _triple(fit.draws(f"{name}[{level}]")),
            float(fit.draws(f"{DEVIATE}[{spec.name}, {level}]").var()),
        )
        for level in _levels(fit, name)
    )


def _finding(fit: FitResult, spec: PopulationSpec) -> PopulationFinding:
    people = _people(fit, spec, f"{spec.by}_{spec.name}")
    scale = _draws(fit, spec.scale.label)
    scores = (
        np.stack([fit.draws(f"{DEVIATE}[{spec.name}, {one.level}]") for one in people], axis=-1)
        * scale[:, None]
    )
    between = float(scores.var(axis=1).mean())
    kind = spec.natural.kind
    return PopulationFinding(
        spec.name,
        spec.by,
        fit.unit(spec.name) if spec.name in fit.names else QUANTITIES[spec.name].unit,
        _triple(_draws(fit, spec.name)),
        _triple(scale),
        "" if kind == "identity" else "ln" if kind.startswith("log") and "logit" not in kind else "logit",
        float(np.clip(1.0 - scores.mean(axis=0).var() / between, 0.0, 1.0)) if between else 1.0,
        people,
        _people(fit, spec, f"{spec.by}_{spec.within}_{spec.name}") if spec.within else (),
        tuple(_contrasts(fit, spec)),
    )


def _contrasts(fit: FitResult, spec: PopulationSpec) -> list[Contrast]:
    contrast, found = spec.contrast, []
    if contrast is None or fit.problem is None or fit.problem.populations is None:
        return []
    kind = "ratio" if spec.natural.kind == "log" else "difference"
    both = both_ways(spec, fit.problem.conditions.labels)
    none, name = (1.0 if kind == "ratio" else 0.0), f"{spec.name}_{kind}"
    for _, parts in [one for one in fit.problem.populations.at(fit.problem.conditions) if one[0] is spec]:
        for part in parts:
            if part.location is None:
                continue
            level = part.location.rpartition(", ")[2].removesuffix("]")
            said = f"{level}/{contrast.reference}"
            values = fit.draws(f"{name}[{said}]")
            own, ending = f"{spec.by}_{name}", f", {said}"
            people = {
                one.removesuffix(ending): fit.draws(f"{own}[{one}]")
                for one in _levels(fit, own)
                if one.endswith(ending)
            }
            found.append(
                Contrast(
                    spec.name, contrast.column, level, contrast.reference, kind,
                    "1" if kind == "ratio" else QUANTITIES[spec.name].unit, _triple(values),
                    float((values < none).mean()), None if part.scale is None else _triple(_draws(fit, part.scale)),
                    {one: (_triple(draws), float((draws < none).mean())) for one, draws in people.items()},
                    both[level],
                )
            )  # fmt: skip
    return found


def people_table(findings: Sequence[PopulationFinding]) -> pandas.DataFrame:
    """Each person's value of each parameter with a population, see :meth:`skinbayes.Fit.people`."""
    import pandas

    rows = [
        {
            "parameter": one.parameter, "level": person.level, "unit": one.unit,
            **dict(zip(("q05", "median", "q95"), person.value, strict=True)), "shrinkage": person.shrinkage,
        }
        for one in findings
        for person in (*one.people, *one.nested)
    ]  # fmt: skip
    columns = ["parameter", "level", "unit", "q05", "median", "q95", "shrinkage"]
    return pandas.DataFrame(rows, columns=columns)


def contrast_table(findings: Sequence[PopulationFinding]) -> pandas.DataFrame:
    """What treatments do, see :meth:`skinbayes.Fit.contrasts`."""
    import pandas

    columns = ["parameter", "compared", "who", "kind", "unit", "q05", "median", "q95", "probability_lower"]
    rows: list[list[Any]] = []
    for one in (contrast for finding in findings for contrast in finding.contrasts):
        compared = f"{one.level}/{one.reference}"
        everyone = {"": (one.value, one.probability_lower), **one.people}
        rows += [
            [one.parameter, compared, who, one.kind, one.unit, *value, probability]
            for who, (value, probability) in everyone.items()
        ]
    return pandas.DataFrame(rows, columns=columns)
