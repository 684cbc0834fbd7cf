"""Forward model ``stribeck-descriptive``: the shape of a Stribeck curve without a theory behind it.

With x = ηv / (S_t (F_N / 1 N)^m), speed times viscosity over that of the transition,

    μ = (μ_0 + μ_r x^b x^a) / (1 + x^a)

a mean of the plateau μ_0 of boundary friction, x ≪ 1, and of the rising branch μ_r x^b of full films, x ≫ 1, with weights
1 and x^a. It is smooth and positive, and lies between the two. Such an interpolation describes measured curves of soft
contacts: Bongaerts, Fourtouni & Stokes, Tribology International 40 (2007) 1531, doi 10.1016/j.triboint.2007.01.007, there
without the load. It says nothing on skin; it is what a theory of as many parameters has to beat.
"""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.stribeck_direct import SPEED_ALTERNATIVES, speed_viscosity_product_of

REFERENCE_LOAD = 1.0
"""Load at which the transition is at ``transition_speed_viscosity_product``, N."""

LAW = (
    "plateau_friction_coefficient",
    "transition_speed_viscosity_product",
    "transition_exponent",
    "rising_friction_coefficient",
    "rising_exponent",
)


def _abscissa(inputs: Inputs, tables: Tables) -> FloatArray:
    return speed_viscosity_product_of(inputs)


def _friction(inputs: Inputs, product: FloatArray) -> FloatArray:
    """Friction coefficient at ηv [N/m]; all broadcast."""
    plateau, transition, sharpness, rising, slope = (inputs[name] for name in LAW)
    load = inputs["normal_force"] / REFERENCE_LOAD
    # 1/(1 + x^a) and x^a/(1 + x^a) do not overflow; where x itself, or x^b, is beyond all numbers there is no prediction
    with np.errstate(all="ignore"):
        place = product / (transition * load ** inputs["transition_load_exponent"])
        boundary = 1.0 / (1.0 + place**sharpness)
        film = 1.0 / (1.0 + place**-sharpness)
        found = plateau * boundary + rising * place**slope * film
    return np.asarray(np.where(found < np.inf, found, np.nan))


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    return {"friction_coefficient": _friction(inputs, speed_viscosity_product_of(inputs))}


def _validate(inputs: Inputs, tables: Tables) -> None:
    if not (speed_viscosity_product_of(inputs) >= 0).all():
        raise InputError("speed times viscosity is negative somewhere; expected values >= 0 N/m")


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    return np.geomspace(1e-6, 1e1, 71)


def _profile(inputs: Inputs, tables: Tables, products: FloatArray) -> FloatArray:
    columns = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    return _friction(columns, products)


MODEL = ForwardModel(
    name="stribeck-descriptive",
    summary="a Stribeck curve that only describes: plateau, transition, rising branch; the baseline model of theories",
    observables=("friction_coefficient",),
    required=(*LAW, "normal_force", SPEED_ALTERNATIVES),
    optional={"transition_load_exponent": 0.0},
    evaluate=_evaluate,
    abscissa=_abscissa,
    validate=_validate,
    uses_surface=False,
    profiles=(
        Profile(
            name="stribeck",
            title="Descriptive Stribeck curve",
            abscissa="speed_viscosity_product",
            ordinate="friction_coefficient",
            grid=_grid,
            evaluate=_profile,
        ),
    ),
)
