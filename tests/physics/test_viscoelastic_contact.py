"""A load that moves over a viscoelastic solid: kernel by quadrature, Hunter's solution, weak loss in closed form, limits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import fsolve
from scipy.special import j1, spherical_jn

from skinbayes.contact import (
    ViscoelasticMaterial,
    constant_loss_solid,
    cylinder_of_sphere,
    line_contact,
    sphere_contact,
    standard_linear_solid,
    viscoelastic_line_contact,
)
from skinbayes.contact.moving_kernel import moving_kernel
from skinbayes.errors import InputError
from skinbayes.lubrication import SPHERE_OVER_CYLINDER

LOAD, RADIUS = 21.92, 4.533e-3
ZENER = standard_linear_solid(20e3, 40e3, relaxation_time=0.1)


def remembered(x: float, length: float) -> float:
    """∫₀^∞ exp(−s) ln|x − ℓs| ds."""
    breaks = [x / length] if 0 < x / length < 50 else None
    return quad(lambda s: np.exp(-s) * np.log(abs(x - length * s)), 0, 50, points=breaks, limit=200)[0]


@pytest.mark.parametrize("length", [0.02, 0.7, 300.0])
def test_kernel_is_the_memory_of_the_logarithm(length: float) -> None:
    nodes = np.array([-1.3, -0.4, 0.1, 1.0])
    pressure = np.array([0.3, 1.0, 0.7, 0.2])
    kernel = moving_kernel(nodes, instantaneous=0.0, compliance=np.ones(1), length=np.array([length]))
    fine = np.linspace(-1.3, 1.0, 461)  # nodes are among its points
    middle = (fine[1:] + fine[:-1]) / 2
    held = np.interp(middle, nodes, pressure) * np.diff(fine)
    found = kernel.deflection @ pressure * np.pi
    expected = [held @ [remembered(x - s, length) for s in middle] for x in nodes[[0, 2]]]
    # a constant, by which the solid moves as a whole, is free
    assert found[0] - found[2] == pytest.approx(expected[0] - expected[1], abs=2e-4)


def test_cells_integrate_the_deflection() -> None:
    nodes = np.sort(np.concatenate([np.linspace(-1, 1, 9), np.linspace(0.25, 0.5, 401)[1:-1]]))
    pressure = np.exp(-np.square(nodes))
    kernel = moving_kernel(
        nodes, instantaneous=0.6, compliance=np.array([0.4, 0.2]), length=np.array([0.3, 40.0])
    )
    depth = kernel.deflection @ pressure
    place = np.searchsorted(nodes, 0.25 - 1e-12)
    inside = slice(place, place + 401)
    assert (kernel.cells @ pressure)[place : place + 400].sum() == pytest.approx(
        np.trapezoid(depth[inside], nodes[inside]), rel=1e-6
    )


def test_slow_and_fast_contacts_are_those_of_hertz() -> None:
    for speed, modulus in [(0.0, 20e3), (1e-9, 20e3), (1e6, 40e3)]:
        hertz = line_contact(LOAD, RADIUS, reduced_modulus=modulus / 0.75)
        found = viscoelastic_line_contact(speed, load_per_length=LOAD, cylinder_radius=RADIUS, material=ZENER)
        inside = np.abs(found.position[0]) < 0.95 * hertz.half_width
        expected = hertz.maximum_pressure * np.sqrt(1 - (found.position[0][inside] / hertz.half_width) ** 2)
        np.testing.assert_allclose(found.pressure[0][inside], expected, rtol=2e-3)
        assert -found.leading_edge[0] == pytest.approx(hertz.half_width, rel=3e-3)
        assert abs(found.hysteresis[0]) < 1e-6


def hunter(speed: float) -> tuple[float, float, float]:
    """Edges of the contact and friction for one relaxation time τ, from the differential equations of the solid.

    ``w + θv w′`` is the deflection that ``P = p + τv p′`` makes on an elastic solid, θ = τ E_g/E∞. In the contact
    w follows the cylinder, so that P, with y from the middle m, is ``E∞*/(2R) (A − y² − y(m + θv))/√(a² − y²)``. Three conditions
    fix a, m and A: p is 0 at both ends (from the leading one it is integrated), ∫p = f_N, and the slope of the surface,
    relaxing from far ahead, is that of the cylinder where they meet.
    """
    modulus, tau = 20e3 / 0.75, 0.1
    memory, recovery = tau * speed, tau * 2 * speed
    b = float(line_contact(LOAD, RADIUS, reduced_modulus=modulus).half_width)

    def parts(unknown: np.ndarray) -> tuple[float, float, float, np.ndarray, np.ndarray, np.ndarray]:
        a, m, level = unknown[0] * b, unknown[1] * b, unknown[2] * b * b
        t = np.linspace(0, np.pi, 6001)
        y = -a * np.cos(t)
        weight = modulus / (2 * RADIUS) * (level - y**2 - y * (m + recovery))  # P dy = weight dt
        # p(y) = ∫ exp(−(y − s)/vτ) P(s) ds/vτ, step by step with the decay exact
        fall = np.exp(-np.diff(y) / memory)
        p = np.zeros_like(y)
        inner = (weight[1:] + weight[:-1]) / 2 * np.diff(t) / memory
        for i in range(t.size - 1):
            p[i + 1] = p[i] * fall[i] + inner[i] * np.sqrt(fall[i])
        return a, m, level, t, y, p

    def miss(unknown: np.ndarray) -> list[float]:
        a, m, level, t, _, p = parts(unknown)

        def ahead(u: float) -> float:
            # (w + θv w′)′ at y = −a cosh u, weighed with exp((y + a)/θv) dy/θv
            y, root = -a * np.cosh(u), a * np.sinh(u)
            slope = (level / root - (y + y * y / root) - (m + recovery) * (1 + y / root)) / RADIUS
            return slope * np.exp((y + a) / recovery) * root / recovery

        top = np.arccosh(1 + 40 * recovery / a)
        meets = quad(ahead, 1e-9, top, limit=200)[0]
        load = np.trapezoid(p * a * np.sin(t), t)
        return [p[-1] / p.max(), load / LOAD - 1, (meets - (a - m) / RADIUS) * RADIUS / b]

    solution = fsolve(miss, [0.9, 0.0, 0.7], xtol=1e-10)
    assert np.abs(miss(solution)).max() < 1e-7
    a, m, _, t, y, p = parts(solution)
    moment = np.trapezoid(p * (y + m) * a * np.sin(t), t)
    return m - a, m + a, -moment / RADIUS / LOAD


@pytest.mark.parametrize("speed", [4e-3, 0.02, 0.08])
def test_one_relaxation_time_has_the_solution_of_hunter(speed: float) -> None:
    lead, trail, friction = hunter(speed)
    found = viscoelastic_line_contact(speed, load_per_length=LOAD, cylinder_radius=RADIUS, material=ZENER)
    assert found.hysteresis[0] == pytest.approx(friction, rel=2e-3)
    assert found.leading_edge[0] == pytest.approx(lead, abs=2e-5)
    assert found.trailing_edge[0] == pytest.approx(trail, abs=2e-5)


def test_weak_loss_has_its_closed_form() -> None:
    # ∫ J1²(x)/x² dx = 4/(3π) with the pressure of Hertz; the next order is 0.33 tan δ
    loss = 0.01
    material = constant_loss_solid(
        20e3, loss, angular_frequency=1.0, lowest_frequency=1e-2, highest_frequency=1e2
    )
    found = viscoelastic_line_contact(
        2e-3, load_per_length=LOAD, cylinder_radius=RADIUS, material=material, nodes=100
    )
    b = line_contact(LOAD, RADIUS, reduced_modulus=found.reference_modulus[0]).half_width
    weak = 8 / (3 * np.pi) * np.sin(np.arctan(loss)) * b / RADIUS
    assert quad(lambda x: (j1(x) / x) ** 2, 1e-9, 400, limit=400)[0] == pytest.approx(
        4 / (3 * np.pi), abs=2e-6
    )
    assert found.hysteresis[0] == pytest.approx(weak * (1 + 0.33 * loss), rel=1e-3)


def test_hysteresis_of_sphere_over_that_of_the_cylinder() -> None:
    # ∫ p(q)² (2/q) |q_x| d²q/(2π)² sin δ/|E*| with p(q) = 2π r0² p0 j1(x)/x of the pressure p0 √(1 − r²/r0²) of Hertz, x = q r0
    modulus, force, radius, sine = 2e4, 0.2, 8e-3, 0.1
    sphere = sphere_contact(force, radius, reduced_modulus=modulus)
    r0, peak = sphere.contact_radius, 1.5 * sphere.mean_pressure
    integral = quad(lambda x: spherical_jn(1, x) ** 2 / x, 1e-9, 300, limit=400)[0]  # 1/4
    drag = sine / modulus * 2 * (2 * np.pi * r0**2 * peak) ** 2 / r0**2 * integral * 4 / (2 * np.pi) ** 2
    assert drag / force == pytest.approx(6 / np.pi**2 * sine * r0 / radius, rel=2e-5)
    load, cylinder = cylinder_of_sphere(force, radius, reduced_modulus=modulus)
    b = line_contact(load, cylinder, reduced_modulus=modulus).half_width
    assert drag / force / (8 / (3 * np.pi) * sine * b / cylinder) == pytest.approx(
        SPHERE_OVER_CYLINDER, rel=2e-5
    )


def test_bad_arguments() -> None:
    with pytest.raises(InputError, match="nodes is 5"):
        viscoelastic_line_contact(1.0, load_per_length=LOAD, cylinder_radius=RADIUS, material=ZENER, nodes=5)
    bad = ViscoelasticMaterial(equilibrium_modulus=-1.0)
    found = viscoelastic_line_contact(
        [-1.0, np.nan], load_per_length=LOAD, cylinder_radius=RADIUS, material=ZENER
    )
    assert np.isnan(found.hysteresis).all()
    found = viscoelastic_line_contact([1.0], load_per_length=LOAD, cylinder_radius=RADIUS, material=bad)
    assert np.isnan(found.pressure).all()
