"""Targets of known distribution for the tests of the samplers; importable, so that worker processes can have them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats import multivariate_normal


@dataclass(frozen=True)
class UnitGaussian:
    """Independent standard normal coordinates."""

    dimension: int = 2
    spread: float = 3.0
    shift: float = 0.0

    @property
    def names(self):
        return tuple(f"x{index}" for index in range(self.dimension))

    @property
    def fingerprint(self):
        return repr(self)

    def scores(self, position):
        """Coordinates that are independent standard normal under the target."""
        return position

    def probabilities(self, position):
        """Coordinates that are uniform on (0, 1) under the target."""
        return ndtr(self.scores(position))

    def log_density(self, position):
        # A running sum: a row gives the same bits alone and in a batch.
        total = np.zeros(len(position))
        for column in self.scores(position).T:
            total = total - 0.5 * column**2
        return total

    def starts(self, rng, count):
        return self.shift + self.spread * rng.normal(size=(count, self.dimension))

    def prior_transform(self, unit):
        return self.shift + self.spread * ndtri(unit)

    def integrated_out(self, position, rng):
        return {}


@dataclass(frozen=True)
class LinearGaussian:
    """Data that are linear in parameters with standard normal priors, with unit noise: everything about it is known.

    ``ridge`` is what the sum of the parameters is multiplied with in the first datum: large, it is known 1/ridge times as well
    as the rest.
    """

    dimension: int = 3
    ridge: float = 1.0

    @cached_property
    def design(self):
        rest = np.random.default_rng(self.dimension).normal(size=(2, self.dimension)) / 2
        return np.concatenate([np.full((1, self.dimension), self.ridge), rest])

    @cached_property
    def data(self):
        return self.design @ np.linspace(-1.0, 1.5, self.dimension) + np.array([0.4, -1.1, 0.3])

    @property
    def names(self):
        return tuple(f"x{index}" for index in range(self.dimension))

    @property
    def fingerprint(self):
        return repr(self)

    def moments(self):
        """Mean and covariance of the posterior."""
        covariance = np.linalg.inv(np.eye(self.dimension) + self.design.T @ self.design)
        return covariance @ self.design.T @ self.data, covariance

    def log_evidence(self):
        covariance = np.eye(3) + self.design @ self.design.T
        return multivariate_normal(np.zeros(3), covariance).logpdf(self.data)

    def log_likelihood(self, position):
        away = self.data - position @ self.design.T
        return -0.5 * (away * away).sum(axis=1) - 1.5 * np.log(2.0 * np.pi)

    def log_density(self, position):
        return self.log_likelihood(position) - 0.5 * (position * position).sum(axis=1)

    def prior_transform(self, unit):
        return ndtri(unit)

    def starts(self, rng, count):
        return rng.normal(size=(count, self.dimension))

    def integrated_out(self, position, rng):
        return {}


@dataclass(frozen=True)
class Banana(UnitGaussian):
    """x1 is bent around x0: mean 0, variance 1 + 2·bend²."""

    bend: float = 1.0

    def scores(self, position):
        straight = np.array(position, dtype=float)
        straight[:, 1] = position[:, 1] - self.bend * (position[:, 0] ** 2 - 1.0)
        return straight


@dataclass(frozen=True)
class TwoModes(UnitGaussian):
    """Two unit Gaussians ``distance`` apart along x0; walkers start in one or the other and cannot change."""

    distance: float = 40.0

    def log_density(self, position):
        away = np.minimum(np.abs(position[:, 0]), np.abs(position[:, 0] - self.distance))
        return -0.5 * (away**2 + position[:, 1] ** 2)

    def starts(self, rng, count):
        position = rng.normal(size=(count, self.dimension))
        position[::2, 0] += self.distance
        return position


@dataclass(frozen=True)
class EnsembleModes(TwoModes):
    """As TwoModes, but all walkers of one ensemble start in the same mode."""

    def starts(self, rng, count):
        position = rng.normal(size=(count, self.dimension))
        position[:, 0] += self.distance * (rng.random() < 0.5)
        return position


@dataclass(frozen=True)
class Faulty(UnitGaussian):
    """NaN where x0 > 2 and +inf where x0 < -2."""

    spread: float = 0.3

    def log_density(self, position):
        value = super().log_density(position)
        value[position[:, 0] > 2.0] = np.nan
        value[position[:, 0] < -2.0] = np.inf
        return value


@dataclass(frozen=True)
class Failing(UnitGaussian):
    """Raises once the walkers have gathered."""

    def log_density(self, position):
        if np.abs(position).max() < 3.0:
            raise ArithmeticError("the model broke")
        return super().log_density(position)


@dataclass(frozen=True)
class Slow(UnitGaussian):
    """Takes its time."""

    seconds: float = 0.002

    def log_density(self, position):
        time.sleep(self.seconds)
        return super().log_density(position)
