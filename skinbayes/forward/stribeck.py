"""Forward model ``stribeck``: friction of a ball on lubricated skin against speed times viscosity (Sect. 6, Fig. 13)."""

from __future__ import annotations

from functools import partial

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.alike_rows import along_rows
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.contact_inputs import (
    SKIN_DEFAULTS,
    SKIN_INPUTS,
    skin_of,
    spectrum_of,
    validate_contact,
)
from skinbayes.lubrication import StribeckCurve, stribeck_curve
from skinbayes.roughness import rms_slope

SPEED_ALTERNATIVES = (("speed_viscosity_product",), ("viscosity", "sliding_speed"))
"""How the abscissa can be given; the first complete alternative is used."""

FIELDS = {
    "friction_coefficient": "friction_coefficient",
    "friction_coefficient_boundary": "boundary",
    "friction_coefficient_couette": "couette",
    "friction_coefficient_pressure_flow": "pressure_flow",
    "asperity_load_share": "asperity_load_share",
    "minimum_film_thickness": "minimum_film",
    "central_film_thickness": "central_film",
}
"""Observables and the fields of the curve they are."""


def speed_viscosity_product_of(inputs: Inputs) -> FloatArray:
    """Return ηv [N/m]: as given, or viscosity times sliding speed."""
    if "speed_viscosity_product" in inputs:
        return np.asarray(inputs["speed_viscosity_product"], dtype=float)
    return np.asarray(inputs["viscosity"] * inputs["sliding_speed"], dtype=float)


def _curve(inputs: Inputs, products: FloatArray, tables: Tables) -> StribeckCurve:
    return stribeck_curve(
        products[0],
        inputs["sphere_radius"],
        inputs["normal_force"],
        skin_of(inputs),
        spectrum_of(inputs, tables),
        inputs["frictional_shear_stress"],
        inputs["area_correction"],
        inputs["velocity_shift_factor"],
    )


def _observables(inputs: Inputs, products: FloatArray, tables: Tables) -> dict[str, FloatArray]:
    curve = _curve(inputs, products, tables)
    return {name: np.asarray(getattr(curve, field)) for name, field in FIELDS.items()}


def _along(inputs: Inputs) -> dict[str, FloatArray]:
    """The inputs that enter, with the abscissa as one of them."""
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return {
        **{name: value for name, value in known.items() if name not in ("viscosity", "sliding_speed")},
        "speed_viscosity_product": speed_viscosity_product_of(inputs),
    }


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    return along_rows(_along(inputs), "speed_viscosity_product", partial(_observables, tables=tables))


def _explain(inputs: Inputs, tables: Tables) -> list[str]:
    """Why points of the curve are missing or doubtful."""
    said: list[str] = []

    def collect(common: Inputs, products: FloatArray) -> dict[str, FloatArray]:
        curve = _curve(common, products, tables)
        said.extend(reason for reason in curve.reasons() if reason not in said)
        return {"friction_coefficient": np.asarray(curve.friction_coefficient)}

    along_rows(_along(inputs), "speed_viscosity_product", collect)
    return said


def _derived(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    return {"rms_slope": np.asarray(rms_slope(spectrum_of(inputs, tables)))}


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    return np.geomspace(1e-6, 1.0, 61)


def _profile(inputs: Inputs, tables: Tables, products: FloatArray) -> FloatArray:
    return np.asarray(_curve(inputs, products[np.newaxis], tables).friction_coefficient)


MODEL = ForwardModel(
    name="stribeck",
    summary="friction of a ball on lubricated rough skin, its boundary, Couette and pressure-flow parts, and the films",
    observables=tuple(FIELDS),
    required=("frictional_shear_stress", "sphere_radius", "normal_force", *SKIN_INPUTS, SPEED_ALTERNATIVES),
    optional={
        **{name: value for name, value in SKIN_DEFAULTS.items() if name != "yield_stress"},
        "velocity_shift_factor": 1.0,
    },
    evaluate=_evaluate,
    validate=validate_contact,
    explain=_explain,
    derived=_derived,
    derived_names=("rms_slope",),
    blocks=("rms_slope",),
    profiles=(
        Profile(
            name="stribeck",
            title="Stribeck curve",
            abscissa="speed_viscosity_product",
            ordinate="friction_coefficient",
            grid=_grid,
            evaluate=_profile,
        ),
    ),
)
