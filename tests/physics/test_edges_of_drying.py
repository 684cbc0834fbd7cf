"""Drying skin at the ends of its domain: flooded, bridged, dry and closed contact, and averages over uneven films."""

from dataclasses import fields
from itertools import product

import numpy as np
import pytest
from drying_skin import ANGLE, DRY, LOAD, SKIN, STRESS, SURFACE, YIELD, contact_of

from skinbayes.contact import LayeredSkin, mean_separation, total_contact_area, twice_stress_variance
from skinbayes.errors import InputError
from skinbayes.roughness import SelfAffineSpectrum
from skinbayes.wetting import (
    capillary_state,
    drying_curve,
)


def area_of(load=LOAD, surface=SURFACE, skin=SKIN, limit=YIELD, gamma=0.42):
    return total_contact_area(
        load, twice_stress_variance(surface, skin), yield_stress=limit, area_correction=gamma
    )


def with_layer(modulus, skin=SKIN):
    return LayeredSkin(
        young_modulus_layer=modulus,
        young_modulus_bulk=skin.young_modulus_bulk,
        poisson_ratio_layer=skin.poisson_ratio_layer,
        poisson_ratio_bulk=skin.poisson_ratio_bulk,
        layer_thickness=skin.layer_thickness,
    )


def member(parts, count):
    """The second of a batch."""
    return type(parts)(
        **{x.name: np.broadcast_to(getattr(parts, x.name), count)[1] for x in fields(parts) if x.init}
    )


def check_ends(count):
    rng = np.random.default_rng(5)

    def between(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    first, bulk = between(5e2, 2e3), between(1e4, 5e4)
    surface = SelfAffineSpectrum(
        rms_height=between(1e-5, 4e-5),
        hurst_exponent=rng.uniform(0.7, 1.0, count),
        wavevector_min=first,
        wavevector_rolloff=first * between(1.0, 10.0),
        wavevector_max=1e9,
    )
    skin = LayeredSkin(
        young_modulus_layer=bulk * between(100.0, 1e3),
        young_modulus_bulk=bulk,
        poisson_ratio_layer=0.5,
        poisson_ratio_bulk=0.5,
        layer_thickness=between(1e-5, 4e-5),
    )
    load, angle, dry = between(2e3, 2e4), rng.uniform(0.0, np.pi, count), bulk * between(1e4, 1e5)
    floor = between(1e-7, 1e-4)
    for limit, half, closure in product((np.inf, YIELD), (None, 3e-6), ("gaussian", "sharp")):
        contact = contact_of(
            load,
            surface,
            skin,
            angle=angle,
            dry=dry,
            limit=limit,
            closure=closure,
            film_floor=floor,
            hardening_film=half,
        )
        # some pulls are out of reach, see `film_contact`; dry skin does not know of them
        dry_area, ok = (
            area_of(load, surface, with_layer(dry, skin), limit),
            np.isfinite(contact.area).all(axis=-1),
        )
        assert ok.mean() >= 0.5
        np.testing.assert_allclose(contact.dry_area, dry_area, rtol=1e-9)
        film, area = contact.film[ok], contact.area[ok]
        assert (np.diff(film, axis=-1) > 0).all() and ((area > 0) & (area <= 1 + 1e-9)).all()
        flooded = mean_separation(load[:, None], surface, skin=skin)[:, 0]
        np.testing.assert_allclose(film[:, -1], flooded[ok], rtol=1e-9)
        np.testing.assert_allclose(film[:, 0], np.minimum(floor, flooded / 2)[ok], rtol=1e-9)
        # flooded skin carries its load alone
        np.testing.assert_allclose(area[:, -1], area_of(load, surface, skin, limit)[ok], rtol=1e-6)
        # as uneven as can be, half of the track is flooded and half of it dry
        wide = contact.average(np.zeros((count, 1)), np.full(count, 1e30))[0][ok, 0]
        np.testing.assert_allclose(wide, (dry_area[ok] + area[:, -1]) / 2, rtol=1e-4)
        ends = contact.average(np.full((count, 2), [-np.inf, np.inf]), np.zeros(count))
        np.testing.assert_array_equal(ends[0][ok], np.stack([contact.dry_area[ok], area[:, -1]], axis=-1))
        np.testing.assert_array_equal(ends[1][ok], 0.0)
        alone = contact_of(
            load[1],
            member(surface, count),
            member(skin, count),
            angle=angle[1],
            dry=dry[1],
            limit=limit,
            closure=closure,
            film_floor=floor[1],
            hardening_film=half,
        )
        for name, value in vars(alone).items():
            np.testing.assert_array_equal(getattr(contact, name)[1], value)


def test_ends_of_the_film():
    check_ends(4)


@pytest.mark.slow
def test_ends_of_the_film_in_a_wide_box():
    check_ends(60)


def test_without_bridges_the_area_is_that_of_the_load():
    for changes in ({"tension": 0.0}, {"angle": np.pi, "other": 0.0}, {"angle": np.pi, "other": np.pi}):
        contact = contact_of(**changes)
        np.testing.assert_allclose(contact.area, area_of(), rtol=1e-9)


def test_a_yield_stress_at_the_load_makes_contact_complete():
    for limit in (LOAD, 1.0):
        contact = contact_of(limit=limit)
        assert (contact.area == 1.0).all() and contact.dry_area == 1.0
    assert contact_of(limit=np.inf).dry_area == pytest.approx(
        area_of(skin=with_layer(DRY), limit=np.inf), rel=1e-9
    )


@pytest.mark.parametrize("more", [{}, {"closure": "sharp"}, {"hardening_film": 5e-6}])
def test_closed_contact_has_no_gap_for_water(more):
    smooth = SelfAffineSpectrum(
        rms_height=1e-12, hurst_exponent=0.78, wavevector_min=1e3, wavevector_rolloff=1e3, wavevector_max=1e9
    )
    for changes in ({"load": 1e12, "limit": np.inf}, {"surface": smooth}):
        contact = contact_of(**changes, **more)
        assert (contact.area == 1.0).all() and contact.dry_area == 1.0 and contact.film[-1] < 1e-29
        load = changes.get("load", LOAD)
        curve = drying_curve(
            [0.0, 30.0, 1e3],
            30.0,
            initial_film=90e-6,
            evaporation_rate=1.743e-7,
            contact=contact,
            frictional_shear_stress=STRESS,
            nominal_pressure=load,
        )
        np.testing.assert_allclose(curve.friction_coefficient, STRESS / load, rtol=1e-12)


def test_rough_skin_has_a_film_that_rises():
    # folds of the film at nanometres
    contact = contact_of(
        surface=SelfAffineSpectrum(
            rms_height=1e-3,
            hurst_exponent=0.78,
            wavevector_min=1e3,
            wavevector_rolloff=1e3,
            wavevector_max=1e9,
        )
    )
    assert (np.diff(contact.film) > 0).all()
    area, slope = contact.average(np.geomspace(1e-9, 1e-2, 400), np.array(1e-9))
    assert (
        np.isfinite(slope).all()
        and (area >= contact.dry_area * (1 - 1e-9)).all()
        and (area <= contact.area.max()).all()
    )


def check_hardening(half, sharpness):
    contact = contact_of(hardening_film=half, hardening_sharpness=sharpness)
    films = contact.film[[20, 100, 150, 200, 230]]
    # the weight of the wet modulus, over that of flooded skin, from logarithms
    log_weight = -np.logaddexp(0.0, sharpness * np.log(half / np.append(films, contact.film[-1])))
    layers = with_layer(DRY * (7e6 / DRY) ** np.exp(log_weight[:-1] - log_weight[-1]))
    state = capillary_state(
        films[:, None],
        LOAD,
        spectrum=SURFACE,
        skin=layers,
        surface_tension=0.0727,
        contact_angle_skin=ANGLE,
        contact_angle_counterface=0.0,
        refine=False,
    )
    wanted = area_of(state.total_pressure[:, 0], skin=layers)
    # the twelve moduli between which the area is interpolated are good to 2 %
    np.testing.assert_allclose(contact.average(films, np.array(0.0))[0], wanted, rtol=0.02)


def test_hardening_is_right_however_sharp():
    for half, sharpness in ((1e-4, 20.0), (5e-6, 1e3), (1e30, 2.0)):
        check_hardening(half, sharpness)


@pytest.mark.slow
@pytest.mark.parametrize("sharpness", [0.01, 2.0, 20.0, 1e3, 1e9])
@pytest.mark.parametrize("half", [1e-30, 5e-6, 1e-4, 1e30])
def test_hardening_is_right_wherever_it_is(half, sharpness):
    check_hardening(half, sharpness)


def test_impossible_parameters_leave_no_number():
    for changes in (
        *({"load": x} for x in (0.0, -1.0, np.inf, np.nan)),
        *({"tension": x} for x in (-1.0, np.nan)),
        *({"angle": x} for x in (-1e-9, np.pi + 1e-9, np.nan)),
        *({name: x} for name in ("dry", "limit", "film_floor") for x in (0.0, -1.0, np.nan)),
        *({"area_correction": x} for x in (0.0, 1.1, np.nan)),
        *({"hardening_film": x} for x in (0.0, -1.0, np.inf, np.nan)),
        *({"hardening_film": 5e-6, "hardening_sharpness": x} for x in (0.0, -1.0, np.inf, np.nan)),
    ):
        contact = contact_of(**changes)
        assert np.isnan(contact.area).all() and np.isnan(contact.dry_area), changes
        curve = drying_curve(
            [0.0, 100.0, 1e4, np.inf],
            30.0,
            initial_film=90e-6,
            evaporation_rate=1.743e-7,
            contact=contact,
            frictional_shear_stress=STRESS,
            nominal_pressure=LOAD,
        )
        assert all(np.isnan(part).all() for part in curve), changes
    with pytest.raises(InputError, match="closure is"):
        contact_of(closure="blunt")
