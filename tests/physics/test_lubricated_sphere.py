"""A sphere solved in two dimensions, and the cylinder of Eq. 9 against it (Fig. 11 of the paper, and skin)."""

from math import pi

import numpy as np
import pytest
from named_fields import surface_from
from scipy.special import ellipe, ellipk

from skinbayes.contact import (
    LayeredSkin,
    sphere_contact,
)
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    ShearThinning,
    TrivialFlowFactors,
    asperity_law,
    lubricated_point_films,
)
from skinbayes.lubrication.newton import FilmState
from skinbayes.lubrication.point_drag import point_drag_integrals
from skinbayes.lubrication.point_grid import PointGrid, far_inlet, point_grid, sector_kernel
from skinbayes.lubrication.point_newton import LOAD, PointSolver
from skinbayes.lubrication.sweep import sweep
from skinbayes.lubrication.transport import no_asperities, transport_of
from skinbayes.roughness import named_surface

GLASS_BALL = (8e-3, 0.2, 20e3 / 0.75)
PAPER_SKIN = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
FIGURE_11_BALL = (1e-2, 1.3, 1.6e6)


SMOOTH = transport_of(None, None, 1.0, 1.0)


def film_at(solver, number):
    """The film of smooth flow at one λ."""
    (state,), _ = sweep(np.array([number]), solver, SMOOTH, (0.0, 1.0, 3.0))
    assert state is not None
    return state


def hertz_deflection(r):
    """Separation by the pressure √(1 − r²), in the units of the solver."""
    far = np.maximum(r, 1)
    outside = ((2 - far**2) * np.arcsin(1 / far) + np.sqrt(far**2 - 1)) / pi
    return np.where(r < 1, 1 - r**2 / 2, outside)


def test_kernel_of_a_uniform_disk():
    faces = np.array([0.0, 0.2, 0.5, 1.0, 1.02, 4.0])
    r = np.array([0.05, 0.4, 0.99, 1.01, 3.0])
    sectors = sector_kernel(r, faces, 7)
    disk = 2 * sectors[:, :3, 1:-1].sum(axis=(1, 2)) + sectors[:, :3, [0, -1]].sum(axis=(1, 2))
    inside, outside = np.minimum(r, 1 - 1e-9) ** 2, np.minimum(1 / r, 1 - 1e-9) ** 2
    exact = np.where(r < 1, ellipe(inside), r * (ellipe(outside) - (1 - outside) * ellipk(outside)))
    np.testing.assert_allclose(disk, 8 / pi**2 * exact, rtol=1e-10)


def test_deflection_of_hertz():
    off = []
    for rings, rays in ((24, 12), (48, 24)):
        grid = point_grid(rings, rays, 0.1, 20.0)
        pressure = np.sqrt(np.maximum(1 - grid.radius**2, 0))
        off.append(np.abs(grid.kernel @ pressure - hertz_deflection(grid.radius)).max())
    assert off[1] < 1.5e-3
    assert off[1] < off[0] / 3.5


def test_flow_of_a_rigid_sphere_balances():
    # full film: P = −λ x/(5 H²) solves the film equation of a parabola
    off = []
    for rings, rays in ((20, 12), (40, 24)):
        grid = point_grid(rings, rays, 1.0, 20.0)
        solver = PointSolver(grid, no_asperities)
        film = 1 + grid.radius**2 / 2
        lost = (
            solver.balance
            @ solver.flows(film, -grid.radius * np.cos(grid.angle) / (5 * film**2), 1.0, SMOOTH(1.0))[0]
        )
        wedge = np.abs(grid.radius * np.cos(grid.angle)) * grid.area / 2
        off.append(np.abs(lost[~grid.rim]).sum() / wedge[~grid.rim].sum())
    assert off[1] < 0.006
    assert off[1] < off[0] / 2.5


def test_thick_films_are_those_of_a_rigid_sphere():
    # Brewe, Hamrock & Taylor, J. Lubr. Technol. 101 (1979) 231: h/R = 128 [φ 1.744 η u R/F]², φ = 3/5, u the mean speed.
    # With the pressure −λ x/(5 H²) of the full film before the middle and none behind it, h/R = (4.8π η u R/F)²/2 and
    # h = (3λ/5)²/2 in the units of the solver
    number = 100.0
    halved = (0.6 * number) ** 2 / 2
    wanted = halved * 128 * (0.6 * (0.131 * np.arctan(0.5) + 1.683)) ** 2 / ((4.8 * pi) ** 2 / 2)
    width = np.sqrt(2 * wanted)
    grid = point_grid(40, 24, 0.5 * width, 60 * width)
    guess = np.maximum(
        -0.2 * number * grid.radius * np.cos(grid.angle) / (wanted + grid.radius**2 / 2) ** 2, 0
    )
    solver = PointSolver(grid, no_asperities)
    state, steps = solver(FilmState(guess, wanted), number, SMOOTH(number), 60)
    assert steps > 0
    assert solver.separation(state).min() == pytest.approx(wanted, rel=0.02)


def test_stiff_asperities_carry_like_a_dry_contact():
    grid = point_grid(32, 8, 0.05, 20.0)

    def law(film):
        pressure = np.exp(np.minimum((0.02 - film) / 1e-3, 50.0))
        return pressure, -pressure / 1e-3

    solver = PointSolver(grid, law)
    state = film_at(solver, 1e-6)
    hertz = np.sqrt(np.maximum(1 - grid.radius**2, 0))
    assert np.abs(state.pressure - hertz)[np.abs(grid.radius - 1) > 0.05].max() < 0.02
    assert grid.area @ state.pressure == pytest.approx(LOAD, rel=1e-6)
    assert grid.area @ law(solver.separation(state))[0] == pytest.approx(LOAD, rel=1e-3)


@pytest.fixture(scope="module")
def rough_film():
    """One mixed film of skin: solver, state, λ."""
    radius, force, modulus = GLASS_BALL
    hertz = sphere_contact(force, radius, reduced_modulus=modulus)
    law = asperity_law(named_surface("paper_reference"), PAPER_SKIN)
    scaled = law.scaled(float(hertz.contact_radius**2 / radius), float(hertz.maximum_pressure))
    solver = PointSolver(point_grid(36, 20, 0.06, 20.0), scaled)
    return solver, film_at(solver, 0.02), 0.02


def test_film_conserves_what_it_should(rough_film):
    solver, state, number = rough_film
    grid, film, fluid = solver.grid, solver.separation(state), solver.fluid(state)
    lost = solver.balance @ solver.flows(film, fluid, number, SMOOTH(number))[0]
    full = (fluid > 1e-12) & ~grid.rim
    assert np.abs(lost[full]).max() < 1e-8 * number
    # the cavity opens: flow that full film would lack, never a surplus
    assert fluid.min() > -1e-12
    assert lost[~full & ~grid.rim].min() > -1e-12
    assert grid.area @ state.pressure == pytest.approx(LOAD, rel=2e-3)  # the rest lies beyond the last ring


def test_pressure_flow_is_the_moment_of_the_load(rough_film):
    # elastic solids and asperities do no work: ∫H ∂P_f/∂x dA = −∫P x dA, but for the far inlet
    solver, state, number = rough_film
    grid, x = solver.grid, solver.grid.radius * np.cos(solver.grid.angle)
    inner = (grid.radius**2 - grid.faces[-2] ** 2) / np.diff(
        grid.faces[-2:] ** 2
    )  # flows end in the middle of the rim
    moment = -(state.pressure * x * grid.area * np.where(grid.rim, inner, 1.0)).sum()
    border = number * pi / grid.rays * (far_inlet(grid.angle) * np.cos(grid.angle))[grid.rim].sum()
    _, found = point_drag_integrals(
        grid, solver.separation(state)[None], solver.fluid(state)[None], np.array([number]),
        end=grid.faces[-1], height=1.0,
    )  # fmt: skip
    assert found[0] == pytest.approx(moment + border, rel=0.02)


def films_of_ball(products, ball, law=None, cells=360):
    radius, force, modulus = ball
    return lubricated_point_films(
        products,
        normal_force=force,
        sphere_radius=radius,
        reduced_modulus=modulus,
        asperities=law,
        cells=cells,
    )


def test_smooth_films_and_friction_are_those_of_the_regressions():
    radius, force, modulus = FIGURE_11_BALL
    products = np.array([1e-3, 1e-2, 1e-1])
    found = films_of_ball(products, FIGURE_11_BALL)
    speed, load = products / 2 / (2 * modulus * radius), force / (2 * modulus * radius**2)
    # Hamrock & Dowson, J. Lubr. Technol. 100 (1978) 236; the smallest film lies in two lobes beside the middle
    lowest = 7.43 * (1 - 0.85 * np.exp(-0.31)) * speed**0.65 * load**-0.21 * radius
    np.testing.assert_allclose(found.minimum_film, lowest, rtol=0.15)
    # Nijenbanning, Venner & Moes, Wear 176 (1994) 217: from rigid to elastic
    moes = load * (2 * speed) ** -0.75
    rigid = 145 * 1.796 ** (-15 / 7) * moes**-2.0
    elastic = 3.18 * 1.63 ** (-14 / 25) * moes ** (-2 / 15)
    power = 1.5 * (1 + np.exp(-1.2 * elastic / rigid))
    bridge = (elastic**-4 + 1.8**-4) ** (-3 * power / 8)
    central = (rigid ** (1.5 * power) + bridge) ** (2 / (3 * power)) * np.sqrt(2 * speed) * radius
    np.testing.assert_allclose(found.central_film, central, rtol=0.10)
    # de Vicente, Stokes & Spikes, Tribol. Lett. 20 (2005) 273, slide-roll ratio 2
    couette = 2 * (3.8 * speed**0.71 * load**-0.76 + 0.96 * speed**0.36 * load**-0.11)
    np.testing.assert_allclose(found.couette, couette, rtol=0.15)
    rolling = 1.46 * speed**0.65 * load**-0.70
    np.testing.assert_allclose(found.pressure_flow[1:], rolling[1:], rtol=0.25)


class TwiceAsOpen(TrivialFlowFactors):
    """φ_p = 2: the pressure gradient drives twice the flow."""

    def flow(self, separation):
        _, *others = super().flow(separation)
        return 2 * np.ones_like(separation), *others


def test_factors_that_are_constant_are_another_viscosity():
    # div(2 H³ ∇P) = λ ∂H/∂x is the film of λ/2; a liquid that thins to a half at all rates is thinner
    # far out the pressure is that of the inlet at the full viscosity: a difference that dies away with the distance
    grid, number, per_product = point_grid(18, 6, 0.1, 200.0), 0.1, 7.0
    oil = ShearThinning(1.0, scale=1.0, exponent=0.0)

    def film_and_drag(number, factors, rheology):
        transport = transport_of(factors, rheology, 1e-3, per_product)
        solver = PointSolver(grid, no_asperities)
        (state,), _ = sweep(np.array([number]), solver, transport, (0.0, 1.0))
        film, fluid = solver.separation(state)[None], solver.fluid(state)[None]
        drag = point_drag_integrals(
            grid, film, fluid, np.array([number]), end=3.0, height=1e-3, flow_factors=factors, rheology=rheology,
            speed=np.array([number / per_product]),
        )  # fmt: skip
        return film[0][grid.radius < 2], drag

    film, plain = film_and_drag(number, None, None)
    opened, drag = film_and_drag(2 * number, TwiceAsOpen(), None)
    np.testing.assert_allclose(opened, film, rtol=3e-3)
    np.testing.assert_allclose(drag.couette, plain.couette, rtol=3e-3)
    thinned, drag = film_and_drag(2 * number, None, oil)
    np.testing.assert_allclose(thinned, film, rtol=3e-3)
    np.testing.assert_allclose(drag.couette, plain.couette / 2, rtol=3e-3)
    np.testing.assert_allclose(drag.pressure_flow, plain.pressure_flow, rtol=3e-3)


def test_a_rough_film_does_not_depend_on_the_speeds_it_is_asked_with():
    """Thin film on fine roughness near the minimum of friction: asperities press in a seam at the exit that needs fine rings."""
    skin = LayeredSkin(young_modulus_layer=8.5e6, young_modulus_bulk=33e3, layer_thickness=173e-6)
    fine = surface_from((9e-6, 0.78, 1e3, 6.345e3, 1e9))
    law = asperity_law(fine, skin)
    one, several, many = (
        films_of_ball(products, (1e-2, 1.75, 33e3 / 0.75), law, cells).asperity_load_fraction[-1]
        for products, cells in (([0.0165], 300), ([1e-4, 0.0165], 300), ([0.0165], 1000))
    )
    assert one == pytest.approx(several, rel=1e-6)
    assert one == pytest.approx(many, rel=0.015)


def test_impossible_films_are_nan_alone():
    radius, force, modulus = GLASS_BALL
    ball = {"sphere_radius": radius, "reduced_modulus": modulus, "cells": 60}
    found = lubricated_point_films([-1.0, 1e-1, np.nan, 1e9], normal_force=force, **ball)
    assert np.isfinite(found.couette).tolist() == [False, True, False, False]
    alone = lubricated_point_films([1e-1], normal_force=force, **ball)
    assert found.couette[1] == alone.couette[0]
    assert np.isnan(lubricated_point_films([1e-1], normal_force=-1.0, **ball).couette).all()
    with pytest.raises(InputError, match="40"):
        lubricated_point_films([1e-1], normal_force=force, **(ball | {"cells": 10}))


def rectangles(finest, end):
    """Cells between lines, equally spaced to 1.25 and stretched to ``end``, with the deflections of Love's formula."""
    lines, step = [0.0], finest
    while lines[-1] < end:
        step *= 1.18 if lines[-1] > 1.25 else 1.0
        lines.append(lines[-1] + step)
    beside = np.array(lines)
    along = np.append(-beside[:0:-1], beside)
    middle, aside = (along[1:] + along[:-1]) / 2, (beside[1:] + beside[:-1]) / 2
    x, y = (z.ravel() for z in np.meshgrid(middle, aside, indexing="ij"))

    def love(edges):
        p, q = along[:, None] - x[:, None, None], edges - y[:, None, None]
        corner = p * np.arcsinh(q / np.abs(p)) + q * np.arcsinh(p / np.abs(q))
        return 2 / pi**2 * np.diff(np.diff(corner, axis=1), axis=2)

    kernel = love(beside) + love(-beside[::-1])[:, :, ::-1]
    shape = middle.size, aside.size
    index = np.arange(x.size).reshape(shape)
    wide, high = np.diff(along), np.diff(beside)
    walls, floors = np.tile(high, shape[0] - 1), np.repeat(wide, shape[1] - 1)
    rim = np.ones(shape, dtype=bool)
    rim[1:-1, :-1] = False
    return PointGrid(
        faces=np.array([0.0, end]),
        rays=int(rim.sum()),
        radius=np.hypot(x, y),
        angle=np.arctan2(y, x),
        area=2 * np.outer(wide, high).ravel(),
        kernel=kernel.reshape(x.size, x.size),
        left=np.append(index[:-1], index[:, :-1]),
        right=np.append(index[1:], index[:, 1:]),
        distance=np.append(np.repeat(np.diff(middle), shape[1]), np.tile(np.diff(aside), shape[0])),
        width=np.append(walls, floors),
        width_along=np.append(walls, np.zeros(floors.size)),
        rim=rim.ravel(),
    )


@pytest.mark.slow
def test_rings_and_rectangles_agree(rough_film):
    fine, state, number = rough_film

    def summary(solver, film):
        """Fraction of the load that asperities carry, ∫dA/H and the load's moment over the contact."""
        grid, h = solver.grid, solver.separation(film)
        near = grid.area * (grid.radius < 1)
        carried = grid.area @ solver.law(h)[0] / LOAD
        return np.array([carried, near @ (1 / h), near @ film.pressure])

    found = []
    for finest in (0.125, 0.0625 * 1.25):
        solver = PointSolver(rectangles(finest, 8.0), fine.law)
        found.append(summary(solver, film_at(solver, number)))
    # errors go as the square of the cells' width
    square = (0.125 / (0.0625 * 1.25)) ** 2
    extrapolated = (square * found[1] - found[0]) / (square - 1)
    rings = summary(fine, state)
    print(found, extrapolated, rings)
    np.testing.assert_allclose(extrapolated, rings, rtol=0.02)
