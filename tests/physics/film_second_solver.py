"""Films on a viscoelastic solid, solved in another way: kernel from the complex modulus by Fourier sums, even nodes, a penalty.

Shares no code with the package: the deflection is ``2 p(q)/(|q| E*(qv))`` summed over wavevectors of a period far longer than
the contact, the liquid is kept from pulling by a penalty in place of an active set, and films are arithmetic means at the
faces of cells.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

PERIOD, PENALTY, LOAD = 400.0, 1e5, np.pi / 2


class Features(NamedTuple):
    """ηv over that of λ = 1 at half of the plateau and at the minimum, and friction over b/Rc at the minimum and at the end."""

    half: float
    minimum: float
    least: float
    last: float


def fourier_kernel(position: np.ndarray, relative_modulus: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Depth at even nodes by hat pressures, for E*(qv)/E_ref as a function of qb; the mean is free and left out."""
    step = position[1] - position[0]
    count = int(PERIOD / step / 2)
    q = 2 * np.pi / PERIOD * np.arange(1, 4 * count)
    hat = step * np.sinc(q * step / 2 / np.pi) ** 2
    response = hat / (q * relative_modulus(q))  # 2/E* over the 2 of p_H = E* b/(2 Rc)
    lags = np.arange(1 - position.size, position.size) * step
    depth = np.array([2 / PERIOD * (response * np.exp(1j * q * lag)).sum().real for lag in lags])
    places = np.arange(position.size)
    return depth[places[:, None] - places + position.size - 1]


class Solver:
    """Newton iterations at many λ on one grid."""

    def __init__(self, position: np.ndarray, kernel: np.ndarray, law: Callable) -> None:
        self.x, self.depth, self.law, self.step = position, kernel, law, position[1] - position[0]

    def film(self, state: np.ndarray) -> np.ndarray:
        """H at the nodes."""
        return state[-1] + np.square(self.x) / 2 + self.depth @ state[:-1]

    def newton(self, state: np.ndarray, number: float, rounds: int = 80) -> np.ndarray | None:
        """Pressures and approach at λ from a guess; None if it does not converge."""
        n, h = self.x.size, self.step
        tail = 4 * number / (3 * abs(self.x[0]) ** 3)
        for _ in range(rounds):
            film = self.film(state)
            asperities, stiff = self.law(film)
            fluid = state[:-1] - asperities
            to_film = np.hstack([self.depth, np.ones((n, 1))])
            to_fluid = np.hstack([np.eye(n), np.zeros((n, 1))]) - stiff[:, None] * to_film
            face = (film[1:] + film[:-1]) / 2
            slope = np.diff(fluid) / h
            flow = number * face - face**3 * slope
            to_face = (to_film[1:] + to_film[:-1]) / 2
            to_flow = (number - 3 * face**2 * slope)[:, None] * to_face - face[:, None] ** 3 * np.diff(
                to_fluid, axis=0
            ) / h
            pull = np.minimum(fluid[1:-1], 0.0)
            scale = np.maximum(face[1:] ** 3, 1e-9) / h**2
            residual = np.concatenate(
                [[fluid[0] - tail], np.diff(flow) / h / scale + PENALTY * pull, [fluid[-1]],
                 [h * state[:-1].sum() + 2 * number / (3 * self.x[0] ** 2) - LOAD]]
            )  # fmt: skip
            rows = (
                np.diff(to_flow, axis=0) / h / scale[:, None] + PENALTY * (pull < 0)[:, None] * to_fluid[1:-1]
            )
            matrix = np.vstack([to_fluid[:1], rows, to_fluid[-1:], np.append(np.full(n, h), 0.0)])
            # the scale is held: its derivative multiplies a residual that goes to nothing
            change = np.linalg.solve(matrix, -residual)
            rise = to_film @ change / np.maximum(film, 1e-12)
            fraction = min(1.0, 0.6 / max(-rise.min(), 1e-12))
            state = state + fraction * change
            if fraction == 1 and np.abs(rise).max() < 1e-7:
                return state
        return None

    def sweep(self, numbers: np.ndarray, start: float) -> list[np.ndarray]:
        """States at rising λ, walking down to the first from λ = ``start``."""
        guess = np.sqrt(np.maximum(1 - self.x**2, 0))
        state = np.append(guess * LOAD / (self.step * guess.sum()), 0.0)
        shape = self.film(state).min()
        found, first = None, 1.0
        for first, thicker in ((1.0, 1.0), (2.0, 1.0), (0.5, 1.0), (1.0, 2.0), (2.0, 2.0)):
            state[-1] = thicker * start - shape
            found = self.newton(state, first, 200)
            if found is not None:
                break
        assert found is not None
        for number in np.geomspace(first, numbers[0], 40)[1:]:
            found = self.newton(found, number)
            assert found is not None
        states = [found]
        for number in numbers[1:]:
            found = self.newton(found, number)
            assert found is not None
            states.append(found)
        return states

    def friction(self, state: np.ndarray, number: float) -> tuple[float, float]:
        """Load fraction of the asperities; shear flow and pressure flow over b/Rc."""
        film = self.film(state)
        fluid = state[:-1] - self.law(film)[0]
        share = self.step * self.law(film)[0].sum() / LOAD
        peak = int(np.argmax(fluid))
        inner = slice(max(peak - 1, 0), peak + 2)
        carried = (
            film[inner].mean() - (film[inner].mean() ** 3 * np.gradient(fluid, self.step)[peak]) / number
        )
        wet = np.where(np.arange(film.size) > peak, np.minimum(1.0, carried / film), 1.0)
        shear = self.step * (wet / film).sum() + 2 / abs(self.x[0]) + carried * 4 / (3 * self.x[-1] ** 3)
        face = (film[1:] + film[:-1]) / 2
        push = (face * np.diff(fluid)).sum() + number * 2 / abs(self.x[0])
        return share, number / (3 * np.pi) * shear + push / np.pi


def features(number: np.ndarray, share: np.ndarray, fluid: np.ndarray, plateau: float) -> Features:
    """Half of the plateau of the sum ``plateau × share + fluid``, its minimum by a parabola in logarithms, its last value."""
    total = plateau * share + fluid
    log_number, log_total = np.log(number), np.log(total)
    cross = int(np.argmax(total < plateau / 2))
    half = np.interp(
        -np.log(plateau / 2), -log_total[cross - 1 : cross + 1], log_number[cross - 1 : cross + 1]
    )
    low = int(np.argmin(total))
    fit = np.polyfit(log_number[low - 2 : low + 3], log_total[low - 2 : low + 3], 2)
    at = -fit[1] / (2 * fit[0])
    return Features(
        float(np.exp(half)), float(np.exp(at)), float(np.exp(np.polyval(fit, at))), float(total[-1])
    )
