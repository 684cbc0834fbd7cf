"""Tables of films with flow factors against the film solver."""

import numpy as np
import pytest

from skinbayes.contact import LayeredSkin
from skinbayes.lubrication import (
    FilmTablePlan,
    LubricatedBalls,
    PatirCheng,
    build_film_table,
    stribeck_curve,
    tabulated_flow_factors,
    tabulated_friction,
)
from skinbayes.roughness import named_surface

SURFACE = named_surface("paper_reference")
BALL = {"young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "rms_height": 22.4e-6, "sphere_radius": 8e-3,
        "normal_force": 0.2, "layer_thickness": 20e-6}  # fmt: skip
PRODUCTS = np.geomspace(1e-5, 0.3, 12)


@pytest.mark.parametrize("kind", ["patir-cheng", "gap"])
def test_a_table_holds_them(kind: str) -> None:
    """Flow factors move the falling flank to half of its speed, and last where roughness no longer touches."""
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    factors = PatirCheng(22.4e-6) if kind == "patir-cheng" else tabulated_flow_factors(SURFACE, skin)
    given = {"normal_force": 0.2, "sphere_radius": 8e-3, "spectrum": SURFACE, "skin": skin,
             "frictional_shear_stress": 15e6, "contact": "line"}  # fmt: skip
    direct = stribeck_curve(PRODUCTS, flow_factors=factors, **given).friction_coefficient
    table = build_film_table(
        FilmTablePlan(
            {name: (value, value) for name, value in BALL.items()},
            spectrum=SURFACE, contact="line", flow_factors=kind, checked=0,
        )
    )  # fmt: skip
    balls = LubricatedBalls(parameters=BALL, frictional_shear_stress=15e6)
    found = tabulated_friction(table, PRODUCTS, balls=balls).friction_coefficient
    assert found == pytest.approx(direct, rel=5e-3)
    plain = stribeck_curve(PRODUCTS, **given).friction_coefficient
    assert np.abs(direct / plain - 1).max() > 0.2


def test_tables_of_other_factors_are_others() -> None:
    ranges = {name: (value, value) for name, value in BALL.items()}
    keys = [
        FilmTablePlan(ranges, spectrum=SURFACE, flow_factors=kind).key()
        for kind in ("none", "gap", "patir-cheng")
    ]
    assert keys[0] != keys[1] != keys[2] and "flow_factors" not in keys[0]
