"""Scatter of rows that are not independent: group effects, smooth curves, correlated noise and drift, integrated out together.

    r = Σ_c b_c + Σ_k g_k(x_k) + a·t + ε,    ε = w · η

with effects b of levels (:mod:`skinbayes.statistics.groups`), smooth curves g (:mod:`skinbayes.statistics.smooth_curves`), a
drift a that is linear in time, normal about zero, and noise η of width 1 that is independent or correlated
(:mod:`skinbayes.statistics.correlated_noise`). Effects, curves and drift are normal effects u with a design X and a factor F of
their covariance: u = F z, z ~ N(0, I), so that Σ = w C wᵀ + X F Fᵀ Xᵀ. With rows and design whitened by w and C,

    Q = I + Fᵀ Xᵀ X F,    ln det Σ = ln det(w C w) + ln det Q,    rᵀ Σ⁻¹ r = min over z of |r − X F z|² + |z|²

as in :mod:`skinbayes.statistics.groups`, at a cost linear in the rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, log, nan, pi

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.statistics._correlated_algebra import Solved, White, times
from skinbayes.statistics._group_algebra import lower_factors
from skinbayes.statistics._group_input import GroupData, group_data
from skinbayes.statistics.correlated_noise import CorrelatedNoise
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.smooth_curves import SmoothCurves

_LOG_TWO_PI = log(2.0 * pi)

_PART = 100_000
"""Numbers that are worked on at once; more than fit into the cache take longer."""


@dataclass(frozen=True, eq=False)
class CorrelatedScatter:
    """What the rows of a model share beside its prediction; its methods are those of :class:`CrossedGroups`.

    ``residual`` and ``width`` are as there. ``scales`` of shape ``(B, P)`` are, in this order: the scale of the effects of each
    grouping column; size and length of the curves along each column; length of the memory of the noise, its independent
    fraction if it has one, and the scale of the drift if there is one. Effects are those of the groups, the values of curves at
    their nodes, and the drift of each series over the longest one.

    Attributes
    ----------
    n_rows : number of rows N
    groups : group effects, or None
    curves : smooth curves, one entry for each column
    noise : memory of the noise, or None
    drift : whether each series drifts
    """

    n_rows: int
    groups: CrossedGroups | None = None
    curves: tuple[SmoothCurves, ...] = ()
    noise: CorrelatedNoise | None = None
    drift: bool = False

    @property
    def n_scales(self) -> int:
        """Number of scales P."""
        of_noise = 0 if self.noise is None else 1 + self.noise.independent + self.drift
        return self._n_groups + 2 * len(self.curves) + of_noise

    @property
    def n_effects(self) -> int:
        """Number of effects K."""
        return self._design.shape[1]

    @property
    def matrix_size(self) -> int:
        """Numbers in the matrices that one parameter vector needs."""
        whole = self.n_rows * (self.n_effects + 1) if self.noise is not None else 0
        return 2 * whole + 4 * self.n_effects**2

    def rows(self, keep: NDArray[np.bool_]) -> CorrelatedScatter:
        """The same for some of the rows; all effects stay."""
        noise = self.noise
        if noise is not None:
            noise = CorrelatedNoise.of(noise.along[keep], noise.series[keep], noise.independent)
        groups = self.groups and replace(self.groups, member=self.groups.member[:, keep])
        curves = tuple(replace(c, x=c.x[keep], level=c.level[keep]) for c in self.curves)
        found = CorrelatedScatter(int(keep.sum()), groups, curves, noise, self.drift)
        found.__dict__["_design"] = np.ascontiguousarray(self._design[keep])
        return found

    def curve_effects(self, number: int) -> slice:
        """Where the nodes of the curves along one column are among the effects."""
        start = (0 if self.groups is None else self.groups.n_effects) + sum(
            curve.n_effects for curve in self.curves[:number]
        )
        return slice(start, start + self.curves[number].n_effects)

    @property
    def drift_effects(self) -> slice:
        """Where the drifts of the series are among the effects."""
        return slice(
            self.n_effects - (self.noise.n_series if self.noise and self.drift else 0), self.n_effects
        )

    def log_density(self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike) -> FloatArray:
        """Joint log-density of all rows, everything shared integrated out, shape ``(B,)``; −inf for impossible input."""

        def part(data: GroupData) -> FloatArray:
            white = White.of(self, data)
            inner, target = white.turned(self.prior_factor(data.scale))
            square = (white.residual**2).sum(axis=-1)
            # the last pivot of the factor of [[Q, t], [tᵀ, square + 1]] is what the effects leave of the square, and 1
            bordered = np.empty((len(inner), self.n_effects + 1, self.n_effects + 1))
            bordered[:, :-1, :-1] = inner + np.eye(self.n_effects)
            bordered[:, :-1, -1] = bordered[:, -1, :-1] = target
            bordered[:, -1, -1] = square + 1.0
            factor, sound = lower_factors(bordered)
            pivots = np.diagonal(factor, axis1=1, axis2=2)
            determinant = white.log_determinant + 2.0 * np.log(pivots[:, :-1]).sum(axis=-1)
            density = -0.5 * (pivots[:, -1] ** 2 - 1.0 + determinant + self.n_rows * _LOG_TWO_PI)
            return np.where(sound, density, nan)

        return self._in_parts(residual, width, scales, part, -inf, ())

    def log_density_pointwise(self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike) -> FloatArray:
        """Log-density of each row given all the others, shape ``(B, N)``; see :class:`CrossedGroups`."""

        def part(data: GroupData) -> FloatArray:
            solved = Solved.of(self, data)
            force, precision = solved.force_and_precision()
            return 0.5 * (np.log(precision) - force**2 / precision - _LOG_TWO_PI)

        return self._in_parts(residual, width, scales, part, -inf, (self.n_rows,))

    def log_density_left_out(
        self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike, block: NDArray[np.intp]
    ) -> FloatArray:
        """Joint log-density of each block of rows given all others, shape ``(B, n_blocks)``; see :class:`CrossedGroups`."""
        r, joint = np.asarray(residual, dtype=float), self.log_density(residual, width, scales)
        w = np.broadcast_to(np.asarray(width, dtype=float), r.shape)
        found = np.zeros((len(joint), int(np.max(block)) + 1))
        for number in np.unique(block):
            keep = np.asarray(block != number)
            rest = self.rows(keep).log_density(r[:, keep], w[:, keep], scales) if keep.any() else 0.0
            with np.errstate(invalid="ignore"):
                found[:, number] = joint - rest
        return np.where(np.isfinite(joint)[:, np.newaxis] & np.isfinite(found), found, -inf)

    def effects_given(
        self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Posterior of all effects given the data: mean ``(B, K)`` and covariance ``(B, K, K)``; NaN for impossible input."""

        def mean(data: GroupData) -> FloatArray:
            return Solved.of(self, data).mean

        def covariance(data: GroupData) -> FloatArray:
            solved = Solved.of(self, data)
            return solved.factor @ solved.effects.covariance() @ np.swapaxes(solved.factor, 1, 2)

        size = self.n_effects
        return (
            self._in_parts(residual, width, scales, mean, nan, (size,)),
            self._in_parts(residual, width, scales, covariance, nan, (size, size)),
        )

    def independent(self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike) -> FloatArray:
        """Residuals as numbers that scatter independently with width 1, shape ``(B, ·)``: R Rᵀ = r Σ⁻¹ rᵀ."""
        data = self._data(residual, width, scales)
        with np.errstate(all="ignore"):
            solved = Solved.of(self, data)
            found = np.concatenate([solved.left, solved.effects.centre], axis=-1)
        found[~(data.possible & solved.effects.sound)] = nan
        return found

    def draw_effects(
        self, rng: np.random.Generator, residual: ArrayLike, width: ArrayLike, scales: ArrayLike
    ) -> FloatArray:
        """One draw of all effects given the data, for each parameter vector, shape ``(B, K)``; NaN for impossible input."""
        standard = iter(rng.standard_normal((len(np.asarray(residual)), self.n_effects)))

        def part(data: GroupData) -> FloatArray:
            solved = Solved.of(self, data)
            own = np.array([next(standard) for _ in range(len(data.residual))]).reshape(-1, self.n_effects)
            return times(solved.factor, solved.effects.draw(own))

        return self._in_parts(residual, width, scales, part, nan, (self.n_effects,))

    def draw_new_effects(self, rng: np.random.Generator, scales: ArrayLike) -> FloatArray:
        """Effects that no data have seen, shape ``(B, K)``."""
        values = np.atleast_2d(np.asarray(scales, dtype=float))
        standard = rng.standard_normal((len(values), self.n_effects))
        parts = [
            times(self.prior_factor(values[place]), standard[place]) for place in self._parts(len(values))
        ]
        return np.concatenate(parts) if parts else standard

    def draw_noise(self, rng: np.random.Generator, scales: ArrayLike) -> FloatArray:
        """Noise of width 1, shape ``(B, N)``."""
        values = np.atleast_2d(np.asarray(scales, dtype=float))
        if self.noise is None:
            return rng.standard_normal((len(values), self.n_rows))
        return self.noise.at(*self._memory(values)).draw(rng)

    def at_rows(self, effects: ArrayLike) -> FloatArray:
        """What the effects ``(B, K)`` add to each row, shape ``(B, N)``."""
        return times(self._design, np.asarray(effects, dtype=float))

    # -- inner parts -------------------------------------------------------------------------------------------------

    @property
    def _n_groups(self) -> int:
        return 0 if self.groups is None else len(self.groups.columns)

    @cached_property
    def _design(self) -> FloatArray:
        """From effects to rows, shape ``(N, K)``."""
        blocks = []
        if self.groups is not None:
            blocks.append(self.groups.at_rows(np.eye(self.groups.n_effects)).T)
        blocks += [curve.design() for curve in self.curves]
        if self.noise is not None and self.drift:
            blocks.append(self.noise.drift_design())
        return np.ascontiguousarray(np.concatenate([np.zeros((self.n_rows, 0)), *blocks], axis=1))

    @cached_property
    def _transposed(self) -> FloatArray:
        return np.ascontiguousarray(self._design.T)

    def _columns(self, last: FloatArray, width: FloatArray) -> FloatArray:
        """Columns of the design over the width of each row, and one more of these, shape ``(B, K + 1, N)``."""
        found = np.empty((len(last), self.n_effects + 1, self.n_rows))
        np.divide(self._transposed, width[:, np.newaxis], out=found[:, :-1])
        found[:, -1] = last
        return found

    @cached_property
    def _gram(self) -> FloatArray:
        return self._design.T @ self._design

    def _memory(self, scales: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Length and independent fraction of the noise."""
        place = self._n_groups + 2 * len(self.curves)
        independent = self.noise is not None and self.noise.independent
        return scales[:, place], scales[:, place + 1] if independent else np.zeros(len(scales))

    def prior_factor(self, scales: FloatArray) -> FloatArray:
        """F, from independent standard normal numbers to effects, shape ``(B, K, K)``."""
        found = np.zeros((len(scales), self.n_effects, self.n_effects))
        start = 0

        def diagonal(scale: FloatArray, count: int) -> None:
            nonlocal start
            place = np.arange(start, start + count)
            found[:, place, place] = scale[:, np.newaxis]
            start += count

        for number in range(self._n_groups):
            diagonal(scales[:, number], len(self.groups.levels[number]) if self.groups else 0)
        for number, curve in enumerate(self.curves):
            place = self._n_groups + 2 * number
            block = curve.factor(scales[:, place], scales[:, place + 1])
            for _ in range(curve.n_levels):
                found[:, start : start + curve.n_nodes, start : start + curve.n_nodes] = block
                start += curve.n_nodes
        if self.noise is not None and self.drift:
            diagonal(scales[:, -1], self.noise.n_series)
        return found

    def _data(self, residual: ArrayLike, width: ArrayLike, scales: ArrayLike) -> GroupData:
        data = group_data(residual, width, scales, self.n_rows, [1] * self.n_scales)
        lengths = [self._n_groups + 2 * number + 1 for number in range(len(self.curves))]
        if self.noise is not None:
            place = self._n_groups + 2 * len(self.curves)
            lengths += [place, place + 1] if self.noise.independent else [place]
            if self.noise.independent:
                data.possible[:] &= data.scale[:, place + 1] < 1.0
        data.possible[:] &= (data.scale[:, lengths] > 0.0).all(axis=-1)
        scale = np.array(data.scale)
        scale[:, lengths] = np.where(data.possible[:, np.newaxis], scale[:, lengths], 0.5)  # harmless
        return replace(data, scale=scale)

    def _in_parts(
        self,
        residual: ArrayLike,
        width: ArrayLike,
        scales: ArrayLike,
        part: object,
        bad: float,
        shape: tuple[int, ...],
    ) -> FloatArray:
        """A function of a batch of data, in parts whose matrices fit into memory; ``bad`` for impossible input."""
        assert callable(part)
        data = self._data(residual, width, scales)
        found = np.empty((len(data.residual), *shape))
        with np.errstate(all="ignore"):
            for place in self._parts(len(found)):
                piece = GroupData(*(values[place] for values in vars(data).values()))
                values = part(piece)
                good = piece.possible & ~np.isnan(values.reshape(len(values), -1)).any(axis=-1)
                found[place] = np.where(good.reshape(-1, *[1] * len(shape)), values, bad)
        return found

    def _parts(self, count: int) -> Iterator[slice]:
        columns = 2 if self.noise is None else self.n_effects + 1
        step = max(1, min(128, _PART // (self.n_rows * columns + self.n_effects**2)))
        for start in range(0, count, step):
            yield slice(start, start + step)
