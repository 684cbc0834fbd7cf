"""Liquids with measured flow curves: tables of them, and the viscosity that agrees with its own film."""

import numpy as np
import pytest
from line_curves import stribeck_curve_of_liquid
from scipy.optimize import brentq
from small_film_tables import draw, skin_of, small_table, spectrum_of

from skinbayes.contact import reduced_modulus
from skinbayes.contact.line_contact import cylinder_of_sphere
from skinbayes.errors import InputError
from skinbayes.files import load_dataset
from skinbayes.lubrication import (
    FlowCurve,
    LubricatedBalls,
    asperity_law,
    liquid_rows,
    lubricated_films,
    tabulated_friction,
    tabulated_friction_of_liquids,
)

STRESS = 15e6


def measured_curves():
    data = load_dataset("fehlberg2025-rheology").columns
    liquids = np.asarray(data["liquid"])
    return {
        str(name): FlowCurve(data["shear_rate"][liquids == name], data["viscosity"][liquids == name])
        for name in dict.fromkeys(liquids)
    }


CURVES = measured_curves()
WITH_RISING_STRESS = [name for name in CURVES if name not in ("hand cream", "hand cream + 6 g starch")]


def rows_of(names):
    return liquid_rows([CURVES[name] for name in names])


@pytest.mark.parametrize("name", CURVES)
def test_tabulated_flow_curves_are_those_of_the_measurements(name):
    curve = CURVES[name]
    low, high = np.log(curve.shear_rate_range)
    inside = np.append(np.linspace(low + 1e-9, high - 1e-9, 5003), np.log(np.asarray(curve.shear_rate)[1:-1]))
    rows = liquid_rows([curve] * inside.size)
    value, slope = rows.log_viscosity(inside)
    assert np.abs(np.exp(value) / curve.viscosity(np.exp(inside)) - 1).max() < 1e-4
    # the slope is that of the tabulated curve itself, by differences
    smooth = (rows.log_viscosity(inside + 1e-6)[0] - rows.log_viscosity(inside - 1e-6)[0]) / 2e-6
    assert np.median(np.abs(smooth - slope)) < 1e-6
    outside = np.array([low - 3.0, high + 3.0])
    ends, flat = liquid_rows([curve] * 2).log_viscosity(outside)
    assert np.exp(ends) == pytest.approx(np.asarray(curve.measured_viscosity)[[0, -1]], rel=1e-9)
    assert np.array_equal(flat, [0.0, 0.0])


def test_rows_of_one_liquid_share_a_table():
    rows = rows_of(["honey", "water", "honey"])
    assert np.array_equal(rows.liquid, [0, 1, 0])
    assert rows.cubics[0].size == 2 * 512
    assert np.array_equal(rows.measured([9.0, 11.0, 1001.0]), [False, True, False])
    with pytest.raises(InputError, match="at least one row"):
        liquid_rows([])


def test_a_newtonian_flow_curve_is_a_plain_viscosity():
    rows = liquid_rows([FlowCurve([1.0, 1e4], [0.3, 0.3])] * 12)
    speeds = np.geomspace(1e-4, 0.3, 12)
    parameters = draw(np.random.default_rng(1), 5)
    found, viscosity = tabulated_friction_of_liquids(
        small_table(),
        speeds,
        balls=LubricatedBalls(
            parameters=parameters, frictional_shear_stress=STRESS, velocity_shift_factor=2.0
        ),
        liquids=rows,
    )
    wanted = tabulated_friction(
        small_table(),
        0.3 * speeds,
        balls=LubricatedBalls(
            parameters=parameters, frictional_shear_stress=STRESS, velocity_shift_factor=2.0, everything=True
        ),
    )
    np.testing.assert_allclose(found.friction_coefficient, wanted.friction_coefficient, rtol=1e-12)
    np.testing.assert_allclose(viscosity.viscosity, 0.3, rtol=1e-12)
    # the shear rate is that of the speed itself, the film that of the shifted one
    np.testing.assert_allclose(viscosity.shear_rate, speeds / wanted.central_film, rtol=1e-9)
    assert np.array_equal(viscosity.unmeasured, (viscosity.shear_rate > 1e4) | (viscosity.shear_rate < 1))


def test_viscosity_agrees_with_its_film():
    names = list(CURVES)
    speeds = np.exp(np.random.default_rng(2).uniform(np.log(1e-3), np.log(0.3), len(names)))
    parameters = draw(np.random.default_rng(3), 200, len(names))
    found, viscosity = tabulated_friction_of_liquids(
        small_table(),
        speeds,
        balls=LubricatedBalls(
            parameters=parameters, frictional_shear_stress=STRESS, velocity_shift_factor=1.5, everything=True
        ),
        liquids=rows_of(names),
    )
    good = np.isfinite(found.friction_coefficient)
    assert good.mean() > 0.9
    rate = speeds / found.central_film
    np.testing.assert_allclose(viscosity.shear_rate[good], rate[good], rtol=1e-6)
    for column, name in enumerate(names):
        curve, keep = CURVES[name], good[:, column]
        low, high = curve.shear_rate_range
        expected = curve.viscosity(np.clip(rate[keep, column], low, high))
        np.testing.assert_allclose(viscosity.viscosity[keep, column], expected, rtol=1e-4)
        assert np.array_equal(
            viscosity.unmeasured[:, column] & keep, keep & ~curve.measured_at(rate[:, column])
        )
    plain = tabulated_friction(
        small_table(),
        viscosity.viscosity * speeds,
        balls=LubricatedBalls(
            parameters=parameters, frictional_shear_stress=STRESS, velocity_shift_factor=1.5
        ),
    )
    np.testing.assert_allclose(found.friction_coefficient[good], plain.friction_coefficient[good], rtol=1e-9)


@pytest.mark.parametrize("name", WITH_RISING_STRESS)
def test_viscosity_against_a_plain_root_finder(name):
    curve, table = CURVES[name], small_table()
    low, high = curve.shear_rate_range
    rng = np.random.default_rng(4)
    parameters = draw(rng, 4)
    speeds = np.exp(rng.uniform(np.log(1e-3), np.log(0.3), 3))
    rows = liquid_rows([curve] * 3)
    found = tabulated_friction_of_liquids(
        table,
        speeds,
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=STRESS),
        liquids=rows,
    )[1].viscosity

    for vector in range(4):
        one = {key: float(value[vector, 0]) for key, value in parameters.items()}
        for column, speed in enumerate(speeds):
            if np.isnan(found[vector, column]):
                continue

            def miss(log_viscosity, one=one, speed=speed):
                film = tabulated_friction(
                    table,
                    np.exp(log_viscosity) * speed,
                    balls=LubricatedBalls(parameters=one, frictional_shear_stress=STRESS, everything=True),
                )
                rate = np.clip(speed / film.central_film, low * (1 + 1e-12), high * (1 - 1e-12))
                return np.log(curve.viscosity(rate)) - log_viscosity

            # a film beyond the ball at the largest viscosity has no friction: the bracket starts from the root's side
            place = np.log(found[vector, column])
            ends = [x for x in (place - 0.05, place + 0.05) if np.isfinite(miss(x))]
            if len(ends) == 2:
                assert brentq(miss, *ends, xtol=1e-10) == pytest.approx(place, abs=2e-4)


def test_rows_of_a_batch_are_single_evaluations_to_the_last_bit():
    names = [name for name in CURVES for _ in range(11)]
    rng = np.random.default_rng(5)
    rows, speeds = rows_of(names), np.exp(rng.uniform(np.log(1e-3), np.log(0.3), len(names)))
    parameters = draw(rng, 120)
    parameters["normal_force"] = np.exp(rng.uniform(np.log(0.2), np.log(0.6), (1, len(names))))
    batch = tabulated_friction_of_liquids(
        small_table(),
        speeds,
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=STRESS),
        liquids=rows,
    )
    for place in (0, 48, 49, 119):
        one = {
            name: value[place : place + 1] if len(value) > 1 else value for name, value in parameters.items()
        }
        single = tabulated_friction_of_liquids(
            small_table(),
            speeds,
            balls=LubricatedBalls(parameters=one, frictional_shear_stress=STRESS),
            liquids=rows,
        )
        for whole, part in zip((*batch[0], *batch[1]), (*single[0], *single[1]), strict=True):
            assert np.array_equal(whole[place], part[0], equal_nan=True)


def test_wrong_number_of_rows_is_named():
    parameters = draw(np.random.default_rng(6), 1)
    with pytest.raises(InputError, match="for 2 rows, but the arguments have 3 rows"):
        tabulated_friction_of_liquids(
            small_table(),
            [1e-3] * 3,
            balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=STRESS),
            liquids=rows_of(["honey"] * 2),
        )


def test_direct_solution_agrees_with_its_film_and_with_the_table():
    parameters = {name: float(value[0, 0]) for name, value in draw(np.random.default_rng(7), 1).items()}
    speeds = np.geomspace(3e-3, 0.2, 6)
    for name in ("honey + 3 g starch", "hand cream + 3 g glycerin", "water"):
        curve, viscosity = stribeck_curve_of_liquid(
            speeds,
            CURVES[name],
            sphere_radius=parameters["sphere_radius"],
            normal_force=parameters["normal_force"],
            skin=skin_of(parameters),
            spectrum=spectrum_of(parameters),
            frictional_shear_stress=STRESS,
            nodes=120,
        )
        modulus = float(reduced_modulus(parameters["young_modulus_bulk"], 0.5))
        load, radius = cylinder_of_sphere(
            parameters["normal_force"], parameters["sphere_radius"], reduced_modulus=modulus
        )
        law = asperity_law(spectrum_of(parameters), skin_of(parameters))
        good = np.isfinite(viscosity.viscosity)
        films = lubricated_films(
            (viscosity.viscosity * speeds)[good],
            cylinder_radius=float(radius),
            load_per_length=float(load),
            reduced_modulus=modulus,
            asperities=law,
            nodes=120,
        )
        low, high = CURVES[name].shear_rate_range
        expected = CURVES[name].viscosity(np.clip(speeds[good] / films.central_film, low, high))
        np.testing.assert_allclose(viscosity.viscosity[good], expected, rtol=2e-3)
        found, tabulated = tabulated_friction_of_liquids(
            small_table(),
            speeds,
            balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=STRESS),
            liquids=liquid_rows([CURVES[name]] * 6),
        )
        np.testing.assert_allclose(found.friction_coefficient, curve.friction_coefficient, rtol=7e-3)
        np.testing.assert_allclose(tabulated.viscosity, viscosity.viscosity, rtol=7e-3)
        assert np.array_equal(tabulated.unmeasured, viscosity.unmeasured)
    with pytest.raises(InputError, match="sliding_speed 2 is -1 m/s"):
        stribeck_curve_of_liquid([0.1, -1.0], CURVES["honey"], sphere_radius=8e-3, normal_force=0.2, skin=skin_of(parameters),
                                 spectrum=spectrum_of(parameters), frictional_shear_stress=STRESS)  # fmt: skip
