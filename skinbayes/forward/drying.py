"""Forward model ``drying``: friction of skin that is wetted and dries, through its peak (Sect. 5, Eq. 8, Fig. 7)."""

from __future__ import annotations

from functools import partial

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ForwardModel, Inputs, Profile, Tables, profiles_against
from skinbayes.forward.capillary_film import CLOSURES, Closure, film_profiles
from skinbayes.forward.deduplicated_rows import along_rows
from skinbayes.forward.drying_inputs import (
    DRYING_ACCEPTED,
    DRYING_DEFAULTS,
    DRYING_GOES_WITH,
    DRYING_INPUTS,
    drying_arguments,
    evaporation_rate_of,
    explain_evaporation,
    initial_film_of,
)
from skinbayes.forward.drying_table import prepared_drying
from skinbayes.forward.small_contact import ROUGH_CONTACT, explain_small_contact
from skinbayes.wetting import BridgeTable, drying_curve

_NOTHING_HAPPENS = 600.0  # what is shown where there is no film or none that evaporates, s
OBSERVABLES = ("friction_coefficient", "film_thickness", "relative_contact_area")


def _dried(
    inputs: Inputs, time: FloatArray, tables: Tables, closure: Closure, table: BridgeTable | None = None
) -> dict[str, FloatArray]:
    curve = drying_curve(time, inputs["wetting_time"], **drying_arguments(inputs, tables, closure, table))
    return {name: np.asarray(getattr(curve, name)) for name in OBSERVABLES}


def _evaluate(
    inputs: Inputs, tables: Tables, closure: Closure, table: BridgeTable | None = None
) -> dict[str, FloatArray]:
    # noise that differs by row must not part rows that share a curve
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return along_rows(known, "time", partial(_dried, tables=tables, closure=closure, table=table))


def _explain(inputs: Inputs, tables: Tables) -> list[str]:
    return explain_evaporation(inputs) + explain_small_contact(inputs, tables)


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    """From a little before wetting until a little after the film is gone."""
    start = float(np.median(inputs["wetting_time"]))
    with np.errstate(all="ignore"):
        lasts = float(np.median(initial_film_of(inputs) / evaporation_rate_of(inputs)))
    if not 0 < lasts < np.inf:
        lasts = _NOTHING_HAPPENS
    return np.linspace(max(0.0, start - 0.1 * lasts), start + 1.1 * lasts, 301)


def _profile(
    inputs: Inputs, tables: Tables, time: FloatArray, observable: str, closure: Closure
) -> FloatArray:
    return _dried(inputs, time, tables, closure)[observable]


def _timeline(closure: Closure) -> tuple[Profile, ...]:
    """Film, contact area and friction one below the other, Fig. 7 of the paper."""
    titles = {
        "film_thickness": "Water film against time",
        "relative_contact_area": "Contact area against time",
        "friction_coefficient": "Friction against time",
    }
    return profiles_against("time", titles, _grid, partial(_profile, closure=closure), called="time")


def drying_model(closure: Closure = "gaussian") -> ForwardModel:
    """Return the forward model with one of the closures of the gap distribution."""
    return ForwardModel(
        name="drying",
        summary="friction of skin that is wetted and dries, flooded, held by capillary bridges and dry, against time",
        observables=OBSERVABLES,
        options=CLOSURES,
        variant=drying_model,
        chosen={"closure": closure},
        required=("time", *DRYING_INPUTS),
        optional=DRYING_DEFAULTS,
        goes_with=DRYING_GOES_WITH,
        accepted=DRYING_ACCEPTED,
        expensive=True,
        prepare=prepared_drying if closure == "gaussian" else None,
        evaluate=partial(_evaluate, closure=closure),
        explain=_explain,
        **ROUGH_CONTACT,
        profiles=(*_timeline(closure), *film_profiles(closure)),
    )


MODEL = drying_model()
