"""What to cite for a fit: the theory that its model used, its data, the methods, and this software."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.fit.bibliography import (
    ARVIZ,
    CAPILLARY,
    DIFFERENTIAL_EVOLUTION,
    DYNESTY,
    ELASTOPLASTIC,
    EMCEE,
    FLOW_FACTORS,
    GAPS,
    MIXED_LUBRICATION,
    NESTED_SAMPLING,
    PERSSON_2001,
    PERSSON_2013,
    R_HAT,
    SEPARATION,
    YANG_PERSSON,
    Reference,
    key_of,
)
from skinbayes.version import __version__

if TYPE_CHECKING:
    from skinbayes.files.dataset import Dataset
    from skinbayes.problem import Problem

BRIDGES = {"surface_tension", "contact_angle_skin", "contact_angle_counterface"}
"""Inputs of models with capillary bridges."""

LUBRICATED = {"viscosity", "speed_viscosity_product"}


METHODS = {
    "emcee": (EMCEE, DIFFERENTIAL_EVOLUTION, R_HAT),
    "nested": (DYNESTY, NESTED_SAMPLING),
}
"""What to cite for an engine."""


def references(problem: Problem, engine: str = "emcee") -> list[Reference]:
    """Theory, data, methods and software that a fit of a problem rests on.

    Theory follows from what enters the model: roughness, the correction of small contact areas unless it is 1, a yield stress
    that is finite, capillary bridges, a lubricant. A model without contact mechanics cites none.
    """
    origin = [] if problem.dataset is None else data_reference(problem.dataset)
    return [*_theory(problem), *origin, *METHODS.get(engine, ()), ARVIZ, software()]


def data_reference(dataset: Dataset) -> list[Reference]:
    """The source of a data set, if it states one."""
    if dataset.provenance is None:
        return []
    known = dataset.provenance
    key = f"data-{key_of(PurePath(dataset.key).stem)}"
    return [Reference(key, tuple(known.authors), known.title, "data", doi=tuple(known.doi))]


def software() -> Reference:
    """This package."""
    return Reference(
        "skinbayes", ("The skinbayes developers",), "skinbayes: Bayesian inference of skin mechanics from friction data",
        "this software", version=__version__,
    )  # fmt: skip


def _theory(problem: Problem) -> list[Reference]:
    if not problem.forward.uses_surface:
        return []
    names = set(problem.forward.input_names())
    values = problem.inputs(problem.prior_medians()[np.newaxis])

    def is_used(name: str, idle: float) -> bool:
        return name in values and bool(np.any(values[name] != idle))

    bridges, liquid = bool(BRIDGES & names), bool(LUBRICATED & names)
    used = {
        PERSSON_2013: True,
        PERSSON_2001: True,
        YANG_PERSSON: bridges or liquid or is_used("area_correction", 1.0),
        ELASTOPLASTIC: is_used("yield_stress", np.inf),
        SEPARATION: bridges or liquid,
        GAPS: bridges or liquid,
        CAPILLARY: bridges,
        MIXED_LUBRICATION: liquid,
        FLOW_FACTORS: liquid,
    }
    return [reference for reference, needed in used.items() if needed]
