"""Films at many speeds, each started from those before, and what is left when a step fails."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.grid import LineGrid
from skinbayes.lubrication.newton import LOAD, FilmState, Law, Solver, Transport

_START = 1.0  # lubrication number at which the contact is solved first: neither stiff nor far from Hertz
_ROUNDS, _FIRST_ROUNDS = 25, 400
_SMALLEST_STEP = 1e-3  # of ln λ


def sweep(
    numbers: FloatArray, grid: LineGrid, law: Law, transport: Callable[[float], Transport], first_film: float
) -> tuple[list[FilmState | None], int]:
    """Films at the lubrication numbers, in their order, None where none was found; and the Newton steps taken.

    ``transport`` gives the film law at a lubrication number; ``first_film`` is a film thicker than the asperities.
    """
    solver = Solver(grid, law)
    middle = np.sqrt(np.maximum(1 - np.square(grid.position), 0.0))
    guess = FilmState(middle * (LOAD / (grid.weight @ middle)), first_film)
    start, steps = solver(guess, _START, transport(_START), _FIRST_ROUNDS)
    found: list[FilmState | None] = [None] * numbers.size
    if steps < 0:
        return found, 0
    order = np.argsort(numbers)
    for way in (order[numbers[order] < _START][::-1], order[numbers[order] >= _START]):
        trail = [(0.0, start)]
        for place in way:
            reached, taken = _walk(solver, trail, float(np.log(numbers[place])), transport)
            steps += taken
            if not reached:
                break
            found[place] = trail[-1][1]
    return found, steps


def _walk(
    solver: Solver, trail: list[tuple[float, FilmState]], goal: float, transport: Callable[[float], Transport]
) -> tuple[bool, int]:
    """Extend the trail of (ln λ, film) to the goal, in smaller steps where Newton's iteration fails."""
    total, target = 0, goal
    while True:
        number = float(np.exp(target))
        state, steps = solver(_extrapolate(trail, target), number, transport(number), _ROUNDS)
        if steps < 0:
            state, steps = solver(trail[-1][1], number, transport(number), 2 * _ROUNDS)
            total += _ROUNDS
        if steps < 0:
            total += 2 * _ROUNDS
            target = (trail[-1][0] + target) / 2
            if abs(target - trail[-1][0]) < _SMALLEST_STEP:
                return False, total
            continue
        total += steps
        trail.append((target, state))
        del trail[:-3]
        if target == goal:
            return True, total
        target = goal


def _extrapolate(trail: list[tuple[float, FilmState]], target: float) -> FilmState:
    """Polynomial through the last films, as high as there are points, up to a parabola."""
    places = [place for place, _ in trail]
    pressure: FloatArray | float = 0.0
    approach = 0.0
    for place, state in trail:
        share = 1.0
        for other in places:
            if other != place:
                share *= (target - other) / (place - other)
        pressure = pressure + share * state.pressure
        approach += share * state.approach
    return FilmState(np.asarray(pressure), approach)
