"""The likelihood of a problem: noise about predictions, the spread of inputs, and the effects that groups share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.problem.observations import NOISE_WORDS, Observation, propagated_spread
from skinbayes.problem.pieces import in_pieces
from skinbayes.problem.predicting import PredictingModel
from skinbayes.statistics.correlated_scatter import CorrelatedScatter


@dataclass(frozen=True)
class Likelihood:
    """Log-density of the data of a problem and draws from it, for batches ``(B, D)`` of parameter vectors in SI.

    ``y = f(θ) + effects + noise``, or ``ln y = ln f(θ) + effects + noise`` where the noise is logarithmic. Effects of groups,
    the curves of a discrepancy and a drift are normal and integrated out; noise may be correlated.

    Attributes
    ----------
    problem : what predicts
    counted : which data enter ``total``, shape ``(M,)``, where nothing is shared between data; None for all
    """

    problem: PredictingModel
    counted: NDArray[np.bool_] | None = None

    def pointwise(self, theta: FloatArray) -> FloatArray:
        """ln p of each datum, shape ``(B, M)``: given θ, and given all other data where groups share effects."""
        return in_pieces(lambda part: self._pointwise(*self._predictions(part)), theta, self.size)

    def total(self, theta: FloatArray) -> FloatArray:
        """ln p of all data, shape ``(B,)``; NaN where the forward model has no answer."""
        return in_pieces(lambda part: self._total(*self._predictions(part)), theta, self.size)

    def given(self, theta: FloatArray, predicted: Mapping[str, FloatArray]) -> FloatArray:
        """The same for vectors whose predictions are known, each ``(B, N)``."""
        return self._total(self.problem.inputs(theta), [predicted[o.name] for o in self._observations])

    def left_out(self, theta: FloatArray, column: str) -> FloatArray:
        """ln p of all data of each level of a grouping column given the others, shape ``(B, levels)``."""
        labels = self.problem.conditions.labels
        if column not in labels:
            raise InputError(
                f"{self.problem.spec.path}: the data have no column '{column}'; "
                f"grouping columns: {', '.join(labels) or 'none'}"
            )
        if len(self._observations) > 1:
            raise InputError(f"{self.problem.spec.path}: leaving out groups needs a model of one observable")
        place: dict[str, int] = {}
        block = np.array([place.setdefault(label, len(place)) for label in labels[column].tolist()])
        return in_pieces(lambda part: self._left_out(part, block, len(place)), theta, self.size)

    def draw(
        self, theta: FloatArray, rng: np.random.Generator, effects: FloatArray | None = None
    ) -> FloatArray:
        """Simulated data, shape ``(B, M)``; effects of groups drawn anew unless given, ``(B, G)``."""
        # predictions in pieces, random numbers for all vectors together: their order does not depend on the pieces
        predicted = in_pieces(lambda part: np.stack(self._predictions(part)[1], axis=1), theta, self.size)
        return self.draw_about(theta, predicted, rng, effects)

    def draw_about(
        self,
        theta: FloatArray,
        predicted: FloatArray,
        rng: np.random.Generator,
        effects: FloatArray | None = None,
    ) -> FloatArray:
        """:meth:`draw` for vectors whose predictions are known, shape ``(B, observations, N)``."""
        spread = in_pieces(self._stacked_spread, theta, self.size) if self.problem.input_spread else None
        inputs = self.problem.inputs(theta)
        shared, noise = self.problem.shared, None
        if isinstance(shared, CorrelatedScatter) and shared.noise is not None:
            noise = shared.draw_noise(rng, self._scales(inputs, len(theta)))
        drawn = []
        for i, o in enumerate(self._observations):
            arguments = o.noise_arguments(inputs, None if spread is None else spread[:, i])
            if noise is None:
                drawn.append(o.noise.draw(rng, predicted[:, i], observed=o.values, **arguments))
            else:
                apart = noise * o.noise.width(predicted[:, i], observed=o.values, **arguments)
                drawn.append(
                    predicted[:, i] * np.exp(apart) if o.noise.logarithmic else predicted[:, i] + apart
                )
        if shared is not None:
            if effects is None:
                effects = shared.draw_new_effects(rng, self._scales(inputs, len(theta)))
            at_rows = shared.at_rows(effects)
            logarithmic = self._observations[0].noise.logarithmic
            drawn = [drawn[0] * np.exp(at_rows) if logarithmic else drawn[0] + at_rows]
        return np.concatenate(drawn, axis=-1)

    def draw_effects(self, theta: FloatArray, rng: np.random.Generator) -> FloatArray:
        """All that rows share given parameters and data, shape ``(B, G)``: effects of groups first."""
        groups = self.problem.shared
        if groups is None:
            raise InputError(
                f"{self.problem.spec.path}: '{self.problem.name}' has no [groups] or [discrepancy]"
            )

        def piece(part: FloatArray) -> FloatArray:
            inputs, (predicted,) = self._predictions(part)
            residual, width, scales, _ = self._residuals(inputs, predicted)
            return groups.draw_effects(rng, residual, width, scales)

        return in_pieces(piece, theta, self.size)

    def effects_given(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean ``(B, G)`` and covariance ``(B, G, G)`` of all that rows share given parameters and data."""
        groups = self.problem.shared
        assert groups is not None
        inputs, (predicted,) = self._predictions(theta)
        residual, width, scales, _ = self._residuals(inputs, predicted)
        return groups.effects_given(residual, width, scales)

    def width(self, theta: FloatArray) -> FloatArray:
        """Width of the noise of each datum, shape ``(B, M)``; of its ln where the noise is logarithmic."""
        return in_pieces(lambda part: self._widths(*self._predictions(part)), theta, self.size)

    def width_about(self, theta: FloatArray, predicted: FloatArray) -> FloatArray:
        """:meth:`width` for vectors whose predictions are known, shape ``(B, observations, N)``."""
        return self._widths(self.problem.inputs(theta), list(np.moveaxis(predicted, 1, 0)))

    def scales(self, theta: FloatArray) -> FloatArray:
        """Scales of what rows share, shape ``(B, P)``."""
        return self._scales(self.problem.inputs(theta), len(theta))

    def independent(self, theta: FloatArray, changes: FloatArray) -> FloatArray:
        """Changes ``(B, M)`` of the data at one parameter vector ``(D,)`` as numbers that scatter independently, ``(B, M + G)``.

        In units of their width; products of the numbers are those of the changes with the inverse covariance of the data.
        """
        batch = theta[np.newaxis]
        width = self.width(batch)
        groups = self.problem.shared
        if groups is None:
            return changes / width
        scales = self._scales(self.problem.inputs(batch), 1)
        return groups.independent(changes, width, scales)

    # -- inner parts -------------------------------------------------------------------------------------------------

    @property
    def _observations(self) -> tuple[Observation, ...]:
        if not self.problem.observations:
            raise InputError(
                f"{self.problem.spec.path}: '{self.problem.name}' has no data here, so there is no likelihood"
            )
        return self.problem.observations

    @property
    def size(self) -> int:
        """Numbers that one vector needs: its data, and the matrix of the levels of groups."""
        groups = self.problem.shared
        matrices = 0 if groups is None else groups.matrix_size
        return len(self._observations) * self.problem.conditions.n_rows + matrices

    def _total(self, inputs: Mapping[str, FloatArray], predicted: list[FloatArray]) -> FloatArray:
        groups = self.problem.shared
        if groups is None:
            each = self._pointwise(inputs, predicted)
            return (each if self.counted is None else each[..., self.counted]).sum(axis=-1)
        residual, width, scales, offset = self._residuals(inputs, predicted[0])
        if (
            self.counted is not None and not self.counted.any()
        ):  # of some of its data a problem of its own is made
            density = np.zeros(len(residual))
        else:
            density = groups.log_density(residual, width, scales) + offset.sum()
        return np.where(np.isnan(predicted[0]).any(axis=-1), np.nan, density)

    def _pointwise(self, inputs: Mapping[str, FloatArray], predicted: list[FloatArray]) -> FloatArray:
        # NaN where the forward model has no answer: samplers count those apart from data that are impossible
        each = [
            np.where(np.isnan(f), np.nan, self._of_each(o, inputs, f))
            for o, f in zip(self._observations, predicted, strict=True)
        ]
        return np.concatenate(each, axis=-1) if len(each) > 1 else each[0]

    def _left_out(self, theta: FloatArray, block: NDArray[np.intp], count: int) -> FloatArray:
        groups = self.problem.shared
        if groups is None:
            pointwise = self._pointwise(*self._predictions(theta))
            return np.stack([pointwise[:, block == i].sum(axis=-1) for i in range(count)], axis=-1)
        inputs, (predicted,) = self._predictions(theta)
        residual, width, scales, offset = self._residuals(inputs, predicted)
        jacobian = np.bincount(block, weights=offset, minlength=count)
        density = groups.log_density_left_out(residual, width, scales, block) + jacobian
        return np.where(np.isnan(predicted).any(axis=-1, keepdims=True), np.nan, density)

    def _widths(self, inputs: Mapping[str, FloatArray], predicted: list[FloatArray]) -> FloatArray:
        return np.concatenate(
            [self._width(o, inputs, f) for o, f in zip(self._observations, predicted, strict=True)], axis=-1
        )

    def _stacked_spread(self, theta: FloatArray) -> FloatArray:
        """What the known spread of inputs adds to that of each observation, shape ``(B, observations, N)``."""
        inputs = self.problem.inputs(theta)
        shape = (len(theta), self.problem.conditions.n_rows)
        return np.stack([np.broadcast_to(self._spread(o, inputs), shape) for o in self._observations], axis=1)

    def _predictions(self, theta: FloatArray) -> tuple[Mapping[str, FloatArray], list[FloatArray]]:
        """All inputs, and the prediction of each observation, ``(B, N)``."""
        inputs = self.problem.inputs(theta)
        found = self.problem.evaluate(inputs, deduplicated=self.problem.deduplicated)
        shape = (len(theta), self.problem.conditions.n_rows)
        predicted = [found[o.name] for o in self._observations]
        return inputs, [f if f.shape == shape else np.broadcast_to(f, shape) for f in predicted]

    def _propagated(self, observation: Observation, inputs: Mapping[str, FloatArray]) -> FloatArray | None:
        """What the known spread of inputs adds to that of an observation, shape ``(B, N)``; None without one."""
        return self._spread(observation, inputs) if self.problem.input_spread else None

    def _spread(self, observation: Observation, inputs: Mapping[str, FloatArray]) -> FloatArray:
        """What the known spread of inputs adds to that of an observation, shape ``(B, N)``."""
        problem = self.problem
        return propagated_spread(
            lambda changed: problem.evaluate(changed, deduplicated=problem.deduplicated)[observation.name],
            inputs,
            problem.input_spread,
            observation,
        )

    def _width(
        self, observation: Observation, inputs: Mapping[str, FloatArray], predicted: FloatArray
    ) -> FloatArray:
        known = self._known_widths.get(observation.name)
        if known is not None:
            return np.broadcast_to(known, predicted.shape)
        arguments = observation.width_arguments(inputs, self._propagated(observation, inputs))
        return observation.noise.width(predicted, observed=observation.values, **arguments)

    @cached_property
    def _known_widths(self) -> dict[str, FloatArray]:
        """Width of logarithmic noise that no parameter changes, by observable, each ``(1, N)``: worked out once."""
        problem = self.problem
        if problem.input_spread:
            return {}
        free = {entry.name for entry in problem.plan if entry.varies}
        inputs = problem.inputs(np.full((1, problem.dimension), np.nan))
        return {
            o.name: o.noise.width(o.values[np.newaxis], observed=o.values, **o.width_arguments(inputs))
            for o in self._observations
            if o.noise.logarithmic and free.isdisjoint(o.key(name) for name in NOISE_WORDS)
        }

    def _of_each(
        self, observation: Observation, inputs: Mapping[str, FloatArray], predicted: FloatArray
    ) -> FloatArray:
        groups = self.problem.shared
        if groups is None:
            known = self._known_widths.get(observation.name)
            width = self._width(observation, inputs, predicted) if known is None else known
            shape = observation.shape_arguments(inputs)
            with np.errstate(all="ignore"):
                return observation.noise.log_density_at(observation.values, predicted, width, **shape)
        residual, width, scales, offset = self._residuals(inputs, predicted)
        return groups.log_density_pointwise(residual, width, scales) + offset

    def _residuals(
        self, inputs: Mapping[str, FloatArray], predicted: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """What scatters ``(B, N)``, its width, the scales of the effects, and ln of the Jacobian for each datum ``(N,)``."""
        (observation,) = self._observations
        residual = observation.noise.residual(observation.values, predicted)
        width = self._width(observation, inputs, predicted)
        values = observation.values
        offset = -np.log(values) if observation.noise.logarithmic else np.zeros_like(values)
        return residual, width, self._scales(inputs, len(predicted)), offset

    def _scales(self, inputs: Mapping[str, FloatArray], count: int) -> FloatArray:
        """Scales of what rows share, shape ``(B, P)``."""
        columns = [inputs[name][:, 0] for name in self.problem.shared_parameters]
        return np.stack([np.broadcast_to(column, (count,)) for column in columns], axis=-1)
