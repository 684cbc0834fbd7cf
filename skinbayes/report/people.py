"""Populations and contrasts on a page: sentences, and the rows of the table of people."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skinbayes.fit.people import Triple, population_findings
from skinbayes.phrases import percent
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.symbols import spoken_name

if TYPE_CHECKING:
    from skinbayes.fit import Fit


def people_sentences(fit: Fit) -> list[str]:
    """What treatments do, then what the populations are; none without populations."""
    findings = population_findings(fit)
    return [c.sentence() for one in findings for c in one.contrasts] + [one.sentence() for one in findings]


def people_rows(fit: Fit) -> list[tuple[str, str, str, str, str]]:
    """Who, what, median, 90 % interval, and how much of it is the population's, for each level and contrast."""
    rows = []
    for finding in population_findings(fit):
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
