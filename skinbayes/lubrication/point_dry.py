"""Where a ball that slides without liquid touches a viscoelastic solid: cells are put there."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.viscoelastic_line_contact import ends_of_contact
from skinbayes.lubrication.point_grid import PointGrid, point_grid
from skinbayes.lubrication.point_memory import PointMemory, point_memory
from skinbayes.lubrication.point_newton import LOAD

_GRID = (26, 8, 0.2, 6.0)  # for a first look
_ROUNDS = 100


def dry_pressure(grid: PointGrid) -> FloatArray:
    """P ≥ 0 with no gap where P > 0 and none below 0 elsewhere, ∫P dA = 2π/3, shape ``(n,)``; nan if none was found."""
    parabola = grid.parabola
    touching = grid.radius < 1.1
    for _ in range(_ROUNDS):
        count = np.count_nonzero(touching)
        matrix = np.zeros((count + 1, count + 1))
        matrix[:count, :count] = grid.kernel[np.ix_(touching, touching)]
        matrix[:count, count], matrix[count, :count] = 1, grid.area[touching]
        found = np.linalg.solve(matrix, np.append(-parabola[touching], LOAD))
        pressure = np.zeros(grid.radius.size)
        pressure[touching] = found[:count]
        gap = found[count] + parabola + grid.kernel @ pressure
        now = np.where(touching, pressure > 0, gap < 0)
        if (now == touching).all():
            return pressure
        touching = now
    return np.full(grid.radius.size, np.nan)


def edges(*, instantaneous: float, compliance: FloatArray, length: FloatArray) -> tuple[float, float]:
    """x at which dry contact begins and ends on y = 0, dimensionless, to about 0.03; −1 and 1 where the solid is elastic."""
    memory = point_memory(
        point_grid(*_GRID), instantaneous=instantaneous, compliance=compliance, length=length
    )
    found, elastic = _ends(memory), _elastic_ends()
    # the error of the coarse cells is nearly the same for both
    return found[0] - elastic[0] - 1, found[1] - elastic[1] + 1


@lru_cache(maxsize=1)
def _elastic_ends() -> tuple[float, float]:
    cells = point_grid(*_GRID).radius.size
    return _ends(PointMemory(np.eye(cells), np.zeros((cells, cells))))


def _ends(memory: PointMemory) -> tuple[float, float]:
    """Ends of the contact on the rays nearest to the inlet and the outlet; nan if none was found."""
    grid = point_grid(*_GRID)
    pressure = dry_pressure(grid._replace(kernel=memory.deflection @ grid.kernel)).reshape(-1, grid.rays)
    radius = grid.radius[:: grid.rays]
    return ends_of_contact(
        np.concatenate([-radius[::-1], radius]), np.concatenate([pressure[::-1, -1], pressure[:, 0]])
    )
