"""A table of bridged gaps over the priors of a model of skin in humid air, so that a row costs an interpolation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import cast

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.emulation import Box, Progress, kept_table
from skinbayes.forward.base import (
    ROUGHNESS_INPUTS,
    ForwardModel,
    Inputs,
    Ranges,
    Tables,
    multiples_of,
)
from skinbayes.forward.contact_inputs import GOES_WITH, nominal_pressure_of, one_layer_skin_of, spectrum_of
from skinbayes.forward.corners import CONTACT_INPUTS, NO_TABLE, corners, known_ranges
from skinbayes.forward.humid_air_inputs import (
    AIR_INPUTS,
    at_skin,
    bridges_form,
    kelvin_gap_and_strength,
)
from skinbayes.roughness import rms_height
from skinbayes.wetting import VERSION_OF_BRIDGES, HumidTable, humid_groups, humid_table

_SHAPE = (*ROUGHNESS_INPUTS[1:], *GOES_WITH, "area_correction")
"""What the table does not interpolate in."""

_DRIEST, _WET, _WETTEST = 0.04, 0.998, 0.9999
"""Humidities that the table always reaches, as curves are drawn between them, and the largest that it ever does."""


@dataclass(frozen=True, eq=False)
class TabulatedBridges:
    """Capillary pressure of bridges from a table of the gaps that they span.

    Attributes
    ----------
    table : of skins that differ in height, moduli, thickness and load only
    shape : name to value of what is the same for all of them
    """

    table: HumidTable
    shape: dict[str, float]

    def capillary_pressure(
        self, inputs: Inputs, tables: Tables, solved: Callable[[Inputs], FloatArray]
    ) -> FloatArray:
        """Capillary pressure [Pa], shape ``(B, N)``, of inputs that broadcast to it; by ``solved`` beyond the table."""
        gap, strength = kelvin_gap_and_strength(inputs)
        wetted = bridges_form(inputs)
        height = rms_height(spectrum_of(inputs, tables))
        load, skin = inputs["nominal_pressure"], one_layer_skin_of(inputs)
        same = np.logical_and.reduce([inputs[name] == value for name, value in self.shape.items()])
        parts = (gap, strength, height, load, same, wetted, *vars(skin).values())
        shape = np.broadcast_shapes(*(np.shape(part) for part in parts))
        gap, strength, height, load, same, wetted, *own = (
            np.broadcast_to(part, shape).reshape(-1) for part in parts
        )
        flat = type(skin)(**dict(zip(vars(skin), own, strict=True)))
        # neither without bridges nor in a flooded gap does anything pull
        bridged = wetted & np.isfinite(gap)
        with np.errstate(all="ignore"):
            groups = humid_groups(load, np.where(bridged, gap, height), height=height, skin=flat)
        inside = same & self.table.covers(groups, strength)
        rows = np.flatnonzero(bridged & inside)
        found = np.where(bridged | np.isnan(gap), np.nan, 0.0)
        ratio = self.table.log_pressure_ratio(
            {name: value[rows] for name, value in groups.items()}, strength[rows]
        )
        found[rows] = load[rows] * np.expm1(ratio)
        found = found.reshape(shape)
        if (missing := (bridged & ~inside).reshape(shape)).any():
            few = missing.any(axis=1)
            some = {name: value[few] if len(value) > 1 else value for name, value in inputs.items()}
            found[few] = np.where(missing[few], solved(some), found[few])
        return found


def bridges_over(
    ranges: Ranges, optional: dict[str, float], tables: Tables, progress: Progress | None
) -> TabulatedBridges | str:
    """Return the capillary pressure of bridges for all skins within ``ranges``, or why not; empty if no bridges form.

    Parameters
    ----------
    ranges : input to its smallest and largest value, SI
    optional : defaults of inputs that are not in ``ranges``, SI
    tables : spectrum, if it is measured
    progress : called with the number of skins computed and their total
    """
    known = known_ranges(ranges, optional)
    if "young_modulus_layer_dry" in known:
        moduli = (*known["young_modulus_layer_dry"], *known["young_modulus_layer_wet"])
        known["young_modulus_layer"] = (min(moduli), max(moduli))
    shape = {name: known[name][0] for name in _SHAPE if name in known}
    if any(known[name][1] > value for name, value in shape.items()):
        return NO_TABLE
    low, high = known["relative_humidity"]
    known["relative_humidity"] = (min(low, _DRIEST), max(high, _WET))
    found = corners(known, (*AIR_INPUTS, *CONTACT_INPUTS), multiples_of(ranges))
    if found is None:
        return NO_TABLE
    inputs = at_skin(found)
    inputs["relative_humidity"] = np.minimum(inputs["relative_humidity"], _WETTEST)
    if not bridges_form(inputs).any():
        return ""
    gap, strength = kelvin_gap_and_strength(inputs)
    spectrum, skin = spectrum_of(inputs, tables), one_layer_skin_of(inputs)
    height = np.broadcast_to(rms_height(spectrum), gap.shape)
    groups = humid_groups(nominal_pressure_of(inputs), gap, height=height, skin=skin)
    ends = dict(Box.around(groups).ends)
    ends["load"] = (ends["load"][0], float(np.max(groups["load"] + np.log1p(strength))))
    one = {name: value[0] for name, value in inputs.items()}
    table = kept_table(
        "humid-air",
        {"version": VERSION_OF_BRIDGES, "ends": ends, "shape": shape, "spectrum": tables.digest()},
        HumidTable,
        lambda _: humid_table(
            Box(ends),
            spectrum=spectrum_of(one, tables),
            skin=one_layer_skin_of(one),
            area_correction=one["area_correction"],
            progress=progress,
        ),
    )
    return NO_TABLE if table is None else TabulatedBridges(table, shape)


def prepared_humid_air(
    model: ForwardModel, ranges: Ranges, tables: Tables, progress: Progress | None, cores: int
) -> ForwardModel:
    """Return a model of skin in humid air whose functions take a ``table`` with the table for ``ranges``, if there is one."""
    table = bridges_over(ranges, model.defaults(ranges), tables, progress)
    if isinstance(table, str):
        return replace(model, accuracy=table)
    return replace(
        model,
        evaluate=partial(cast(partial[dict[str, FloatArray]], model.evaluate), table=table),
        flags=partial(cast("partial[dict[str, BoolArray]]", model.flags), table=table),
        prepare=None,
        accuracy="pressure of bridged skin interpolated to 4e-4, or 2e-3 where bridges pull hard (root mean square)",
    )
