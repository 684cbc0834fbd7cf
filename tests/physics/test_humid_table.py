"""Bridged gaps from a table: against the solution without one, outside the table, and moduli read from a table."""

from dataclasses import replace

import numpy as np
import pytest

from skinbayes.contact import LayeredSkin, gap_distribution
from skinbayes.emulation import Box
from skinbayes.errors import InputError
from skinbayes.roughness import named_surface
from skinbayes.wetting import (
    capillary_state_in_humid_air,
    humid_groups,
    humid_table,
    kelvin_gap,
    kelvin_radius,
    surface_tension_of_water,
    young_modulus_at_humidity,
    young_modulus_from_table,
)

SURFACE = named_surface("paper_reference")
LOAD, ANGLE, ROOM = 6830.0, np.radians(80.0), 293.15
GAMMA = np.array(0.42)
SKIN = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)


def air(humidity):
    radius = kelvin_radius(humidity, ROOM)
    return kelvin_gap(radius, ANGLE, contact_angle_counterface=0.0), surface_tension_of_water(
        ROOM
    ) / radius / LOAD


def table_over(groups, strength, **options):
    ends = dict(Box.around(groups).ends)
    ends["load"] = (ends["load"][0], float(np.max(groups["load"] + np.log1p(strength))))
    return humid_table(Box(ends), spectrum=SURFACE, skin=SKIN, area_correction=GAMMA, **options)


@pytest.mark.parametrize("thickness", [0.0, 0.1])
def test_states_of_a_table_are_those_solved_one_by_one(thickness):
    rng = np.random.default_rng(4)
    count = 60
    humidity = rng.uniform(0.05, 0.99, count)
    layer, bulk = (
        np.exp(rng.uniform(np.log(4e6), np.log(2e9), count)),
        20e3 * np.exp(0.2 * rng.normal(size=count)),
    )
    height, deep = (x * np.exp(s * rng.normal(size=count)) for x, s in ((22.4e-6, 0.2), (20e-6, thickness)))
    skin, surface = (
        LayeredSkin(young_modulus_layer=layer, young_modulus_bulk=bulk, layer_thickness=deep),
        replace(SURFACE, rms_height=height),
    )
    gap, strength = air(humidity)
    groups = humid_groups(np.full(count, LOAD), gap, height=height, skin=skin)
    table = table_over(groups, strength)
    assert ("layer_thickness" in table.axes) == (thickness > 0)
    assert table.covers(groups, strength).all()
    found = LOAD * np.exp(table.log_pressure_ratio(groups, strength))
    state = capillary_state_in_humid_air(
        humidity[:, None],
        ROOM,
        nominal_pressure=LOAD,
        spectrum=surface,
        skin=skin,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        count=False,
    )
    error = np.abs(found / state.total_pressure[:, 0] - 1)
    # the errors that the docstring states
    for those, worst, usual in (
        (state.capillary_pressure[:, 0] < LOAD / 2, 3e-3, 4e-4),
        (state.capillary_pressure[:, 0] > LOAD / 2, 2e-2, 2e-3),
    ):
        assert those.sum() > 10
        assert error[those].max() < worst
        assert np.sqrt(np.mean(error[those] ** 2)) < usual
    # some of these skins are pulled hard
    assert np.median(found) < 1.5 * LOAD < 50 * LOAD < found.max()


def test_shares_of_a_table_are_those_of_the_public_gap_distribution():
    gap, strength = air(np.array([0.3, 0.6, 0.9]))
    groups = humid_groups(np.full(3, LOAD), gap, height=np.full(3, 22.4e-6), skin=SKIN)
    table = table_over(groups, strength)
    # a surface, its loads and its gaps three times as high, and all moduli and loads twice as large, are the same
    gaps = gap_distribution(
        6 * LOAD,
        replace(SURFACE, rms_height=3 * 22.4e-6),
        skin=LayeredSkin(young_modulus_layer=14e6, young_modulus_bulk=40e3, layer_thickness=20e-6),
    )
    np.testing.assert_allclose(
        table.fraction(groups), gaps.cumulative(3 * gap) - gaps.contact_fraction, rtol=1e-3
    )


def test_a_table_knows_where_it_ends():
    gap, strength = air(np.array([0.3, 0.9]))
    groups = humid_groups(np.full(2, LOAD), gap, height=np.full(2, 22.4e-6), skin=SKIN)
    table = table_over(groups, strength)
    assert table.covers(groups, strength).all()
    assert not table.covers({**groups, "stiffness": groups["stiffness"] + 0.1}, strength).any()
    assert not table.covers({**groups, "load": groups["load"] - 0.1}, strength).any()
    np.testing.assert_array_equal(table.covers(groups, 1.1 * strength), [False, True])
    assert table_over(groups, strength, most=10) is None


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_solutions_need_not_be_counted_to_be_found(closure):
    humidity = np.array([0.05, 0.3, 0.5, 0.8, 0.95, 1.0])
    moduli = np.array([5e6, 7e6, 12e6, 40e6, 300e6, 1e9])
    all_of_them, first = (
        capillary_state_in_humid_air(
            humidity,
            ROOM,
            nominal_pressure=LOAD,
            spectrum=SURFACE,
            skin=LayeredSkin(young_modulus_layer=moduli, young_modulus_bulk=20e3, layer_thickness=20e-6),
            contact_angle_skin=ANGLE,
            contact_angle_counterface=0.0,
            closure=closure,
            count=count,
        )
        for count in (True, False)
    )
    assert first.total_pressure.shape == (6, 6)
    np.testing.assert_allclose(first.total_pressure, all_of_them.total_pressure, rtol=1e-11)
    assert np.isnan(first.solutions[:, :-1]).all()
    assert (all_of_them.solutions >= 1).all()
    # there is more than one to choose from
    assert (all_of_them.solutions > 1).any() == (closure == "sharp")


# -- a table of moduli ---------------------------------------------------------------------------------------------------


def test_moduli_between_the_points_of_a_table():
    places = np.linspace(0.1, 0.95, 18)
    moduli = young_modulus_at_humidity(
        places, 1e9, young_modulus_wet=7e6, transition_humidity=0.7, sharpness=1.5
    )
    np.testing.assert_allclose(
        young_modulus_from_table(places, places, table_modulus=moduli), moduli, rtol=1e-12
    )
    between = np.linspace(0.1, 0.95, 500)
    found = young_modulus_from_table(between, places, table_modulus=moduli)
    assert np.all(np.diff(found) < 0)
    # a cubic through values 5 % of humidity apart
    np.testing.assert_allclose(
        found,
        young_modulus_at_humidity(
            between, 1e9, young_modulus_wet=7e6, transition_humidity=0.7, sharpness=1.5
        ),
        rtol=0.02,
    )
    assert np.isnan(young_modulus_from_table([0.09, 0.96, np.nan], places, table_modulus=moduli)).all()


def test_a_step_in_a_table_does_not_overshoot():
    places, moduli = np.array([0.2, 0.4, 0.6, 0.7, 0.9]), np.array([1e9, 1e9, 1e9, 1e7, 1e7])
    found = young_modulus_from_table(np.linspace(0.2, 0.9, 400), places, table_modulus=moduli)
    assert found.max() <= 1e9 * (1 + 1e-12)
    assert found.min() >= 1e7 * (1 - 1e-12)


@pytest.mark.parametrize(
    ("places", "moduli", "said"),
    [
        ([0.2], [1e9], "two at least"),
        ([0.2, 0.4], [1e9, 1e8, 1e7], "as many of each"),
        ([0.4, 0.2], [1e9, 1e8], "ascend"),
        ([20, 40], [1e9, 1e8], "between 0 and 1"),
        ([0.2, 0.4], [1e9, -1e8], "positive"),
    ],
)
def test_tables_that_are_none(places, moduli, said):
    with pytest.raises(InputError, match=said):
        young_modulus_from_table(0.3, places, table_modulus=moduli)
