"""Films at many speeds, each started from those before, and what is left when a step fails."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.lubrication.newton import FilmState, Transport

_ROUNDS, _FIRST_ROUNDS = 25, 100
_SMALLEST_STEP = 1e-3  # of ln λ


class FilmSolver(Protocol):
    """What a sweep asks of a solver of one film, be it that of a cylinder or of a ball."""

    @property
    def starts(self) -> tuple[float, ...]:
        """Lubrication numbers at which a film is sought first, one after the other until there is one."""

    def guess(self, number: float, thick: float) -> FilmState:
        """A first guess for λ whose approach is about ``thick``."""

    def __call__(
        self, state: FilmState, number: float, transport: Transport, rounds: int
    ) -> tuple[FilmState, int]:
        """Film at the lubrication number λ, from a first guess; also the steps taken, −1 if it did not converge."""


def sweep(
    numbers: FloatArray,
    solver: FilmSolver,
    transport: Callable[[float], Transport],
    first_approaches: Sequence[float],
) -> tuple[list[FilmState | None], int]:
    """Films at the lubrication numbers, in their order, None where none was found; and the Newton steps taken.

    ``transport`` gives the film law at a lubrication number; ``first_approaches`` are those of first guesses.
    """
    found: list[FilmState | None] = [None] * numbers.size
    first, steps = _first_film(solver, transport, first_approaches)
    if first is None:
        return found, steps
    begin, start = first
    order = np.argsort(numbers)
    low = np.log(numbers[order]) < begin
    for way in (order[low][::-1], order[~low]):
        trail = [(begin, start)]
        for place in way:
            reached, taken = _walk(solver, trail, float(np.log(numbers[place])), transport)
            steps += taken
            if not reached:
                break
            found[place] = trail[-1][1]
    return found, steps


def _first_film(
    solver: FilmSolver, transport: Callable[[float], Transport], first_approaches: Sequence[float]
) -> tuple[tuple[float, FilmState] | None, int]:
    """A film to start from with its ln λ, from the pressure of Hertz and a thick film; and the steps taken."""
    total = 0
    for number in solver.starts:
        for approach in first_approaches:
            state, steps = solver(solver.guess(number, approach), number, transport(number), _FIRST_ROUNDS)
            if steps > 0:
                return (float(np.log(number)), state), total + steps
            total += _FIRST_ROUNDS
    return None, total


def _walk(
    solver: FilmSolver,
    trail: list[tuple[float, FilmState]],
    goal: float,
    transport: Callable[[float], Transport],
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
        fraction = 1.0
        for other in places:
            if other != place:
                fraction *= (target - other) / (place - other)
        pressure = pressure + fraction * state.pressure
        approach += fraction * state.approach
    return FilmState(np.asarray(pressure), approach)
