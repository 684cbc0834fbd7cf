"""Water, bridges and humid air at the ends of their domains: the values there are limits."""

from dataclasses import fields

import numpy as np
import pytest
from named_fields import surface_from

from skinbayes.contact import (
    LayeredSkin,
    gap_distribution,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.roughness import named_surface
from skinbayes.wetting import (
    capillary_state,
    capillary_state_at_gap,
    capillary_state_in_humid_air,
    density_of_water,
    evaporation_rate,
    humidity_at_surface,
    is_below_molecule,
    kelvin_gap,
    kelvin_radius,
    latent_heat_of_evaporation,
    molecular_volume_of_water,
    saturation_vapour_pressure,
    surface_tension_of_water,
    young_modulus_at_humidity,
)

SURFACE = named_surface("paper_reference")
SOFT = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
LOAD, ROOM, ANGLE = 6830.0, 293.15, np.radians(80.0)
WATER = (
    surface_tension_of_water,
    saturation_vapour_pressure,
    density_of_water,
    molecular_volume_of_water,
    latent_heat_of_evaporation,
)


def in_air(humidity, skin=SOFT, angle=ANGLE, surface=SURFACE, load=LOAD, other=0.0):
    return capillary_state_in_humid_air(
        humidity,
        ROOM,
        nominal_pressure=load,
        spectrum=surface,
        skin=skin,
        contact_angle_skin=angle,
        contact_angle_counterface=other,
        count=False,
    )


def skin_samples(count, seed):
    rng = np.random.default_rng(seed)

    def between(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    first = between(3e2, 5e3)
    surface = surface_from(
        (
            between(5e-6, 5e-5),
            rng.uniform(0.6, 1.0, count),
            first,
            first * between(1.0, 10.0),
            between(1e8, 1e9),
        )
    )
    bulk = between(1e4, 1e5)
    skin = LayeredSkin(
        young_modulus_layer=bulk * between(10.0, 1e5),
        young_modulus_bulk=bulk,
        layer_thickness=between(1e-5, 4e-5),
    )
    return surface, skin, between(2e3, 5e4), rng.uniform(0.5, np.pi, count), rng.uniform(0.0, 0.7, count)


@pytest.mark.parametrize("property_of_water", WATER)
def test_water_from_freezing_to_the_critical_point(property_of_water):
    ends = property_of_water([273.15, 647.096 - 1e-6])
    assert np.isfinite(ends).all() and (ends > 0).all()
    assert property_of_water(273.15) == pytest.approx(property_of_water(273.15 + 1e-9), rel=1e-9)
    assert np.isnan(property_of_water([273.15 - 1e-9, 647.096, 0.0, -1.0, np.inf, np.nan])).all()
    assert property_of_water(np.empty(0)).shape == (0,)


def test_saturated_air_is_the_limit_of_humid_air():
    surface, skin, load, first, second = skin_samples(12, 3)
    distance = np.array([1e-6, 1e-9, 1e-12])
    state = capillary_state_in_humid_air(
        1 - distance,
        ROOM,
        nominal_pressure=load,
        spectrum=surface,
        skin=skin,
        contact_angle_skin=first,
        contact_angle_counterface=second,
        count=False,
    )
    end = capillary_state_in_humid_air(
        1.0,
        ROOM,
        nominal_pressure=load,
        spectrum=surface,
        skin=skin,
        contact_angle_skin=first,
        contact_angle_counterface=second,
        count=False,
    )
    # far from all gaps all is wet: the capillary pressure is the Laplace pressure k_B T (1 − RH)/v, 135 MPa times the distance
    wetting = np.cos(first) + np.cos(second) > 0
    assert 3 < wetting.sum() < 12
    dry = relative_contact_area(load, twice_stress_variance(surface, skin))
    np.testing.assert_allclose(
        state.capillary_pressure[wetting, -1], 135e6 * 1e-12 * (1 - dry[wetting]), rtol=0.01
    )
    np.testing.assert_array_equal(end.capillary_pressure, 0.0)
    np.testing.assert_array_equal(state.capillary_pressure[~wetting], 0.0)
    np.testing.assert_allclose(end.relative_contact_area, dry, rtol=1e-12)
    np.testing.assert_allclose(state.relative_contact_area[:, -1], dry, rtol=1e-6)
    separation = mean_separation(load[:, None], surface, skin=skin)[:, 0]
    np.testing.assert_allclose(end.film_thickness[wetting], separation[wetting], rtol=1e-12)
    np.testing.assert_allclose(state.film_thickness[wetting, -1], separation[wetting], rtol=1e-4)
    np.testing.assert_array_equal(end.flooded, wetting)


def test_dry_air_is_the_limit_of_dry_air():
    for skin in (SOFT, LayeredSkin(young_modulus_layer=1e9, young_modulus_bulk=20e3, layer_thickness=20e-6)):
        pulls = in_air([1e-300, 1e-30, 0.0], skin).capillary_pressure
        assert pulls[2] > 0
        np.testing.assert_allclose(pulls[:2], pulls[2], rtol=2e-3)
        assert pulls[2] == pytest.approx(in_air(0.0, skin).capillary_pressure, rel=1e-12)
        # γ_w Σcos P(u → 0; p), with the density of gaps at 0 from the public distribution
        state = in_air(0.0, skin)
        gaps = gap_distribution(state.total_pressure, SURFACE, skin=skin)
        small = 1e-11
        density = (gaps.cumulative(small) - gaps.contact_fraction) / small
        expected = surface_tension_of_water(ROOM) * (np.cos(ANGLE) + 1) * density
        assert state.capillary_pressure == pytest.approx(expected, rel=0.01)
        assert state.film_thickness == 0.0 and state.wet_area == 0.0 and state.mean_separation_wet == 0.0
    assert kelvin_radius(0.0, ROOM) == 0.0
    assert np.isnan(kelvin_radius([-1e-9, 1 + 1e-12, np.nan], ROOM)).all()


def test_gaps_below_a_picometre_keep_their_digits():
    gaps = np.array([1e-300, 1e-20, 1e-16, 1e-14, 1e-13, 1e-12])
    state = capillary_state_at_gap(
        gaps,
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.0727,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        count=False,
    )
    np.testing.assert_allclose(state.capillary_pressure, state.capillary_pressure[-1], rtol=1e-3)
    np.testing.assert_allclose(state.wet_area / gaps, state.wet_area[-1] / gaps[-1], rtol=1e-3)
    np.testing.assert_allclose(state.mean_separation_wet, gaps / 2, rtol=1e-3)


def test_no_bridges_means_no_water():
    for humidity in (0.0, 1e-10, 0.5, 0.99, 1.0):
        state = in_air(humidity, other=np.radians(102.0))
        for name in ("capillary_pressure", "film_thickness", "wet_area", "mean_separation_wet", "kelvin_gap"):
            assert getattr(state, name) == 0.0, name
        assert state.total_pressure == LOAD
    # two cosines that cancel but for rounding
    for first, second in ((90, 90), (80, 100), (0, 180), (180, 0), (60, 120)):
        assert kelvin_gap(np.inf, np.radians(first), contact_angle_counterface=np.radians(second)) == 0.0
    assert (
        kelvin_gap(np.inf, 0.0, contact_angle_counterface=0.0) == np.inf
        and kelvin_gap(0.0, 0.0, contact_angle_counterface=0.0) == 0.0
    )
    assert np.isnan(kelvin_gap(1e-9, [-1e-9, np.pi + 1e-9, np.nan], contact_angle_counterface=0.0)).all()
    np.testing.assert_array_equal(is_below_molecule([0.0, np.inf]), [1.0, 0.0])
    assert np.isnan(is_below_molecule([-1e-9, np.nan])).all()


def test_films_at_their_ends():
    flooded = float(mean_separation(LOAD, SURFACE, skin=SOFT))
    state = capillary_state(
        [flooded * (1 - 1e-9), flooded, 1e-3, np.inf],
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.0727,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        refine=False,
    )
    np.testing.assert_array_equal(state.flooded, [0, 1, 1, 1])
    assert state.capillary_pressure[0] < 1e-3 * LOAD
    for refine in (True, False):
        impossible = capillary_state(
            [0.0, -1e-6, np.nan],
            LOAD,
            spectrum=SURFACE,
            skin=SOFT,
            surface_tension=0.0727,
            contact_angle_skin=ANGLE,
            contact_angle_counterface=0.0,
            refine=refine,
        )
        assert all(np.isnan(getattr(impossible, field.name)).all() for field in fields(impossible))
    # a film that the interpolated curve does not reach has no number, rather than that of another film
    thin = capillary_state(
        [1e-12, 1e-6],
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.0727,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        refine=False,
    )
    assert all(np.isnan(getattr(thin, field.name)[0]) for field in fields(thin))
    assert np.isfinite(thin.capillary_pressure[1])
    for tension in (np.inf, -1.0, np.nan):
        assert np.isnan(
            capillary_state_at_gap(
                1e-6,
                LOAD,
                spectrum=SURFACE,
                skin=SOFT,
                surface_tension=tension,
                contact_angle_skin=ANGLE,
                contact_angle_counterface=0.0,
            ).total_pressure
        )
    none = capillary_state_at_gap(
        1e-6,
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.0,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
    )
    assert none.capillary_pressure == 0.0 and none.wet_area > 0


def test_empty_batches_are_empty():
    none = np.empty(0)
    nobody = LayeredSkin(young_modulus_layer=none, young_modulus_bulk=20e3, layer_thickness=20e-6)
    assert in_air(none).wet_area.shape == (0,)
    assert in_air(0.5, nobody).wet_area.shape == (0,)
    assert capillary_state(
        none,
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.07,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
    ).film_thickness.shape == (0,)
    assert capillary_state(
        1e-6,
        LOAD,
        spectrum=SURFACE,
        skin=nobody,
        surface_tension=0.07,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
    ).film_thickness.shape == (0,)
    assert capillary_state_at_gap(
        none,
        LOAD,
        spectrum=SURFACE,
        skin=SOFT,
        surface_tension=0.07,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
    ).wet_area.shape == (0,)


def test_modulus_at_the_ends_of_humidity():
    np.testing.assert_allclose(
        young_modulus_at_humidity(
            [0.0, 1.0], 1e9, young_modulus_wet=7e6, transition_humidity=0.7, sharpness=1.5
        ),
        [1e9, 7e6],
        rtol=1e-12,
    )
    assert np.isnan(
        young_modulus_at_humidity(
            [-1e-9, 1 + 1e-12, np.nan], 1e9, young_modulus_wet=7e6, transition_humidity=0.7, sharpness=1.5
        )
    ).all()


def test_humidity_at_warm_skin():
    # saturation pressures of a steam table, kPa: 20 °C 2.339, 25 °C 3.169, 30 °C 4.246, 32 °C 4.759, 35 °C 5.628
    table = {20.0: 2.339, 25.0: 3.169, 30.0: 4.246, 32.0: 4.759, 35.0: 5.628}
    for air in (20.0, 25.0):
        for surface, pressure in table.items():
            found = humidity_at_surface(
                relative_humidity=0.5, air_temperature=air + 273.15, surface_temperature=surface + 273.15
            )
            assert found == pytest.approx(min(0.5 * table[air] / pressure, 1.0), rel=1e-3)
    assert (
        humidity_at_surface(relative_humidity=0.37, air_temperature=301.0, surface_temperature=301.0) == 0.37
    )
    assert humidity_at_surface(relative_humidity=0.0, air_temperature=293.0, surface_temperature=305.0) == 0.0
    np.testing.assert_array_equal(
        humidity_at_surface(relative_humidity=[0.9, 1.0], air_temperature=293.15, surface_temperature=288.15),
        1.0,
    )
    assert np.isnan(
        humidity_at_surface(
            relative_humidity=[-0.1, 1.1, np.nan], air_temperature=293.15, surface_temperature=305.15
        )
    ).all()
    assert np.isnan(
        humidity_at_surface(
            relative_humidity=0.5, air_temperature=[273.0, 293.15], surface_temperature=[293.15, 273.0]
        )
    ).all()
    # what evaporates is driven by the same pressures: none where the skin sees saturated air
    humidity = float(saturation_vapour_pressure(298.15) / saturation_vapour_pressure(303.15))
    assert humidity_at_surface(
        relative_humidity=1.0, air_temperature=298.15, surface_temperature=303.15
    ) == pytest.approx(humidity, rel=1e-12)
    assert evaporation_rate(
        surface_temperature=298.15, air_temperature=303.15, relative_humidity=humidity
    ) == pytest.approx(0.0, abs=1e-20)
