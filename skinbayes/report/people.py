"""Populations and contrasts on a page: sentences, and the rows of the table of people."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.fit.people import Contrast, PopulationFinding, Triple
from skinbayes.phrases import number, percent
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.symbols import spoken_name

if TYPE_CHECKING:
    from skinbayes.fit import Fit


SURE = 0.95
"""Probability from which on one person counts as changed."""


def people_sentences(fit: Fit) -> list[str]:
    """What treatments do, then what the populations are; none without populations."""
    findings = fit.population_findings
    return [contrast_sentence(c) for one in findings for c in one.contrasts] + [
        population_sentence(one) for one in findings
    ]


def contrast_values(fit: Fit) -> list[str]:
    """What each treatment does to the median person, in a few words; none without treatments."""
    return [
        f"{_capital(spoken_name(one.parameter))}, {_compared(one)} = {quantity(one.value[1], one.unit)} (90 %: "
        f"{interval(one.value[0], one.value[2], one.unit, typical=one.value[1])})"
        for finding in fit.population_findings
        for one in finding.contrasts
    ]


def _capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}"


def _compared(contrast: Contrast) -> str:
    return f"{contrast.level} {'over' if contrast.kind == 'ratio' else 'less'} {contrast.reference}"


def contrast_sentence(contrast: Contrast) -> str:
    """The contrast in words."""
    low, middle, high = contrast.value
    lower = contrast.probability_lower >= 0.5
    probable = contrast.probability_lower if lower else 1.0 - contrast.probability_lower
    name = spoken_name(contrast.parameter)
    said = (
        f"{_capital(name)}, {_compared(contrast)} ({contrast.column}): {quantity(middle, contrast.unit)} for the median, with "
        "90 % "
        f"probability between {interval(low, high, contrast.unit, typical=middle, joint=' and ')}; it is "
        f"{'lower' if lower else 'higher'} with {contrast.level} with a probability of {_probability(probable)}."
    )
    if not contrast.both_ways:
        return (
            f"{said} Nobody was measured both with {contrast.level} and with {contrast.reference}: different people are "
            "compared, and what the treatment does cannot be told from how they differ anyway."
        )
    if contrast.people:
        sure = sum(max(p, 1.0 - p) >= SURE for _, p in contrast.people.values())
        said += (
            f" Of {len(contrast.people)} taken one by one {sure or 'none'} {'is' if sure == 1 else 'are'} changed with a "
            f"probability of {number(100 * SURE)} % or more."
        )
    return said


def population_sentence(finding: PopulationFinding) -> str:
    """The population in words."""
    low, middle, high = finding.median
    name = spoken_name(finding.parameter)
    medians = [person.value[1] for person in finding.people]
    if finding.scale_of == "ln":
        factors = [float(np.exp(s)) for s in finding.scale]
        apart = (
            f"one {finding.by} differs from the median by a factor of {number(factors[1], 3)} "
            f"({number(factors[0], 3)} to {number(factors[2], 3)}) or so"
        )
    else:
        of = f" of its {finding.scale_of}" if finding.scale_of else ""
        unit = "1" if finding.scale_of else finding.unit
        apart = (
            f"the standard deviation{of} between levels of {finding.by} is {quantity(finding.scale[1], unit)} "
            f"({interval(finding.scale[0], finding.scale[2], unit, typical=finding.scale[1])})"
        )
    return (
        f"{_capital(name)}: {quantity(middle, finding.unit)} for the median {finding.by} (90 %: "
        f"{interval(low, high, finding.unit, typical=middle)}); {apart}. The {len(medians)} have medians between "
        f"{interval(min(medians), max(medians), finding.unit, joint=' and ')}; of how they differ "
        f"{percent(finding.pooling)} is not told by the data."
    )


def people_rows(fit: Fit) -> list[tuple[str, str, str, str, str]]:
    """Who, what, median, 90 % interval, and how much of it is the population's, for each level and contrast."""
    rows = []
    for finding in fit.population_findings:
        name = spoken_name(finding.parameter)
        for person in (*finding.people, *finding.nested):
            shrinkage = percent(min(person.shrinkage, 1.0))
            rows.append((person.level, name, *_value(person.value, finding.unit), shrinkage))
        for contrast in finding.contrasts:
            what = f"{name}, {contrast.level} against {contrast.reference}"
            rows += [
                (level, what, *_value(value, contrast.unit), "")
                for level, (value, _) in contrast.people.items()
            ]
    return rows


def _value(value: Triple, unit: str) -> tuple[str, str]:
    low, middle, high = value
    return quantity(middle, unit), interval(low, high, unit, typical=middle)


def _probability(value: float) -> str:
    if value > 0.999:
        return "more than 99.9 %"
    return f"{100 * value:.1f} %"
