"""Group effects, smooth curves, correlated noise and drift together, against dense normal distributions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from skinbayes.errors import InputError
from skinbayes.statistics.correlated_noise import CorrelatedNoise
from skinbayes.statistics.correlated_scatter import CorrelatedScatter
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.smooth_curves import WORST_ERROR, SmoothCurves, nodes_for

ROWS = 40
SIZE, LENGTH, MEMORY, FRACTION, DRIFT = 0.25, 0.2, 12.0, 0.3, 0.4
GROUPS = (0.3, 0.2)


class Case:
    """A design, its scales, and the covariance of its rows as a dense matrix."""

    def __init__(self, seed: int, groups: bool, curve: bool, noise: str, drift: bool, alike: bool) -> None:
        rng = np.random.default_rng(seed)
        self.width = np.full(ROWS, 0.1) if alike else rng.uniform(0.05, 0.2, ROWS)
        covariance = np.zeros((ROWS, ROWS))
        scales: list[float] = []
        crossed, curves, memory = None, (), None
        if groups:
            crossed = CrossedGroups.of_labels(
                {name: rng.integers(0, 4, ROWS).astype(np.str_) for name in ("person", "item")}
            )
            scales += GROUPS
            for member, scale in zip(crossed.member, GROUPS, strict=True):
                covariance += scale**2 * (member[:, None] == member)
        if curve:
            x, level = rng.uniform(size=ROWS), rng.integers(0, 2, ROWS)
            curves = (SmoothCurves(x, level, 2, 30),)  # so many nodes that only rounding is left
            scales += [SIZE, LENGTH]
            kernel = SIZE**2 * np.exp(-0.5 * ((x[:, None] - x) / LENGTH) ** 2)
            covariance += kernel * (level[:, None] == level)
        correlation = np.eye(ROWS)
        if noise:
            time, series = rng.uniform(0.0, 100.0, ROWS), rng.integers(0, 2, ROWS)
            independent = noise == "independent part"
            time = 5.0 * np.round(time / 5.0) if independent else time  # rows of the same time
            memory = CorrelatedNoise.of(time, series, independent)
            scales += [MEMORY, FRACTION] if independent else [MEMORY]
            correlation = np.exp(-np.abs(time[:, None] - time) / MEMORY) * (series[:, None] == series)
            if independent:
                correlation = (1.0 - FRACTION) * correlation + FRACTION * np.eye(ROWS)
            if drift:
                scales.append(DRIFT)
                since = time - np.array([time[series == s].min() for s in series])
                covariance += (
                    DRIFT**2 * np.outer(since, since) / since.max() ** 2 * (series[:, None] == series)
                )
        self.covariance = covariance + self.width[:, None] * correlation * self.width
        self.scatter = CorrelatedScatter(ROWS, crossed, curves, memory, drift)
        self.scales = np.array([scales])
        self.residual = rng.multivariate_normal(np.zeros(ROWS), self.covariance)

    @property
    def arguments(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.residual[np.newaxis], self.width, self.scales

    def dense(self, rows: np.ndarray | slice = slice(None)) -> float:
        covariance = self.covariance[rows][:, rows]
        return float(
            stats.multivariate_normal(np.zeros(len(covariance)), covariance).logpdf(self.residual[rows])
        )


CASES = [
    (True, True, "", False, False),
    (False, True, "", False, True),
    (False, False, "pure", True, False),
    (True, True, "pure", True, True),
    (False, False, "independent part", False, True),
    (True, True, "independent part", True, False),
]


@pytest.mark.parametrize("parts", CASES)
def test_every_density_is_that_of_the_dense_normal(parts: tuple[bool, bool, str, bool, bool]) -> None:
    case = Case(3, *parts)
    precision = np.linalg.inv(case.covariance)
    assert case.scatter.log_density(*case.arguments)[0] == pytest.approx(case.dense(), abs=1e-7)
    force, own = precision @ case.residual, np.diag(precision)
    pointwise = 0.5 * (np.log(own) - force**2 / own - np.log(2 * np.pi))
    found = case.scatter.log_density_pointwise(*case.arguments)[0]
    np.testing.assert_allclose(found, pointwise, atol=1e-7)
    block = np.arange(ROWS) % 3
    left_out = [case.dense() - case.dense(block != i) for i in range(3)]
    np.testing.assert_allclose(
        case.scatter.log_density_left_out(*case.arguments, block)[0], left_out, atol=1e-7
    )
    changes = np.vstack([case.residual, np.ones(ROWS)])
    white = case.scatter.independent(changes, case.width, case.scales)
    np.testing.assert_allclose(white @ white.T, changes @ precision @ changes.T, rtol=1e-6)


@pytest.mark.parametrize("parts", CASES[:1] + CASES[3:4])
def test_effects_given_data_are_the_conditional_normal(parts: tuple[bool, bool, str, bool, bool]) -> None:
    case = Case(5, *parts)
    mean, covariance = case.scatter.effects_given(*case.arguments)
    noise = case.covariance.copy()
    factor = case.scatter.prior_factor(case.scales)[0]
    design = case.scatter.at_rows(np.eye(case.scatter.n_effects)).T
    prior = factor @ factor.T
    noise -= design @ prior @ design.T
    gain = prior @ design.T @ np.linalg.inv(case.covariance)
    np.testing.assert_allclose(mean[0], gain @ case.residual, atol=1e-6)
    np.testing.assert_allclose(covariance[0], prior - gain @ design @ prior, atol=1e-6)
    draws = case.scatter.draw_effects(
        np.random.default_rng(1), np.repeat(case.residual[np.newaxis], 500, 0), case.width, case.scales
    )
    spread = np.sqrt(np.diag(covariance[0])) + 1e-9
    assert np.abs((draws.mean(axis=0) - mean[0]) / spread).max() < 4.5 / np.sqrt(500)


@pytest.mark.parametrize("noise", ["pure", "independent part"])
def test_new_data_have_the_covariance_of_the_model(noise: str) -> None:
    case = Case(7, True, True, noise, True, False)
    rng, count = np.random.default_rng(2), 4000
    effects = case.scatter.draw_new_effects(rng, np.repeat(case.scales, count, 0))
    drawn = case.scatter.at_rows(effects) + case.width * case.scatter.draw_noise(
        rng, np.repeat(case.scales, count, 0)
    )
    whitened = np.linalg.solve(np.linalg.cholesky(case.covariance), drawn.T)
    assert np.abs(np.cov(whitened) - np.eye(ROWS)).max() < 5 * np.sqrt(2 / count)


@pytest.mark.parametrize("parts", CASES)
def test_a_batch_is_its_vectors_and_impossible_ones_touch_no_other(
    parts: tuple[bool, bool, str, bool, bool],
) -> None:
    case = Case(9, *parts)
    scales = case.scales * np.random.default_rng(1).uniform(0.5, 1.5, (6, case.scales.shape[1]))
    scales[2, 0] = -1.0
    scales[4, -1] = np.nan
    residual = np.repeat(case.residual[np.newaxis], 6, 0)
    together = case.scatter.log_density(residual, case.width, scales)
    alone = [case.scatter.log_density(residual[:1], case.width, row[np.newaxis])[0] for row in scales]
    assert np.array_equal(together, alone)
    assert np.isneginf(together[[2, 4]]).all() and np.isfinite(together[[0, 1, 3, 5]]).all()


@pytest.mark.parametrize("length", [0.05, 0.1, 0.3, 1.0])
def test_curves_between_nodes_are_those_of_the_gaussian_process(length: float) -> None:
    x = np.linspace(0.0, 1.0, 101)
    curve = SmoothCurves(x, np.zeros(len(x), dtype=np.intp), 1, nodes_for(length))
    for longer in (1.0, 3.0):
        root = curve.design() @ curve.factor(np.ones(1), np.array([length * longer]))[0]
        dense = np.exp(-0.5 * ((x[:, None] - x) / (length * longer)) ** 2)
        error = np.abs(root @ root.T - dense).max()
        assert error < (WORST_ERROR if longer == 1.0 else 1e-7)


def test_equal_steps_are_an_autoregressive_process_of_first_order() -> None:
    memory = CorrelatedNoise.of(np.arange(50.0), np.zeros(50, dtype=int), False)
    length = -1.0 / np.log(0.8)
    noise = memory.at(np.array([length]), np.zeros(1)).draw(np.random.default_rng(3))[0]
    scatter = CorrelatedScatter(50, noise=memory)
    first, rest = stats.norm.logpdf(noise[0]), stats.norm.logpdf(noise[1:], 0.8 * noise[:-1], 0.6)
    found = scatter.log_density(noise[np.newaxis], 1.0, [[length]])[0]
    assert found == pytest.approx(first + rest.sum(), abs=1e-10)


def test_rows_of_a_series_at_the_same_place_need_an_independent_part() -> None:
    with pytest.raises(InputError, match="same place"):
        CorrelatedNoise.of(np.array([1.0, 2.0, 2.0]), np.zeros(3, dtype=int), False)
    assert CorrelatedNoise.of(np.array([1.0, 2.0, 2.0]), np.array([0, 0, 1]), False).n_series == 2


def test_some_of_the_rows_keep_all_effects() -> None:
    case = Case(11, True, True, "independent part", True, False)
    keep = np.arange(ROWS) % 3 > 0
    reduced = case.scatter.rows(keep)
    assert reduced.n_effects == case.scatter.n_effects
    found = reduced.log_density(case.residual[np.newaxis, keep], case.width[keep], case.scales)[0]
    assert found == pytest.approx(case.dense(keep), abs=1e-7)
    assert replace(case.scatter, drift=False).n_effects == case.scatter.n_effects - 2
