"""Capillary bridges: the paper's numbers, brute force, limits, residuals, energy, smoothness."""

from itertools import pairwise

import numpy as np
import pytest
from named_fields import skin_from, surface_from
from scipy.integrate import quad
from scipy.optimize import brentq

from skinbayes.contact import (
    LayeredSkin,
    gap_distribution,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.errors import InputError
from skinbayes.roughness import SelfAffineSpectrum, named_surface
from skinbayes.wetting import capillary_state, capillary_state_at_gap, kelvin_gap
from skinbayes.wetting._curve import solve_curve
from skinbayes.wetting._gaps import GapSource

SURFACE = named_surface("paper_reference")
WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
LOAD, TENSION, SKIN_ANGLE = 6830.0, 0.0727, np.radians(80.0)
PAPER = {"spectrum": SURFACE, "skin": WET, "surface_tension": TENSION, "contact_angle_skin": SKIN_ANGLE,
         "contact_angle_counterface": 0.0}  # fmt: skip
FIELDS = ("film_thickness", "kelvin_gap", "capillary_pressure", "total_pressure", "relative_contact_area",
          "wet_area", "mean_separation", "mean_separation_wet", "flooded", "solutions")  # fmt: skip


def paper(film, glass=0.0, load=LOAD, **options):
    return capillary_state(film, load, **PAPER | {"contact_angle_counterface": np.radians(glass)} | options)


def paper_at_gap(gap, load=LOAD, **options):
    return capillary_state_at_gap(gap, load, **PAPER | options)


@pytest.mark.parametrize(
    ("closure", "glass", "strength", "film", "separation"),
    [
        ("gaussian", 0, 0.62, 5.8e-6, 11.05e-6),
        ("gaussian", 20, 0.585, 5.8e-6, 11.16e-6),
        ("sharp", 0, 0.75, 9.7e-6, 10.70e-6),
        ("sharp", 20, 0.705, 9.7e-6, 10.82e-6),
    ],
)
def test_strongest_pull_of_the_paper(closure, glass, strength, film, separation):
    # prototypes computed apart from this code, water at 25 °C; the maximum of the sharp closure is broad
    films = np.linspace(2e-6, 13e-6, 89)
    state = paper(films, surface_tension=0.0720, contact_angle_counterface=np.radians(glass), closure=closure)
    best = np.argmax(state.capillary_pressure)
    assert state.capillary_pressure[best] / LOAD == pytest.approx(strength, rel=0.005)
    assert films[best] == pytest.approx(film, abs=0.4e-6 if closure == "sharp" else 0.1e-6)
    assert state.mean_separation[best] == pytest.approx(separation, rel=0.001)


def test_flooded_from_the_mean_separation_on():
    separation = mean_separation(LOAD, SURFACE, skin=WET)
    assert separation == pytest.approx(13.5e-6, rel=0.005)
    state = paper(separation * np.array([0.9999, 1.0, 5.0]))
    np.testing.assert_array_equal(state.flooded, [0, 1, 1])
    np.testing.assert_array_equal(state.capillary_pressure[1:], 0.0)
    np.testing.assert_array_equal(state.kelvin_gap[1:], np.inf)
    np.testing.assert_allclose(state.film_thickness[1:], separation, rtol=1e-12)
    dry = relative_contact_area(LOAD, twice_stress_variance(SURFACE, WET))
    np.testing.assert_allclose(state.relative_contact_area, dry, rtol=5e-4)  # continuous: nothing jumps
    np.testing.assert_allclose(state.wet_area[1:] + dry, 1.0, rtol=1e-12)
    close = paper(separation * (1 - np.array([1e-3, 1e-4, 1e-5])))
    # the attraction goes to zero in proportion to what is missing of the flooded film
    np.testing.assert_allclose(close.capillary_pressure[:-1] / close.capillary_pressure[1:], 10.0, rtol=0.01)


def brute_force(film, load, surface, skin, strength, closure):
    """p and d by nested root finding, with quadratures over P(u) written out."""

    def density(gaps):
        def evaluate(u):
            near, far = (u - gaps.location) / gaps.width, (u + gaps.location) / gaps.width
            bells = np.exp(-(near**2) / 2) + np.exp(-(far**2) / 2)
            return np.sum(gaps.weight * bells / (np.sqrt(2 * np.pi) * gaps.width))

        return evaluate

    def integrate(gaps, gap, power):
        # in ln u: contacts are surrounded by narrow gaps
        curve = density(gaps)
        edges = np.linspace(np.log(gap) - 18.0, np.log(gap), 25)
        return sum(
            quad(lambda t: np.exp((1 + power) * t) * curve(np.exp(t)), a, b, epsrel=1e-10, epsabs=0)[0]
            for a, b in pairwise(edges)
        )

    def gap_for(gaps):
        return np.exp(
            brentq(lambda t: np.log(integrate(gaps, np.exp(t), 1) / film), np.log(film) - 1, np.log(film) + 6)
        )

    def imbalance(log_pressure):
        pressure = np.exp(log_pressure)
        gaps = gap_distribution(pressure, surface, skin=skin, closure=closure)
        gap = gap_for(gaps)
        return pressure - load - strength / gap * integrate(gaps, gap, 0)

    pressure = np.exp(brentq(imbalance, np.log(load * (1 + 1e-6)), np.log(load * 4), xtol=1e-10))
    return pressure, gap_for(gap_distribution(pressure, surface, skin=skin, closure=closure))


@pytest.mark.parametrize(
    ("film", "load", "skin", "angles", "closure"),
    [
        (3e-6, 6830.0, WET, (80.0, 20.0), "gaussian"),
        (0.4e-6, 2500.0, skin_from((3e6, 60e3, 0.4, 0.5, 35e-6)), (60.0, 75.0), "gaussian"),
        (1.5e-6, 20e3, skin_from((60e6, 40e3, 0.5, 0.45, 15e-6)), (95.0, 10.0), "gaussian"),
        (4e-6, 9000.0, WET, (70.0, 40.0), "sharp"),
    ],
)
def test_brute_force(film, load, skin, angles, closure):
    first, second = np.radians(angles)
    strength = TENSION * (np.cos(first) + np.cos(second))
    pressure, gap = brute_force(film, load, SURFACE, skin, strength, closure)
    given = {"load": load, "skin": skin, "contact_angle_skin": first, "closure": closure}
    state = paper(film, contact_angle_counterface=second, **given)
    sharp = closure == "sharp"  # which costs the quadrature some digits
    assert state.total_pressure == pytest.approx(pressure, rel=1e-6 if sharp else 1e-7)
    assert state.kelvin_gap == pytest.approx(gap, rel=1e-5 if sharp else 1e-6)
    again = paper_at_gap(gap, contact_angle_counterface=second, **given)
    assert again.film_thickness == pytest.approx(film, rel=1e-5 if sharp else 1e-6)


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_residuals_with_the_public_gap_distribution(closure):
    films = np.geomspace(0.05e-6, 13e-6, 9)
    state = paper(films, 20.0, closure=closure)
    strength = TENSION * (np.cos(SKIN_ANGLE) + np.cos(np.radians(20.0)))
    for i, film in enumerate(films):
        gaps = gap_distribution(state.total_pressure[i], SURFACE, skin=WET, closure=closure)
        wet = gaps.cumulative(state.kelvin_gap[i]) - gaps.contact_fraction
        total = LOAD + strength / state.kelvin_gap[i] * wet
        assert state.total_pressure[i] == pytest.approx(total, rel=1e-10)
        assert gaps.film(state.kelvin_gap[i]) == pytest.approx(film, rel=1e-10)
        assert state.wet_area[i] == pytest.approx(wet, rel=1e-10)
        assert state.mean_separation[i] == pytest.approx(gaps.mean, rel=1e-10)
        assert state.relative_contact_area[i] == pytest.approx(gaps.contact_fraction, rel=1e-6)
    np.testing.assert_allclose(state.mean_separation_wet * state.wet_area, films, rtol=1e-10)
    np.testing.assert_allclose(state.capillary_pressure, state.total_pressure - LOAD, rtol=1e-12)
    np.testing.assert_array_equal(state.solutions, 1)


def test_interpolated_solution_is_close():
    films = np.geomspace(0.05e-6, 13.4e-6, 40)
    exact, quick = paper(films), paper(films, refine=False)
    for name in ("total_pressure", "relative_contact_area", "wet_area", "mean_separation"):
        np.testing.assert_allclose(getattr(quick, name), getattr(exact, name), rtol=1e-4)
    assert np.isnan(quick.solutions).all()


def test_film_and_pull_along_the_gap():
    gaps = np.geomspace(2e-6, 2e-4, 60)
    state = paper_at_gap(gaps)
    assert np.all(np.diff(state.film_thickness) > 0)
    assert np.all(np.diff(state.wet_area) > 0)
    assert np.all(state.wet_area + state.relative_contact_area < 1 + 1e-12)
    assert np.all(state.mean_separation_wet < gaps)
    # one smooth curve: no jump from one gap to the next
    assert np.max(np.abs(np.diff(np.log(state.total_pressure)))) < 0.05


def test_more_pull_more_contact():
    state = paper(5e-6, surface_tension=np.array([0.0, 0.02, 0.05, 0.0727, 0.2]))
    assert np.all(np.diff(state.relative_contact_area) > 0)
    assert np.all(np.diff(state.mean_separation) < 0)
    assert state.capillary_pressure[0] == 0
    dry = relative_contact_area(LOAD, twice_stress_variance(SURFACE, WET))
    assert state.relative_contact_area[0] == pytest.approx(dry, rel=1e-12)
    weak = paper(5e-6, surface_tension=np.array([1e-5, 2e-5]))
    assert weak.capillary_pressure[1] / weak.capillary_pressure[0] == pytest.approx(2.0, rel=1e-3)


def test_polypropylene_has_no_bridges_and_water_fills_narrow_gaps():
    glass = np.radians(102.0)
    film = np.array([1e-6, 6e-6, 20e-6])
    state = paper(film, contact_angle_counterface=glass)
    np.testing.assert_allclose(state.capillary_pressure, 0.0, atol=1e-9 * LOAD)
    gaps = gap_distribution(LOAD, SURFACE, skin=WET)
    np.testing.assert_allclose(gaps.film(state.kelvin_gap[:2]), film[:2], rtol=1e-10)
    np.testing.assert_allclose(
        state.wet_area[:2], gaps.cumulative(state.kelvin_gap[:2]) - gaps.contact_fraction, rtol=1e-10
    )
    assert state.flooded[2] == 1
    assert kelvin_gap(1e-9, SKIN_ANGLE, contact_angle_counterface=glass) == 0
    # and the wetting side joins it
    edge = np.pi - SKIN_ANGLE
    near = paper(film[1], contact_angle_counterface=edge + np.array([-1e-6, 0.0]))
    assert near.relative_contact_area[0] == pytest.approx(near.relative_contact_area[1], rel=1e-6)


def test_surface_energy_is_the_work_of_the_laplace_pressure():
    # at fixed surfaces a volume dV of water wets an area dF: γ_w Σcos dF = p_K dV, so that dF/dV = 1/d_K
    films = np.array([0.3e-6, 2e-6, 6e-6, 10e-6])
    state = paper(films)
    step = 1e-3 * films
    for i in range(films.size):
        held = paper(
            films[i] + step[i] * np.array([-1.0, 1.0]), load=state.total_pressure[i], surface_tension=0.0
        )
        assert np.diff(held.wet_area)[0] / (2 * step[i]) == pytest.approx(1 / state.kelvin_gap[i], rel=1e-5)


def test_bridges_act_like_a_load_of_the_same_size():
    state = paper(4e-6)
    pressed = paper(4e-6, load=state.total_pressure, surface_tension=0.0)
    for name in ("relative_contact_area", "mean_separation", "wet_area", "kelvin_gap"):
        assert getattr(pressed, name) == pytest.approx(getattr(state, name), rel=1e-9)


def test_hysteresis_is_seen_and_both_branches_can_be_had():
    # sharp gaps at nanometres: the surfaces snap together
    radius = 0.44735e-9
    gap = kelvin_gap(radius, SKIN_ANGLE, contact_angle_counterface=0.0)
    sides = [paper_at_gap(gap, closure="sharp", branch=b) for b in ("approach", "retreat")]
    assert sides[0].solutions == sides[1].solutions == 3
    assert sides[1].total_pressure > 1.05 * sides[0].total_pressure
    for side in sides:
        gaps = gap_distribution(side.total_pressure, SURFACE, skin=WET, closure="sharp")
        wet = gaps.cumulative(gap) - gaps.contact_fraction
        total = LOAD + TENSION / radius * wet
        assert side.total_pressure == pytest.approx(total, rel=1e-10)
    # with the smooth closure there is one solution, whichever side one comes from
    both = [paper_at_gap(gap, branch=b) for b in ("approach", "retreat")]
    assert both[0].solutions == 1
    assert both[0].total_pressure == pytest.approx(both[1].total_pressure, rel=1e-11)


def random_vectors(count, seed):
    rng = np.random.default_rng(seed)

    def scale(middle, width):
        return middle * np.exp(rng.normal(0.0, width, count))

    surface = surface_from((scale(22e-6, 0.3), rng.uniform(0.65, 0.95, count), scale(1e3, 0.2), scale(6.3e3, 0.2),
                            scale(1e9, 0.3)))  # fmt: skip
    skin = LayeredSkin(
        young_modulus_layer=scale(7e6, 0.5),
        young_modulus_bulk=scale(20e3, 0.4),
        layer_thickness=scale(20e-6, 0.3),
    )
    return surface, skin, scale(6830.0, 0.3), scale(0.07, 0.05), rng.uniform(0.0, 0.6, count)


@pytest.mark.parametrize("refine", [True, False])
def test_batches_agree_with_rows_to_the_last_bit(refine):
    surface, skin, load, tension, glass = random_vectors(5, 3)
    films = np.geomspace(0.2e-6, 30e-6, 6)
    batch = paper(
        films,
        load=load,
        spectrum=surface,
        skin=skin,
        surface_tension=tension,
        contact_angle_counterface=glass,
        refine=refine,
    )
    for i in range(load.size):
        one = paper(
            films,
            load=load[i],
            spectrum=surface_from(getattr(surface, n)[i] for n in surface.__dataclass_fields__),
            skin=LayeredSkin(
                young_modulus_layer=skin.young_modulus_layer[i],
                young_modulus_bulk=skin.young_modulus_bulk[i],
                layer_thickness=skin.layer_thickness[i],
            ),
            surface_tension=tension[i],
            contact_angle_counterface=glass[i],
            refine=refine,
        )
        for name in FIELDS:
            np.testing.assert_array_equal(getattr(batch, name)[i], getattr(one, name), err_msg=name)


def test_interpolation_holds_over_many_skins():
    surface, skin, load, tension, glass = random_vectors(24, 5)
    films = mean_separation(load[:, None], surface, skin=skin) * np.array([0.01, 0.1, 0.3, 0.5, 0.8, 0.97])
    exact, quick = (
        paper(
            films,
            load=load,
            spectrum=surface,
            skin=skin,
            surface_tension=tension,
            contact_angle_counterface=glass,
            refine=refine,
        )
        for refine in (True, False)
    )
    np.testing.assert_allclose(quick.relative_contact_area, exact.relative_contact_area, rtol=1e-3)
    error = np.abs(quick.relative_contact_area / exact.relative_contact_area - 1)
    assert np.median(error) < 5e-5


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_no_kinks_along_random_lines(seed):
    direction = np.random.default_rng(seed).normal(size=7)

    def gradient(half_width):
        place = np.linspace(-half_width, half_width, 41)
        surface = surface_from(
            (22.4e-6 * np.exp(direction[0] * place), 0.78 + 0.05 * direction[1] * place, 1e3, 6345.0, 1e9)
        )
        skin = LayeredSkin(
            young_modulus_layer=7e6 * np.exp(direction[2] * place),
            young_modulus_bulk=20e3 * np.exp(direction[3] * place),
            layer_thickness=20e-6,
        )
        state = paper(
            5e-6 * np.exp(0.3 * direction[4] * place)[:, None],
            load=LOAD * np.exp(direction[5] * place),
            spectrum=surface,
            skin=skin,
            contact_angle_counterface=0.3 + 0.3 * direction[6] * place,
            refine=False,
        )
        return np.diff(np.log(state.relative_contact_area[:, 0])) / np.diff(place)

    # changes of the gradient from step to step shrink with the step where there is neither jump nor kink
    wide, narrow = (np.max(np.abs(np.diff(gradient(w)))) for w in (0.08, 0.02))
    assert narrow < 0.4 * wide + 1e-3


def test_shapes_and_impossible_arguments():
    assert paper(5e-6).wet_area.shape == ()
    assert paper([5e-6]).wet_area.shape == (1,)
    grid = paper(
        [1e-6, 5e-6, 9e-6],
        load=np.array([[3e3], [6e3]]),
        contact_angle_counterface=np.array([0.0, 0.2, 0.4, 0.6]),
        refine=False,
    )
    assert grid.wet_area.shape == (2, 4, 3)
    bad = paper([np.nan, -1e-6, 0.0, 5e-6])
    for name in FIELDS:
        np.testing.assert_array_equal(np.isnan(getattr(bad, name)), [True, True, True, False])
    for load, tension, angle in (
        (-1.0, TENSION, 0.0),
        (LOAD, -0.1, 0.0),
        (LOAD, TENSION, 4.0),
        (np.nan, 0.07, 0.0),
    ):
        assert np.isnan(
            paper(5e-6, load=load, surface_tension=tension, contact_angle_counterface=angle).wet_area
        )
    with pytest.raises(InputError, match="closure is 'square'"):
        paper(5e-6, closure="square")
    with pytest.raises(InputError, match="branch is 'up'"):
        paper_at_gap(5e-6, branch="up")


def test_films_at_the_nodes_of_the_interpolation_are_found():
    # there the root lies on the edge of its bracket, where rounding decides on which side
    source = GapSource(SURFACE, WET, np.float64(0.42), "gaussian")
    load, strength = np.array([LOAD]), np.array([TENSION * (np.cos(SKIN_ANGLE) + 1)])
    separation = mean_separation(load, SURFACE, skin=WET)
    with np.errstate(all="ignore"):
        curve = solve_curve(source, load, strength, separation, np.array([0.1e-6]))
    z, _ = curve.at(np.exp(curve.nodes[:, 1:-1]))
    places = np.sin(np.pi / 2 * np.arange(curve.nodes.shape[1]) / (curve.nodes.shape[1] - 1)) ** 2
    np.testing.assert_allclose(z, curve.end[:, None] * places[1:-1], atol=1e-9)


def test_thin_films_and_strong_pulls():
    # below 0.024 nm there is no solution with an open gap, and films beside it are not touched by that
    state = paper([5e-12, 1e-6, 6e-6])
    assert np.isnan(state.total_pressure[0]) or state.total_pressure[0] > 100 * LOAD
    np.testing.assert_allclose(state.total_pressure[1:], paper([1e-6, 6e-6]).total_pressure, rtol=1e-9)
    surface = SelfAffineSpectrum(
        rms_height=10e-6,
        hurst_exponent=0.8,
        wavevector_min=640.0,
        wavevector_rolloff=3600.0,
        wavevector_max=2e9,
    )
    soft = LayeredSkin(young_modulus_layer=1.4e6, young_modulus_bulk=68e3, layer_thickness=20e-6)
    separation = mean_separation(14e3, surface, skin=soft)
    strong = paper(
        separation * np.array([0.01, 0.1, 0.5, 0.9]),
        load=14e3,
        spectrum=surface,
        skin=soft,
        contact_angle_skin=0.6,
        contact_angle_counterface=1.5,
    )
    assert np.all(strong.capillary_pressure > 0)
    assert np.all(strong.mean_separation < separation)
    assert np.all(strong.capillary_pressure[:3] > 14e3)
