"""Forward model ``capillary-film``: skin held by capillary bridges against the water film (Eqs. 5–7, Figs. 8–10)."""

from __future__ import annotations

from functools import partial
from typing import Literal

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables, profiles_against
from skinbayes.forward.contact_inputs import (
    LAYERS_GO_WITH,
    PRESSURE_ALTERNATIVES,
    SKIN_DEFAULTS,
    SOLID_ALTERNATIVES,
    nominal_pressure_of,
    skin_of,
    spectrum_of,
)
from skinbayes.forward.deduplicated_rows import along_rows
from skinbayes.forward.small_contact import ROUGH_CONTACT, explain_small_contact
from skinbayes.wetting import capillary_state

Closure = Literal["gaussian", "sharp"]

CLOSURES = {"closure": ("gaussian", "sharp")}
"""How the gaps at one magnification are distributed: normally, as boundary-element solutions have them, or all alike, most likely
as the paper had them."""

WATER_INPUTS = ("surface_tension", "contact_angle_skin", "contact_angle_counterface")

BRIDGED_SKIN_DEFAULTS = {name: value for name, value in SKIN_DEFAULTS.items() if name != "yield_stress"}
"""Contact of bridged skin is elastic."""

OBSERVABLES = (
    "relative_contact_area",
    "wet_area",
    "mean_separation",
    "mean_separation_wet",
    "capillary_pressure",
)


FILMS = np.geomspace(1e-7, 1e-4, 61)
"""Films of the curves, m: from gaps of nanometres to skin that floats, Figs. 8 to 10 of the paper."""


def _bridged(
    inputs: Inputs, film: FloatArray, tables: Tables, closure: Closure, refine: bool = True
) -> dict[str, FloatArray]:
    state = capillary_state(
        film,
        nominal_pressure_of(inputs),
        spectrum=spectrum_of(inputs, tables),
        skin=skin_of(inputs),
        closure=closure,
        refine=refine,
        **{name: inputs[name] for name in (*WATER_INPUTS, "area_correction")},
    )
    return {name: np.asarray(getattr(state, name)) for name in OBSERVABLES}


def _evaluate(inputs: Inputs, tables: Tables, closure: Closure) -> dict[str, FloatArray]:
    # noise that differs by row must not part rows that share a curve
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return along_rows(known, "film_thickness", partial(_bridged, tables=tables, closure=closure))


def _explain(inputs: Inputs, tables: Tables) -> list[str]:
    """Why there is no prediction."""
    if (np.asarray(inputs["film_thickness"]) == 0).any():
        return [
            "film_thickness is 0: as a film vanishes from a soft layer its capillary pressure grows without limit, and skin "
            "without water is not the end of this curve; 'contact-area' has dry skin."
        ]
    return explain_small_contact(inputs, tables)


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    return FILMS


def _profile(
    inputs: Inputs, tables: Tables, film: FloatArray, observable: str, closure: Closure
) -> FloatArray:
    # good to 1e-4 in the Gaussian closure, which no line shows
    return _bridged(inputs, film[np.newaxis], tables, closure, refine=closure != "gaussian")[observable]


def film_profiles(closure: Closure) -> tuple[Profile, ...]:
    """Contact area, wet area and separations against the water film, one below the other."""
    titles = {
        "relative_contact_area": "Contact area against the water film",
        "wet_area": "Wet area against the water film",
        "mean_separation": "Mean separation against the water film",
        "mean_separation_wet": "Mean separation in the wet area against the water film",
    }
    return profiles_against(
        "film_thickness", titles, _grid, partial(_profile, closure=closure), called="film"
    )


def capillary_film_model(closure: Closure = "gaussian") -> ForwardModel:
    """Return the forward model with one of the closures of the gap distribution."""
    return ForwardModel(
        name="capillary-film",
        summary="contact and gaps of skin held by capillary bridges, against the water film",
        observables=OBSERVABLES,
        options=CLOSURES,
        variant=capillary_film_model,
        chosen={"closure": closure},
        expensive=True,
        required=("film_thickness", SOLID_ALTERNATIVES, PRESSURE_ALTERNATIVES, *WATER_INPUTS),
        goes_with=LAYERS_GO_WITH,
        optional=BRIDGED_SKIN_DEFAULTS,
        evaluate=partial(_evaluate, closure=closure),
        explain=_explain,
        **ROUGH_CONTACT,
        profiles=film_profiles(closure),
    )


MODEL = capillary_film_model()
