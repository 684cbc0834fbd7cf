"""Densities on which samplers fail, of known evidence and quantiles; each is told as a likelihood under a normal prior."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr, ndtri
from scipy.stats import multivariate_t, norm
from scipy.stats import t as student

LEVELS = np.array([0.05, 0.25, 0.5, 0.75, 0.95])


@dataclass(frozen=True)
class HardTarget:
    """A density whose first coordinate is known.

    Attributes
    ----------
    function : log-density of rows ``(B, D)``
    dimension : D
    spread : standard deviation of the normal prior, from which walkers start
    log_evidence : ln of the integral of the density
    probability : distribution function of the first coordinate
    """

    function: Callable[[np.ndarray], np.ndarray]
    dimension: int
    spread: float
    log_evidence: float
    probability: Callable[[np.ndarray], np.ndarray]

    @property
    def names(self):
        return tuple(f"x{index}" for index in range(self.dimension))

    @property
    def fingerprint(self):
        return repr(self)

    def log_density(self, position):
        return self.function(position)

    def log_likelihood(self, position):
        return self.function(position) - norm.logpdf(position, scale=self.spread).sum(axis=1)

    def prior_transform(self, unit):
        return self.spread * ndtri(unit)

    def starts(self, rng, count):
        possible = self.spread * rng.normal(size=(200 * count, self.dimension))
        return possible[np.isfinite(self.function(possible))][:count]

    def integrated_out(self, position, rng):
        return {}


def two_modes(position):
    """Six standard deviations apart, a quarter and three quarters of the mass."""
    parts = [
        np.log(part) + norm.logpdf(position[:, 0] - place) for part, place in ((0.25, -3.0), (0.75, 3.0))
    ]
    return np.logaddexp(*parts) + norm.logpdf(position[:, 1:]).sum(axis=1)


def funnel(position):
    return norm.logpdf(position[:, 0], scale=3.0) + norm.logpdf(
        position[:, 1:], scale=np.exp(position[:, :1] / 2)
    ).sum(axis=1)


def banana(position):
    bent = position[:, 1] - 2.0 * (np.square(position[:, 0]) - 1.0)
    return norm.logpdf(position[:, 0]) + norm.logpdf(bent, scale=0.3) + norm.logpdf(position[:, 2])


def ridge(position):
    """10,000 times longer than wide."""
    along, across = position[:, 0] + position[:, 1], position[:, 0] - position[:, 1]
    return (
        norm.logpdf(along / np.sqrt(2), scale=100.0)
        + norm.logpdf(across / np.sqrt(2), scale=0.01)
        + norm.logpdf(position[:, 2])
    )


def heavy(position):
    """Student t with two degrees of freedom: no variance."""
    return np.asarray(multivariate_t(np.zeros(3), np.eye(3), df=2).logpdf(position))


def box(position):
    return np.where((np.abs(position) < 1.0).all(axis=1), -position.shape[1] * np.log(2.0), -np.inf)


NARROW, WIDTH, PLACE = 0.3, 0.01, 2.5
"""Mass, standard deviation and place of a narrow mode beside a normal distribution."""


def narrow(position):
    """No draw further than about five of its widths from the narrow mode tells anything of it."""
    away = position.copy()
    away[:, 0] -= PLACE
    thin = norm.logpdf(away, scale=WIDTH).sum(axis=1) + np.log(NARROW)
    return np.logaddexp(thin, np.log1p(-NARROW) + norm.logpdf(position).sum(axis=1))


def _normal_mixture(*parts):
    return lambda x: sum(a * np.exp(log_ndtr((x - m) / s)) for a, m, s in parts)


def _narrow(dimension):
    parts = ((1 - NARROW, 0.0, 1.0), (NARROW, PLACE, WIDTH))
    return HardTarget(narrow, dimension, 2.0, 0.0, _normal_mixture(*parts))


HARD = {
    "two modes": HardTarget(
        two_modes, 3, 4.0, 0.0, _normal_mixture((0.25, -3.0, 1.0), (0.75, 3.0, 1.0))
    ),
    "funnel": HardTarget(funnel, 4, 3.0, 0.0, norm(scale=3.0).cdf),
    "banana": HardTarget(banana, 3, 2.0, 0.0, norm.cdf),
    "ridge": HardTarget(ridge, 3, 30.0, 0.0, norm(scale=np.sqrt((100.0**2 + 0.01**2) / 2)).cdf),
    "heavy tails": HardTarget(heavy, 3, 3.0, 0.0, student(2).cdf),
    "box": HardTarget(box, 4, 0.5, 0.0, lambda x: np.clip((x + 1) / 2, 0.0, 1.0)),
    "narrow mode 1": _narrow(1),
    "narrow mode 2": _narrow(2),
    "narrow mode 3": _narrow(3),
}  # fmt: skip
