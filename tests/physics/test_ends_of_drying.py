"""Drying curves, their features and evaporation at the ends of their domains."""

import numpy as np
import pytest
from drying_skin import LOAD, NONE, STRESS, contact_of

from skinbayes.contact import LayeredSkin
from skinbayes.friction import friction_coefficient
from skinbayes.wetting import (
    FilmContact,
    drying_curve,
    drying_features,
    evaporation_rate,
    evaporation_rate_from_pressures,
    film_of_droplet,
)

CONTACT = FilmContact(
    film=np.array([1e-7, 4e-6, 1e-5]), area=np.array([8e-4, 1e-3, 6e-4]), dry_area=np.array(1e-4)
)


def dried(
    time, contact=CONTACT, stress=STRESS, load=LOAD, wetting=30.0, film=90e-6, rate=1.743e-7, spread=2e-7
):
    return drying_curve(
        time,
        wetting,
        initial_film=film,
        evaporation_rate=rate,
        contact=contact,
        frictional_shear_stress=stress,
        nominal_pressure=load,
        film_spread=spread,
    )


def test_time_goes_on_for_ever():
    curve = dried([-np.inf, np.inf])
    friction = friction_coefficient(STRESS, CONTACT.dry_area, nominal_pressure=LOAD)
    np.testing.assert_array_equal(curve.friction_coefficient, friction)
    np.testing.assert_array_equal([*curve.film_thickness, *curve.flooded_fraction], 0.0)
    np.testing.assert_array_equal(curve.dry_fraction, 1.0)
    # nothing evaporates, or there is no end of water: flooded as on the first day
    flooded = friction_coefficient(STRESS, CONTACT.area[-1], nominal_pressure=LOAD)
    for changes in ({"rate": 0.0}, {"film": np.inf}):
        curve = dried([0.0, 30.0, 1e9], **changes)
        np.testing.assert_array_equal(curve.friction_coefficient, [friction, flooded, flooded])
        np.testing.assert_array_equal(curve.flooded_fraction, [0.0, 1.0, 1.0])
        assert curve.film_thickness[2] == changes.get("film", 90e-6)
    assert dried(np.inf, rate=0.0).friction_coefficient == flooded
    # never wetted
    np.testing.assert_array_equal(dried([0.0, 1e30], wetting=np.inf).friction_coefficient, friction)
    assert dried(30.0, film=0.0, spread=0.0).friction_coefficient == friction
    assert dried(30.0, film=0.0, spread=0.0).film_thickness < 1e-12


def test_a_film_is_no_thicker_anywhere_than_there_is_water_for():
    dry = friction_coefficient(STRESS, CONTACT.dry_area, nominal_pressure=LOAD)
    nothing = dried([0.0, 30.0, 40.0], film=0.0)
    np.testing.assert_array_equal(nothing.friction_coefficient, dry)
    np.testing.assert_array_equal(nothing.dry_fraction, 1.0)
    # all films, however thin beside the wanted spread, hold the water that was laid down
    films = np.array([1e-9, 1e-8, 1e-7, 3e-7, 6e-7, 1e-6])
    curve = drying_curve(30.0, 30.0, initial_film=films, evaporation_rate=1.743e-7, contact=CONTACT,
                         frictional_shear_stress=STRESS, nominal_pressure=LOAD)  # fmt: skip
    np.testing.assert_allclose(curve.film_thickness, films, rtol=2e-4)
    # little water makes little of a difference
    assert curve.friction_coefficient[0] == pytest.approx(dry, rel=1e-12)
    assert (np.diff(curve.friction_coefficient) >= 0).all()


def test_drying_with_impossible_parameters_is_nan_as_a_whole():
    for changes in (
        *({name: x} for name in ("film", "rate", "spread") for x in (-1e-9, np.nan)),
        *({name: np.inf} for name in ("rate", "spread")),
        {"stress": -1.0}, {"load": 0.0}, {"load": -1.0}, {"wetting": np.nan}, {"stress": np.nan},
    ):  # fmt: skip
        assert all(np.isnan(part).all() for part in dried([0.0, 30.0, 600.0, np.inf], **changes)), changes
    assert np.isnan(dried(np.nan).friction_coefficient)
    for spread in (-1.0, np.inf, np.nan):
        assert np.isnan(CONTACT.average(np.array([1e-6, 1e-3]), np.array(spread))).all()


def features(contact=CONTACT, stress=STRESS, load=LOAD, wetting=30.0, film=90e-6, rate=1.743e-7, spread=2e-7):
    return drying_features(
        wetting,
        film,
        evaporation_rate=rate,
        contact=contact,
        frictional_shear_stress=stress,
        nominal_pressure=load,
        film_spread=spread,
    )


def test_features_at_their_ends():
    found = features(rate=0.0)
    assert np.isnan([found.peak_time, found.peak_friction, found.peak_width, found.dry_time]).all()
    assert (
        found.wet_plateau
        == features().wet_plateau
        == friction_coefficient(STRESS, 6e-4, nominal_pressure=LOAD)
    )
    assert found.dry_friction == friction_coefficient(STRESS, 1e-4, nominal_pressure=LOAD)
    assert features(film=0.0).dry_time == 30.0
    even, nearly = features(spread=0.0), features(spread=1e-11)
    np.testing.assert_allclose(even, nearly, rtol=1e-4)
    assert even.peak_friction == pytest.approx(
        friction_coefficient(STRESS, 1e-3, nominal_pressure=LOAD), rel=1e-5
    )
    assert even.peak_time == pytest.approx(30 + 86e-6 / 1.743e-7, rel=1e-6)
    # so uneven that dry skin is under all films: no peak
    assert np.isnan(features(spread=1e30).peak_time)
    for changes in (
        *({name: x} for name in ("film", "rate", "spread") for x in (-1e-9, np.nan, np.inf)),
        {"wetting": np.nan},
    ):
        assert np.isnan(features(**changes)).all(), changes
    for changes in ({"stress": -1.0}, {"load": 0.0}, {"load": -1.0}):
        found = features(**changes)
        assert np.isnan([found.peak_friction, found.wet_plateau, found.dry_friction]).all()
    many = features(wetting=np.array([0.0, 30.0]))
    assert all(part.shape == (2,) for part in many)
    np.testing.assert_array_equal([part[1] for part in many], features())


def test_empty_batches_are_empty():
    nobody = LayeredSkin(
        young_modulus_layer=NONE,
        young_modulus_bulk=20e3,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=20e-6,
    )
    for more in ({}, {"closure": "sharp"}, {"hardening_film": 5e-6}):
        for contact in (contact_of(NONE, **more), contact_of(skin=nobody, **more)):
            assert contact.film.shape == contact.area.shape == (0, 256) and contact.dry_area.shape == (0,)
            assert contact.average(np.empty((0, 3)), NONE)[0].shape == (0, 3)
            assert features(contact).peak_time.shape == (0,)
    assert all(part.shape == (0,) for part in dried(NONE))
    assert all(part.shape == (0, 2) for part in dried([0.0, 1.0], wetting=NONE))
    assert all(part.shape == (0,) for part in features(wetting=NONE))
    assert (
        evaporation_rate(surface_temperature=NONE, air_temperature=300.0, relative_humidity=0.5).shape
        == film_of_droplet(NONE, 1.0, contact_width=1.0).shape
        == (0,)
    )


def test_evaporation_at_its_ends():
    # saturated air as warm as the skin takes up nothing, dry air most; on colder skin water condenses
    assert (
        evaporation_rate(surface_temperature=300.0, air_temperature=300.0, relative_humidity=1.0) == 0.0
        and evaporation_rate(surface_temperature=273.15, air_temperature=273.15, relative_humidity=1.0) == 0.0
    )
    assert (
        evaporation_rate(surface_temperature=273.15, air_temperature=300.0, relative_humidity=1.0)
        < 0
        < evaporation_rate(surface_temperature=300.0, air_temperature=300.0, relative_humidity=0.0)
    )
    assert evaporation_rate_from_pressures(0.0, 0.0) == 0.0
    assert np.isnan(
        evaporation_rate(
            surface_temperature=300.0, air_temperature=300.0, relative_humidity=[-1e-9, 1 + 1e-12, np.nan]
        )
    ).all()
    assert (
        film_of_droplet(0.0, 0.08, contact_width=0.008) == 0.0
        and film_of_droplet(1e-9, np.inf, contact_width=0.008) == 0.0
    )
    assert np.isnan(
        film_of_droplet([-1e-9, 1e-9, 1e-9], [1.0, 0.0, 1.0], contact_width=[1.0, 1.0, 0.0])
    ).all()
