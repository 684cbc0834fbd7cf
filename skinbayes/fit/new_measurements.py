"""Measurements that were not made yet: drawn for each posterior draw, and their density under every other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.fit.prediction import measuring_at
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
    location : of what scatters, y or ln y, for each observable ``(M, N)``; effects that the fit knows are in it
    width : of the noise, for each observable ``(M, N)``
    shapes : parameters of the shape of the noise, for each observable
    shared : factors F of the covariance F Fᵀ that effects give the rows beside the noise, ``(M, N, K)``; None without effects
    values : one measurement of each observable drawn for each draw, on the scale on which it scatters, ``(M, N)``
    """

    observables: tuple[str, ...]
    theta: FloatArray
    noise: tuple[NoiseFamily, ...]
    location: tuple[FloatArray, ...]
    width: tuple[FloatArray, ...]
    shapes: tuple[dict[str, FloatArray], ...]
    shared: FloatArray | None
    values: tuple[FloatArray, ...]

    @classmethod
    def of(cls, new: NewConditions, theta: FloatArray, rng: np.random.Generator) -> NewMeasurements:
        """Draw measurements at the rows of ``new`` for each of the draws ``theta``."""
        shared = new.problem.shared
        if shared is not None:
            theta = theta[: max(200, MOST_NUMBERS // new.measured.shared.n_effects**2)]  # type: ignore[union-attr]
        predicted = new.problem.predict(theta)
        sound = np.all([np.isfinite(predicted[o]).all(axis=1) for o in new.measured.observables], axis=0)
        if not sound.mean() > 0.5:
            raise InputError(
                f"{new.dataset.path}: the model '{new.measured.name}' has no answer at some of these rows in "
                f"{1 - sound.mean():.0%} of the draws; leave out rows that lie outside its range"
            )
        theta = theta[sound]
        predicted = {name: values[sound] for name, values in predicted.items()}
        measuring = measuring_at(new, predicted)
        inputs = measuring.inputs(theta)
        noise = tuple(o.noise for o in measuring.observations)
        with np.errstate(all="ignore"):
            location = [
                np.log(predicted[o.name]) if o.noise.logarithmic else predicted[o.name]
                for o in measuring.observations
            ]
        widths = np.split(measuring.likelihood.width(theta), len(noise), axis=-1)
        shapes = tuple(o.shape_arguments(inputs) for o in measuring.observations)
        factors = None
        if shared is not None:
            mean, factors = _effects(new, theta)
            location[0] = location[0] + mean
        values = []
        for family, middle, width, shape in zip(noise, location, widths, shapes, strict=True):
            values.append(middle + width * family.standard_draw(rng, middle.shape, **shape))
        if factors is not None:
            standard = rng.standard_normal((len(theta), factors.shape[-1], 1))
            values[0] = values[0] + (factors @ standard)[..., 0]
        return cls(
            new.measured.observables, theta, noise, tuple(location), tuple(widths), shapes, factors, tuple(values)
        )  # fmt: skip

    def log_density(self, made: NewMeasurements, rows: list[int]) -> FloatArray:
        """ln p of the measurements ``made`` at some rows together under each draw of this, ``(M of made, M)``.

        Measurements are on the scale on which they scatter in this model.
        """
        total = np.zeros((len(made.theta), len(self.theta)))
        for place, family in enumerate(self.noise):
            values, jacobian = made.on_scale(place, family, rows)
            total += jacobian[:, np.newaxis]
            location, width = self.location[place][:, rows], self.width[place][:, rows]
            if place == 0 and self.shared is not None:
                total += self._normal(values, location, width, rows)
                continue
            for i in range(len(rows)):
                shape = {
                    name: np.broadcast_to(v, self.width[place].shape)[:, rows[i]]
                    for name, v in self.shapes[place].items()
                }
                z = (values[:, np.newaxis, i] - location[:, i]) / width[:, i]
                total += family.standard_log_density(z, **shape) - np.log(width[:, i])
        return total

    def log_predictive(self, made: NewMeasurements, rows: list[int]) -> FloatArray:
        """ln p of the measurements ``made`` under this model, its draws averaged; of its own without the draw that made each."""
        density = self.log_density(made, rows)
        if made is self:
            np.fill_diagonal(density, -np.inf)
        return np.asarray(logsumexp(density, axis=1) - np.log(len(self.theta) - (made is self)))

    def on_scale(self, place: int, family: NoiseFamily, rows: list[int]) -> tuple[FloatArray, FloatArray]:
        """Measurements on the scale of another family, ``(M, rows)``, and ln of the Jacobian to the observable, ``(M,)``."""
        values, logarithmic = self.values[place][:, rows], self.noise[place].logarithmic
        with np.errstate(all="ignore"):
            ln = values if logarithmic else np.log(values)
            found = (
                values
                if logarithmic == family.logarithmic
                else (ln if family.logarithmic else np.exp(values))
            )
        # what the scale of this family cannot hold, such as ln of a negative number, is impossible there
        return np.where(np.isnan(found), np.inf, found), -ln.sum(axis=1) if family.logarithmic else np.zeros(
            len(ln)
        )

    def _normal(
        self, values: FloatArray, location: FloatArray, width: FloatArray, rows: list[int]
    ) -> FloatArray:
        """Joint normal density of rows that share effects, ``(I, M)``."""
        assert self.shared is not None
        factor = self.shared[:, rows]
        covariance = factor @ np.swapaxes(factor, 1, 2)
        diagonal = np.arange(len(rows))
        covariance[:, diagonal, diagonal] += width**2
        lower = np.linalg.cholesky(covariance)
        constant = -np.log(np.diagonal(lower, axis1=1, axis2=2)).sum(axis=1) - 0.5 * len(rows) * np.log(
            2 * np.pi
        )
        inverse = np.linalg.inv(lower)
        found = np.broadcast_to(constant, (len(values), len(location))).copy()
        for a in range(len(rows)):
            z = sum(inverse[:, a, b] * (values[:, np.newaxis, b] - location[:, b]) for b in range(a + 1))
            found -= 0.5 * z**2
        return found


def _effects(new: NewConditions, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean of what effects add to the new rows given the data, ``(M, N)``, and factors of its covariance, ``(M, N, K)``."""
    shared, known = new.problem.shared, new.known
    assert shared is not None
    inputs = new.problem.inputs(theta)
    scales = np.stack(
        [np.broadcast_to(inputs[name][:, 0], len(theta)) for name in new.problem.shared_parameters], axis=-1
    )
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
