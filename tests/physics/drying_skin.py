"""Skin of the paper that is wetted and dries, for tests at the ends of its domain."""

import numpy as np

from skinbayes.contact import LayeredSkin
from skinbayes.roughness import named_surface
from skinbayes.wetting import film_contact

SURFACE, SKIN = (
    named_surface("paper_reference"),
    LayeredSkin(
        young_modulus_layer=7e6,
        young_modulus_bulk=20e3,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=20e-6,
    ),
)
LOAD, ANGLE, DRY, YIELD, STRESS = 6830.0, np.radians(80.0), 1e9, 50e6, 15e6
NONE = np.empty(0)


def contact_of(
    load=LOAD,
    surface=SURFACE,
    skin=SKIN,
    tension=0.0727,
    angle=ANGLE,
    other=0.0,
    dry=DRY,
    limit=YIELD,
    **more,
):
    return film_contact(
        load,
        surface,
        skin=skin,
        surface_tension=tension,
        contact_angle_skin=angle,
        contact_angle_counterface=other,
        young_modulus_layer_dry=dry,
        yield_stress=limit,
        **more,
    )
