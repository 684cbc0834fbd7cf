"""A lubricated sphere on a soft half-space in two dimensions: what the cylinder of Eq. 9 is held against.

Lengths along the surface are counted in the Hertz radius a, separations in a²/R, pressures in the Hertz maximum p_H. With
P = P_f + P_a(H), ρ the distance of two places and the flow towards positive x,

``H = H0 + r²/2 + (2/π²)∫P/ρ dA``, ``∫P dA = 2π/3``, ``div(H³ ∇P_f) = λ ∂H/∂x``, ``λ = 6 η v R²/(a³ p_H)``,

and P_f ≥ 0 where full film would pull. As in `skinbayes.lubrication.lubricated_films` the mean speed is v/2, the parabola goes on
without end and flow factors are trivial. Cells lie between rings and rays, because what changes fast does so
across the edge of the contact, r = 1; y and −y are alike. Pressures are constant in a cell, flows pass its faces.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse
from scipy.linalg import lapack
from scipy.optimize import brentq

from skinbayes.contact import sphere_contact
from skinbayes.lubrication import AsperityLaw

Law = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

LOAD = 2 * np.pi / 3
TOLERANCE = 1e-7  # of the films, in the last Newton step
TINY = 1e-14
DRY = 1e-12  # P_f of a cavity after rounding
STARTS, THICKER = (0.3, 1.0, 0.1, 3.0), (0.0, 1.0, 3.0)

# Far away P_f = λ f(ψ)/r³, ψ the angle from the inlet, f″ − 9f = −8 cos ψ. Film and gradient end together at BREAK.
BREAK = float(brentq(lambda psi: np.tan(psi) + 3 * np.tanh(3 * psi), 1.7, 2.5))
SMOOTH = float(-0.8 * np.cos(BREAK) / np.cosh(3 * BREAK))


class PolarGrid(NamedTuple):
    """Cells of the upper half plane, ring after ring, n in all, and the F faces between them.

    faces : radii of the rings' edges; rays : number of cells in a ring
    radius, angle : of the cells' middles, the flow comes from angle π, ``(n,)``
    area : of the cells with their mirror images, ``(n,)``
    kernel : separation at each cell by unit pressure in each cell and its mirror image, ``(n, n)``
    left, right : cells on both sides of each face; distance : between their middles, ``(F,)``
    width, width_along : of the faces, and the same times the x component of the normal, ``(F,)``
    rim : whether a cell lies in the last ring, where the pressure is that of the far inlet, ``(n,)``
    """

    faces: np.ndarray
    rays: int
    radius: np.ndarray
    angle: np.ndarray
    area: np.ndarray
    kernel: np.ndarray
    left: np.ndarray
    right: np.ndarray
    distance: np.ndarray
    width: np.ndarray
    width_along: np.ndarray
    rim: np.ndarray


class Film(NamedTuple):
    """Total pressure P, approach H0, Newton steps taken, and the largest flow lost in a full cell over λ max H."""

    pressure: np.ndarray
    approach: float
    steps: int = 0
    residual: float = np.inf


class SphereFilms(NamedTuple):
    """Films at K speeds, SI, named as in `skinbayes.lubrication.LubricatedFilms`; pressures and areas of n cells."""

    area: np.ndarray
    separation: np.ndarray
    fluid_pressure: np.ndarray
    asperity_pressure: np.ndarray
    asperity_load_fraction: np.ndarray
    couette: np.ndarray
    pressure_flow: np.ndarray
    minimum_film: np.ndarray
    central_film: np.ndarray
    lubrication_number: np.ndarray
    residual: np.ndarray


def polar_grid(rings: int, rays: int, edge: float, reach: float) -> PolarGrid:
    """Rings equally spaced in arsinh((r − 1)/edge) out to ``reach``, rays equally spaced from the outlet to the inlet."""
    faces = 1 + edge * np.sinh(np.linspace(-np.arcsinh(1 / edge), np.arcsinh((reach - 1) / edge), rings + 1))
    faces[0] = 0.0
    middle, step = (faces[1:] + faces[:-1]) / 2, np.pi / rays
    places = (np.arange(rays) + 0.5) * step
    sectors = sector_kernel(middle, faces, rays)
    apart = np.abs(np.subtract.outer(np.arange(rays), np.arange(rays)))
    mirrored = np.add.outer(np.arange(rays), np.arange(rays)) + 1
    kernel = sectors[:, :, apart] + sectors[:, :, np.minimum(mirrored, 2 * rays - mirrored)]
    index = np.arange(rings * rays).reshape(rings, rays)
    spacing, widths = np.diff(middle), np.diff(faces)
    outward = np.sin(places + step / 2) - np.sin(places - step / 2)  # ∫cos over a ray
    around = -np.sin(places[:-1] + step / 2)
    return PolarGrid(
        faces=faces,
        rays=rays,
        radius=np.repeat(middle, rays),
        angle=np.tile(places, rings),
        area=np.repeat(step * np.diff(np.square(faces)), rays),
        kernel=np.ascontiguousarray(kernel.transpose(0, 2, 1, 3).reshape(index.size, index.size)),
        left=np.concatenate([index[:-1].ravel(), index[:, :-1].ravel()]),
        right=np.concatenate([index[1:].ravel(), index[:, 1:].ravel()]),
        distance=np.concatenate([np.repeat(spacing, rays), np.repeat(middle * step, rays - 1)]),
        width=np.concatenate([np.repeat(faces[1:-1] * step, rays), np.repeat(widths, rays - 1)]),
        width_along=np.append(np.outer(faces[1:-1], outward), np.outer(widths, around)),
        rim=np.repeat(np.arange(rings) == rings - 1, rays),
    )


def sector_kernel(radius: np.ndarray, faces: np.ndarray, rays: int) -> np.ndarray:
    """(2/π²)∫dA/ρ over sectors between ``faces``, 0 to ``rays`` sectors away, seen from ``radius``.

    ``∫r′ dr′/ρ = ρ + r cosφ ln(r′ − r cosφ + ρ)`` is exact, the angle goes by Gauss's rule; in the sector of the place itself
    the logarithm is singular at φ = 0, and φ ∝ t⁴.
    """
    step = np.pi / rays
    nodes, weights = np.polynomial.legendre.leggauss(10)
    close, close_weights = np.polynomial.legendre.leggauss(48)
    close = (close + 1) / 2
    r, edge = radius[:, None, None], faces[None, :, None]
    result = np.empty((radius.size, radius.size, rays + 1))
    for away in range(rays + 1):
        angles, fractions = (away + nodes / 2) * step, weights * step / 2
        if away == 0:  # both halves alike
            angles, fractions = step / 2 * close**4, close_weights * step * 2 * close**3
        along, across = edge - r * np.cos(angles), r * np.sin(angles)
        distance = np.hypot(along, across)
        # before the place the sum cancels, where it is (r sinφ)² over the difference
        before = along < 0
        term = np.where(before, np.square(across) / np.where(before, distance - along, 1.0), along + distance)
        result[:, :, away] = np.diff(distance + r * np.cos(angles) * np.log(term), axis=1) @ fractions
    return 2 / np.pi**2 * result


def far_inlet(grid: PolarGrid) -> np.ndarray:
    """P_f r³/λ far from the contact, where H = r²/2."""
    psi = np.pi - grid.angle
    return np.where(psi < BREAK, 0.8 * np.cos(psi) + SMOOTH * np.cosh(3 * psi), 0.0)


def smooth(film: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.zeros_like(film), np.zeros_like(film)


class SphereSolver:
    """Newton's iteration with the active set of the cavitation condition, on one grid for one asperity law P_a(H)."""

    def __init__(self, grid: PolarGrid, law: Law = smooth) -> None:
        self.grid, self.law = grid, law
        ones, places = np.ones(grid.left.size), np.arange(grid.left.size)
        shape = (grid.left.size, grid.radius.size)
        self._at_left = sparse.csr_array((ones, (places, grid.left)), shape)
        self._at_right = sparse.csr_array((ones, (places, grid.right)), shape)
        self.balance = sparse.csr_array((self._at_left - self._at_right).T)  # flows to what leaves each cell
        far = far_inlet(grid)
        self._rim_pressure = np.where(grid.rim, far / grid.radius**3, 0.0)
        self._load_outside = 2 * np.pi / grid.rays * far[grid.rim].sum() / grid.faces[-1]

    def separation(self, state: Film) -> np.ndarray:
        """H of the cells."""
        return state.approach + np.square(self.grid.radius) / 2 + self.grid.kernel @ state.pressure

    def fluid(self, state: Film) -> np.ndarray:
        """P_f of the cells."""
        return state.pressure - self.law(self.separation(state))[0]

    def __call__(self, start: Film, number: float, rounds: int = 25) -> Film | None:
        """Film at the lubrication number λ from a first guess; None if the iteration does not settle."""
        grid, pressure, approach = self.grid, start.pressure, start.approach
        count, full_before = pressure.size, None
        for step in range(1, rounds + 1):
            film = self.separation(Film(pressure, approach))
            residual, local, distant, full, off = self._linearised(pressure, film, number)
            matrix = np.empty((count + 1, count + 1), order="F")
            matrix[:count, :count] = distant @ grid.kernel
            matrix[:count, :count] += local.toarray()
            matrix[:count, count] = distant.sum(axis=1)
            matrix[count, :count], matrix[count, count] = grid.area, 0.0
            *_, change, info = lapack.dgesv(matrix, -residual, overwrite_a=1)
            if info != 0 or not np.isfinite(change).all():
                return None
            relative = (change[-1] + grid.kernel @ change[:-1]) / np.maximum(film, TINY)
            fraction = 1.0 if film.min() <= 0 else min(1.0, -0.75 / min(relative.min(), -TINY))
            pressure, approach = pressure + fraction * change[:-1], float(approach + fraction * change[-1])
            if fraction == 1 and np.abs(relative).max() < TOLERANCE and np.array_equal(full, full_before):
                return Film(pressure, approach, step, off)
            full_before = full
        return None

    def flows(self, film: np.ndarray, fluid: np.ndarray, number: float) -> tuple[np.ndarray, ...]:
        """Flow through each face, its derivatives for H left and right, and the conductance of the face.

        Between two cells the film is taken as linear: λ H̃ n_x − H̃² H̄ ∂P_f/∂n, H̃ harmonic and H̄ arithmetic mean.
        """
        grid = self.grid
        low, high = (np.maximum(film[side], TINY) for side in (grid.left, grid.right))
        both = low + high
        conduct = 2 * np.square(low * high) / both * grid.width / grid.distance
        drag, push = number * grid.width_along, conduct * (fluid[grid.left] - fluid[grid.right])
        by_low = 2 * drag * np.square(high / both) + push * (low + 2 * high) / (low * both)
        by_high = 2 * drag * np.square(low / both) + push * (high + 2 * low) / (high * both)
        return 2 * drag * low * high / both + push, by_low, by_high, conduct

    def _linearised(self, pressure: np.ndarray, film: np.ndarray, number: float):
        """Residuals of cells and load, their derivatives for P at fixed H and for H, full cells, and the flow lost in them."""
        grid = self.grid
        carried, stiffness = self.law(film)
        fluid = pressure - carried
        flow, by_low, by_high, conduct = self.flows(film, fluid, number)
        scale = 1 / (np.abs(self.balance) @ conduct)
        lost = self.balance @ flow
        full = (fluid > lost * scale) & ~grid.rim
        residual = np.where(full, lost * scale, fluid - number * self._rim_pressure)
        load = grid.area @ pressure + number * self._load_outside - LOAD
        rows, others = sparse.diags_array(full * scale), sparse.diags_array(np.where(full, 0.0, 1.0))
        local = rows @ self.balance @ sparse.diags_array(conduct) @ self.balance.T + others
        distant = rows @ self.balance @ (
            sparse.diags_array(by_low) @ self._at_left + sparse.diags_array(by_high) @ self._at_right
        ) - local @ sparse.diags_array(stiffness)
        off = float(np.abs(lost[full]).max(initial=0.0) / (number * film[~grid.rim].max()))
        return np.append(residual, load), local, sparse.csr_array(distant), full, off

    def sweep(self, numbers: Sequence[float]) -> list[Film]:
        """Films at all λ: the first from the pressure of Hertz, from there up and down, in smaller steps where needed."""
        hertz = np.sqrt(np.maximum(1 - np.square(self.grid.radius), 0.0))
        guesses = [Film(hertz * LOAD / (self.grid.area @ hertz), thick) for thick in THICKER]
        attempts = ((number, self(guess, number, 100)) for number in STARTS for guess in guesses)
        first, begin = next((found for found in attempts if found[1] is not None), (np.nan, None))
        if begin is None:
            raise RuntimeError("no first film was found")
        films: dict[float, Film] = {}
        upward = sorted(numbers)
        for way in ([x for x in upward if x < first][::-1], [x for x in upward if x >= first]):
            trail = [(np.log(first), begin)]
            for number in way:
                self._follow(trail, float(np.log(number)))
                films[number] = trail[-1][1]
        return [films[number] for number in numbers]

    def _follow(self, trail: list[tuple[float, Film]], goal: float) -> None:
        """Extend the trail of (ln λ, film) to the goal."""
        target = goal
        while trail[-1][0] != goal:
            state = self(_extrapolated(trail, target), np.exp(target)) or self(trail[-1][1], np.exp(target))
            if state is None:
                target = (target + trail[-1][0]) / 2
                if abs(target - trail[-1][0]) < 1e-3:
                    raise RuntimeError(f"the film could not be followed to λ = {np.exp(goal):g}")
                continue
            trail.append((target, state))
            del trail[:-3]
            target = goal


def _extrapolated(trail: list[tuple[float, Film]], target: float) -> Film:
    """Polynomial through the last films against ln λ."""
    places = np.array([place for place, _ in trail])
    others = [np.delete(places, k) for k in range(places.size)]
    fractions = [
        np.prod((target - rest) / (place - rest)) for place, rest in zip(places, others, strict=True)
    ]
    pressure = sum(fraction * film.pressure for fraction, (_, film) in zip(fractions, trail, strict=True))
    approach = sum(fraction * film.approach for fraction, (_, film) in zip(fractions, trail, strict=True))
    return Film(np.asarray(pressure), float(approach))


def drag_integrals(solver: SphereSolver, state: Film, number: float, cut: float) -> tuple[float, float]:
    """∫θ/H dA and ∫H ∂P_f/∂x dA within r < ``cut``; without end both would grow as the logarithm of the radius.

    In the cavity the liquid that passed the break at the same y fills the fraction θ = H_c/H of the width.
    """
    grid, film, fluid = solver.grid, solver.separation(state), solver.fluid(state)
    wet = fluid > DRY
    inside = np.repeat(np.diff(np.minimum(grid.faces, cut) ** 2) / np.diff(grid.faces**2), grid.rays)
    y = grid.radius * np.sin(grid.angle)
    breaks = wet[grid.left] != wet[grid.right]
    filled = np.ones_like(film)
    if breaks.any():
        at, height = ((z[grid.left] + z[grid.right])[breaks] / 2 for z in (y, film))
        order = np.argsort(at)
        passed = np.interp(y, at[order], height[order])
        filled = np.where(wet, 1.0, np.minimum(1.0, passed / film))
    couette = (filled / film * grid.area * inside).sum()

    # ∫H dP_f between two cells, exact for a linear film and the flow that passes: see `skinbayes.lubrication.drag`
    low, high = film[grid.left], film[grid.right]
    both = low + high
    uneven = np.maximum(np.abs(high - low) / both, 1e-4)
    push = number * grid.width_along / grid.width * grid.distance * 2 / both
    climb = 2 * low * high / both * (fluid[grid.right] - fluid[grid.left])
    climb += np.where(wet[grid.left] | wet[grid.right], push * (np.arctanh(uneven) / uneven - 1), 0.0)
    fraction = (inside[grid.left] + inside[grid.right]) / 2
    return float(couette), float(2 * (climb * grid.width_along * fraction).sum())


def lubricated_sphere(
    speed_viscosity_product: np.ndarray,
    sphere_radius: float,
    normal_force: float,
    reduced_modulus: float,
    asperities: AsperityLaw | None,
    grid: PolarGrid,
) -> SphereFilms:
    """Films under a ball at several ηv; shear stress and pressure flow are counted up to the edge of the ball, r = R."""
    product = np.asarray(speed_viscosity_product, dtype=np.float64)
    hertz = sphere_contact(normal_force, sphere_radius, reduced_modulus=reduced_modulus)
    a, peak = float(hertz.contact_radius), float(hertz.maximum_pressure)
    height, slope = a * a / sphere_radius, a / sphere_radius
    number = 6 * product * sphere_radius**2 / (a**3 * peak)
    solver = SphereSolver(grid, smooth if asperities is None else asperities.scaled(height, peak))
    states = solver.sweep(list(number))
    film = np.array([solver.separation(state) for state in states])
    fluid = np.array([solver.fluid(state) for state in states])
    carried = np.array([state.pressure for state in states]) - fluid
    parts = np.array(
        [drag_integrals(solver, state, x, 1 / slope) for state, x in zip(states, number, strict=True)]
    )
    return SphereFilms(
        area=grid.area * a * a,
        separation=film * height,
        fluid_pressure=fluid * peak,
        asperity_pressure=carried * peak,
        asperity_load_fraction=carried @ grid.area / LOAD,
        couette=number * slope / (4 * np.pi) * parts[:, 0],
        pressure_flow=3 * slope / (4 * np.pi) * parts[:, 1],
        minimum_film=film.min(axis=1) * height,
        central_film=film[:, : grid.rays].mean(axis=1) * height,
        lubrication_number=number,
        residual=np.array([state.residual for state in states]),
    )
