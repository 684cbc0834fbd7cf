"""A table of bridged skins over the priors of a model, so that a vector costs an interpolation instead of a solution."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import cast

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Box, Progress, kept_table
from skinbayes.forward.base import ForwardModel, Ranges, Tables, multiples_of
from skinbayes.forward.capillary_film import WATER_INPUTS
from skinbayes.forward.contact_inputs import nominal_pressure_of, one_layer_skin_of, spectrum_of
from skinbayes.forward.corners import CONTACT_INPUTS, NO_TABLE, corners, known_ranges
from skinbayes.roughness import TabulatedSpectrum, rms_height
from skinbayes.wetting import VERSION_OF_BRIDGES, BridgeTable, bridge_table, skin_groups


def table_over(
    ranges: Ranges, optional: dict[str, float], tables: Tables, progress: Progress | None = None
) -> BridgeTable | str:
    """Return curves of bridges for all skins within ``ranges``, or why there are none; empty if no bridges form.

    Parameters
    ----------
    ranges : input to its smallest and largest value, SI
    optional : defaults of inputs that are not in ``ranges``, SI
    tables : spectrum, if it is measured
    progress : called with the number of skins solved and their total
    """
    known, multiples = known_ranges(ranges, optional), multiples_of(ranges)
    if not isinstance(tables.spectrum, TabulatedSpectrum | None):
        return NO_TABLE
    if "hardening_film" in ranges:
        moduli = (*known["young_modulus_layer"], *known["young_modulus_layer_dry"])
        known["young_modulus_layer"] = (min(moduli), max(moduli))
        # a layer that hardens leaves what it is tied to
        multiples = {
            name: tie for name, tie in multiples.items() if "young_modulus_layer" not in (name, tie[0])
        }
    inputs = corners(known, (*WATER_INPUTS, *CONTACT_INPUTS), multiples)
    if inputs is None:
        return NO_TABLE
    spectrum, skin, load = spectrum_of(inputs, tables), one_layer_skin_of(inputs), nominal_pressure_of(inputs)
    wetting = np.cos(inputs["contact_angle_skin"]) + np.cos(inputs["contact_angle_counterface"])
    wetting_tension = inputs["surface_tension"] * np.maximum(wetting, 0.0)
    if not wetting_tension.max() > 0:
        return ""
    height = np.broadcast_to(rms_height(spectrum), load.shape)
    groups = skin_groups(
        load,
        wetting_tension,
        height=height,
        spectrum=spectrum,
        skin=skin,
        area_correction=inputs["area_correction"],
    )
    modulus = inputs["young_modulus" if "young_modulus" in inputs else "young_modulus_bulk"]
    depth = float(np.max(load / modulus)) / known["film_floor"][0]
    box = Box.around(groups)
    table = kept_table(
        "bridges",
        {"version": VERSION_OF_BRIDGES, "ends": box.ends, "depth": depth, "spectrum": tables.digest()},
        BridgeTable,
        lambda _: bridge_table(box, depth=depth, spectrum=tables.spectrum, progress=progress),
    )
    return NO_TABLE if table is None else table


def prepared_drying(
    model: ForwardModel, ranges: Ranges, tables: Tables, progress: Progress | None, cores: int
) -> ForwardModel:
    """Return a model of drying skin whose evaluation takes a ``table`` with the table for ``ranges``, if there is one."""
    table = table_over(ranges, model.defaults(ranges), tables, progress)
    if isinstance(table, str):
        return replace(model, accuracy=table)
    return replace(
        model,
        evaluate=partial(cast(partial[dict[str, FloatArray]], model.evaluate), table=table),
        prepare=None,
        accuracy=f"pressure of bridged skin interpolated to {table.found.error:.0e} (root mean square)",
    )
