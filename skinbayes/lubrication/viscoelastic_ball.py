"""Friction of a ball itself on lubricated viscoelastic skin, with what memory adds taken from its cylinder."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.contact.viscoelastic_skin import ViscoelasticSkin
from skinbayes.lubrication.contact_films import POINT
from skinbayes.lubrication.stribeck import StribeckCurve, stribeck_curve
from skinbayes.lubrication.viscoelastic_stribeck import (
    ViscoelasticStribeckCurve,
    skin_at_speed,
    viscoelastic_stribeck_curve,
)

SIMILAR_SPEED = 0.8
"""Speed of a cylinder that carries the same load as its ball on a film, over that of the ball."""


def viscoelastic_ball_curve(
    speed: float, viscosity: FloatArray | float, *, skin: ViscoelasticSkin, **ball: Any
) -> ViscoelasticStribeckCurve:
    """The curve of the elastic ball of the same |E| at v/b, each part times that of the viscoelastic over the elastic cylinder.

    An approximation: the cylinders are compared at 0.8 of the speed times viscosity, where they carry as much on the film. The
    hysteresis is that of the cylinder times 0.663, as everywhere. Arguments are those of `viscoelastic_stribeck_curve`, of one
    speed, m/s, and viscosities, Pa s, shape ``(K,)``.
    """
    viscosities = np.atleast_1d(np.asarray(viscosity, dtype=np.float64))
    given = {"normal_force": ball["normal_force"], "sphere_radius": ball["sphere_radius"]}
    held = skin_at_speed(speed, skin=skin, **given)
    elastic = ViscoelasticSkin(
        layer=ViscoelasticMaterial(
            equilibrium_modulus=held.young_modulus_layer, poisson_ratio=held.poisson_ratio_layer
        ),
        bulk=ViscoelasticMaterial(
            equilibrium_modulus=held.young_modulus_bulk, poisson_ratio=held.poisson_ratio_bulk
        ),
        layer_thickness=skin.layer_thickness,
    )
    point = stribeck_curve(speed * viscosities, contact=POINT, skin=held, **ball)
    endless = ball | {"thickest_film": np.inf}
    with_memory, without = (
        viscoelastic_stribeck_curve(speed, SIMILAR_SPEED * viscosities, skin=one, **endless)
        for one in (skin, elastic)
    )
    names = ("boundary", "couette", "asperity_load_fraction", "minimum_film", "central_film")
    found = {
        name: getattr(point, name) * (getattr(with_memory, name) / getattr(without, name)) for name in names
    }
    # the pressure flow up to the edge of a ball may be of either sign: the whole drag is compared
    drag = point.couette + point.pressure_flow
    drag = drag * (
        (with_memory.couette + with_memory.pressure_flow) / (without.couette + without.pressure_flow)
    )
    found["asperity_load_fraction"] = np.minimum(found["asperity_load_fraction"], 1.0)
    found |= {"pressure_flow": drag - found["couette"], "hysteresis": with_memory.hysteresis}
    found["friction_coefficient"] = found["boundary"] + drag + found["hysteresis"]
    plain = {entry.name: getattr(point, entry.name) for entry in fields(StribeckCurve)}
    return ViscoelasticStribeckCurve(
        **(plain | found | {"speed": np.full(viscosities.shape, float(speed)), "viscosity": viscosities})
    )
