"""Films under a cylinder: closed limits, identities that the discrete equations do not know of, an independent solver."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from skinbayes.contact import LayeredSkin, mean_separation, pressure_at_separation, reduced_modulus
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.lubrication.asperities import asperity_law, law_of_table
from skinbayes.lubrication.film import lubricated_films, lubrication_number_per_product
from skinbayes.lubrication.flow_factors import TrivialFlowFactors
from skinbayes.roughness import named_surface

WET, SURFACE = (
    LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6),
    named_surface("paper_reference"),
)
MODULUS = float(reduced_modulus(20e3, 0.5))
LOAD, RADIUS = (float(x) for x in cylinder_of_sphere(0.2, 8e-3, reduced_modulus=MODULUS))
HERTZ = line_contact(LOAD, RADIUS, reduced_modulus=MODULUS)
PER_PRODUCT = lubrication_number_per_product(RADIUS, HERTZ)


def rigid_cylinder():
    """Film and friction of a rigid cylinder: X = √(2H0) tan t, h = h0/cos² t, in units of ηv R/f_N and of √(ηv/f_N)."""

    def rise(edge):
        return quad(lambda t: np.cos(t) ** 2 - np.cos(t) ** 4 / np.cos(edge) ** 2, -np.pi / 2, edge)[0]

    edge = brentq(rise, 0.1, 1.0, xtol=1e-14)  # pressure and its gradient vanish at the cavity

    def pressure(t):
        return quad(lambda s: np.cos(s) ** 2 - np.cos(s) ** 4 / np.cos(edge) ** 2, -np.pi / 2, t)[0]

    # p = 6ηv √(2R h0)/h0² pressure(t), f_N = ∫ p dx with dx = √(2R h0)/cos² t dt
    load = quad(lambda t: pressure(t) / np.cos(t) ** 2, -np.pi / 2 + 1e-9, edge, epsabs=1e-10)[0]
    film = 12 * load  # h0 = 12 load ηv R/f_N
    cavity = quad(lambda t: np.cos(t) ** 2 / np.cos(edge) ** 2, edge, np.pi / 2)[0]
    shear = np.sqrt(2 / film) * (edge + np.pi / 2 + cavity)  # times √(ηv/f_N)
    slip = quad(
        lambda t: np.cos(t) ** -2 * (np.cos(t) ** 2 - np.cos(t) ** 4 / np.cos(edge) ** 2), -np.pi / 2, edge
    )[0]
    return film, shear, 0.5 * 6 * np.sqrt(2 / film) * slip


def test_thick_films_are_those_of_a_rigid_cylinder():
    film, shear, pressure = rigid_cylinder()
    assert film == pytest.approx(2.447, abs=1e-3)  # the number in textbooks, after Martin
    product = np.array([1e3, 1e4]) / PER_PRODUCT
    films = lubricated_films(
        product, cylinder_radius=RADIUS, load_per_length=LOAD, reduced_modulus=MODULUS, nodes=200
    )
    root = np.sqrt(product / LOAD)
    np.testing.assert_allclose(films.minimum_film, film * product * RADIUS / LOAD, rtol=2e-3)
    np.testing.assert_allclose(films.couette, shear * root, rtol=2e-3)
    np.testing.assert_allclose(films.pressure_flow, pressure * root, rtol=2e-3)


def test_smooth_soft_contact_has_the_exponent_of_soft_lubrication():
    # isoviscous-elastic: film ~ (ηv)^0.6, approached from above; regressions of full solutions by Moes, 2.05 and 2.621
    # for the minimum and the central film, are 3 to 5 % higher
    number = np.array([1e-5, 2e-5, 1e-4])
    product = number / PER_PRODUCT
    films = lubricated_films(
        product, cylinder_radius=RADIUS, load_per_length=LOAD, reduced_modulus=MODULUS, nodes=300
    )
    step = np.diff(np.log(number))
    assert np.diff(np.log(films.central_film)) / step == pytest.approx([0.6, 0.6], abs=3e-3)
    assert np.diff(np.log(films.minimum_film)) / step == pytest.approx([0.6, 0.6], abs=4e-3)
    modulus = 2 * MODULUS
    moes = RADIUS * (product / (modulus * RADIUS)) ** 0.6 * (LOAD / (modulus * RADIUS)) ** -0.2
    np.testing.assert_allclose(films.minimum_film / (2.05 * moes), 0.965, atol=0.015)
    np.testing.assert_allclose(films.central_film / (2.621 * moes), 0.955, atol=0.015)


def test_slow_sliding_is_the_dry_contact():
    # without fluid all pressure is that of asperities and the gap is their separation
    films = lubricated_films(
        [1e-12, 1e-9],
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
        nodes=200,
    )
    assert films.asperity_load_fraction == pytest.approx([1, 1], abs=1e-5)
    assert films.asperity_pressure[0] @ films.load_weight == pytest.approx(LOAD, rel=1e-6)
    loaded = films.asperity_pressure[0] > 1.0
    expected = mean_separation(films.asperity_pressure[0, loaded], SURFACE, skin=WET)
    np.testing.assert_allclose(films.separation[0, loaded], expected, rtol=1e-4)
    # friction of the fluid is proportional to the speed, down to any speed
    assert films.couette[1] / films.couette[0] == pytest.approx(1e3, rel=1e-5)
    assert films.pressure_flow[1] / films.pressure_flow[0] == pytest.approx(1e3, rel=1e-3)
    assert (1 - films.asperity_load_fraction[1]) / (1 - films.asperity_load_fraction[0]) == pytest.approx(
        1e3, rel=1e-2
    )
    assert films.fluid_pressure[1].max() / films.fluid_pressure[0].max() == pytest.approx(1e3, rel=1e-2)


def test_asperity_law_is_the_inverse_of_the_mean_separation():
    law = asperity_law(SURFACE, WET)
    u = np.geomspace(5e-7, 1e-3, 400)
    exact = pressure_at_separation(u, SURFACE, skin=WET)
    found, slope = law(u)
    np.testing.assert_allclose(found, exact, rtol=2e-4)
    step = 1e-6 * u
    np.testing.assert_allclose(slope, (law(u + step)[0] - law(u - step)[0]) / (2 * step), rtol=1e-6)
    np.testing.assert_allclose(law.scaled(1e-5, 1e3)(u / 1e-5)[0], found / 1e3, rtol=1e-10)
    np.testing.assert_allclose(law.scaled(1e-5, 1e3)(u / 1e-5)[1], slope / 1e3 * 1e-5, rtol=1e-10)
    assert law.separation_at(5e3) == pytest.approx(mean_separation(5e3, SURFACE, skin=WET), rel=2e-2)
    # it rises without a limit, and without an overflow, where surfaces would overlap
    assert np.all(np.diff(law(np.array([-1e-4, -1e-6, 0.0, 1e-8]))[0]) <= 0)
    assert np.isfinite(law(np.array([-1.0]))[0]).all()


def test_fast_sliding_forgets_the_roughness():
    product = np.array([0.2, 0.5])
    rough = lubricated_films(
        product,
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
        nodes=200,
    )
    smooth = lubricated_films(
        product, cylinder_radius=RADIUS, load_per_length=LOAD, reduced_modulus=MODULUS, nodes=200
    )
    assert rough.asperity_load_fraction.max() < 1e-6
    np.testing.assert_allclose(rough.couette, smooth.couette, rtol=1e-3)
    np.testing.assert_allclose(rough.minimum_film, smooth.minimum_film, rtol=2e-3)


def test_load_and_balance_of_forces():
    product = np.geomspace(1e-4, 0.5, 9)
    films = lubricated_films(
        product,
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
        nodes=300,
    )
    total = films.fluid_pressure + films.asperity_pressure
    # before the grid the fluid pressure is 4λ/(3|X|³)
    start = films.position[0] / HERTZ.half_width
    before = 2 * films.lubrication_number / (3 * start**2) / (np.pi / 2)
    np.testing.assert_allclose(total @ films.load_weight / LOAD + before, 1.0, rtol=1e-10)
    # ½∫u dp_f = −½∫p x/Rc dx: elastic displacements do no work in steady sliding, asperities none on u
    inside = -(total * films.position) @ films.load_weight / (LOAD * RADIUS)
    outside = 4 * films.lubrication_number / (3 * -start) / (np.pi / 2) * HERTZ.half_width / RADIUS
    np.testing.assert_allclose(films.pressure_flow, (inside + outside) / 2, rtol=6e-3)


def test_film_is_thinnest_and_asperities_are_strongest_at_the_exit():
    # what the paper says of its Fig. 15
    films = lubricated_films(
        [3e-3, 1e-2, 0.1],
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
    )
    thinnest = films.position[np.argmin(films.separation, axis=1)]
    strongest = films.position[np.argmax(films.asperity_pressure, axis=1)]
    assert np.all(thinnest > 0.3 * HERTZ.half_width)
    np.testing.assert_array_equal(thinnest, strongest)
    assert np.all(films.central_film > films.minimum_film)


def test_parts_are_monotone_in_speed():
    films = lubricated_films(
        np.geomspace(1e-7, 0.5, 40),
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
    )
    assert np.all(np.diff(films.asperity_load_fraction) < 0)
    for name in ("minimum_film", "central_film", "couette", "pressure_flow"):
        assert np.all(np.diff(getattr(films, name)) > 0), name


@pytest.mark.parametrize("nodes", [64, 80, 100])
def test_few_nodes_are_enough(nodes):
    product = np.geomspace(1e-6, 0.5, 16)
    law = asperity_law(SURFACE, WET)
    films, exact = (
        lubricated_films(
            product,
            cylinder_radius=RADIUS,
            load_per_length=LOAD,
            reduced_modulus=MODULUS,
            asperities=law,
            nodes=n,
        )
        for n in (nodes, 500)
    )
    friction, wanted = (
        1.447 * f.asperity_load_fraction + f.couette + f.pressure_flow for f in (films, exact)
    )
    assert np.abs(friction / wanted - 1).max() < 0.006 * (64 / nodes) ** 2
    assert np.abs(films.minimum_film / exact.minimum_film - 1).max() < 0.01 * (64 / nodes) ** 2


def test_answers_do_not_depend_on_the_other_speeds():
    law = asperity_law(SURFACE, WET)
    together = lubricated_films(
        [3e-4, 0.02, 0.3],
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=law,
        nodes=150,
    )
    for i, product in enumerate((3e-4, 0.02, 0.3)):
        alone = lubricated_films(
            [product],
            cylinder_radius=RADIUS,
            load_per_length=LOAD,
            reduced_modulus=MODULUS,
            asperities=law,
            nodes=150,
        )
        assert alone.couette[0] == pytest.approx(together.couette[i], rel=3e-3)
        assert alone.asperity_load_fraction[0] == pytest.approx(
            together.asperity_load_fraction[i], rel=1e-2, abs=1e-8
        )
    # in any order
    back = lubricated_films(
        [0.3, 3e-4, 0.02],
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=law,
        nodes=150,
    )
    np.testing.assert_allclose(back.couette, together.couette[[2, 0, 1]], rtol=1e-9)


def test_dimensionless_groups():
    # lengths times 3, pressures times 7 and ηv times 7·3 make the same problem
    u = np.linspace(1e-6, 4e-4, 60)
    law = law_of_table(u, np.log(2e6) - u / 14e-6)
    larger = law_of_table(3 * u, np.log(7 * 2e6) - u / 14e-6)
    product = np.geomspace(1e-4, 0.1, 5)
    first = lubricated_films(
        product, cylinder_radius=RADIUS, load_per_length=LOAD, reduced_modulus=MODULUS, asperities=law
    )
    second = lubricated_films(
        21 * product,
        cylinder_radius=3 * RADIUS,
        load_per_length=21 * LOAD,
        reduced_modulus=7 * MODULUS,
        asperities=larger,
    )
    np.testing.assert_allclose(second.couette, first.couette, rtol=1e-8)
    np.testing.assert_allclose(second.separation, 3 * first.separation, rtol=1e-8)
    np.testing.assert_allclose(
        second.asperity_load_fraction, first.asperity_load_fraction, rtol=1e-7, atol=1e-9
    )


def test_trivial_factors_change_nothing():
    product = [1e-3, 0.1]
    plain = lubricated_films(
        product,
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
    )
    trivial = lubricated_films(
        product,
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=asperity_law(SURFACE, WET),
        flow_factors=TrivialFlowFactors(),
    )
    np.testing.assert_allclose(trivial.couette, plain.couette, rtol=1e-9)
    np.testing.assert_allclose(trivial.separation, plain.separation, rtol=1e-9)


def plain_solver():
    path = Path(__file__).parents[2] / "benchmarks" / "stribeck.py"
    spec = importlib.util.spec_from_file_location("stribeck_benchmark", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("number", "count", "tolerance"),
    [(0.02, 65, 0.05), *(pytest.param(n, 200, 0.02, marks=pytest.mark.slow) for n in (3e-3, 0.02, 0.3))],
)
def test_an_independent_solver_agrees(number, count, tolerance):
    # even spacing, piecewise constant pressures, scipy.optimize.root; its error falls with the spacing
    module = plain_solver()
    law = asperity_law(SURFACE, WET)
    scaled = law.scaled(float(HERTZ.half_width**2 / RADIUS), float(HERTZ.maximum_pressure))
    ours = lubricated_films(
        [number / PER_PRODUCT],
        cylinder_radius=RADIUS,
        load_per_length=LOAD,
        reduced_modulus=MODULUS,
        asperities=law,
        nodes=300,
    )
    position = np.linspace(-5.0, 2.5, count)
    guess = np.append(np.sqrt(np.maximum(1 - position**2, 0.0)), 1.5)
    kernel = module.plain_kernel(position)
    for step in np.geomspace(1.0, number, 7):
        film, guess, found = module.plain_film(step, position, kernel, lambda gap: scaled(gap)[0], guess)
    assert found
    fraction = scaled(film)[0].sum() * (position[1] - position[0]) * 2 / np.pi
    assert film.min() * HERTZ.half_width**2 / RADIUS == pytest.approx(ours.minimum_film[0], rel=tolerance)
    assert fraction == pytest.approx(ours.asperity_load_fraction[0], rel=2 * tolerance, abs=1e-4)
