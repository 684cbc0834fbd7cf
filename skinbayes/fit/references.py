"""What to cite for a fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from skinbayes.problem import Problem

THEORY = (
    "Persson, Kovalev & Gorb 2013, Tribology Letters 50:17, doi 10.1007/s11249-012-0053-2 (contact and friction of skin)",
    "Persson 2001, Journal of Chemical Physics 115:3840, doi 10.1063/1.1388626 (contact area)",
)
SOFTWARE = (
    "Foreman-Mackey, Hogg, Lang & Goodman 2013, PASP 125:306, doi 10.1086/670067 (emcee)",
    "Kumar, Carroll, Hartikainen & Martin 2019, JOSS 4:1143, doi 10.21105/joss.01143 (ArviZ)",
)


def references(problem: Problem) -> list[str]:
    """References for theory, data and software of a problem, each with a DOI where there is one."""
    data: list[str] = []
    if problem.dataset is not None and problem.dataset.provenance is not None:
        origin = problem.dataset.provenance
        doi = ", ".join(origin.doi)
        data.append(f"{', '.join(origin.authors)}: {origin.title}{f', doi {doi}' if doi else ''} (data)")
    return [*THEORY, *data, *SOFTWARE]
