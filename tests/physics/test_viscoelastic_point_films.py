"""Films under a ball on a viscoelastic solid: the memory by Fourier integrals, elastic limits, energy, dry ball, direction."""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from skinbayes.contact import (
    LayeredSkin,
    ViscoelasticMaterial,
    ViscoelasticSkin,
    constant_loss_solid,
    standard_linear_solid,
)
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    asperity_law,
    lubricated_point_films,
    stribeck_curve,
    viscoelastic_point_films,
    viscoelastic_stribeck_curve,
)
from skinbayes.lubrication.point_dry import dry_pressure
from skinbayes.lubrication.point_film import point_films_of
from skinbayes.lubrication.point_grid import PointGrid, point_grid
from skinbayes.lubrication.point_memory import point_memory
from skinbayes.lubrication.point_newton import LOAD
from skinbayes.lubrication.viscoelastic_point_film import passage_under_ball, passing
from skinbayes.roughness import named_surface

BALL = {"normal_force": 0.2, "sphere_radius": 8e-3}
WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
SURFACE = named_surface("paper_reference")
LAW = asperity_law(SURFACE, WET)
ELASTIC = ViscoelasticMaterial(equilibrium_modulus=20e3)
ZENER = standard_linear_solid(20e3, 27.8e3, relaxation_time=0.1)
STRONG = standard_linear_solid(20e3, 60e3, relaxation_time=0.1)
PRODUCT = np.geomspace(1e-4, 0.3, 5)


def gauss(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places and weights of Gauss's rule between each two edges."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    places = np.concatenate([(a + b + (b - a) * nodes) / 2 for a, b in pairwise(edges)])
    return places, np.concatenate([(b - a) / 2 * weights for a, b in pairwise(edges)])


def deflection_by_fourier(x: np.ndarray, y: np.ndarray, compliance: object) -> np.ndarray:
    """Depth under the pressure √(1 − r²), less that at the middle; ``compliance``: 1/E*(q_x v) over that of the unit."""
    q, steps = gauss(np.linspace(0.0, 50.0, 26), 40)
    turn = (np.arange(128) + 0.5) * 2 * np.pi / 128
    bessel = (np.sin(q) - q * np.cos(q)) / q**3  # of the pressure, over 2π
    along = q[:, None] * np.cos(turn)
    weight = (steps * bessel)[:, None] * compliance(along) / 128
    phases = np.exp(1j * (along[..., None] * x + q[:, None, None] * np.sin(turn)[:, None] * y)) - 1
    # (2/π²) ∫∫ p/ρ in the units of the solver is (4/π) ∫dq p(q) J0(qr)
    return 4 / np.pi * np.real(np.einsum("qt,qtp->p", weight, phases))


@pytest.mark.parametrize("length", [0.3, 2.0])
def test_memory_is_that_of_the_complex_modulus(length: float) -> None:
    # J0 = 0.4, J1 = 0.6: 1/E*(q_x v) = 0.4 + 0.6/(1 + i q_x ℓ); the rim of the pressure is a kink between cells
    grid = point_grid(40, 20, 0.08, 20.0)
    memory = point_memory(grid, instantaneous=0.4, compliance=np.array([0.6]), length=np.array([length]))
    x, y = grid.radius * np.cos(grid.angle), grid.radius * np.sin(grid.angle)
    pressure = np.sqrt(np.maximum(1 - np.square(grid.radius), 0))
    depth = memory.deflection @ (grid.kernel @ pressure)
    places = [0, *np.flatnonzero((grid.radius > 0.3) & (grid.radius < 1.6))[::83]]
    exact = deflection_by_fourier(x[places], y[places], lambda q: 0.4 + 0.6 / (1 + 1j * q * length))
    other_way = deflection_by_fourier(x[places], y[places], lambda q: 0.4 + 0.6 / (1 - 1j * q * length))
    np.testing.assert_allclose(depth[places] - depth[0], exact - exact[0], atol=3e-3)
    assert np.abs(depth[places] - depth[0] - other_way + other_way[0]).max() > 0.1


@pytest.mark.parametrize(
    ("material", "speed", "modulus"), [(ELASTIC, 0.01, 20e3), (ZENER, 1e-9, 20e3), (ZENER, 1e7, 27.8e3)]
)
def test_slow_and_fast_films_are_elastic(
    material: ViscoelasticMaterial, speed: float, modulus: float
) -> None:
    for law, product in ((LAW, PRODUCT), (None, PRODUCT[2:])):
        expected = lubricated_point_films(product, reduced_modulus=modulus / 0.75, asperities=law, **BALL)
        found = viscoelastic_point_films(speed, product / speed, material=material, asperities=law, **BALL)
        for name in ("couette", "pressure_flow", "minimum_film", "central_film", "asperity_load_fraction"):
            np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-6, atol=1e-14)
        assert np.abs(found.hysteresis).max() < 1e-6


@pytest.mark.parametrize("material", [ZENER, STRONG])
def test_work_of_the_drag_is_what_the_solid_dissipates(material: ViscoelasticMaterial) -> None:
    # force ∫d²q/(2π)² |p(q)|² (2/q) q_x Im(E*)/|E*|², both halves of the plane and of q alike
    speed, viscosity = 0.02, np.array([0.3, 8.0])
    films = viscoelastic_point_films(speed, viscosity, material=material, asperities=LAW, **BALL)
    q, step = gauss(np.geomspace(10.0, 1.5e4, 12), 8)
    turn, part = gauss(np.array([0.0, np.pi / 4, np.pi / 2]), 12)
    along, across = q[:, None] * np.cos(turn), q[:, None] * np.sin(turn)
    modulus = material.reduced_modulus(along.ravel() * speed).reshape(along.shape)
    loss = 2 * np.cos(turn) * modulus.imag / np.abs(modulus) ** 2
    weight = 4 * q[:, None] * step[:, None] * part / (2 * np.pi) ** 2
    inside, share = gauss(np.array([-1.0, 1.0]), 3)  # places in a cell, which has one pressure
    for row in range(2):
        rays = 12  # of 360 cells
        side = films.lateral_position[row]
        centre = films.position[row, :rays].mean()
        radius, angle = (f(side, films.position[row] - centre) for f in (np.hypot, np.arctan2))
        width = films.load_weight[row] / radius / (2 * np.pi / rays)  # of the ring
        r = (radius[:, None] + width[:, None] / 2 * inside)[:, :, None]
        phi = angle[:, None, None] + np.pi / rays / 2 * inside
        force = films.fluid_pressure[row] + films.asperity_pressure[row]
        force = (force * films.load_weight[row])[:, None, None] * (share * share[:, None] / 4)
        force = force * r / radius[:, None, None]
        x, y, force = (z.ravel() for z in (r * np.cos(phi), r * np.sin(phi), force))
        transform = np.array(
            [
                (np.exp(-1j * np.outer(u, x)) * np.cos(np.outer(w, y))) @ force
                for u, w in zip(along, across, strict=True)
            ]
        )
        expected = (np.abs(transform) ** 2 * loss * weight).sum()
        assert films.hysteresis[row] * BALL["normal_force"] == pytest.approx(expected, rel=0.008)
    assert (films.hysteresis > 0.015).all()


def test_dry_ball_with_little_loss_at_all_frequencies() -> None:
    # (6/π²) sin δ a/R, with a next order in tan δ; cells end at the edge of the contact or not: 1 %
    radius = BALL["sphere_radius"]
    for loss in (0.02, 0.05):
        material = constant_loss_solid(
            20e3, loss, angular_frequency=1.0, lowest_frequency=1e-3, highest_frequency=1e4
        )
        scales = passage_under_ball(material, 0.01, **BALL)
        grid = passing(point_grid(32, 10, 0.05, 8.0), scales)
        pressure = dry_pressure(grid)
        slope = scales.half_width / radius
        friction = slope / LOAD * pressure @ (grid.area * (grid.drag @ pressure))
        expected = 6 / np.pi**2 * np.sin(np.arctan(loss)) * slope
        assert friction == pytest.approx(expected, rel=0.012 + 0.3 * loss)


def reversed_passage(grid: PointGrid, scales: object) -> PointGrid:
    """A solid that passes the other way, wrong on purpose."""
    right = passing(grid, scales)
    cells = np.arange(grid.radius.size).reshape(-1, grid.rays)[:, ::-1].ravel()
    return right._replace(kernel=right.kernel[np.ix_(cells, cells)], centre=-right.centre)


def test_solids_that_pass_the_other_way_shift_the_curve_the_other_way() -> None:
    speed, viscosity = 0.02, np.array([0.1, 0.3])
    scales = passage_under_ball(STRONG, speed, **BALL)
    case = {"reduced_modulus": scales.modulus, "asperities": LAW, "cells": 160, **BALL}
    shares = [
        point_films_of(speed * viscosity, respond=respond, flow_factors=None, rheology=None, **case)[
            0
        ].asperity_load_fraction
        for respond in (None, partial(passing, scales=scales), partial(reversed_passage, scales=scales))
    ]
    elastic, viscoelastic, wrong = shares
    assert (viscoelastic > elastic + 0.04).all()
    assert (wrong < elastic).all()


def test_curve_of_a_ball() -> None:
    skin = ViscoelasticSkin(
        layer=ViscoelasticMaterial(equilibrium_modulus=7e6), bulk=ELASTIC, layer_thickness=20e-6
    )
    case = {"normal_force": 0.2, "sphere_radius": 8e-3, "spectrum": SURFACE, "frictional_shear_stress": 15e6}
    viscosity = np.array([0.1, 2.0, 300.0])
    found = viscoelastic_stribeck_curve(0.01, viscosity, skin=skin, contact="point", **case)
    expected = stribeck_curve(0.01 * viscosity, skin=WET, **case)
    for name in ("friction_coefficient", "boundary", "couette", "central_film", "strain"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-9)
    assert found.reasons() == expected.reasons()
    lossy = ViscoelasticSkin(layer=skin.layer, bulk=ZENER, layer_thickness=20e-6)
    pair = viscoelastic_stribeck_curve(
        [0.01, 1.0, -1.0], [1.0, 0.01, 1.0], skin=lossy, contact="point", **case
    )
    assert pair.hysteresis[0] > 5 * pair.hysteresis[1] > 0
    assert pair.impossible.tolist() == [False, False, True]
    total = pair.boundary + pair.couette + pair.pressure_flow + pair.hysteresis
    assert (pair.friction_coefficient[:2] == total[:2]).all()
    alone = viscoelastic_stribeck_curve(1.0, 0.01, skin=lossy, contact="point", **case)
    assert alone.friction_coefficient == total[1]
    with pytest.raises(InputError, match="contact is 'pad'"):
        viscoelastic_stribeck_curve(0.01, 1.0, skin=skin, contact="pad", **case)
    with pytest.raises(InputError, match="cells is 30"):
        viscoelastic_point_films(0.01, 1.0, material=ZENER, cells=30, **BALL)


@pytest.mark.slow
@pytest.mark.parametrize(("material", "error"), [(ZENER, 0.004), (STRONG, 0.007)])
def test_grid_refinement(material: ViscoelasticMaterial, error: float) -> None:
    coarse, fine = (
        viscoelastic_point_films(0.02, PRODUCT / 0.02, material=material, asperities=LAW, cells=cells, **BALL)
        for cells in (360, 1440)
    )
    friction = [
        1.447 * films.asperity_load_fraction + films.couette + films.pressure_flow for films in (coarse, fine)
    ]
    np.testing.assert_allclose(*friction, rtol=error)
    np.testing.assert_allclose(coarse.hysteresis, fine.hysteresis, rtol=0.018)
