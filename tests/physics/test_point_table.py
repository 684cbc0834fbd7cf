"""Tables of films under the ball itself, against the film solver in two dimensions."""

import numpy as np
import pytest
from small_film_tables import RANGES, draw, skin_of, spectrum_of

from skinbayes.errors import InputError
from skinbayes.lubrication import (
    FilmTablePlan,
    FlowCurve,
    LubricatedBalls,
    build_film_table,
    liquid_rows,
    stribeck_curve,
    stribeck_curve_of_liquid,
    tabulated_friction,
    tabulated_friction_of_liquids,
)
from skinbayes.roughness import named_surface

STRESS = 15e6
BALL = {name: float(np.sqrt(low * high)) for name, (low, high) in RANGES.items()}
PARTS = {
    "friction_coefficient": 0.01, "boundary": 0.03, "couette": 0.01, "central_film": 0.01, "minimum_film": 0.04,
}  # fmt: skip


@pytest.fixture(scope="module")
def table():
    """A table of one ball."""
    ranges = {name: (value, value) for name, value in BALL.items()}
    return build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), checked=0))


def direct(parameters, products, **more):
    return stribeck_curve(
        products, normal_force=parameters["normal_force"], sphere_radius=parameters["sphere_radius"],
        spectrum=spectrum_of(parameters), skin=skin_of(parameters), frictional_shear_stress=STRESS, **more,
    )  # fmt: skip


def test_one_ball_at_all_speeds(table):
    # from where asperities carry everything to the thickest film, beyond both ends of the speeds of the table
    products = np.geomspace(1e-7, 0.8, 12)
    curve = direct(BALL, products)
    balls = LubricatedBalls(parameters=BALL, frictional_shear_stress=STRESS, everything=True)
    found = tabulated_friction(table, products, balls=balls)
    for name, allowed in PARTS.items():
        wanted, got = getattr(curve, name), getattr(found, name)
        there = wanted > 1e-3 * curve.friction_coefficient if name == "boundary" else wanted > 0
        np.testing.assert_allclose(got[there], wanted[there], rtol=allowed, err_msg=name)
    np.testing.assert_allclose(found.asperity_load_fraction, curve.asperity_load_fraction, atol=4e-3)
    np.testing.assert_allclose(
        found.boundary + found.couette + found.pressure_flow, found.friction_coefficient
    )


def test_the_viscosity_is_that_in_the_film_of_the_ball(table):
    honey = FlowCurve([10.0, 100.0, 1000.0], [25.0, 23.5, 15.0])
    speeds = np.array([1e-3, 1e-2])
    skin = {"spectrum": spectrum_of(BALL), "skin": skin_of(BALL), "frictional_shear_stress": STRESS}
    ball = {name: BALL[name] for name in ("normal_force", "sphere_radius")}
    curve, liquid = stribeck_curve_of_liquid(speeds, honey, cells=150, **ball, **skin)
    balls = LubricatedBalls(parameters=BALL, frictional_shear_stress=STRESS)
    found, viscosity = tabulated_friction_of_liquids(
        table, speeds, balls=balls, liquids=liquid_rows([honey] * 2)
    )
    np.testing.assert_allclose(viscosity.shear_rate, liquid.shear_rate, rtol=0.03)
    np.testing.assert_allclose(found.friction_coefficient, curve.friction_coefficient, rtol=0.03)


def test_a_ball_that_is_similar_but_for_its_edge_is_outside(table):
    # same h R and F R: the cylinder's films are the same, but the drag of the ball ends elsewhere
    other = BALL | {
        "sphere_radius": 2 * BALL["sphere_radius"], "normal_force": BALL["normal_force"] / 2,
        "rms_height": BALL["rms_height"] / 2,
    }  # fmt: skip
    assert table.contains(**BALL)
    assert not table.contains(**other)
    balls = LubricatedBalls(parameters=other, frictional_shear_stress=STRESS)
    assert np.isnan(tabulated_friction(table, 1e-3, balls=balls).friction_coefficient)


def test_an_unknown_contact_is_refused_with_the_list():
    with pytest.raises(InputError, match="'point' or 'line'"):
        FilmTablePlan(RANGES, spectrum=named_surface("paper_reference"), contact="ellipse")
    with pytest.raises(InputError, match="'point' or 'line'"):
        direct(BALL, [1e-3], contact="ellipse")


@pytest.mark.slow
@pytest.mark.parametrize("radius", [(8e-3, 8e-3), (4e-3, 16e-3)])
def test_random_balls(radius):
    """200 random balls and speeds, with the radius as one more axis and without."""
    ranges = RANGES | {"sphere_radius": radius, "young_modulus_layer": (3e6, 14e6)}
    table = build_film_table(FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), checked=0))
    rng = np.random.default_rng(8)
    drawn = draw(rng, 25)
    for name in ("sphere_radius", "young_modulus_layer"):
        drawn[name] = np.exp(rng.uniform(*np.log(ranges[name]), (25, 1)))
    products = np.geomspace(1e-4, 0.3, 8)
    balls = LubricatedBalls(parameters=drawn, frictional_shear_stress=STRESS)
    found = tabulated_friction(table, products, balls=balls).friction_coefficient
    errors = []
    for row in range(25):
        one = {name: float(value[row, 0]) for name, value in drawn.items()}
        errors.append(found[row] / direct(one, products, cells=800).friction_coefficient - 1)
    size = np.abs(np.array(errors)[np.isfinite(errors)])
    print(size.size, np.quantile(size, [0.5, 0.9, 0.99, 1.0]))
    assert size.size > 150
    assert np.quantile(size, 0.99) < 0.01
    assert size.max() < 0.015
