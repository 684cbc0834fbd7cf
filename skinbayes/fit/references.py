"""What to cite for a fit: the theory that its model used, its data, the methods, and this software."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.fit.bibliography import Reference, key_of, works
from skinbayes.version import __version__

if TYPE_CHECKING:
    from skinbayes.files.dataset import Dataset
    from skinbayes.problem import Problem

BRIDGES = {"surface_tension", "contact_angle_skin", "contact_angle_counterface"}
"""Inputs of models with capillary bridges."""

LUBRICATED = {"viscosity", "speed_viscosity_product"}


METHODS = {
    "emcee": ("foremanmackey2013emcee", "terbraak2006markov", "vehtari2021rank"),
    "nested": ("speagle2020dynesty", "skilling2006nested"),
}
"""Keys of what to cite for an engine."""


def references(problem: Problem, engine: str = "emcee") -> list[Reference]:
    """Theory, data, methods and software that a fit of a problem rests on.

    Theory follows from what enters the model: roughness, the correction of small contact areas unless it is 1, a yield stress
    that is finite, capillary bridges, a lubricant. A model without contact mechanics cites none.
    """
    origin = [] if problem.dataset is None else data_reference(problem.dataset)
    known = works()
    theory = [known[key] for key in _theory(problem)]
    methods = [known[key] for key in (*METHODS.get(engine, ()), "kumar2019arviz")]
    return [*theory, *origin, *methods, software()]


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


def _theory(problem: Problem) -> list[str]:
    """Keys of the works whose equations enter the model."""
    if not problem.forward.uses_surface:
        return []
    names = set(problem.forward.input_names())
    values = problem.inputs(problem.prior_medians()[np.newaxis])

    def is_used(name: str, idle: float) -> bool:
        return name in values and bool(np.any(values[name] != idle))

    bridges, liquid = bool(BRIDGES & names), bool(LUBRICATED & names)
    used = {
        "persson2013skin": True,
        "persson2001theory": True,
        "yang2008contact": bridges or liquid or is_used("area_correction", 1.0),
        "persson2001elastoplastic": is_used("yield_stress", np.inf),
        "persson2007relation": bridges or liquid,
        "almqvist2011interfacial": bridges or liquid,
        "persson2008capillary": bridges,
        "persson2009transition": liquid,
        "persson2011lubricated": liquid,
    }
    return [key for key, needed in used.items() if needed]
