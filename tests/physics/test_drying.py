"""Drying skin: the paper's timeline, regimes, averages over an uneven film, features, hardening."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from skinbayes.contact import (
    LayeredSkin,
    elastoplastic_contact_area,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.roughness import named_surface
from skinbayes.wetting import (
    FilmContact,
    capillary_state,
    drying_curve,
    drying_features,
    evaporation_rate_from_pressures,
    film_contact,
)
from skinbayes.wetting._falling import falling_root

SURFACE = named_surface("paper_reference")
WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
LOAD, SHEAR, TENSION, ANGLE = 6830.0, 15e6, 0.0727, np.radians(80.0)
RATE = evaporation_rate_from_pressures(5.6e3, 1.15e3)
START, FILM = 30.0, 90e-6
DRYING = {"evaporation_rate": RATE, "frictional_shear_stress": SHEAR, "nominal_pressure": LOAD}
RUN = {"initial_film": FILM, **DRYING}
WATER = {"surface_tension": TENSION, "contact_angle_skin": ANGLE}
HARD = {"young_modulus_layer_dry": 1e9, "yield_stress": 50e6}


def contact_of(**options):
    glass = options.pop("glass", 0.0)
    return film_contact(
        LOAD,
        SURFACE,
        **WATER,
        **HARD,
        skin=options.pop("skin", WET),
        contact_angle_counterface=np.radians(glass),
        **options,
    )


CONTACT = contact_of()


def curve(time, contact=CONTACT, spread=2e-7, start=START, film=FILM):
    return drying_curve(time, start, **DRYING, initial_film=film, contact=contact, film_spread=spread)


@pytest.mark.parametrize(("closure", "time", "friction"), [("gaussian", 513.0, 2.31), ("sharp", 490.0, 2.49)])
def test_timeline_of_the_paper(closure, time, friction):
    contact = contact_of(closure=closure)
    features = drying_features(START, FILM, **DRYING, contact=contact)
    assert features.dry_friction == pytest.approx(0.300, abs=0.001)
    assert features.wet_plateau == pytest.approx(1.42, abs=0.005)
    assert features.peak_friction == pytest.approx(friction, rel=0.02)
    assert features.peak_time == pytest.approx(time, abs=6.0)
    assert features.dry_time == pytest.approx(546.3, abs=0.5)
    run = curve(np.array([0.0, 29.9, 30.1, 465.0, 475.0, 500.0, 545.0, 550.0]), contact)
    np.testing.assert_allclose(run.friction_coefficient[:2], 0.3, rtol=1e-3)
    np.testing.assert_allclose(run.friction_coefficient[2:4], 1.42, rtol=3e-3)
    assert np.all(run.friction_coefficient[4:6] > 1.5)
    assert run.friction_coefficient[-1] == pytest.approx(0.3, rel=1e-3)
    # the paper has the friction peak last of the order of 100 s
    assert 40 < features.peak_width < 100


def test_regimes_follow_the_physics_behind_them():
    separation = mean_separation(LOAD, SURFACE, skin=WET)
    assert CONTACT.film[-1] == pytest.approx(separation, rel=1e-12)
    assert CONTACT.area[-1] == pytest.approx(
        relative_contact_area(LOAD, twice_stress_variance(SURFACE, WET)), rel=1e-5
    )
    dry = LayeredSkin(young_modulus_layer=1e9, young_modulus_bulk=20e3, layer_thickness=20e-6)
    plastic = elastoplastic_contact_area(LOAD, twice_stress_variance(SURFACE, dry), yield_stress=50e6).total
    assert CONTACT.dry_area == pytest.approx(plastic, rel=1e-12)
    films = np.array([0.15e-6, 1e-6, 3.3e-6, 8e-6, 12e-6])
    state = capillary_state(films, LOAD, **WATER, spectrum=SURFACE, skin=WET, contact_angle_counterface=0.0)
    local = CONTACT.average(films, np.array(0.0))[0]
    np.testing.assert_allclose(local, state.relative_contact_area, rtol=1e-3)
    run = curve(np.linspace(0, 600, 1201))
    np.testing.assert_allclose(run.friction_coefficient, SHEAR / LOAD * run.relative_contact_area, rtol=1e-14)
    fractions = run.flooded_fraction + run.dry_fraction
    assert np.all((fractions >= 0) & (fractions <= 1 + 1e-12))
    assert run.flooded_fraction[100] == 1
    assert run.dry_fraction[0] == run.dry_fraction[-1] == 1
    # water leaves at the rate of evaporation while the track is wet
    wet = (run.film_thickness > 1e-6)[1:] & (np.arange(1200) > 70)
    np.testing.assert_allclose(np.diff(run.film_thickness)[wet], -RATE * 0.5, rtol=1e-6)


def test_no_spurious_peak_at_the_end():
    # friction falls from its peak to the dry value without another peak: the area does not run away above the floor
    run = curve(np.linspace(515, 560, 400))
    assert np.all(np.diff(run.friction_coefficient) < 1e-12)
    assert np.max(curve(np.linspace(0, 600, 2000)).friction_coefficient) < 2.4
    # which it would with a floor of the thickness of nothing
    deep = contact_of(film_floor=3e-11)
    assert SHEAR / LOAD * deep.area[0] > 1.5 * SHEAR / LOAD * CONTACT.area.max()


def test_average_is_the_integral_over_an_uneven_film():
    spread = 0.8e-6

    def local(film):
        if film < CONTACT.film[0]:
            return float(CONTACT.dry_area)
        return float(np.interp(film, CONTACT.film, CONTACT.area))

    for mean in (-0.5e-6, 0.3e-6, 2e-6, 13e-6):

        def integrand(x, mean=mean):
            return local(mean + spread * x) * np.exp(-x * x / 2) / np.sqrt(2 * np.pi)

        breaks = [(CONTACT.film[0] - mean) / spread, (CONTACT.film[-1] - mean) / spread]
        inside = [b for b in breaks if -8 < b < 8]
        expected = quad(integrand, -8, 8, points=inside or None, limit=400)[0]
        assert CONTACT.average(np.array([mean]), np.array(spread))[0][0] == pytest.approx(expected, rel=1e-5)


def test_slope_is_the_derivative_and_the_curve_has_no_kinks():
    film = np.linspace(-1e-6, 16e-6, 900)
    spread = np.array(2e-7)
    area, slope = CONTACT.average(film, spread)
    step = 1e-11
    ahead, behind = (CONTACT.average(film + s * step, spread)[0] for s in (1, -1))
    np.testing.assert_allclose(slope, (ahead - behind) / (2 * step), atol=1e-5 * np.max(np.abs(slope)))

    def bend(count):
        places = np.linspace(-1e-6, 16e-6, count)
        return np.max(np.abs(np.diff(CONTACT.average(places, spread)[1])))

    assert bend(3200) < 0.3 * bend(800)  # changes of the slope shrink with the step everywhere
    assert area.max() < CONTACT.area.max()


def test_features_agree_with_a_fine_curve():
    for spread in (1e-7, 5e-7, 2e-6):
        features = drying_features(START, FILM, **DRYING, contact=CONTACT, film_spread=spread)
        times = np.linspace(450, 560, 11_001)
        friction = curve(times, spread=spread).friction_coefficient
        best = np.argmax(friction)
        assert features.peak_time == pytest.approx(times[best], abs=0.02)
        assert features.peak_friction == pytest.approx(friction[best], rel=1e-7)
        half = (features.peak_friction + features.wet_plateau) / 2
        above = times[friction > half]
        assert features.peak_width == pytest.approx(above[-1] - above[0], abs=0.03)
        exact = minimize_scalar(
            lambda t, s=spread: -float(curve(t, spread=s).friction_coefficient),
            bounds=(times[best] - 5, times[best] + 5), method="bounded", options={"xatol": 1e-7},
        )  # fmt: skip
        assert features.peak_time == pytest.approx(exact.x, abs=1e-3)


def test_timing_moves_with_the_film_and_not_with_the_shear_stress():
    features = drying_features(START, np.array([60e-6, 90e-6]), **DRYING, contact=CONTACT)
    assert np.diff(features.peak_time)[0] == pytest.approx(30e-6 / RATE, rel=1e-9)
    assert features.peak_width[0] == pytest.approx(features.peak_width[1], rel=1e-9)
    other = drying_features(
        START,
        60e-6,
        evaporation_rate=RATE,
        contact=CONTACT,
        frictional_shear_stress=0.5 * SHEAR,
        nominal_pressure=LOAD,
    )
    assert other.peak_time == features.peak_time[0]
    assert other.peak_friction == pytest.approx(features.peak_friction[0] / 2, rel=1e-12)
    faster = drying_features(
        START,
        60e-6,
        evaporation_rate=2 * RATE,
        contact=CONTACT,
        frictional_shear_stress=SHEAR,
        nominal_pressure=LOAD,
    )
    assert faster.peak_time - START == pytest.approx((features.peak_time[0] - START) / 2, rel=1e-9)


def test_features_change_smoothly():
    modulus = 7e6 * np.exp(np.linspace(-0.1, 0.1, 41))
    contact = contact_of(
        skin=LayeredSkin(young_modulus_layer=modulus, young_modulus_bulk=20e3, layer_thickness=20e-6)
    )
    features = drying_features(START, FILM, **DRYING, contact=contact)
    for value in (features.peak_time, features.peak_friction, features.peak_width, features.wet_plateau):
        steps = np.diff(value)
        assert np.max(np.abs(np.diff(steps))) < 0.03 * np.max(np.abs(steps))  # no step, no kink


def test_roots_of_features_are_found_whatever_the_function():
    rng = np.random.default_rng(0)
    root, steep = rng.uniform(0, 1, 300), 10 ** rng.uniform(0, 6, 300)
    zero, one = np.zeros(300), np.ones(300)
    for function in (lambda x: -np.tanh(steep * (x - root)), lambda x: root**3 - x**3,
                     lambda x: np.where(x < root, 1.0, -1.0)):  # fmt: skip
        np.testing.assert_allclose(falling_root(function, zero, one), root, rtol=0, atol=2e-12)
    # no change of sign: the end towards which the function points
    np.testing.assert_array_equal(falling_root(lambda x: 1 + 0 * x, zero, one), one)
    np.testing.assert_array_equal(falling_root(lambda x: -1 + 0 * x, zero, one), zero)
    assert np.isnan(falling_root(lambda x: np.nan * x, zero, one)).all()
    # a member does not depend on the others
    alone = [falling_root(lambda x, c=c: c**3 - x**3, np.zeros(1), np.ones(1))[0] for c in root[:20]]
    np.testing.assert_array_equal(alone, falling_root(lambda x: root[:20] ** 3 - x**3, zero[:20], one[:20]))


def test_polypropylene_has_no_peak():
    contact = contact_of(glass=102.0)
    features = drying_features(START, FILM, **DRYING, contact=contact)
    assert np.isnan([features.peak_time, features.peak_friction, features.peak_width]).all()
    assert features.wet_plateau == pytest.approx(1.42, abs=0.005)
    run = curve(np.linspace(31, 600, 500), contact)
    assert np.all(np.diff(run.friction_coefficient) < 1e-9)


def test_hardening_layer():
    hard = contact_of(hardening_film=1e-6)
    assert hard.area[-1] == pytest.approx(CONTACT.area[-1], rel=1e-6)
    assert hard.dry_area == CONTACT.dry_area
    # towards the floor the layer is nearly dry, and the area with it
    assert CONTACT.dry_area < hard.area[0] < 0.5 * CONTACT.area[0]
    # against a skin of the modulus of one film
    place = np.argmin(np.abs(hard.film - 2e-6))
    film = hard.film[place]

    def wet_fraction(thickness):
        return (thickness / 1e-6) ** 2 / (1 + (thickness / 1e-6) ** 2)

    fraction = wet_fraction(film) / wet_fraction(hard.film[-1])
    skin = LayeredSkin(
        young_modulus_layer=7e6**fraction * 1e9 ** (1 - fraction),
        young_modulus_bulk=20e3,
        layer_thickness=20e-6,
    )
    state = capillary_state(film, LOAD, **WATER, spectrum=SURFACE, skin=skin, contact_angle_counterface=0.0)
    area = elastoplastic_contact_area(
        state.total_pressure, twice_stress_variance(SURFACE, skin), yield_stress=50e6
    ).total
    assert hard.area[place] == pytest.approx(area, rel=0.02)
    # a layer that never hardens above the floor is the plain case
    late = contact_of(hardening_film=1e-10)
    films = np.linspace(0.2e-6, 13e-6, 60)
    plain, same = (each.average(films, np.array(1e-7))[0] for each in (CONTACT, late))
    np.testing.assert_allclose(same, plain, rtol=2e-3)


def test_batches_agree_with_rows_to_the_last_bit():
    modulus, glass = np.array([4e6, 7e6, 12e6]), np.array([0.0, 0.3, 0.5])
    bulk = np.array([25e3, 20e3, 15e3])
    batch = film_contact(
        LOAD,
        SURFACE,
        **WATER,
        **HARD,
        skin=LayeredSkin(young_modulus_layer=modulus, young_modulus_bulk=bulk, layer_thickness=20e-6),
        contact_angle_counterface=glass,
    )
    times = np.linspace(0, 600, 7)
    runs = drying_curve(times, START, **RUN, contact=batch)
    features = drying_features(START, FILM, **DRYING, contact=batch)
    for i in range(3):
        skin = LayeredSkin(young_modulus_layer=modulus[i], young_modulus_bulk=bulk[i], layer_thickness=20e-6)
        one = film_contact(LOAD, SURFACE, **WATER, **HARD, skin=skin, contact_angle_counterface=glass[i])
        for name in ("film", "area", "dry_area"):
            np.testing.assert_array_equal(getattr(batch, name)[i], getattr(one, name))
        for whole, part in (
            (
                runs,
                drying_curve(times, START, **RUN, contact=one),
            ),
            (
                features,
                drying_features(START, FILM, **DRYING, contact=one),
            ),
        ):
            for left, right in zip(whole, part, strict=True):
                np.testing.assert_array_equal(left[i] if np.ndim(left) else left, right)


def test_shapes_and_impossible_arguments():
    assert curve(100.0).friction_coefficient.shape == ()
    assert curve([100.0, 200.0]).friction_coefficient.shape == (2,)
    wide = drying_curve(
        [100.0, 200.0, 300.0],
        START,
        initial_film=np.array([[50e-6], [90e-6]]),
        evaporation_rate=np.array([1e-7, 2e-7]),
        contact=CONTACT,
        frictional_shear_stress=SHEAR,
        nominal_pressure=LOAD,
    )
    assert wide.relative_contact_area.shape == (2, 2, 3)
    assert drying_features(START, np.array([50e-6, 90e-6]), **DRYING, contact=CONTACT).peak_time.shape == (2,)
    assert np.isnan(
        drying_curve(100.0, START, **DRYING, initial_film=-1e-6, contact=CONTACT).friction_coefficient
    )
    assert np.isnan(
        drying_features(
            START,
            FILM,
            evaporation_rate=-RATE,
            contact=CONTACT,
            frictional_shear_stress=SHEAR,
            nominal_pressure=LOAD,
        ).peak_friction
    )
    assert np.isnan(contact_of(film_floor=-1e-7).area).all()
    toy = FilmContact(film=np.array([1.0, 2.0, 3.0]), area=np.array([0.5, 0.5, 0.5]), dry_area=np.array(0.5))
    np.testing.assert_allclose(toy.average(np.array([-1.0, 1.5, 9.0]), np.array(0.7))[0], 0.5, rtol=1e-14)
