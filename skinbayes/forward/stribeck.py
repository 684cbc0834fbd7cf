"""Forward model ``stribeck``: friction of a ball on lubricated skin against speed times viscosity (Sect. 6, Fig. 13)."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.errors import InputError
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.contact_inputs import (
    LAYERS_GO_WITH,
    SKIN_DEFAULTS,
    SOLID_ALTERNATIVES,
    spectrum_of,
    validate_contact,
)
from skinbayes.forward.pad import AREA_DEFAULTS, PAD, validate_pad, with_ball
from skinbayes.forward.shear_thinning import SHEAR_THINNING, thinning
from skinbayes.forward.stribeck_direct import (
    FIELDS,
    FLAGS,
    SPEED_ALTERNATIVES,
    Theory,
    curve_of,
    explain,
    one_by_one,
    solve,
    speed_viscosity_product_of,
)
from skinbayes.forward.stribeck_table import prepare
from skinbayes.forward.stribeck_viscoelastic import on_viscoelastic_skin
from skinbayes.lubrication import CONTACTS, LARGEST_STRAIN, POINT, THICKEST_FILM
from skinbayes.lubrication.viscoelastic_memory import ELASTIC, SUBSTRATES
from skinbayes.roughness import rms_slope

FLOW_FACTORS = ("none", "patir-cheng", "gap")
"""Where the factors of the flow between rough surfaces come from; the paper has none."""


def _evaluate(inputs: Inputs, tables: Tables, theory: Theory) -> dict[str, FloatArray]:
    found = solve(inputs, tables, MODEL.input_names(), theory)
    return {name: found[name] for name in FIELDS}


def _flags(inputs: Inputs, tables: Tables, theory: Theory) -> dict[str, BoolArray]:
    found = solve(inputs, tables, MODEL.input_names(), theory)
    return {name: found[name] > 0 for name in FLAGS}


def _explain(inputs: Inputs, tables: Tables, theory: Theory) -> list[str]:
    return explain(solve(inputs, tables, MODEL.input_names(), theory))


def _abscissa(inputs: Inputs, tables: Tables, theory: Theory) -> FloatArray:
    if tables.flow_curves is None:
        return speed_viscosity_product_of(inputs)
    return solve(inputs, tables, MODEL.input_names(), theory)["speed_viscosity_product"]


def _derived(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    return {"rms_slope": np.asarray(rms_slope(spectrum_of(inputs, tables)))}


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    return np.geomspace(1e-6, 1.0, 61)


def _profile(inputs: Inputs, tables: Tables, products: FloatArray, theory: Theory) -> FloatArray:
    if theory.contact == PAD:
        inputs = with_ball(inputs)
    if theory.flow_factors == "none":
        friction = np.asarray(curve_of(inputs, products, tables, theory).friction_coefficient)
    else:  # each vector has its own
        count = max(np.size(value) for value in inputs.values())
        vectors = one_by_one({name: np.atleast_1d(value) for name, value in inputs.items()}, count)
        curves = [curve_of(one, products, tables, theory) for one in vectors]
        friction = np.array([curve.friction_coefficient for curve in curves])
    return friction + np.asarray(inputs.get("additive_friction", 0.0))[..., np.newaxis]


def stribeck_model(
    contact: str = POINT, flow_factors: str = "none", substrate: str = ELASTIC, shear_thinning: str = "none"
) -> ForwardModel:
    """Return the forward model of the ball, of the cylinder that the paper takes for it, or of a pad that is pressed flat."""
    if contact == PAD and substrate != ELASTIC:
        raise InputError(
            f"options.contact is 'pad' and options.substrate '{substrate}': a pad carries its contact with it while it "
            "slides, so that its tissue does not pass, comes back in no film and dissipates nothing; expected substrate = "
            f"'{ELASTIC}' with the modulus of tissue that is held for as long as a stroke, or 'line' or 'point', a ball that "
            "passes over skin that relaxes"
        )
    theory = Theory(contact, flow_factors, substrate)
    elastic = _elastic(theory)
    model = elastic if substrate == ELASTIC else on_viscoelastic_skin(elastic, theory)
    model = model if shear_thinning == "none" else thinning(model)
    return replace(model, chosen={**theory._asdict(), "shear_thinning": shear_thinning})


def _elastic(theory: Theory) -> ForwardModel:
    pad = theory.contact == PAD
    return ForwardModel(
        name="stribeck",
        summary="friction of a ball on lubricated rough skin, its boundary, Couette and pressure-flow parts, and the films",
        observables=tuple(FIELDS),
        options={
            "contact": (*CONTACTS, PAD),
            "flow_factors": FLOW_FACTORS,
            "substrate": SUBSTRATES,
            "shear_thinning": SHEAR_THINNING,
        },
        variant=stribeck_model,
        required=(
            "frictional_shear_stress",
            *(("nominal_contact_area", "inlet_length") if pad else ("sphere_radius",)),
            "normal_force",
            SOLID_ALTERNATIVES,
            SPEED_ALTERNATIVES,
        ),
        goes_with=LAYERS_GO_WITH,
        optional={
            **{name: value for name, value in SKIN_DEFAULTS.items() if name != "yield_stress"},
            "velocity_shift_factor": 1.0,
            "additive_friction": 0.0,
            **(AREA_DEFAULTS if pad else {"inlet_film_limit": THICKEST_FILM}),
            "strain_limit": LARGEST_STRAIN,
        },
        evaluate=partial(_evaluate, theory=theory),
        validate=validate_pad if pad else validate_contact,
        explain=partial(_explain, theory=theory),
        flags=partial(_flags, theory=theory),
        flag_meanings=FLAGS,
        prepare=partial(prepare, theory=theory),
        abscissa=partial(_abscissa, theory=theory),
        expensive=True,
        uses_flow_curves=True,
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
                evaluate=partial(_profile, theory=theory),
            ),
        ),
    )


MODEL = stribeck_model()
