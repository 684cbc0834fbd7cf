"""Walkers that burn-in left behind are taken along, and nothing else is touched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from skinbayes.sampling.ensemble_engine import EnsembleEngine
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.stuck_walkers import (
    LATEST_ROUND,
    ensembles_left_behind,
    left_behind,
)


@dataclass(frozen=True)
class Pit:
    """A narrow normal peak in 3 dimensions, and a shallow pit far away in which walkers stay."""

    pit: bool = True

    names = ("x", "y", "z")
    fingerprint = "pit"

    def log_density(self, position):
        peak = -0.5 * np.square(position / 0.01).sum(axis=-1)
        far = -400.0 - 0.5 * np.square((position - 30.0) / 0.5).sum(axis=-1)
        return np.logaddexp(peak, far) if self.pit else peak

    def starts(self, rng, count):
        starts = rng.normal(0.0, 0.05, size=(count, 3))
        if self.pit:
            starts[:7] = rng.normal(30.0, 0.5, size=(7, 3))
        return starts


def test_left_behind_is_far_below_the_median() -> None:
    rng = np.random.default_rng(2)
    for dimension in (1, 5, 12):
        normal = -0.5 * np.square(rng.normal(size=(20_000, dimension))).sum(axis=1)
        assert not left_behind(normal, dimension).any()
        low = np.append(normal, np.median(normal) - 21 - 3 * dimension)
        assert left_behind(low, dimension).tolist() == [False] * len(normal) + [True]
    assert left_behind(np.array([-1.0, -2.0, -np.inf]), 1).tolist() == [False, False, True]


@pytest.fixture(scope="module")
def chains():
    return run_ensembles(Pit(), SamplerOptions(importance=False, seed=3, max_steps=3000))


def test_a_run_with_walkers_in_a_pit_converges_to_the_peak(chains) -> None:
    assert chains.report.converged
    assert chains.report.burn_in > 100
    assert (np.abs(chains.positions[:, 0, :7]) > 10).all()
    kept = chains.positions[:, chains.report.burn_in :]
    assert np.abs(kept).max() < 0.1
    # standard error of a standard deviation from this many effective draws, five of them
    effective = chains.report.ess_bulk.min()
    assert kept.std(axis=(0, 1, 2)) == pytest.approx(0.01, rel=5 / np.sqrt(2 * effective))


def test_pieces_and_cores_give_the_same_draws(chains, tmp_path) -> None:
    from skinbayes.sampling.store import SampleStore

    options = SamplerOptions(importance=False, seed=3, max_steps=200)
    run_ensembles(Pit(), options, store=SampleStore(tmp_path / "steps"))
    store = SampleStore(tmp_path / "steps", resume=True)
    resumed = run_ensembles(Pit(), SamplerOptions(importance=False, seed=3, max_steps=3000), store=store)
    assert_array_equal(resumed.positions, chains.positions)
    assert resumed.report.burn_in == chains.report.burn_in


def test_without_stuck_walkers_nothing_changes() -> None:
    run = run_ensembles(Pit(pit=False), SamplerOptions(importance=False, seed=4, max_steps=400, ess=1e9))
    low = [left_behind(run.log_density[e, step], 3).any() for e in range(4) for step in range(99, 400, 100)]
    assert not any(low)
    assert run.report.burn_in <= 200
    assert LATEST_ROUND >= 4


@dataclass(frozen=True)
class WholePit(Pit):
    """Half of the ensembles begin in the pit, with all their walkers."""

    def starts(self, rng, count):
        starts = rng.normal(0.0, 0.05, size=(count, 3))
        return starts + 30.0 if rng.random() < 0.5 else starts

    def prior_transform(self, unit):
        return 30.0 * unit


@pytest.mark.parametrize("importance", [True, False])
def test_an_ensemble_in_a_pit_goes_on_from_the_others(importance) -> None:
    found = EnsembleEngine().run(WholePit(), SamplerOptions(seed=2, importance=importance, max_steps=2000))
    assert found.diagnostics["converged"]
    weights = None if found.log_weights is None else np.exp(found.log_weights.ravel())
    deviation = np.sqrt(np.average(np.square(found.samples.reshape(-1, 3)), axis=0, weights=weights))
    effective = np.min(found.diagnostics["ess_bulk"])
    assert deviation == pytest.approx(0.01, rel=5 / np.sqrt(2 * effective))


def test_two_modes_that_both_count_keep_their_ensembles() -> None:
    """A mode of 100 times the height in each of 12 dimensions has e^55 times the density, and as much mass."""
    rng = np.random.default_rng(1)
    z = rng.normal(size=(2, 400, 12))
    width = np.array([1.0, 0.01])[:, np.newaxis]
    density = -0.5 * np.square(z).sum(axis=2) - 12 * np.log(width)
    positions = z * width[..., np.newaxis]
    assert not ensembles_left_behind(density, positions).any()
    assert ensembles_left_behind(density - np.array([[0.0], [90.0]]), positions).tolist() == [False, True]
