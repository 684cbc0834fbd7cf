"""Forward model ``drying-features``: time, height and width of the friction peak of drying skin (Sect. 5, Fig. 7)."""

from __future__ import annotations

from functools import partial

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.capillary_film import CLOSURES, Closure
from skinbayes.forward.deduplicated_rows import once_for_distinct
from skinbayes.forward.drying_inputs import (
    DRYING_ACCEPTED,
    DRYING_DEFAULTS,
    DRYING_GOES_WITH,
    DRYING_INPUTS,
    drying_arguments,
    evaporation_rate_of,
    explain_evaporation,
)
from skinbayes.forward.drying_table import prepared_drying
from skinbayes.forward.small_contact import ROUGH_CONTACT, explain_small_contact
from skinbayes.wetting import BridgeTable, DryingFeatures, drying_features

OBSERVABLES = DryingFeatures._fields


def _features(
    inputs: Inputs, tables: Tables, closure: Closure, table: BridgeTable | None
) -> dict[str, FloatArray]:
    features = drying_features(inputs["wetting_time"], **drying_arguments(inputs, tables, closure, table))
    return {name: np.asarray(getattr(features, name)) for name in OBSERVABLES}


def _evaluate(
    inputs: Inputs, tables: Tables, closure: Closure, table: BridgeTable | None = None
) -> dict[str, FloatArray]:
    # noise that differs by row must not part rows that share a curve
    known = {name: value for name, value in inputs.items() if name in MODEL.input_names()}
    return once_for_distinct(known, partial(_features, tables=tables, closure=closure, table=table))


def _explain(inputs: Inputs, tables: Tables, closure: Closure) -> list[str]:
    """Why there is no peak, or none after wetting."""
    found = _evaluate(inputs, tables, closure)
    missing = np.isnan(found["peak_time"]) & np.isfinite(found["dry_time"] + found["wet_plateau"])
    said = explain_evaporation(inputs)
    if (evaporation_rate_of(inputs) == 0).any():
        said.append(
            "no friction peak: nothing evaporates, and the skin stays as it was wetted; peak_time, peak_friction, peak_width and "
            "dry_time are missing"
        )
    wetting = np.cos(inputs["contact_angle_skin"]) + np.cos(inputs["contact_angle_counterface"])
    wetting_tension = inputs["surface_tension"] * np.maximum(wetting, 0.0)
    if (missing & (wetting_tension == 0.0)).any():
        said.append(
            "no friction peak: without surface tension, or where the cosines of the two contact angles do not sum to more than "
            "0, there are no capillary bridges to raise friction above the wet plateau; peak_time, peak_friction and peak_width "
            "are missing"
        )
    if (missing & (wetting_tension > 0.0)).any():
        said.append(
            "no friction peak: capillary bridges do not outweigh the hardening of the drying layer, so that friction never rises "
            "above the wet plateau; peak_time, peak_friction and peak_width are missing"
        )
    if (found["peak_time"] < inputs["wetting_time"]).any():
        said.append(
            "the film after wetting is thinner than that of the peak: friction falls from the start, and peak_time, before "
            "wetting, says when it would have peaked"
        )
    return said + explain_small_contact(inputs, tables)


def features_model(closure: Closure = "gaussian") -> ForwardModel:
    """Return the forward model with one of the closures of the gap distribution."""
    return ForwardModel(
        name="drying-features",
        summary="time, height and width of the friction peak of drying skin, wet plateau, dry friction and the time it is dry",
        observables=OBSERVABLES,
        options=CLOSURES,
        variant=features_model,
        chosen={"closure": closure},
        required=DRYING_INPUTS,
        optional=DRYING_DEFAULTS,
        goes_with=DRYING_GOES_WITH,
        accepted=DRYING_ACCEPTED,
        expensive=True,
        prepare=prepared_drying if closure == "gaussian" else None,
        evaluate=partial(_evaluate, closure=closure),
        explain=partial(_explain, closure=closure),
        **ROUGH_CONTACT,
    )


MODEL = features_model()
