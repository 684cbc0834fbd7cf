"""Deflection of the half-space under a line pressure, and the Newton iteration with its Jacobian and active set."""

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.lubrication.grid import line_grid, log_kernel
from skinbayes.lubrication.newton import LOAD, FilmState, Solver


def smooth(film):
    return film**3, 3 * film**2, film, np.ones_like(film)


def decaying(film):
    pressure = 0.8 * np.exp(-film / 0.02)
    return pressure, -pressure / 0.02


@pytest.fixture(scope="module")
def grid():
    return line_grid(8.0, 3.0, 80, 0.1)


def hertz_guess(grid):
    pressure = np.sqrt(np.maximum(1 - grid.position**2, 0.0))
    return FilmState(pressure * LOAD / (grid.weight @ pressure), 1.5)


def test_kernel_integrates_hat_functions_exactly():
    nodes = np.array([-2.0, -1.5, -0.2, 0.0, 0.7, 3.0])
    kernel = log_kernel(nodes)
    for i, x in enumerate(nodes):
        for j in range(nodes.size):
            hat = np.eye(nodes.size)[j]
            exact = quad(
                lambda s, h=hat, at=x: np.interp(s, nodes, h) * np.log(abs(at - s)),
                -2, 3, points=np.unique([*nodes[1:-1], x]), epsabs=1e-10, limit=400,
            )[0]  # fmt: skip
            assert kernel[i, j] == pytest.approx(exact / np.pi, abs=1e-8)


@pytest.mark.parametrize(("count", "tolerance"), [(101, 2e-3), (401, 2e-4)])
def test_hertz_pressure_flattens_the_parabola(count, tolerance):
    grid = line_grid(3.0, 3.0, count, 0.05)
    pressure = np.sqrt(np.maximum(1 - grid.position**2, 0.0))
    gap = grid.position**2 / 2 - grid.kernel @ pressure
    inside = np.abs(grid.position) < 0.98
    assert np.ptp(gap[inside]) < tolerance
    # outside, the gap of Hertz's line contact: [X√(X² − 1) − ln(X + √(X² − 1))]/2
    x = np.abs(grid.position[~inside & (np.abs(grid.position) > 1.1)])
    root = np.sqrt(x**2 - 1)
    opened = gap[np.abs(grid.position) > 1.1] - gap[inside].mean()
    np.testing.assert_allclose(opened, (x * root - np.log(x + root)) / 2, atol=2 * tolerance)


def test_grid_is_graded_about_both_edges(grid):
    assert grid.position[[0, -1]].tolist() == [-8.0, 3.0]
    assert np.all(grid.spacing > 0)
    for edge in (-1.0, 1.0):
        near = np.argmin(np.abs(grid.position - edge))
        assert grid.spacing[near] < 0.2 * grid.spacing.max()
    assert grid.weight.sum() == pytest.approx(11.0, rel=1e-14)
    # neighbouring cells differ little: the scheme keeps its order
    assert np.abs(np.diff(np.log(grid.spacing))).max() < 0.4


@pytest.mark.parametrize("law", [decaying, lambda film: (0 * film, 0 * film)])
def test_jacobian_is_the_derivative_of_the_residual(grid, law):
    solver = Solver(grid, law)
    state, _ = solver(hertz_guess(grid), 0.01, smooth, 200)
    rng = np.random.default_rng(3)
    pressure = state.pressure * (1 + 1e-3 * rng.standard_normal(grid.position.size))
    unknown = np.append(pressure, state.approach)

    def residual(values):
        film = values[-1] + solver.parabola - grid.kernel @ values[:-1]
        return solver._assemble(values[:-1], film, 0.01, smooth)

    _, full = residual(unknown)
    matrix = solver._matrix.copy()
    # rows are scaled by conductances that depend on the film: compare with the scale held, i.e. where the residual is small
    direction = rng.standard_normal(unknown.size) * np.append(np.maximum(state.pressure, 0.01), 0.01)
    step = 1e-7
    base, forward = residual(unknown)[0], residual(unknown + step * direction)
    backward = residual(unknown - step * direction)
    assert np.array_equal(forward[1], full)
    assert np.array_equal(backward[1], full)
    numeric = (forward[0] - backward[0]) / (2 * step)
    exact = matrix @ direction
    allowed = 1e-5 * np.abs(exact).max() + 30 * np.abs(base) * np.abs(direction).max() / 0.01
    assert np.all(np.abs(numeric - exact) < allowed)


@pytest.mark.parametrize("number", [1e-4, 1e-2, 1.0, 20.0])
@pytest.mark.parametrize("law", [decaying, lambda film: (0 * film, 0 * film)])
def test_solution_balances_load_and_mass_and_cavitates(grid, number, law):
    solver = Solver(grid, law)
    state = hertz_guess(grid)
    for step in np.geomspace(1.0, number, 13):
        state, rounds = solver(state, step, smooth, 400)
        assert rounds > 0
    film = solver.separation(state)
    fluid = state.pressure - law(film)[0]
    # the fluid before the first node, at X = −8, carries 2λ/(3X²)
    assert grid.weight @ state.pressure + 2 * number / (3 * 8.0**2) == pytest.approx(LOAD, rel=1e-12)
    assert film.min() > 0
    assert fluid.min() > -1e-9
    low, high = film[:-1], film[1:]
    mean = (low + high) / 2
    harmonic = low * high / mean
    flow = number * harmonic - harmonic**2 * mean * np.diff(fluid) / grid.spacing
    full = fluid[1:-1] > 1e-10
    loss = np.diff(flow)
    # the same volume passes all cells that are full, and the cavity takes up what it is offered
    assert np.abs(loss[full]).max() < 1e-8 * number * film.min() + 1e-12 * np.abs(flow).max()
    assert loss[~full].min() > -1e-9 * number
    assert not full[grid.position[1:-1] > 2.5].any() or number > 5
    # one inlet, one cavity: the fluid's part is connected
    assert np.count_nonzero(np.diff(full.astype(int))) <= 2


def test_without_answer_the_guess_comes_back(grid):
    solver = Solver(grid, decaying)
    guess = hertz_guess(grid)
    state, rounds = solver(guess, 1.0, smooth, 2)
    assert rounds == -1
    assert state is guess
