"""From named inputs to the arguments of contact mechanics; shared by all forward models of dry and wet contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import (
    AREA_CORRECTION,
    ContactArea,
    ElasticSolid,
    HomogeneousSolid,
    LayeredSkin,
    SolidPair,
    StackedSkin,
    elastoplastic_contact_area,
    modulus_under_ball,
    twice_stress_variance,
    validate_solid,
)
from skinbayes.contact.counterface import in_series
from skinbayes.contact.hertz import mean_pressure
from skinbayes.contact.variance import integrated
from skinbayes.errors import InputError
from skinbayes.forward.base import ROUGHNESS_INPUTS, Inputs, Tables
from skinbayes.forward.deduplicated_rows import on_distinct
from skinbayes.roughness import (
    PowerSpectrum,
    SelfAffineSpectrum,
    SummedSpectrum,
    TabulatedSpectrum,
    rms_height,
    rms_slope,
    validate_spectrum,
)

SKIN_INPUTS = ("young_modulus_layer", "young_modulus_bulk", "layer_thickness")

DERMIS_INPUTS = ("young_modulus_dermis", "dermis_thickness")
FAT_INPUTS = ("young_modulus_fat", "fat_thickness")
"""Layers below the stratum corneum, each of two inputs; ``young_modulus_bulk`` is what lies below them."""

SOLID_ALTERNATIVES = (
    (*SKIN_INPUTS, *DERMIS_INPUTS, *FAT_INPUTS),
    (*SKIN_INPUTS, *DERMIS_INPUTS),
    (*SKIN_INPUTS, *FAT_INPUTS),
    SKIN_INPUTS,
    ("young_modulus",),
)
"""How the solid can be given: skin of three layers, two or one, or one of a single material."""

SOLID_INPUTS = (
    *SKIN_INPUTS, *DERMIS_INPUTS, *FAT_INPUTS, "young_modulus", "poisson_ratio_layer", "poisson_ratio_bulk", "poisson_ratio",
)  # fmt: skip
"""All inputs that may belong to the solid."""

GOES_WITH = {
    "poisson_ratio_layer": "layer_thickness",
    "poisson_ratio_bulk": "layer_thickness",
    "poisson_ratio": "young_modulus",
}
"""Inputs of one kind of solid, which have no meaning for the other."""

LAYERS_GO_WITH = {
    **GOES_WITH,
    "young_modulus_dermis": "dermis_thickness",
    "dermis_thickness": "young_modulus_dermis",
    "young_modulus_fat": "fat_thickness",
    "fat_thickness": "young_modulus_fat",
}
"""The same where there may be more layers, of two inputs each."""

COUNTERFACE_ROUGHNESS = tuple(f"counterface_{name}" for name in ROUGHNESS_INPUTS)
ELASTIC_COUNTERFACE = "young_modulus_counterface"
COUNTERFACE_INPUTS = (*COUNTERFACE_ROUGHNESS, ELASTIC_COUNTERFACE, "poisson_ratio_counterface")
"""A counterface that is rough, if its five roughness inputs are given, and elastic, if its modulus is."""

RIDGE_INPUTS = ("ridge_spacing", "ridge_width", "ridge_height")
"""Ridges of a finger pad, on whose tops all contact is."""

SKIN_DEFAULTS = {
    "poisson_ratio_layer": 0.5,
    "poisson_ratio_bulk": 0.5,
    "poisson_ratio": 0.5,
    "yield_stress": np.inf,
    "area_correction": AREA_CORRECTION,
}
"""Incompressible, elastic, with the Yang–Persson correction."""

FURTHER: dict[str, Any] = {
    "optional": {**SKIN_DEFAULTS, "poisson_ratio_counterface": 0.5},
    "accepted": (*COUNTERFACE_ROUGHNESS, ELASTIC_COUNTERFACE, *RIDGE_INPUTS),
    "goes_with": {
        **LAYERS_GO_WITH,
        # each with the next, so that none can be missing
        **dict(
            zip(COUNTERFACE_ROUGHNESS, COUNTERFACE_ROUGHNESS[1:] + COUNTERFACE_ROUGHNESS[:1], strict=True)
        ),
        "poisson_ratio_counterface": ELASTIC_COUNTERFACE,
        "ridge_spacing": "ridge_width",
        "ridge_width": "ridge_spacing",
        "ridge_height": "ridge_width",
    },
}
"""Fields of a forward model that knows counterface and ridges."""

PRESSURE_ALTERNATIVES = (
    ("nominal_pressure",),
    ("normal_force", "nominal_contact_area"),
    ("normal_force", "sphere_radius"),
)
"""How the nominal pressure can be given; the first complete alternative is used."""


def spectrum_of(inputs: Inputs, tables: Tables) -> PowerSpectrum:
    """Return the roughness spectrum: self-affine from the five roughness inputs, or the table; with that of a rough counterface.

    A table is scaled to ``rms_height`` if that input is given.
    """
    if COUNTERFACE_ROUGHNESS[0] in inputs:
        counterface = {
            name: inputs[own] for name, own in zip(ROUGHNESS_INPUTS, COUNTERFACE_ROUGHNESS, strict=True)
        }
        return SummedSpectrum(_own_spectrum(inputs, tables), SelfAffineSpectrum(**counterface))
    return _own_spectrum(inputs, tables)


def _own_spectrum(inputs: Inputs, tables: Tables) -> PowerSpectrum:
    table = tables.spectrum
    if table is None:
        return SelfAffineSpectrum(**{name: inputs[name] for name in ROUGHNESS_INPUTS})
    if "rms_height" in inputs and isinstance(table, TabulatedSpectrum):
        scale = (inputs["rms_height"] / rms_height(table)) ** 2 * np.asarray(table.scale)
        return TabulatedSpectrum(table.wavevector, table.node_power, scale=scale)
    return table


def skin_of(inputs: Inputs) -> ElasticSolid:
    """Return the solid of ``inputs``: skin of as many layers as are given, or a homogeneous one, with an elastic counterface.

    All that lies below the stratum corneum has the Poisson ratio of the bulk.
    """
    skin = _skin_alone(inputs)
    return skin if ELASTIC_COUNTERFACE not in inputs else SolidPair(skin, _counterface_of(inputs))


def _counterface_of(inputs: Inputs) -> HomogeneousSolid:
    return HomogeneousSolid(
        young_modulus=inputs[ELASTIC_COUNTERFACE], poisson_ratio=inputs["poisson_ratio_counterface"]
    )


def _skin_alone(inputs: Inputs) -> LayeredSkin | StackedSkin | HomogeneousSolid:
    deeper = [names for names in (DERMIS_INPUTS, FAT_INPUTS) if names[0] in inputs]
    if not deeper:
        return one_layer_skin_of(inputs)
    moduli = ["young_modulus_layer", *(modulus for modulus, _ in deeper), "young_modulus_bulk"]
    ratios = ["poisson_ratio_layer", *["poisson_ratio_bulk"] * (len(deeper) + 1)]
    thicknesses = ["layer_thickness", *(thickness for _, thickness in deeper)]
    return StackedSkin(
        young_moduli=_together(inputs, moduli),
        poisson_ratios=_together(inputs, ratios),
        thicknesses=_together(inputs, thicknesses),
    )


def _together(inputs: Inputs, names: list[str]) -> FloatArray:
    """Inputs along a new last axis."""
    return np.stack(np.broadcast_arrays(*(inputs[name] for name in names)), axis=-1)


def one_layer_skin_of(inputs: Inputs) -> LayeredSkin | HomogeneousSolid:
    """Return the solid of ``inputs`` of models that know one layer."""
    if "young_modulus" in inputs:
        return HomogeneousSolid(young_modulus=inputs["young_modulus"], poisson_ratio=inputs["poisson_ratio"])
    return LayeredSkin(
        young_modulus_layer=inputs["young_modulus_layer"],
        young_modulus_bulk=inputs["young_modulus_bulk"],
        poisson_ratio_layer=inputs["poisson_ratio_layer"],
        poisson_ratio_bulk=inputs["poisson_ratio_bulk"],
        layer_thickness=inputs["layer_thickness"],
    )


def nominal_pressure_of(inputs: Inputs) -> FloatArray:
    """Return p0 [Pa]: as given, load over nominal area, or the mean Hertz pressure of a sphere on the solid.

    On skin of one layer the Hertz pressure uses the modulus of the tissue below: the layer is far thinner than the contact is
    wide. Of more layers the contact of the ball on all of them is computed.
    """
    if "nominal_pressure" in inputs:
        return np.asarray(inputs["nominal_pressure"], dtype=float)
    if "nominal_contact_area" in inputs:
        return np.asarray(inputs["normal_force"] / inputs["nominal_contact_area"], dtype=float)
    return mean_pressure(inputs["normal_force"], inputs["sphere_radius"], modulus_under_ball_of(inputs))


def modulus_under_ball_of(inputs: Inputs) -> FloatArray:
    """Return the plane-strain modulus [Pa] that gives the contact of the ball of ``inputs`` on their solid, Hertz."""
    modulus = modulus_under_ball(inputs["normal_force"], inputs["sphere_radius"], skin=_skin_alone(inputs))
    return (
        modulus
        if ELASTIC_COUNTERFACE not in inputs
        else in_series(modulus, _counterface_of(inputs).contact_modulus)
    )


def ridge_share_of(inputs: Inputs) -> FloatArray | None:
    """Return the area of the tops of ridges over the nominal one; None without ridges."""
    return np.asarray(inputs["ridge_width"] / inputs["ridge_spacing"]) if "ridge_width" in inputs else None


def pressure_on_skin_of(inputs: Inputs) -> FloatArray:
    """Return the pressure [Pa] on what roughness is pressed with: p0, or p0 λ/w on the tops of ridges, which carry all load."""
    pressure, share = nominal_pressure_of(inputs), ridge_share_of(inputs)
    return pressure if share is None else np.asarray(pressure / share)


def pressure_and_slope(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    """Return what stands between the inputs and any contact: ``nominal_pressure`` [Pa] and ``rms_slope``."""
    return {
        "nominal_pressure": nominal_pressure_of(inputs),
        "rms_slope": np.asarray(rms_slope(spectrum_of(inputs, tables))),
    }


PRESSURE_AND_SLOPE: dict[str, Any] = {
    "derived": pressure_and_slope,
    "derived_names": ("nominal_pressure", "rms_slope"),
    "blocks": ("rms_slope",),
}
"""Fields of a forward model between whose inputs and observables stand these two."""


def check_one_solid(inputs: Inputs) -> None:
    """Raise InputError if layered skin and a homogeneous solid are both given, even in part."""
    layered = [name for name in inputs if name in SKIN_INPUTS or name.startswith("young_modulus_layer")]
    if "young_modulus" in inputs and layered:
        raise InputError(
            f"young_modulus and {layered[0]} exclude each other: the solid is homogeneous, of young_modulus alone, "
            f"or layered, of {', '.join(SKIN_INPUTS)}"
        )


def validate_contact(inputs: Inputs, tables: Tables) -> None:
    """Raise InputError naming the input of spectrum or solid that cannot be, such as a roll-off below the band."""
    check_one_solid(inputs)
    spectrum = spectrum_of(inputs, tables)
    parts = [spectrum.first, spectrum.second] if isinstance(spectrum, SummedSpectrum) else [spectrum]
    for part in parts:
        if isinstance(part, SelfAffineSpectrum):
            validate_spectrum(part)
    validate_solid(skin_of(inputs))
    share = ridge_share_of(inputs)
    if share is not None and not np.all(share <= 1):
        raise InputError(
            "ridge_width is larger than ridge_spacing; expected tops that are narrower than their distance"
        )


ENTERS_VARIANCE = (*SOLID_INPUTS, *ROUGHNESS_INPUTS, *COUNTERFACE_INPUTS)
"""Inputs that the stress variance depends on."""


def variance_of(inputs: Inputs, tables: Tables) -> FloatArray:
    """Return twice the stress variance V at full magnification [Pa²], an integral that is made once for rows of equal skin.

    Load and yield stress do not enter it: rows that differ in these alone share it.
    """
    return on_distinct(
        {name: inputs[name] for name in ENTERS_VARIANCE if name in inputs},
        lambda skins: integrated(spectrum_of(skins, tables), skin_of(skins)),
    )


def contact_area_of(inputs: Inputs, tables: Tables, twice_variance: FloatArray | None = None) -> ContactArea:
    """Return the relative contact area (elastic, plastic) at full magnification, or for a given V; ridges are counted in."""
    if twice_variance is None:
        twice_variance = twice_stress_variance(spectrum_of(inputs, tables), skin_of(inputs))
    area = elastoplastic_contact_area(
        pressure_on_skin_of(inputs),
        twice_variance,
        yield_stress=inputs["yield_stress"],
        area_correction=inputs["area_correction"],
    )
    share = ridge_share_of(inputs)
    if share is None:
        return area
    return ContactArea(area.elastic * share, area.plastic * share, 1 - share * (1 - area.non_contact))
