"""One film at one speed: Newton steps with the active set of the cavitation condition.

Unknowns are the pressures P at the nodes and the approach H0. With ``H = H0 + X²/2 − K P`` and ``P_f = P − P_a(H)`` the
finite-volume residual is ``r = [λ S − T P_f′]`` at the right face minus that at the left one. In each cell either ``r = 0``
and P_f > 0, or ``P_f = 0`` and r ≥ 0: the cavity takes up what full film would lose. The load closes the system,
∫P dX = π/2, and counts the pressure before the grid.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.lubrication.grid import LineGrid

Law = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Pressure of the asperities and its slope, ``H -> (P_a, dP_a/dH)``, dimensionless."""

Transport = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray, FloatArray]]
"""``H -> (T, dT/dH, S, dS/dH)``: T multiplies the pressure gradient, S is the volume dragged along, dimensionless."""

LOAD = np.pi / 2
"""∫P dX."""

_TOLERANCE, _SMALLEST_FRACTION = 1e-6, 0.25
_TINY = 1e-14


class FilmState(NamedTuple):
    """Pressures P at the nodes, dimensionless, shape ``(N,)``, and the approach H0, dimensionless."""

    pressure: FloatArray
    approach: float


class Solver:
    """Newton iteration on one grid for one asperity law; keeps work arrays, otherwise without state.

    Liquid that is not ``endless`` has no pressure at the first node and none before.
    """

    # neither stiff nor far from Hertz; the active set may run in a circle from a guess far away
    starts = (1.0, 2.0, 0.5, 5.0, 0.1)

    def __init__(self, grid: LineGrid, law: Law, *, endless: bool = True) -> None:
        count = grid.position.size
        self.grid, self.law = grid, law
        self.parabola = np.square(grid.position) / 2
        # the kernel and its rows moved down and up, for the three diagonals of the film equation
        self._kernel = grid.kernel
        self._matrix = np.zeros((count + 1, count + 1), order="F")
        self._product = np.empty((count - 2, count), order="F")
        self._diagonal = np.arange(count)
        # fluid pressure before the first node, where H ≈ X²/2 and P_f′ = λ/H²: 4λ/(3|X|³), and the load it carries
        self._before, self._load_before = 4 / (3 * -(grid.position[0] ** 3)), 2 / (3 * grid.position[0] ** 2)
        if not endless:
            self._before = self._load_before = 0.0

    def guess(self, number: float, thick: float) -> FilmState:
        """A first guess: the pressure of Hertz on a thick film."""
        pressure = np.sqrt(np.maximum(1 - np.square(self.grid.position), 0.0))
        pressure *= LOAD / (self.grid.weight @ pressure)
        return FilmState(pressure, thick)

    def separation(self, state: FilmState) -> FloatArray:
        """H at the nodes, dimensionless."""
        return state.approach + self.parabola - self._kernel @ state.pressure

    def __call__(
        self, state: FilmState, number: float, transport: Transport, rounds: int
    ) -> tuple[FilmState, int]:
        """Film at the lubrication number λ, from a first guess; also the steps taken, −1 if it did not converge."""
        pressure, approach = state
        full_before = np.zeros(0, dtype=bool)
        for step in range(1, rounds + 1):
            film = approach + self.parabola - self._kernel @ pressure
            residual, full = self._assemble(pressure, film, number, transport)
            _, _, change, info = dgesv(self._matrix, -residual)
            if info != 0 or not np.isfinite(change[-1]):
                return state, -1
            rise = change[-1] - self._kernel @ change[:-1]
            relative = rise / np.maximum(film, _TINY)
            # films may fall to a quarter in one step; a film below zero at the start is left to rise
            fall = relative.min()
            fraction = (
                1.0 if fall > _SMALLEST_FRACTION - 1 or film.min() <= 0 else (_SMALLEST_FRACTION - 1) / fall
            )
            pressure, approach = pressure + fraction * change[:-1], approach + fraction * change[-1]
            if fraction == 1 and np.abs(relative).max() < _TOLERANCE and np.array_equal(full, full_before):
                return FilmState(pressure, float(approach)), step
            full_before = full
        return state, -1

    def _assemble(
        self, pressure: FloatArray, film: FloatArray, number: float, transport: Transport
    ) -> tuple[FloatArray, BoolArray]:
        """Fill the matrix; return the residual and the cells that are full of fluid."""
        grid, matrix, kernel = self.grid, self._matrix, self._kernel
        count = film.size
        asperities, stiffness = self.law(film)
        fluid = pressure - asperities
        # a film that is linear in a cell passes λ H̃ − H̃² H̄ P_f′ exactly, H̃ harmonic and H̄ arithmetic mean of its ends
        low, high = np.maximum(film[:-1], _TINY), np.maximum(film[1:], _TINY)
        mean = (low + high) / 2
        middle = low * high / mean
        conduct, conduct_slope, drag, drag_slope = transport(middle)
        excess = mean / middle
        gradient = (fluid[1:] - fluid[:-1]) / grid.spacing
        conductance = conduct * excess / grid.spacing
        flow = number * drag - conduct * excess * gradient
        turn = number * drag_slope - conduct_slope * excess * gradient
        pressure_flow = conduct * gradient / middle
        low_fraction, high_fraction = (
            np.square(middle / low) / 2,
            np.square(middle / high) / 2,
        )  # ∂H̃/∂H at the ends
        at_low = turn * low_fraction - pressure_flow * (0.5 - excess * low_fraction)
        at_high = turn * high_fraction - pressure_flow * (0.5 - excess * high_fraction)
        left, right = conductance[:-1], conductance[1:]
        scale = 1 / (left + right)
        imbalance = (flow[1:] - flow[:-1]) * scale
        full = fluid[1:-1] > imbalance
        residual = np.empty(count + 1)
        residual[:count] = fluid
        residual[1 : count - 1] = np.where(full, imbalance, fluid[1:-1])
        residual[0] -= number * self._before
        residual[count] = grid.weight @ pressure + number * self._load_before - LOAD

        scale *= full
        lower, upper = -left * scale, -right * scale  # of the derivative for P_f, whose diagonal is 1
        slope_left, slope_right = at_low[:-1] * scale, at_high[1:] * scale
        # dP_f = (1 + P_a′ K) dP − P_a′ dH0 and dH = −K dP + dH0; bands of (∂r/∂P_f) P_a′ − ∂r/∂H
        middle_band = stiffness.copy()
        middle_band[1:-1] -= (at_low[1:] - at_high[:-1]) * scale
        lower_band = lower * stiffness[:-2] + slope_left
        upper_band = upper * stiffness[2:] - slope_right
        block = matrix[:count, :count]
        np.multiply(kernel, middle_band[:, None], out=block)
        inner = block[1:-1]
        np.multiply(kernel[:-2], lower_band[:, None], out=self._product)
        inner += self._product
        np.multiply(kernel[2:], upper_band[:, None], out=self._product)
        inner += self._product
        places = self._diagonal
        block[places, places] += 1
        block[places[1:-1], places[:-2]] += lower
        block[places[1:-1], places[2:]] += upper
        matrix[:count, count] = -middle_band
        matrix[1 : count - 1, count] -= lower_band + upper_band
        matrix[count, :count] = grid.weight
        return residual, full
