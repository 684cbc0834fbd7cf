"""One film under a ball at one speed: Newton steps with the active set of the cavitation condition, in two dimensions.

Unknowns are the pressures P of the cells and the approach H0. With ``H = H0 + r²/2 + K P`` and ``P_f = P − P_a(H)`` the
finite-volume residual of a cell is what flows out of it, ``Σ [λ S n_x − T ∂P_f/∂n] width``. In each cell either it is 0 and
P_f > 0, or P_f = 0 and it is ≥ 0. The load closes the system, ∫P dA = 2π/3, and counts the pressure beyond the grid.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.linalg import lapack

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.lubrication.newton import FilmState, Law, Transport
from skinbayes.lubrication.point_grid import PointGrid, far_inlet

LOAD = 2 * np.pi / 3
"""∫P dA."""

# of the films, in the last step: with the active set of the step before, where the error left is the square, and without
_TOLERANCE, _TIGHT = 1e-4, 1e-6
_SMALLEST_FRACTION = 0.25
_BELOW_ZERO = 6  # steps after which a film that is still below zero somewhere is given up
_TINY = 1e-14
_WIDE = 2.0  # λ beyond which the ball is taken as rigid in a first guess


class PointSolver:
    """Newton iteration on one grid for one asperity law; keeps work arrays, otherwise without state.

    ``smallest`` is the smallest λ that is wanted. Liquid that is not ``endless`` has no pressure in the rim and none beyond.
    """

    def __init__(self, grid: PointGrid, law: Law, smallest: float = 0.0, *, endless: bool = True) -> None:
        self.grid, self.law = grid, law
        # where liquid ends, films are no wider than that: the slow ones lead to the fast ones
        wide = endless and smallest > _WIDE
        self.starts = (smallest, 2 * smallest, 4 * smallest) if wide else (0.3, 1.0, 0.1, 3.0)
        faces, cells = grid.left.size, grid.radius.size
        ones, places = np.ones(faces), np.arange(faces)
        at_left = sparse.csr_array((ones, (places, grid.left)), (faces, cells))
        at_right = sparse.csr_array((ones, (places, grid.right)), (faces, cells))
        self.balance = sparse.csr_array((at_left - at_right).T)  # flows to what leaves each cell
        self._touching = sparse.csr_array((at_left + at_right).T)
        far = far_inlet(grid.angle) if endless else np.zeros(grid.angle.size)
        self._rim_pressure = np.where(grid.rim, far / grid.radius**3, 0.0)
        self._load_outside = 2 * np.pi / grid.rays * far[grid.rim].sum() / grid.faces[-1]
        self._parabola = grid.parabola
        self._matrix = np.empty((cells + 1, cells + 1), order="F")
        # entries of a sparse matrix: diagonal, from left to right, from right to left
        self._rows = np.concatenate([np.arange(cells), grid.left, grid.right])
        self._columns = np.concatenate([np.arange(cells), grid.right, grid.left])
        self._order = np.lexsort((self._columns, self._rows))
        begin = np.searchsorted(self._rows[self._order], np.arange(cells + 1))
        entries = np.zeros(self._rows.size), self._columns[self._order], begin
        self._distant = sparse.csr_array(entries, (cells, cells))

    def guess(self, number: float, thick: float) -> FilmState:
        """A first guess: the pressure of Hertz, or that of a rigid ball, whose film is wider than the contact."""
        grid = self.grid
        if number <= _WIDE:
            pressure, approach = np.sqrt(np.maximum(1 - np.square(grid.radius), 0.0)), thick
        else:
            approach = 0.18 * number**2 + thick
            pressure = np.maximum(-grid.radius * np.cos(grid.angle), 0.0) / (approach + self._parabola) ** 2
        return FilmState(pressure * (LOAD / (grid.area @ pressure)), float(approach))

    def separation(self, state: FilmState) -> FloatArray:
        """H of the cells, dimensionless."""
        return state.approach + self._parabola + self.grid.kernel @ state.pressure

    def fluid(self, state: FilmState) -> FloatArray:
        """P_f of the cells, dimensionless."""
        return np.asarray(state.pressure - self.law(self.separation(state))[0])

    def __call__(
        self, state: FilmState, number: float, transport: Transport, rounds: int
    ) -> tuple[FilmState, int]:
        """Film at the lubrication number λ, from a first guess; also the steps taken, −1 if it did not converge."""
        pressure, approach = state
        kernel = self.grid.kernel
        full_before = np.zeros(0, dtype=bool)
        for step in range(1, rounds + 1):
            film = self.separation(FilmState(pressure, approach))
            residual, full = self._assemble(pressure, film, number, transport)
            _, _, change, info = lapack.dgesv(self._matrix, -residual, overwrite_a=1)
            if info != 0 or not np.isfinite(change).all():
                return state, -1
            relative = (change[-1] + kernel @ change[:-1]) / np.maximum(film, _TINY)
            # films may fall to a quarter in one step; a film below zero at the start is left to rise
            fall = relative.min()
            fraction = (
                1.0 if fall > _SMALLEST_FRACTION - 1 or film.min() <= 0 else (_SMALLEST_FRACTION - 1) / fall
            )
            pressure, approach = pressure + fraction * change[:-1], approach + fraction * change[-1]
            moved = np.abs(relative).max()
            settled = moved < _TOLERANCE and np.array_equal(full, full_before)
            if fraction == 1 and (settled or moved < _TIGHT):
                return FilmState(pressure, float(approach)), step
            if step > _BELOW_ZERO and film.min() <= 0:
                return state, -1
            full_before = full
        return state, -1

    def flows(
        self, film: FloatArray, fluid: FloatArray, number: float, transport: Transport
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Flow through each face, its derivatives for H on the left and right, and the conductance of the face.

        Between two cells the film is taken as linear: λ S(H̃) n_x − T(H̃) H̄/H̃ ∂P_f/∂n, H̃ harmonic and H̄ arithmetic mean.
        """
        grid = self.grid
        low, high = np.maximum(film[grid.left], _TINY), np.maximum(film[grid.right], _TINY)
        mean = (low + high) / 2
        middle = low * high / mean
        conduct, conduct_slope, drag, drag_slope = transport(middle)
        excess = mean / middle
        rise = (fluid[grid.right] - fluid[grid.left]) * (grid.width / grid.distance)
        along = number * grid.width_along
        turn = along * drag_slope - conduct_slope * excess * rise
        pressure_flow = conduct * rise / middle
        low_fraction, high_fraction = np.square(middle / low) / 2, np.square(middle / high) / 2  # ∂H̃/∂H
        return (
            along * drag - conduct * excess * rise,
            turn * low_fraction - pressure_flow * (0.5 - excess * low_fraction),
            turn * high_fraction - pressure_flow * (0.5 - excess * high_fraction),
            conduct * excess * (grid.width / grid.distance),
        )

    def _assemble(
        self, pressure: FloatArray, film: FloatArray, number: float, transport: Transport
    ) -> tuple[FloatArray, BoolArray]:
        """Fill the matrix; return the residual and the cells that are full of fluid."""
        grid, matrix = self.grid, self._matrix
        count = film.size
        carried, stiffness = self.law(film)
        fluid = pressure - carried
        flow, by_left, by_right, conduct = self.flows(film, fluid, number, transport)
        scale = 1 / (self._touching @ conduct)
        lost = (self.balance @ flow) * scale
        full = (fluid > lost) & ~grid.rim
        residual = np.empty(count + 1)
        residual[:count] = np.where(full, lost, fluid - number * self._rim_pressure)
        residual[count] = grid.area @ pressure + number * self._load_outside - LOAD

        # ∂r/∂P = ∂r/∂P_f + (∂r/∂H − ∂r/∂P_f P_a′) K, on the diagonal and between neighbours; that of ∂r/∂P_f is 1
        left, right = grid.left, grid.right
        out, into = (scale * full)[left], (scale * full)[right]
        own = np.bincount(left, out * by_left, count) - np.bincount(right, into * by_right, count)
        onward = out * (by_right + conduct * stiffness[right])
        back = into * (conduct * stiffness[left] - by_left)
        self._distant.data = np.concatenate([own - stiffness, onward, back])[self._order]
        matrix[:count, :count] = self._distant @ grid.kernel
        matrix[self._rows, self._columns] += np.concatenate([np.ones(count), -out * conduct, -into * conduct])
        matrix[:count, count] = self._distant.sum(axis=1)
        matrix[count, :count], matrix[count, count] = grid.area, 0.0
        return residual, full
