"""A table of bridged skins over the priors of a model, so that a vector costs an interpolation instead of a solution."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import product
from typing import cast

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ROUGHNESS_INPUTS, ForwardModel, Progress, Ranges, Tables
from skinbayes.forward.capillary_film import WATER_INPUTS
from skinbayes.forward.contact_inputs import (
    PRESSURE_ALTERNATIVES,
    SKIN_INPUTS,
    nominal_pressure_of,
    skin_of,
    spectrum_of,
)
from skinbayes.roughness import TabulatedSpectrum, rms_height
from skinbayes.wetting import BridgeTable, bridge_table, skin_groups

_ENTERS = {
    *SKIN_INPUTS,
    *WATER_INPUTS,
    *ROUGHNESS_INPUTS,
    "poisson_ratio_layer",
    "poisson_ratio_bulk",
    "area_correction",
    *(name for names in PRESSURE_ALTERNATIVES for name in names),
}
_CORNERS = 12  # inputs that vary, at most


def table_over(
    ranges: Ranges, optional: dict[str, float], tables: Tables, progress: Progress | None = None
) -> BridgeTable | None:
    """Return curves of bridges for all skins within ``ranges``, or None if there are none or too many.

    Parameters
    ----------
    ranges : input to its smallest and largest value, SI
    optional : defaults of inputs that are not in ``ranges``, SI
    tables : spectrum, if it is measured
    progress : called with the number of skins solved and their total
    """
    known = {**{name: (value, value) for name, value in optional.items()}, **ranges}
    if not isinstance(tables.spectrum, TabulatedSpectrum | None):
        return None
    ends = {name: known[name] for name in _ENTERS if name in known}
    if "hardening_film" in ranges:
        moduli = (*known["young_modulus_layer"], *known["young_modulus_layer_dry"])
        ends["young_modulus_layer"] = (min(moduli), max(moduli))
    if sum(high > low for low, high in ends.values()) > _CORNERS:
        return None
    corners = np.array(list(product(*(sorted({low, high}) for low, high in ends.values())))).T
    inputs: dict[str, FloatArray] = dict(zip(ends, corners, strict=True))
    spectrum, skin, load = spectrum_of(inputs, tables), skin_of(inputs), nominal_pressure_of(inputs)
    wetting = np.cos(inputs["contact_angle_skin"]) + np.cos(inputs["contact_angle_counterface"])
    pull = inputs["surface_tension"] * np.maximum(wetting, 0.0)
    if not pull.max() > 0:
        return None
    height = np.broadcast_to(rms_height(spectrum), load.shape)
    groups = skin_groups(load, pull, height, spectrum, skin, inputs["area_correction"])
    depth = float(np.max(load / np.asarray(skin.young_modulus_bulk))) / known["film_floor"][0]
    low, high = ({name: float(end(x)) for name, x in groups.items()} for end in (np.min, np.max))
    return bridge_table(low, high, depth, tables.spectrum, progress=progress)


def prepared_drying(
    ranges: Ranges, tables: Tables, progress: Progress | None, cores: int, model: ForwardModel
) -> ForwardModel:
    """Return a model of drying skin whose evaluation takes a ``table`` with the table for ``ranges``, if there is one."""
    table = table_over(ranges, dict(model.optional), tables, progress)
    if table is None:
        return model
    return replace(
        model,
        evaluate=partial(cast(partial[dict[str, FloatArray]], model.evaluate), table=table),
        prepare=None,
        accuracy=f"pressure of bridged skin interpolated to {table.error:.0e} (root mean square)",
    )
