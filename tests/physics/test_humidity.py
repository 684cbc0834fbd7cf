"""Skin in humid air: Kelvin's equation, the paper's Fig. 16, molecules, the softening layer."""

import numpy as np
import pytest

from skinbayes.contact import LayeredSkin, gap_distribution
from skinbayes.roughness import named_surface
from skinbayes.wetting import (
    capillary_state_in_humid_air,
    is_below_molecule,
    kelvin_gap,
    kelvin_radius,
    molecular_volume_of_water,
    surface_tension_of_water,
    young_modulus_at_humidity,
)

SURFACE = named_surface("paper_reference")
LOAD, ANGLE, ROOM = 6830.0, np.radians(80.0), 293.15


def layer(modulus):
    return LayeredSkin(young_modulus_layer=modulus, young_modulus_bulk=20e3, layer_thickness=20e-6)


def in_air(humidity, skin, **options):
    return capillary_state_in_humid_air(
        humidity,
        ROOM,
        nominal_pressure=LOAD,
        spectrum=SURFACE,
        skin=skin,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        **options,
    )


def test_kelvin_equation():
    # 0.54 nm/log10(1/RH) at 25 °C, the textbook length γ v/(k_B T) = 0.523 nm
    assert kelvin_radius(np.exp(-1), 298.15) == pytest.approx(0.523e-9, rel=5e-3)
    humidity = np.array([0.2, 0.5, 0.9])
    pressure = surface_tension_of_water(ROOM) / kelvin_radius(humidity, ROOM)
    # work of the Laplace pressure on a molecule is the chemical potential below saturation, R T ln(1/RH) for a mole
    molar = 6.02214076e23 * molecular_volume_of_water(ROOM)
    np.testing.assert_allclose(pressure * molar, 8.314462618 * ROOM * np.log(1 / humidity), rtol=1e-9)
    assert np.all(np.diff(kelvin_radius(np.linspace(0.01, 1, 50), ROOM)) > 0)
    assert kelvin_radius(1.0, ROOM) == np.inf
    assert np.isnan(kelvin_radius([-0.1, 1.1, np.nan], ROOM)).all()


def test_molecules():
    gap = kelvin_gap(kelvin_radius([0.05, 0.1, 0.15, 0.5, 1.0], ROOM), ANGLE, contact_angle_counterface=0.0)
    np.testing.assert_array_equal(is_below_molecule(gap), [1, 1, 0, 0, 0])
    assert np.isnan(is_below_molecule(np.nan))
    assert molecular_volume_of_water(ROOM) ** (1 / 3) == pytest.approx(0.31e-9, rel=0.01)


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_contact_against_humidity_as_in_the_paper(closure):
    humidity = np.array([0.15, 0.3, 0.5, 0.8, 0.9, 0.99])
    stiff = np.log10(in_air(humidity, layer(70e6), closure=closure).relative_contact_area)
    assert np.all((stiff > -4.2) & (stiff < -4.0))
    assert np.all(np.diff(stiff) < 0)
    soft = in_air(humidity, layer(7e6), closure=closure)
    assert soft.relative_contact_area[0] > 0.6
    assert soft.relative_contact_area[-1] < 1.3e-3
    assert np.all(np.diff(soft.relative_contact_area) < 0)
    assert np.all(soft.film_thickness[:3] < 1e-9)


def test_solution_satisfies_the_equations_with_the_public_gap_distribution():
    humidity = np.array([0.4, 0.85, 0.97])
    state = in_air(humidity, layer(15e6))
    radius = kelvin_radius(humidity, ROOM)
    np.testing.assert_allclose(state.kelvin_gap, radius * (np.cos(ANGLE) + 1), rtol=1e-14)
    for i in range(3):
        gaps = gap_distribution(state.total_pressure[i], SURFACE, skin=layer(15e6))
        wet = gaps.cumulative(state.kelvin_gap[i]) - gaps.contact_fraction
        total = LOAD + surface_tension_of_water(ROOM) / radius[i] * wet
        assert state.total_pressure[i] == pytest.approx(total, rel=1e-9)


def test_ends():
    state = in_air([0.9999999, 1.0], layer(7e6))
    np.testing.assert_array_equal(state.flooded, [0, 1])
    assert state.relative_contact_area[0] == pytest.approx(state.relative_contact_area[1], rel=0.01)
    # no bridges on polypropylene
    plastic = capillary_state_in_humid_air(
        [0.3, 0.9],
        ROOM,
        nominal_pressure=LOAD,
        spectrum=SURFACE,
        skin=layer(7e6),
        contact_angle_skin=ANGLE,
        contact_angle_counterface=np.radians(102.0),
    )
    np.testing.assert_array_equal(plastic.capillary_pressure, 0.0)
    np.testing.assert_array_equal(plastic.kelvin_gap, 0.0)
    np.testing.assert_allclose(plastic.wet_area, 0.0, atol=1e-8)
    assert plastic.relative_contact_area[0] == pytest.approx(state.relative_contact_area[1], rel=1e-9)
    # and none in saturated air either, where the radius is infinite
    assert kelvin_gap(np.inf, ANGLE, contact_angle_counterface=np.radians(102.0)) == 0.0
    assert kelvin_gap(np.inf, ANGLE, contact_angle_counterface=0.0) == np.inf
    assert np.isnan(in_air([-0.1, 1.2], layer(7e6)).wet_area).all()


def test_a_layer_of_its_own_for_each_humidity():
    humidity = np.array([0.3, 0.6, 0.9, 0.99])
    moduli = young_modulus_at_humidity(
        humidity, 1e9, young_modulus_wet=7e6, transition_humidity=0.7, sharpness=2.0
    )
    state = in_air(humidity[:, None], layer(moduli))
    assert state.wet_area.shape == (4, 1)
    for i in range(4):
        one = in_air(humidity[i : i + 1], layer(moduli[i]))
        assert one.relative_contact_area[0] == state.relative_contact_area[i, 0]


def test_softening_layer():
    humidity = np.linspace(0, 1, 101)
    moduli = young_modulus_at_humidity(
        humidity, 2e9, young_modulus_wet=8e6, transition_humidity=0.7, sharpness=1.7
    )
    assert moduli[0] == pytest.approx(2e9, rel=1e-12)
    assert moduli[-1] == pytest.approx(8e6, rel=1e-12)
    assert moduli[70] == pytest.approx(np.sqrt(2e9 * 8e6), rel=1e-9)
    assert np.all(np.diff(moduli[1:-1]) < 0)
    steeper = young_modulus_at_humidity(
        humidity, 2e9, young_modulus_wet=8e6, transition_humidity=0.7, sharpness=4.0
    )
    assert np.all(steeper[1:70] > moduli[1:70])
    assert np.all(steeper[71:-1] < moduli[71:-1])
    for bad in (
        (1.1, 1e9, 7e6, 0.7, 2.0),
        (0.5, -1e9, 7e6, 0.7, 2.0),
        (0.5, 1e9, 7e6, 1.0, 2.0),
        (0.5, 1e9, 7e6, 0.7, 0.0),
    ):
        humidity, dry, wet, transition, sharpness = bad
        modulus = young_modulus_at_humidity(
            humidity, dry, young_modulus_wet=wet, transition_humidity=transition, sharpness=sharpness
        )
        assert np.isnan(modulus)
