"""Measurements that were not made yet: drawn for each posterior draw, and their density under every other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.prediction import drawn_measurements
from skinbayes.problem.new_conditions import NewConditions
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.noise import NoiseFamily

MOST_NUMBERS = 40_000_000
"""Numbers in the covariances of effects of all draws together."""

ROUNDING = 1e-12
"""Added to a covariance, as a fraction of its trace, so that rounding leaves it positive definite."""


@dataclass(frozen=True)
class NewMeasurements:
    """What the draws of a fit say about measurements at new rows.

    Attributes
    ----------
    observables : what is measured in each row
    theta : the draws, ``(M, D)``
    noise : of each observable
    predicted : of each observable, ``(M, N)``, SI
    width : of the noise, for each observable ``(M, N)``
    shapes : parameters of the shape of the noise, for each observable, each ``(M, N)``
    shared : mean ``(M, N)`` of what effects add to the rows on the scale on which these scatter, given the data, and factors F of
        the covariance F Fᵀ between them, ``(M, N, K)``; None without effects
    values : one measurement of each observable drawn for each draw, ``(M, N)``, SI
    """

    observables: tuple[str, ...]
    theta: FloatArray
    noise: tuple[NoiseFamily, ...]
    predicted: tuple[FloatArray, ...]
    width: tuple[FloatArray, ...]
    shapes: tuple[dict[str, FloatArray], ...]
    shared: tuple[FloatArray, FloatArray] | None
    values: tuple[FloatArray, ...]

    @classmethod
    def of(cls, new: NewConditions, theta: FloatArray, rng: np.random.Generator) -> NewMeasurements:
        """Draw measurements at the rows of ``new`` for each of the draws ``theta``."""
        names = new.measured.observables
        if new.people:
            raise InputError(
                f"{new.dataset.path}: rows of {' and '.join(new.new_people)} that were not measured, whose values are not "
                "known; the information of rows is computed for those that the fit has seen"
            )
        if new.measured.shared is not None:
            theta = theta[: max(200, MOST_NUMBERS // new.measured.shared.n_effects**2)]
        found = new.problem.predict(theta)
        sound = np.all([np.isfinite(found[name]).all(axis=1) for name in names], axis=0)
        if not sound.mean() > 0.5:
            raise InputError(
                f"{new.dataset.path}: the model '{new.measured.name}' has no answer at some of these rows in "
                f"{1 - sound.mean():.0%} of the draws; leave out rows that lie outside its range"
            )
        theta, predicted = theta[sound], {name: found[name][sound] for name in names}
        made = drawn_measurements(new, theta, predicted, rng)
        observations, stacked = made.problem.observations, np.stack(list(predicted.values()), axis=1)
        inputs, shape = made.problem.inputs(theta), stacked[:, 0].shape
        return cls(
            observables=names,
            theta=theta,
            noise=tuple(o.noise for o in observations),
            predicted=tuple(predicted.values()),
            width=tuple(np.split(made.problem.likelihood.width_about(theta, stacked), len(names), axis=-1)),
            shapes=tuple(
                {key: np.broadcast_to(value, shape) for key, value in o.shape_arguments(inputs).items()}
                for o in observations
            ),
            shared=None if made.effects is None else _effects(new, theta),
            values=tuple(made.values.values()),
        )

    def log_density(self, made: NewMeasurements, rows: list[int]) -> FloatArray:
        """ln p of the measurements ``made`` at some rows together under each draw of this, ``(M of made, M)``."""
        total = np.zeros((len(made.theta), len(self.theta)))
        for place, family in enumerate(self.noise):
            values = made.values[place][:, rows]
            if self.shared is not None:  # then there is one observable
                return self._normal(values, rows)
            for i, row in enumerate(rows):
                shape = {key: value[:, row] for key, value in self.shapes[place].items()}
                with np.errstate(all="ignore"):
                    total += family.log_density_at(
                        values[:, [i]], self.predicted[place][:, row], self.width[place][:, row], **shape
                    )
        return total

    def log_predictive(self, made: NewMeasurements, rows: list[int]) -> FloatArray:
        """ln p of the measurements ``made`` under this model, its draws averaged; of its own without the draw that made each."""
        density = self.log_density(made, rows)
        if made is self:
            np.fill_diagonal(density, -np.inf)
        return np.asarray(logsumexp(density, axis=1) - np.log(len(self.theta) - (made is self)))

    def _normal(self, values: FloatArray, rows: list[int]) -> FloatArray:
        """Joint normal density of values ``(I, rows)`` of rows that share effects, ``(I, M)``."""
        assert self.shared is not None
        (family,), (mean, factors) = self.noise, self.shared
        predicted, factor = self.predicted[0][:, rows], factors[:, rows]
        covariance = factor @ np.swapaxes(factor, 1, 2)
        diagonal = np.arange(len(rows))
        covariance[:, diagonal, diagonal] += self.width[0][:, rows] ** 2
        lower = np.linalg.cholesky(covariance)
        pivots = np.diagonal(lower, axis1=1, axis2=2)
        constant = -np.log(pivots).sum(axis=1) - 0.5 * len(rows) * np.log(2 * np.pi)
        inverse = np.linalg.inv(lower)
        # values that this family cannot hold, such as negative ones where ln scatters, are impossible
        apart = [
            np.nan_to_num(family.residual(values[:, [i]], predicted[:, i]) - mean[:, row], nan=np.inf)
            for i, row in enumerate(rows)
        ]
        found = np.broadcast_to(constant, (len(values), len(predicted))).copy()
        for a in range(len(rows)):
            found -= 0.5 * np.square(sum(inverse[:, a, b] * apart[b] for b in range(a + 1)))
        if family.logarithmic:
            with np.errstate(all="ignore"):
                found -= np.log(values).sum(axis=1)[:, np.newaxis]
        return np.nan_to_num(found, nan=-np.inf, posinf=-np.inf, neginf=-np.inf)


def _effects(new: NewConditions, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean of what effects add to the new rows given the data, ``(M, N)``, and factors of its covariance, ``(M, N, K)``."""
    shared, known = new.problem.shared, new.known
    assert shared is not None
    scales = new.problem.likelihood.scales(theta)
    mean, covariance = new.measured.likelihood.effects_given(theta)
    size = np.trace(covariance, axis1=1, axis2=2)[:, np.newaxis, np.newaxis]
    factor = np.linalg.cholesky(covariance + ROUNDING * size * np.eye(covariance.shape[-1]))
    design = shared.at_rows(np.eye(len(known))).T  # from new effects to new rows
    seen = known >= 0
    of_rows = shared.at_rows(np.where(seen, mean[:, known], 0.0))
    old = design[:, seen] @ factor[:, known[seen]]
    if isinstance(shared, CrossedGroups):
        of_levels = np.repeat(scales, [len(levels) for levels in shared.levels], axis=1)
        prior = of_levels[:, :, np.newaxis] * np.eye(len(known))
    else:
        prior = shared.prior_factor(scales)
    fresh = design[:, ~seen] @ prior[:, ~seen]
    return of_rows, np.concatenate([old, fresh], axis=-1)
