"""Stribeck curves by the film solver itself: exact, some tenths of a millisecond for a point."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import cylinder_of_sphere
from skinbayes.forward.base import Inputs, Tables
from skinbayes.forward.contact_inputs import modulus_under_ball_of, skin_of, spectrum_of
from skinbayes.forward.deduplicated_rows import along_rows
from skinbayes.forward.pad import PAD, with_ball
from skinbayes.lubrication import (
    LARGE_STRAIN,
    LARGEST_STRAIN,
    NOTABLE_STRAIN,
    POINT,
    REASONS_FOR_NO_PREDICTION,
    THICKEST_FILM,
    FlowFactors,
    PatirCheng,
    StribeckCurve,
    stribeck_curve,
    stribeck_curve_of_liquid,
    tabulated_flow_factors,
)
from skinbayes.lubrication.viscoelastic_memory import ELASTIC
from skinbayes.roughness import rms_height

NOTABLE_FILM = THICKEST_FILM / 5
"""3π ηv/f_N beyond which a prediction is marked: the fraction of the load beyond the edge of the ball grows to a fifth at five
times this."""

FIELDS = {
    "friction_coefficient": "friction_coefficient",
    "friction_coefficient_boundary": "boundary",
    "friction_coefficient_couette": "couette",
    "friction_coefficient_pressure_flow": "pressure_flow",
    "asperity_load_fraction": "asperity_load_fraction",
    "minimum_film_thickness": "minimum_film",
    "central_film_thickness": "central_film",
}
"""Observables and the fields of the curve they are."""

FLAGS = {
    "strained": f"the contact is strained (b/Rc above {NOTABLE_STRAIN:g}), where Hertz's theory is stretched",
    "largely_strained": f"the contact is nearly half as wide as the ball, or wider (b/Rc above {LARGE_STRAIN:g})",
    "strained_beyond_ball": f"the contact is wider than the shape of a ball allows (b/Rc above {LARGEST_STRAIN:g})",
    "film_near_inlet": f"the film is thick for the inlet that the ball offers (3π ηv/f_N above {NOTABLE_FILM:g})",
    "film_beyond_inlet": f"the film is thicker than the inlet that the ball offers (3π ηv/f_N above {THICKEST_FILM:g}), so "
    "that more than a fifth of the load is carried beyond its edge",
    "shear_rate_unmeasured": "the liquid is sheared at a rate for which its viscosity was not measured",
}
"""Flags and what they say."""

SPEED_ALTERNATIVES = (("speed_viscosity_product",), ("viscosity", "sliding_speed"))
"""How the abscissa can be given; the first complete alternative is used."""

REASONS = (
    "impossible", "too_strained", "film_beyond_ball", "not_converged", "strained", "largely_strained",
    "shear_rate_unmeasured",
)  # fmt: skip
"""Fields of the curve that say where it is silent or doubtful."""

CURVE = "flow_curve"
"""Number of the flow curve of a row, among the inputs."""


def speed_viscosity_product_of(inputs: Inputs) -> FloatArray:
    """Return ηv [N/m]: as given, or viscosity times sliding speed."""
    if "speed_viscosity_product" in inputs:
        return np.asarray(inputs["speed_viscosity_product"], dtype=float)
    return np.asarray(inputs["viscosity"] * inputs["sliding_speed"], dtype=float)


class Theory(NamedTuple):
    """What is chosen beside the inputs: contact ("point", "line" or "pad"), where flow factors come from, and substrate."""

    contact: str = POINT
    flow_factors: str = "none"
    substrate: str = ELASTIC


BALL = Theory()
"""The ball as it is, without flow factors."""


def curve_of(inputs: Inputs, products: FloatArray, tables: Tables, theory: Theory = BALL) -> StribeckCurve:
    """The curve of Newtonian liquids for inputs that broadcast to ``(B,)`` at products ηv of shape ``(K,)``."""
    return stribeck_curve(products, **_ball(inputs, tables, theory))


def _ball(inputs: Inputs, tables: Tables, theory: Theory) -> dict[str, Any]:
    """What both film solvers take beside liquid and speed."""
    names = (
        "normal_force",
        "sphere_radius",
        "frictional_shear_stress",
        "area_correction",
        "velocity_shift_factor",
    )
    return {name: inputs[name] for name in names} | {
        "contact": POINT if theory.contact == PAD else theory.contact,
        "inlet_length": limit_of(inputs, "inlet_length") if theory.contact == PAD else None,
        "flow_factors": flow_factors_of(inputs, tables, theory.flow_factors),
        "skin": skin_of(inputs),
        "spectrum": spectrum_of(inputs, tables),
        "thickest_film": np.inf if theory.contact == PAD else limit_of(inputs, "inlet_film_limit"),
        "largest_strain": limit_of(inputs, "strain_limit"),
    }


def flow_factors_of(inputs: Inputs, tables: Tables, kind: str) -> FlowFactors | None:
    """Flow factors of one surface and skin, from the statistics of its gaps or the fits of Patir and Cheng."""
    if kind == "none":
        return None
    spectrum = spectrum_of(inputs, tables)
    if kind == "patir-cheng":
        return PatirCheng(float(np.squeeze(rms_height(spectrum))))
    correction = float(np.squeeze(inputs["area_correction"]))
    return tabulated_flow_factors(spectrum, skin_of(inputs), area_correction=correction)


def limit_of(inputs: Inputs, name: str) -> float:
    """Return the largest 3π ηv/f_N, or b/Rc, at which friction is predicted; the same for all rows and vectors."""
    return float(np.ravel(inputs[name])[0])


def solve(
    inputs: Inputs, tables: Tables, names: tuple[str, ...], theory: Theory = BALL
) -> dict[str, FloatArray]:
    """Observables, flags and reasons of the film solver by name, each ``(B, N)``.

    Parameters
    ----------
    inputs : inputs of the forward model, others are left aside
    tables : with flow curves if viscosities are to follow from the film
    names : inputs of the forward model
    theory : contact and flow factors

    Returns
    -------
    dict
        Observables of `FIELDS`, flags of `FLAGS` (as 0 and 1), the reasons of silence of `StribeckCurve`, and
        ``speed_viscosity_product`` with the viscosity in the film.
    """
    if theory.contact == PAD:
        inputs = with_ball(inputs)
        names = (*names, "inlet_length")
    known = {name: value for name, value in inputs.items() if name in names}
    for name in ("viscosity", "sliding_speed", "additive_friction"):
        known.pop(name, None)
    if tables.flow_curves is None:
        known["speed_viscosity_product"] = speed_viscosity_product_of(inputs)
        found = along_rows(
            known, "speed_viscosity_product", partial(_newtonian, tables=tables, theory=theory)
        )
    else:
        known.pop("speed_viscosity_product", None)
        known["sliding_speed"] = inputs["sliding_speed"]
        known[CURVE], tables = numbered_flow_curves(tables)
        found = along_rows(known, "sliding_speed", partial(_of_liquids, tables=tables, theory=theory))
    found["friction_coefficient"] = found["friction_coefficient"] + inputs.get("additive_friction", 0.0)
    return found


def numbered_flow_curves(tables: Tables) -> tuple[FloatArray, Tables]:
    """The number of the flow curve of each row, ``(1, N)``, and the tables with each flow curve once."""
    assert tables.flow_curves is not None
    curves = {id(curve): curve for curve in tables.flow_curves}
    place = {name: float(i) for i, name in enumerate(curves)}
    numbers = np.array([[place[id(curve)] for curve in tables.flow_curves]])
    return numbers, Tables(tables.spectrum, tuple(curves.values()))


def explain(found: dict[str, FloatArray]) -> list[str]:
    """Why points of a curve that was solved are missing or doubtful."""
    return counted(found, REASONS_FOR_NO_PREDICTION | FLAGS)


def counted(found: Mapping[str, NDArray[Any]], meanings: Mapping[str, str]) -> list[str]:
    """How many points each meaning applies to; a sentence for each that applies to any."""
    counts = {meaning: np.count_nonzero(found[name]) for name, meaning in meanings.items()}
    total = max(values.size for values in found.values())
    return [f"{count} of {total} points: {meaning}." for meaning, count in counts.items() if count]


def film_flags(inputs: Inputs, products: FloatArray) -> dict[str, BoolArray]:
    """Where 3π ηv/f_N is above `NOTABLE_FILM` and `THICKEST_FILM` for products ηv in N/m, shapes broadcast.

    Under a pad, whose liquid ends at the ``inlet_length``, it is nowhere.
    """
    if "inlet_length" in inputs:
        nowhere = np.zeros(np.shape(products), dtype=bool)
        return {"film_near_inlet": nowhere, "film_beyond_inlet": nowhere}
    modulus = modulus_under_ball_of(inputs)
    cylinder = cylinder_of_sphere(inputs["normal_force"], inputs["sphere_radius"], reduced_modulus=modulus)
    with np.errstate(invalid="ignore"):
        fraction = (
            3 * np.pi * products * inputs["velocity_shift_factor"] / np.asarray(cylinder.load_per_length)
        )
        return {"film_near_inlet": fraction > NOTABLE_FILM, "film_beyond_inlet": fraction > THICKEST_FILM}


def _newtonian(inputs: Inputs, products: FloatArray, tables: Tables, theory: Theory) -> dict[str, FloatArray]:
    batch = max(len(products), *(np.size(value) for value in inputs.values()))
    if len(products) == 1 and theory.flow_factors == "none":
        return _everything(curve_of(inputs, products[0], tables, theory), inputs)
    # a load that differs by vector, or a covariate: each vector has its own abscissae; and it has flow factors of its own
    rows = [
        _everything(curve_of(one, products[b if len(products) > 1 else 0], tables, theory), one)
        for b, one in enumerate(one_by_one(inputs, batch))
    ]
    return {name: np.stack([row[name] for row in rows]) for name in rows[0]}


def _of_liquids(inputs: Inputs, speeds: FloatArray, tables: Tables, theory: Theory) -> dict[str, FloatArray]:
    assert tables.flow_curves is not None
    batch = max(len(speeds), *(np.shape(value)[0] for value in inputs.values()))
    rows = []
    for b, one in enumerate(one_by_one(inputs, batch)):
        liquid = tables.flow_curves[int(one[CURVE])]
        curve, _ = stribeck_curve_of_liquid(
            speeds[b if len(speeds) > 1 else 0], liquid, **_ball(one, tables, theory)
        )
        rows.append(_everything(curve, one))
    return {name: np.stack([row[name] for row in rows]) for name in rows[0]}


def one_by_one(inputs: Inputs, count: int) -> list[dict[str, FloatArray]]:
    """Inputs that broadcast to ``(B,)`` as scalars for each of the vectors."""
    return [
        {name: np.asarray(value)[b if np.shape(value)[0] > 1 else 0] for name, value in inputs.items()}
        for b in range(count)
    ]


def _everything(curve: StribeckCurve, inputs: Inputs) -> dict[str, FloatArray]:
    shape = np.shape(curve.friction_coefficient)
    found = {name: np.asarray(getattr(curve, field)) for name, field in FIELDS.items()}
    found |= {name: np.asarray(getattr(curve, name), dtype=float) for name in REASONS}
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    found["strained_beyond_ball"] = np.asarray(curve.strain > LARGEST_STRAIN, dtype=float)[..., np.newaxis]
    flags = film_flags(column, curve.speed_viscosity_product)
    found |= {name: flag.astype(float) for name, flag in flags.items()}
    found["speed_viscosity_product"] = curve.speed_viscosity_product
    return {name: np.broadcast_to(value, shape) for name, value in found.items()}
