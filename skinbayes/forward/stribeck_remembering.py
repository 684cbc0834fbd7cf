"""Stribeck curves on skin that is not elastic, by the film solver itself, one speed after the other."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import ConstantLossMaterial, ViscoelasticMaterial, ViscoelasticSkin
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.contact_inputs import spectrum_of
from skinbayes.forward.deduplicated_rows import along_rows
from skinbayes.forward.stribeck_direct import (
    CURVE,
    REASONS,
    Theory,
    film_flags,
    flow_factors_of,
    limit_of,
    numbered_flow_curves,
    one_by_one,
)
from skinbayes.forward.stribeck_direct import (
    FIELDS as ELASTIC_FIELDS,
)
from skinbayes.lubrication import (
    LARGEST_STRAIN,
    POINT,
    ViscoelasticStribeckCurve,
    viscoelastic_stribeck_curve,
)
from skinbayes.lubrication.viscoelastic_ball import viscoelastic_ball_curve
from skinbayes.lubrication.viscoelastic_liquid import viscoelastic_stribeck_curve_of_liquid
from skinbayes.lubrication.viscoelastic_memory import (
    RELAXATION_PARAMETERS,
    STANDARD_LINEAR_SOLID,
    TissueInContact,
    tissue_in_contact,
)

FIELDS = ELASTIC_FIELDS | {"friction_coefficient_hysteresis": "hysteresis"}
"""Observables and the fields of the curve they are."""


def tissue_of(inputs: Inputs, substrate: str) -> TissueInContact:
    """Moduli and memory of the skin at v/b, of the broadcast shape of what enters."""
    return tissue_in_contact(
        substrate,
        inputs["sliding_speed"],
        parameters=inputs,
        relaxation={name: inputs[name] for name in RELAXATION_PARAMETERS[substrate]},
        poisson_ratio_bulk=float(np.ravel(inputs["poisson_ratio_bulk"])[0]),
    )


def at_frequency(inputs: Inputs, tissue: TissueInContact) -> Inputs:
    """Inputs with the moduli that the contact meets."""
    return {
        **inputs,
        "young_modulus_layer": np.exp(tissue.log_modulus_layer),
        "young_modulus_bulk": np.exp(tissue.log_modulus_bulk),
    }


def solve(inputs: Inputs, tables: Tables, names: tuple[str, ...], theory: Theory) -> dict[str, FloatArray]:
    """Observables of `FIELDS`, flags and reasons by name, each ``(B, N)``, as the `solve` of elastic skin gives them."""
    known = {name: value for name, value in inputs.items() if name in names}
    known.pop("additive_friction", None)
    if tables.flow_curves is not None:
        known.pop("viscosity", None)
        known[CURVE], tables = numbered_flow_curves(tables)
    found = along_rows(known, "sliding_speed", partial(_vectors, tables=tables, theory=theory))
    found["friction_coefficient"] = found["friction_coefficient"] + inputs.get("additive_friction", 0.0)
    return found


def _vectors(inputs: Inputs, speeds: FloatArray, tables: Tables, theory: Theory) -> dict[str, FloatArray]:
    batch = max(len(speeds), *(np.shape(value)[0] for value in inputs.values()))
    rows = [
        _one(one, speeds[b if len(speeds) > 1 else 0], tables, theory)
        for b, one in enumerate(one_by_one(inputs, batch))
    ]
    return {name: np.stack([row[name] for row in rows]) for name in rows[0]}


def _one(inputs: Inputs, speeds: FloatArray, tables: Tables, theory: Theory) -> dict[str, FloatArray]:
    """One vector of inputs at K speeds, each solved by itself: rows do not depend on each other."""
    rows = [_everything(_curve(inputs, speed, tables, theory), inputs, speed, theory) for speed in speeds]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def _curve(inputs: Inputs, speed: float, tables: Tables, theory: Theory) -> ViscoelasticStribeckCurve:
    held = at_frequency(inputs, tissue_of({**inputs, "sliding_speed": np.asarray(speed)}, theory.substrate))
    curve = viscoelastic_ball_curve if theory.contact == POINT else viscoelastic_stribeck_curve
    given: dict[str, Any] = {
        "spectrum": spectrum_of(inputs, tables),
        "skin": skin_of(inputs, theory.substrate),
        "flow_factors": flow_factors_of(held, tables, theory.flow_factors),
        "thickest_film": limit_of(inputs, "inlet_film_limit"),
        "largest_strain": limit_of(inputs, "strain_limit"),
        **{
            name: float(inputs[name])
            for name in (
                "normal_force",
                "sphere_radius",
                "frictional_shear_stress",
                "area_correction",
                "velocity_shift_factor",
            )
        },
    }
    if CURVE not in inputs:
        return curve(speed, float(inputs["viscosity"]), **given)
    assert tables.flow_curves is not None
    liquid = tables.flow_curves[int(inputs[CURVE])]
    return viscoelastic_stribeck_curve_of_liquid(speed, liquid, curve=curve, **given)


def skin_of(inputs: Inputs, substrate: str) -> ViscoelasticSkin:
    """Layered skin of one substrate, for scalar inputs."""
    parts: dict[str, ViscoelasticMaterial | ConstantLossMaterial] = {}
    for part in ("layer", "bulk"):
        modulus, ratio = float(inputs[f"young_modulus_{part}"]), float(inputs[f"poisson_ratio_{part}"])
        if substrate != STANDARD_LINEAR_SOLID:
            parts[part] = ConstantLossMaterial(
                modulus=modulus,
                tan_delta=float(inputs[f"loss_tangent_{part}"]),
                reference_frequency=float(inputs["reference_angular_frequency"]),
                poisson_ratio=ratio,
            )
            continue
        strength, time = (float(inputs[f"relaxation_{what}_{part}"]) for what in ("strength", "time"))
        relaxing = (
            {} if strength == 0 else {"relaxing_moduli": [modulus * strength], "relaxation_times": [time]}
        )
        parts[part] = ViscoelasticMaterial(equilibrium_modulus=modulus, poisson_ratio=ratio, **relaxing)
    return ViscoelasticSkin(**parts, layer_thickness=float(inputs["layer_thickness"]))


def _everything(
    curve: ViscoelasticStribeckCurve, inputs: Inputs, speed: float, theory: Theory
) -> dict[str, FloatArray]:
    found = {name: np.asarray(getattr(curve, field)) for name, field in FIELDS.items()}
    found |= {name: np.asarray(getattr(curve, name), dtype=float) for name in REASONS}
    found["strained_beyond_ball"] = np.asarray(curve.strain > LARGEST_STRAIN, dtype=float)
    held = at_frequency(inputs, tissue_of({**inputs, "sliding_speed": np.asarray(speed)}, theory.substrate))
    flags = film_flags(held, curve.speed_viscosity_product)
    found |= {name: flag.astype(float) for name, flag in flags.items()}
    found["speed_viscosity_product"] = curve.speed_viscosity_product
    return {name: np.squeeze(value) for name, value in found.items()}


def with_profile(model: ForwardModel) -> ForwardModel:
    """The model with a Stribeck curve at the speed of a row, for liquids of other viscosities, that it evaluates itself."""
    evaluate = partial(_at_speed_of_row, model=replace(model, profiles=()))
    return replace(model, profiles=tuple(replace(curve, evaluate=evaluate) for curve in model.profiles))


def _at_speed_of_row(inputs: Inputs, tables: Tables, products: FloatArray, model: ForwardModel) -> FloatArray:
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    column["viscosity"] = products / column["sliding_speed"]
    return model.evaluate(column, replace(tables, flow_curves=None))["friction_coefficient"]
