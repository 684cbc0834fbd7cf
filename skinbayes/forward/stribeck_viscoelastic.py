"""Forward model ``stribeck`` on skin that relaxes: speed and viscosity act apart, and the tissue dissipates (Sect. 6.2)."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.contact_inputs import SKIN_INPUTS
from skinbayes.forward.stribeck_direct import FLAGS, Theory, explain
from skinbayes.forward.stribeck_remembering import FIELDS, solve, with_profile
from skinbayes.forward.stribeck_remembering_table import prepare
from skinbayes.lubrication.viscoelastic_memory import (
    CONSTANT_LOSS,
    RELAXATION_PARAMETERS,
    STANDARD_LINEAR_SOLID,
)

REFERENCE_ANGULAR_FREQUENCY = 10.0
"""1/s, at which moduli of a constant loss angle are given unless told otherwise: that of a contact of 1 mm at 1 cm/s."""

LAYER_DEFAULTS = {
    STANDARD_LINEAR_SOLID: {"relaxation_strength_layer": 0.0, "relaxation_time_layer": 1.0},
    CONSTANT_LOSS: {"loss_tangent_layer": 0.0, "reference_angular_frequency": REFERENCE_ANGULAR_FREQUENCY},
}
"""The layer is elastic unless told otherwise: it enters with nothing but its modulus at v/b."""

_APART = "on skin that is not elastic speed and viscosity act apart, and their product does not say enough"


def _evaluate(
    inputs: Inputs, tables: Tables, theory: Theory, names: tuple[str, ...]
) -> dict[str, FloatArray]:
    found = solve(inputs, tables, names, theory)
    return {name: found[name] for name in FIELDS}


def _flags(inputs: Inputs, tables: Tables, theory: Theory, names: tuple[str, ...]) -> dict[str, BoolArray]:
    found = solve(inputs, tables, names, theory)
    return {name: found[name] > 0 for name in FLAGS}


def _explain(inputs: Inputs, tables: Tables, theory: Theory, names: tuple[str, ...]) -> list[str]:
    return explain(solve(inputs, tables, names, theory))


def _abscissa(inputs: Inputs, tables: Tables, theory: Theory, names: tuple[str, ...]) -> FloatArray:
    return solve(inputs, tables, names, theory)["speed_viscosity_product"]


def on_viscoelastic_skin(elastic: ForwardModel, theory: Theory) -> ForwardModel:
    """The forward model of elastic skin for another substrate of layered skin."""
    relaxing = RELAXATION_PARAMETERS[theory.substrate]
    layer = LAYER_DEFAULTS[theory.substrate]
    optional = {name: value for name, value in elastic.optional.items() if name != "poisson_ratio"} | layer
    needed = ("viscosity", "sliding_speed")
    bare = replace(
        elastic,
        summary=f"{elastic.summary}, on skin that relaxes; the loss of its tissue is a part of the friction",
        observables=tuple(FIELDS),
        required=(
            "frictional_shear_stress",
            "sphere_radius",
            "normal_force",
            *SKIN_INPUTS,
            *needed,
            *(name for name in relaxing if name not in layer),
        ),
        optional=optional,
        goes_with={},
        why_needed=dict.fromkeys(needed, _APART),
    )
    names = bare.input_names()
    chosen: dict[str, Any] = {"theory": theory, "names": names}
    model = replace(
        bare,
        evaluate=partial(_evaluate, **chosen),
        flags=partial(_flags, **chosen),
        explain=partial(_explain, **chosen),
        abscissa=partial(_abscissa, **chosen),
        prepare=partial(prepare, theory=theory),
    )
    return with_profile(model)
