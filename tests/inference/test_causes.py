"""Why a run has not converged: two places, a ridge, too few steps."""

from __future__ import annotations

import numpy as np
import pytest
from sampling_targets import UnitGaussian

from skinbayes.sampling.causes import RIDGE, cause, thinned
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.stopping import judge


def made(positions) -> Chains:
    """A run with given steps ``(E, S, W, D)``."""
    names = tuple(f"x{index}" for index in range(positions.shape[-1]))
    report = judge(positions, names, SamplerOptions(importance=False, seed=1))
    return Chains(names, positions, np.zeros(positions.shape[:-1]), report, 0, 0, np.full(len(names), np.nan))


@pytest.mark.parametrize(("elsewhere", "expected"), [(32, 128), (3, 12), (0, 0)])
def test_walkers_in_two_places(elsewhere, expected) -> None:
    positions = np.random.default_rng(1).normal(size=(4, 300, 64, 2))
    positions[:, :, :elsewhere, 1] += 30.0
    found = cause(made(positions))
    assert found.apart == expected
    assert found.walkers == 256
    assert found.slowest == "x1" or not expected


def test_slow_walkers_of_one_mode_are_not_two_places() -> None:
    rng = np.random.default_rng(2)
    walk = np.cumsum(0.02 * rng.normal(size=(4, 300, 64, 2)), axis=1) + rng.normal(size=(4, 1, 64, 2))
    assert cause(made(walk)).apart <= 3  # outliers at most


def test_a_ridge_and_quantities_that_are_not_sampled() -> None:
    rng = np.random.default_rng(4)
    along = np.cumsum(0.1 * rng.normal(size=(4, 300, 64, 1)), axis=1)  # slow, known to a hundredth across
    positions = np.concatenate([along, along, np.zeros_like(along)], axis=-1)
    chains = made(positions + np.array([0.01, 0.01, 1.0]) * rng.normal(size=positions.shape))
    found = cause(chains)
    pair = {found.slowest, found.partner}
    assert found.apart == 0
    assert pair == {"x0", "x1"}
    assert found.correlation > RIDGE
    # an effect that makes up for the slowest coordinate is found, one that does not is not
    index = chains.names.index(found.slowest)
    opposite = -thinned(chains)[:, index]
    noise = np.random.default_rng(1).normal(size=len(opposite))
    shared = cause(chains, {"the effect of person": opposite, "the effect of site": noise})
    assert shared.partner == "the effect of person"
    assert shared.correlation == pytest.approx(-1.0)


def test_too_few_steps() -> None:
    found = cause(
        run_ensembles(UnitGaussian(2), SamplerOptions(importance=False, seed=1, max_steps=200, ess=1e6))
    )
    assert found.apart == 0
    assert found.partner is None
