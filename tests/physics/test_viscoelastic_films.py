"""Films on a viscoelastic solid: elastic limits, energy, moments, friction in parts, and a second solver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from film_second_solver import Features, Solver, features, fourier_kernel

from skinbayes.contact import (
    LayeredSkin,
    ViscoelasticMaterial,
    ViscoelasticSkin,
    constant_loss_solid,
    line_contact,
    standard_linear_solid,
)
from skinbayes.contact.moving_kernel import moving_kernel
from skinbayes.contact.viscoelastic_line_contact import passage
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    asperity_law,
    lubricated_films,
    stribeck_curve,
    viscoelastic_films,
    viscoelastic_stribeck_curve,
)
from skinbayes.lubrication.film import lubrication_number_per_product
from skinbayes.roughness import named_surface

LOAD, RADIUS = 21.92, 4.533e-3
CYLINDER = {"load_per_length": LOAD, "cylinder_radius": RADIUS}
WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
SURFACE = named_surface("paper_reference")
LAW = asperity_law(SURFACE, WET)
ELASTIC = ViscoelasticMaterial(equilibrium_modulus=20e3)
ZENER = standard_linear_solid(20e3, 27.8e3, relaxation_time=0.1)
STRONG = standard_linear_solid(20e3, 60e3, relaxation_time=0.1)
PRODUCT = np.geomspace(1e-5, 0.3, 9)


@pytest.mark.parametrize("law", [None, LAW])
@pytest.mark.parametrize(
    ("material", "speed", "modulus", "error"),
    [(ELASTIC, 0.01, 20e3, 1e-10), (ZENER, 1e-9, 20e3, 1e-6), (ZENER, 1e7, 27.8e3, 1e-6)],
)
def test_slow_and_fast_films_are_elastic(
    law: object, material: ViscoelasticMaterial, speed: float, modulus: float, error: float
) -> None:
    expected = lubricated_films(PRODUCT, reduced_modulus=modulus / 0.75, asperities=law, **CYLINDER)
    found = viscoelastic_films(speed, PRODUCT / speed, material=material, asperities=law, **CYLINDER)
    for name in ("couette", "pressure_flow", "minimum_film", "central_film", "asperity_load_fraction"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=error, atol=1e-14)
    np.testing.assert_allclose(found.separation, expected.separation, rtol=10 * error)
    assert np.abs(found.hysteresis).max() < 1e-6


@pytest.mark.parametrize("material", [ZENER, STRONG])
@pytest.mark.parametrize("law", [None, LAW])
def test_work_of_the_drag_is_what_the_solid_dissipates(material: ViscoelasticMaterial, law: object) -> None:
    # force ∫ dq/(2π) |p(q)|² (2/|q|) q Im(E*)/|E*|², over both signs of q; p(q) of piecewise linear pressures in closed form
    speed = 0.02
    films = viscoelastic_films(speed, [2e-2, 1.0, 8.0], material=material, asperities=law, **CYLINDER)
    q = np.concatenate([np.geomspace(1e-3, 1.0, 300)[:-1], np.linspace(1.0, 3e4, 6000)])
    modulus = material.reduced_modulus(q * speed)
    for row in range(3):
        x, p = films.position[row], films.fluid_pressure[row] + films.asperity_pressure[row]
        bends = np.diff(
            np.diff(np.concatenate([[0.0], p, [0.0]]))
            / np.diff(np.concatenate([[x[0] - 1e-6], x, [x[-1] + 1e-6]]))
        )
        kinks = np.concatenate([[p[0] / 1e-6], bends, [p[-1] / 1e-6]])
        places = np.concatenate([[x[0] - 1e-6], x, [x[-1] + 1e-6]])
        transform = (kinks * np.exp(-1j * q[:, None] * places)).sum(axis=1) / -np.square(q)
        density = 2 / np.pi * np.abs(transform) ** 2 * modulus.imag / np.abs(modulus) ** 2
        assert films.hysteresis[row] * LOAD == pytest.approx(np.trapezoid(density, q), rel=5e-3)
        # moment of the pressure on the cylinder, with that of the inlet before the first node, 4λ/(3|X|)
        moment = -((p * x) @ films.load_weight[row]) / RADIUS / LOAD
        hertz = line_contact(LOAD, RADIUS, reduced_modulus=films.reference_modulus[row])
        number = lubrication_number_per_product(RADIUS, hertz) * speed * [2e-2, 1.0, 8.0][row]
        slope = films.half_width[row] / RADIUS
        moment += slope * 2 / np.pi * 4 * number / 3 * films.half_width[row] / -x[0]
        parts = films.hysteresis[row] + 2 * films.pressure_flow[row]
        assert moment == pytest.approx(parts, abs=4e-4)
    assert (films.hysteresis > 0.03).all()


def test_solids_that_pass_the_other_way_mirror_the_deflection() -> None:
    # J0 = 0.5, J1 = 0.5, vθ = 0.7 in units of E_ref and b: E*(qv)/E_ref = (1 + 0.7iq)/(1 + 0.35iq)
    nodes = np.linspace(-1.5, 1.5, 31)
    closed = -moving_kernel(
        nodes, instantaneous=0.5, compliance=np.array([0.5]), length=np.array([0.7])
    ).deflection

    def modulus(q: np.ndarray) -> np.ndarray:
        return (1 + 0.7j * q) / (1 + 0.35j * q)

    forward = fourier_kernel(nodes, modulus)
    backward = fourier_kernel(nodes, lambda q: np.conj(modulus(q)))
    free = (closed - forward)[:, 1:-1]  # the mean; the period is felt beyond the fourth digit
    assert np.ptp(free) < 2e-4
    assert np.ptp((closed[::-1, ::-1] - backward)[:, 1:-1]) < 2e-4
    assert np.ptp((closed - backward)[:, 1:-1]) > 0.03
    # the solid has not come back where it leaves
    depth = closed @ np.sqrt(np.maximum(1 - nodes**2, 0))
    assert depth[-1] > depth[0] + 0.1


def test_speeds_do_not_know_of_each_other() -> None:
    speeds, viscosity = np.array([0.01, 0.3, 0.01, -1.0, np.nan]), np.array([0.1, 0.01, 3.0, 1.0, 1.0])
    together = viscoelastic_films(speeds, viscosity, material=ZENER, asperities=LAW, **CYLINDER)
    alone = viscoelastic_films(0.3, 0.01, material=ZENER, asperities=LAW, **CYLINDER)
    assert together.couette[1] == alone.couette[0]
    assert (together.separation[1] == alone.separation[0]).all()
    assert np.isnan(together.hysteresis[3:]).all()
    with pytest.raises(InputError, match="nodes is 3"):
        viscoelastic_films(0.3, 0.01, material=ZENER, nodes=3, **CYLINDER)


def test_curve_of_elastic_skin_is_that_of_elastic_skin() -> None:
    skin = ViscoelasticSkin(
        layer=ViscoelasticMaterial(equilibrium_modulus=7e6), bulk=ELASTIC, layer_thickness=20e-6
    )
    case = {"normal_force": 0.2, "sphere_radius": 8e-3, "spectrum": SURFACE, "frictional_shear_stress": 15e6}
    speed, viscosity = np.array([1e-3, 0.02, 0.02, 0.5, 5.0]), np.array([0.01, 0.1, 1.0, 0.1, 1.0])
    found = viscoelastic_stribeck_curve(speed, viscosity, skin=skin, **case)
    for rows in ([0], [1, 2], [3]):  # points of one speed share their nodes
        expected = stribeck_curve(speed[rows] * viscosity[rows], skin=WET, contact="line", **case)
        for name in ("friction_coefficient", "boundary", "couette", "central_film", "strain"):
            np.testing.assert_allclose(getattr(found, name)[rows], getattr(expected, name), rtol=1e-9)
    assert (found.film_beyond_ball == [False, False, False, False, True]).all()
    assert found.reasons() == stribeck_curve(speed * viscosity, skin=WET, contact="line", **case).reasons()
    # with loss, friction is no function of ηv alone, and the parts add up
    lossy = ViscoelasticSkin(layer=skin.layer, bulk=ZENER, layer_thickness=20e-6)
    pair = viscoelastic_stribeck_curve([0.01, 1.0, -1.0], [1.0, 0.01, 1.0], skin=lossy, **case)
    assert pair.friction_coefficient[0] > pair.friction_coefficient[1] + 0.02
    assert pair.hysteresis[0] > 5 * pair.hysteresis[1]
    assert pair.impossible.tolist() == [False, False, True]
    total = pair.boundary + pair.couette + pair.pressure_flow + pair.hysteresis
    assert (pair.friction_coefficient[:2] == total[:2]).all()
    assert viscoelastic_stribeck_curve(0.01, 1.0, skin=lossy, **case).friction_coefficient == total[0]


def compared(
    material: ViscoelasticMaterial, speed: float, modulus: Callable, nodes: int
) -> tuple[Features, Features]:
    """What the package and the second solver find; ``modulus`` is E* as a function of frequency."""
    numbers, plateau = np.geomspace(2e-4, 0.4, 18), 3.0
    scales = passage(material, speed, **CYLINDER)
    hertz = line_contact(LOAD, RADIUS, reduced_modulus=scales.modulus)
    product = numbers / lubrication_number_per_product(RADIUS, hertz)
    films = viscoelastic_films(speed, product / speed, material=material, asperities=LAW, **CYLINDER)
    fluid = (films.couette + films.pressure_flow) / (scales.half_width / RADIUS)
    mine = features(numbers, films.asperity_load_fraction, fluid, plateau)
    position = np.linspace(-5.0, 2.8, nodes)
    kernel = fourier_kernel(position, lambda q: modulus(q * speed / scales.half_width) / scales.modulus)
    law = LAW.scaled(scales.half_width**2 / RADIUS, float(hertz.maximum_pressure))
    solver = Solver(position, kernel, law)
    found = [solver.friction(s, n) for s, n in zip(solver.sweep(numbers, 1.6), numbers, strict=True)]
    return mine, features(numbers, *np.array(found).T, plateau)


def zener(equilibrium: float, instantaneous: float, time: float) -> Callable:
    """Complex plane-strain modulus of one relaxation time, in its closed form."""
    return lambda w: (
        (equilibrium + (instantaneous - equilibrium) * 1j * w * time / (1 + 1j * w * time)) / 0.75
    )


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [1.39, 3.0])
@pytest.mark.parametrize("deborah", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("slow_modulus", [20e3, 10e3])
def test_second_solver_finds_the_same_curve(ratio: float, deborah: float, slow_modulus: float) -> None:
    material = standard_linear_solid(slow_modulus, ratio * slow_modulus, relaxation_time=0.1)
    mine, other = compared(
        material, deborah * 2.2e-3 / 0.1, zener(slow_modulus, ratio * slow_modulus, 0.1), 313
    )
    np.testing.assert_allclose(mine, other, rtol=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("power", [0.09, 0.3])
def test_second_solver_finds_the_same_curve_for_a_power_law(power: float) -> None:
    # the exact (iω)^n against the sum of relaxing moduli that stands for it
    reference = 5.0
    material = constant_loss_solid(
        20e3,
        np.tan(power * np.pi / 2),
        angular_frequency=reference,
        lowest_frequency=1e-3,
        highest_frequency=1e5,
    )
    mine, other = compared(material, 0.01, lambda w: 20e3 / 0.75 * (1j * w / reference) ** power, 313)
    np.testing.assert_allclose(mine, other, rtol=0.01)


def test_second_solver_finds_the_same_film() -> None:
    # one film in mixed lubrication at strong loss; the slow tests compare whole curves
    number, speed = 0.05, 0.03
    scales = passage(STRONG, speed, **CYLINDER)
    hertz = line_contact(LOAD, RADIUS, reduced_modulus=scales.modulus)
    viscosity = number / lubrication_number_per_product(RADIUS, hertz) / speed
    films = viscoelastic_films(speed, viscosity, material=STRONG, asperities=LAW, **CYLINDER)
    position = np.linspace(-4.0, 2.6, 199)
    modulus = zener(20e3, 60e3, 0.1)
    kernel = fourier_kernel(position, lambda q: modulus(q * speed / scales.half_width) / scales.modulus)
    solver = Solver(
        position, kernel, LAW.scaled(scales.half_width**2 / RADIUS, float(hertz.maximum_pressure))
    )
    state = solver.sweep(np.array([number]), 1.6)[0]
    share, fluid = solver.friction(state, number)
    assert films.asperity_load_fraction[0] == pytest.approx(share, rel=0.01)
    assert films.couette[0] + films.pressure_flow[0] == pytest.approx(
        fluid * scales.half_width / RADIUS, rel=0.01
    )
    inside = np.abs(position) < 1.2
    film = np.interp(position * scales.half_width, films.position[0], films.separation[0])
    expected = solver.film(state) * scales.half_width**2 / RADIUS
    np.testing.assert_allclose(film[inside], expected[inside], rtol=0.02)
