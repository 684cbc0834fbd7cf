"""Solids up to scale, for tables: a modulus that loads are counted in, and what is left of the solid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import HomogeneousSolid, LayeredSkin

Solid: TypeAlias = LayeredSkin | HomogeneousSolid
"""Solids that tables know."""


def scale_modulus(solid: Solid) -> FloatArray:
    """The modulus that loads are counted in, that of the bulk, Pa."""
    return np.asarray(solid.young_modulus_bulk if isinstance(solid, LayeredSkin) else solid.young_modulus)


def shape_groups(solid: Solid) -> dict[str, FloatArray]:
    """What a solid is apart from its scale: ``ln(E0/E1)``, ln of the thickness in m, and Poisson ratios, dimensionless."""
    if not isinstance(solid, LayeredSkin):
        return {"poisson_ratio": np.asarray(solid.poisson_ratio)}
    return {
        "stiffness": np.log(solid.young_modulus_layer / np.asarray(solid.young_modulus_bulk)),
        "layer_thickness": np.log(solid.layer_thickness),
        "poisson_ratio_layer": np.asarray(solid.poisson_ratio_layer),
        "poisson_ratio_bulk": np.asarray(solid.poisson_ratio_bulk),
    }


def solid_of_groups(groups: Mapping[str, FloatArray], modulus: FloatArray) -> Solid:
    """The solid that has these `shape_groups`, and ``modulus``, Pa, as its scale."""
    if "stiffness" not in groups:
        return HomogeneousSolid(young_modulus=modulus, poisson_ratio=groups["poisson_ratio"])
    return LayeredSkin(
        young_modulus_layer=modulus * np.exp(groups["stiffness"]),
        young_modulus_bulk=modulus,
        poisson_ratio_layer=groups["poisson_ratio_layer"],
        poisson_ratio_bulk=groups["poisson_ratio_bulk"],
        layer_thickness=np.exp(groups["layer_thickness"]),
    )
