"""Lubricated films at the ends of their domains: at rest, without asperities, in empty batches and with impossible arguments.

At rest the areas of real contact alone rub: friction is that of dry contact at the mean pressure of Hertz, μ = σ_f A/(A0 p0),
which `friction_coefficient` and `relative_contact_area` know without any film.
"""

from dataclasses import fields
from functools import lru_cache

import numpy as np
import pytest
from line_curves import FilmTablePlan, stribeck_curve, stribeck_curve_of_liquid

from skinbayes.contact import (
    LayeredSkin,
    reduced_modulus,
    relative_contact_area,
    sphere_contact,
    twice_stress_variance,
)
from skinbayes.errors import InputError
from skinbayes.friction import friction_coefficient
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    FlowCurve,
    LubricatedBalls,
    PatirCheng,
    ShearThinning,
    TrivialFlowFactors,
    asperity_law,
    asperity_table,
    build_film_table,
    liquid_rows,
    lubricated_films,
    tabulated_friction,
    tabulated_friction_of_liquids,
    thinned_viscosity,
)
from skinbayes.roughness import SelfAffineSpectrum, named_surface

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
BALL = {"sphere_radius": 8e-3, "normal_force": 0.2, "skin": SKIN, "spectrum": SURFACE}
LINE = {"cylinder_radius": 4.533e-3, "load_per_length": 21.92, "reduced_modulus": 20e3 / 0.75}
WITHIN = 2e-3  # of friction: what the grid of the solver leaves
NONE, STRESS = np.empty(0), 15e6
LIQUID = FlowCurve([1.0, 10.0, 100.0], [2.0, 1.0, 0.5])


def curve(products, **changes):
    return stribeck_curve(products, **{**BALL, "frictional_shear_stress": STRESS, **changes})


def at_rest(skin=SKIN, surface=SURFACE, force=0.2, radius=8e-3, gamma=0.42, stress=STRESS):
    """Friction of dry contact at the mean pressure of Hertz."""
    modulus = reduced_modulus(skin.young_modulus_bulk, skin.poisson_ratio_bulk)
    pressure = sphere_contact(force, radius, reduced_modulus=modulus).mean_pressure
    area = relative_contact_area(pressure, twice_stress_variance(surface, skin), area_correction=gamma)
    return friction_coefficient(stress, area, nominal_pressure=pressure)


def at_rest_within(skin, surface, force, radius, gamma):
    """The same with the semi-elliptic pressure of the cylinder that stands for the ball, by quadrature over its contact."""
    modulus = reduced_modulus(skin.young_modulus_bulk, skin.poisson_ratio_bulk)
    mean = sphere_contact(force, radius, reduced_modulus=modulus).mean_pressure
    variance = twice_stress_variance(surface, skin)
    angles, weights = np.polynomial.legendre.leggauss(60)
    area = 0.0
    for angle, weight in zip(np.pi / 4 * (angles + 1), weights * np.pi / 4, strict=True):
        pressure = 4 / np.pi * mean * np.cos(angle)
        area += weight * np.cos(angle) * relative_contact_area(pressure, variance, area_correction=gamma)
    return STRESS * area / mean


def random_balls(count):
    rng = np.random.default_rng(17)

    def between(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    bulk, first = between(1e4, 1e5), between(3e2, 3e3)
    skin = LayeredSkin(
        young_modulus_layer=bulk * between(30.0, 3e3),
        young_modulus_bulk=bulk,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=between(1e-5, 4e-5),
    )
    surface = SelfAffineSpectrum(
        rms_height=between(5e-6, 4e-5),
        hurst_exponent=rng.uniform(0.6, 0.95, count),
        wavevector_min=first,
        wavevector_rolloff=first * between(1.0, 10.0),
        wavevector_max=1e9,
    )
    # b/Rc stays below 0.8
    radius = between(4e-3, 2e-2)
    return skin, surface, radius, 0.1 * bulk * radius**2 * between(0.1, 1.0), rng.uniform(0.1, 1.0, count)


def member(parts, count):
    """The second of a batch."""
    return type(parts)(
        **{x.name: np.broadcast_to(getattr(parts, x.name), count)[1] for x in fields(parts) if x.init}
    )


def check_rest(count):
    skin, surface, radius, force, gamma = random_balls(count)
    arguments = {
        "sphere_radius": radius,
        "normal_force": force,
        "skin": skin,
        "spectrum": surface,
        "frictional_shear_stress": STRESS,
        "area_correction": gamma,
    }
    found = stribeck_curve([0.0, 1e-300, 1e-15], **arguments)
    assert found.valid.all()
    wanted = at_rest_within(skin, surface, force, radius, gamma)
    np.testing.assert_allclose(found.friction_coefficient[:, 0], wanted, rtol=WITHIN)
    np.testing.assert_allclose(
        found.friction_coefficient[:, 1:], found.friction_coefficient[:, :1] * [1, 1], rtol=1e-6
    )
    for name in ("couette", "pressure_flow"):
        np.testing.assert_array_equal(getattr(found, name)[:, 0], 0.0)
    np.testing.assert_array_equal(found.asperity_load_fraction[:, 0], 1.0)
    one = stribeck_curve(
        [0.0, 1e-300, 1e-15],
        sphere_radius=radius[1],
        normal_force=force[1],
        skin=member(skin, count),
        spectrum=member(surface, count),
        frictional_shear_stress=STRESS,
        area_correction=gamma[1],
    )
    for field in fields(found):
        np.testing.assert_array_equal(getattr(found, field.name)[1], getattr(one, field.name))


def test_a_ball_at_rest_has_boundary_friction():
    check_rest(6)


@pytest.mark.slow
def test_many_balls_at_rest_have_boundary_friction():
    check_rest(150)


@pytest.mark.parametrize(
    "changes",
    [
        {"rheology": ShearThinning(1.0)},
        {"rheology": LIQUID},
        {"flow_factors": PatirCheng(22.4e-6)},
        {"flow_factors": TrivialFlowFactors()},
        {"flow_factors": PatirCheng(22.4e-6), "rheology": ShearThinning(1.0, exponent=0.0)},
    ],
)
def test_at_rest_neither_liquid_nor_flow_factors_matter(changes):
    found = curve([0.0, 1e-300], **changes)
    np.testing.assert_allclose(found.friction_coefficient, at_rest(), rtol=1e-4)
    assert found.couette[0] == 0.0 and found.pressure_flow[0] == 0.0


def test_the_end_of_a_curve_says_why_it_is_silent():
    found = curve([-1.0, 0.0, -0.0, np.nan, np.inf, 1e300, 1e-3])
    assert found.valid.tolist() == [False, True, True, False, False, False, True]
    assert found.film_beyond_ball.tolist() == [False] * 5 + [True, False]
    for changes in ({"velocity_shift_factor": 0.0}, {"velocity_shift_factor": -1.0}):
        assert curve([-1e-3, 0.0, 1e-3], **changes).impossible.all()
    # a speed beyond all films does not take those of others away
    both = curve([1e300, 1e-2], thickest_film=np.inf)
    assert both.not_converged.tolist() == [True, False]
    assert both.friction_coefficient[1] == pytest.approx(curve([1e-2]).friction_coefficient[0], rel=1e-9)
    assert curve(0.0).friction_coefficient.shape == ()
    # without asperities that count, the smooth ball
    smooth = lubricated_films([1e-3], **LINE)
    fine = curve(
        [1e-3],
        spectrum=SelfAffineSpectrum(
            rms_height=1e-12,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=1e3,
            wavevector_max=1e9,
        ),
        frictional_shear_stress=0.0,
    )
    assert fine.friction_coefficient[0] == pytest.approx(
        smooth.couette[0] + smooth.pressure_flow[0], rel=2e-3
    )


def test_films_of_impossible_arguments_are_nan_and_leave_others_alone():
    law = asperity_law(SURFACE, SKIN)
    with_bad = lubricated_films([-1.0, 1e-2, np.nan, np.inf, 1e300], **LINE, asperities=law)
    alone = lubricated_films([1e-2], **LINE, asperities=law)
    for name, value in with_bad._asdict().items():
        if name in ("position", "load_weight"):
            np.testing.assert_array_equal(value, getattr(alone, name))
            continue
        np.testing.assert_allclose(value[1], getattr(alone, name)[0], rtol=1e-9, atol=1e-9)
        if name != "lubrication_number":
            assert np.isnan(value[[0, 2, 3, 4]]).all(), name
    resting = lubricated_films([0.0, 0.1], **LINE)
    assert np.isnan(resting.minimum_film[0]) and np.isnan(resting.asperity_load_fraction[0])
    assert resting.central_film[1] == pytest.approx(lubricated_films([0.1], **LINE).central_film[0], rel=1e-9)
    for name in LINE:
        for value in (0.0, -1.0, np.inf, np.nan):
            for asperities in (None, law):
                found = lubricated_films([0.0, 0.1], **{**LINE, name: value}, asperities=asperities)
                assert np.isnan(found.couette).all() and found.couette.shape == (2,)
                assert np.isnan(found.separation).all() and found.separation.shape == (2, 80)
    with pytest.raises(InputError, match="nodes is 3"):
        lubricated_films([0.1], **LINE, nodes=3)


def test_thick_films_grow_with_the_root_of_the_speed():
    # the load is then carried on a wide parabola that hardly bends: μ ∝ √λ and u ∝ λ, as of a rigid cylinder
    found = [lubricated_films([product], **LINE) for product in (1e4, 1e8)]
    couette, film = (np.array([getattr(x, name)[0] for x in found]) for name in ("couette", "central_film"))
    assert couette[1] / couette[0] == pytest.approx(1e2, rel=1e-2)
    assert film[1] / film[0] == pytest.approx(1e4, rel=1e-2)


def test_empty_batches_are_empty():
    nobody = LayeredSkin(
        young_modulus_layer=NONE,
        young_modulus_bulk=20e3,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=20e-6,
    )
    assert curve(NONE).friction_coefficient.shape == (0,)
    for changes in ({"normal_force": NONE}, {"skin": nobody}):
        empty = curve([1e-3, 1e-2], **changes)
        assert empty.friction_coefficient.shape == empty.valid.shape == (0, 2) and empty.reasons() == []
        assert empty.strain.shape == (0,) and empty.impossible.dtype == bool
    assert lubricated_films(NONE, **LINE).separation.shape == (0, 80)
    assert asperity_table(SURFACE, nobody).separation.shape == (0, 160)
    found, viscosity = stribeck_curve_of_liquid(NONE, LIQUID, **BALL, frictional_shear_stress=STRESS)
    assert found.friction_coefficient.shape == viscosity.viscosity.shape == (0,)
    assert LIQUID.viscosity(NONE).shape == thinned_viscosity(NONE, 1.0).shape == (0,)
    for factors in (PatirCheng(1e-6), TrivialFlowFactors()):
        assert all(part.shape == (0,) for part in (*factors.flow(NONE), *factors.friction(NONE)))
    balls, one = mid_ball(), one_table()
    liquids = liquid_rows([LIQUID] * 2)
    assert tabulated_friction(
        one, NONE, balls=LubricatedBalls(parameters=balls, frictional_shear_stress=STRESS)
    ).friction_coefficient.shape == (0,)
    assert tabulated_friction(
        one, np.empty((0, 2)), balls=LubricatedBalls(parameters=balls, frictional_shear_stress=STRESS)
    ).outside_table.shape == (0, 2)
    nothing, none = tabulated_friction_of_liquids(
        one,
        np.empty((0, 2)),
        balls=LubricatedBalls(parameters=balls, frictional_shear_stress=STRESS),
        liquids=liquids,
    )
    assert nothing.friction_coefficient.shape == none.viscosity.shape == (0, 2)


@lru_cache(maxsize=1)
def one_table():
    """Films of one ball at all speeds."""
    return build_film_table(
        FilmTablePlan({name: (x, x) for name, x in mid_ball().items()}, spectrum=SURFACE, checked=0)
    )


def mid_ball():
    return dict(zip(FILM_PARAMETERS, (7e6, 20e3, 22.4e-6, 8e-3, 0.2, 20e-6), strict=True))


def test_a_table_of_films_at_its_ends():
    table, ball = one_table(), mid_ball()
    found = tabulated_friction(
        table,
        [0.0, 1e-300, 1e-12],
        balls=LubricatedBalls(parameters=ball, frictional_shear_stress=STRESS, everything=True),
    )
    np.testing.assert_allclose(found.friction_coefficient, at_rest(), rtol=5e-3)
    np.testing.assert_allclose(found.friction_coefficient[:2], found.friction_coefficient[2], rtol=1e-6)
    assert found.couette[0] == 0.0 and found.pressure_flow[0] == 0.0
    np.testing.assert_array_equal(found.central_film[0], found.central_film[1])
    assert (found.asperity_load_fraction <= 1).all() and not found.outside_table.any()
    for product in (0.0, 1e-300, 1e-12):
        alone = tabulated_friction(
            table, product, balls=LubricatedBalls(parameters=ball, frictional_shear_stress=STRESS)
        )
        assert alone.friction_coefficient == found.friction_coefficient[[0.0, 1e-300, 1e-12].index(product)]
    for product, shift in ((-1.0, 1.0), (np.nan, 1.0), (-1.0, -1.0), (1.0, 0.0), (1e-3, -1.0)):
        bad = tabulated_friction(
            table,
            product,
            balls=LubricatedBalls(
                parameters=ball, frictional_shear_stress=STRESS, velocity_shift_factor=shift
            ),
        )
        # impossible, which is not to say that another table would do
        assert np.isnan(bad.friction_coefficient) and not bad.outside_table
    far = tabulated_friction(
        table,
        [1e300, np.inf],
        balls=LubricatedBalls(parameters=ball, frictional_shear_stress=STRESS, thickest_film=np.inf),
    )
    assert far.outside_table.all() and np.isnan(far.friction_coefficient).all()
    for name in FILM_PARAMETERS:
        for value in (0.0, -1.0, np.inf, np.nan):
            bad = tabulated_friction(
                table,
                1e-3,
                balls=LubricatedBalls(parameters={**ball, name: value}, frictional_shear_stress=STRESS),
            )
            assert np.isnan(bad.friction_coefficient) and bad.outside_table


@pytest.mark.parametrize("viscosities", [[2.0, 1.0, 0.5], [2.0, 0.1, 0.01]])  # the stress of the second falls
def test_liquids_at_rest(viscosities):
    liquid = FlowCurve([1.0, 10.0, 100.0], viscosities)
    speeds = [0.0, 1e-300, 1e-3]
    friction, viscosity = tabulated_friction_of_liquids(
        one_table(),
        speeds,
        balls=LubricatedBalls(parameters=mid_ball(), frictional_shear_stress=STRESS),
        liquids=liquid_rows([liquid] * 3),
    )
    direct, effective = stribeck_curve_of_liquid(speeds, liquid, **BALL, frictional_shear_stress=STRESS)
    for mu, liquids in ((friction.friction_coefficient, viscosity), (direct.friction_coefficient, effective)):
        np.testing.assert_allclose(mu[:2], at_rest(), rtol=5e-3)
        assert mu[0] == pytest.approx(mu[1], rel=1e-9)
        # as thick as it was measured to be at the slowest shear
        np.testing.assert_allclose(liquids.viscosity[:2], 2.0, rtol=1e-9)
        assert liquids.shear_rate[0] == 0.0 and liquids.unmeasured[:2].all()
    assert not friction.outside_table.any()
    bad, thick = tabulated_friction_of_liquids(
        one_table(),
        [-1.0, np.nan, 1e-3],
        balls=LubricatedBalls(parameters=mid_ball(), frictional_shear_stress=STRESS),
        liquids=liquid_rows([liquid] * 3),
    )
    assert (
        np.isnan(bad.friction_coefficient).tolist()
        == np.isnan(thick.viscosity).tolist()
        == [True, True, False]
    )
    assert not bad.outside_table.any()
    for wrong in (-1.0, np.nan, np.inf):
        with pytest.raises(InputError, match="sliding_speed 2 is"):
            stribeck_curve_of_liquid([0.0, wrong], liquid, **BALL, frictional_shear_stress=STRESS)
    for changes in (
        {"normal_force": 0.0},
        {"area_correction": 0.0},
        {
            "skin": LayeredSkin(
                young_modulus_layer=-1.0,
                young_modulus_bulk=2e4,
                poisson_ratio_layer=0.5,
                poisson_ratio_bulk=0.5,
                layer_thickness=2e-5,
            )
        },
    ):
        silent, unknown = stribeck_curve_of_liquid(
            [0.0, 1e-3], liquid, **{**BALL, "frictional_shear_stress": STRESS, **changes}
        )
        assert silent.impossible.all() and np.isnan(unknown.viscosity).all()
