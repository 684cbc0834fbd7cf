"""The stopping rule: its numbers against closed forms and other implementations, and what must and must not pass."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from sampling_targets import EnsembleModes, TwoModes, UnitGaussian
from scipy.signal import lfilter
from scipy.special import ndtri
from scipy.stats import rankdata

from skinbayes.sampling.convergence import (
    autocorrelation_time,
    r_hat,
    rank_normalise,
    rank_r_hat,
)
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.stopping import is_check, judge


def first_order(shape, tau, seed=0):
    """Stationary first-order process of unit variance along the last axis: τ = (1 + φ)/(1 − φ)."""
    phi = (tau - 1.0) / (tau + 1.0)
    noise = np.random.default_rng(seed).normal(size=shape) * np.sqrt(1.0 - phi**2)
    noise[..., 0] /= np.sqrt(1.0 - phi**2)
    return lfilter([1.0], [1.0, -phi], noise, axis=-1)


def chains(steps, tau, seed=0, walkers=64, dimension=2):
    """Positions (ensembles, steps, walkers, D) of independent walkers of known autocorrelation time."""
    return np.ascontiguousarray(np.moveaxis(first_order((4, walkers, dimension, steps), tau, seed), -1, 1))


def verdict(positions, **options):
    names = tuple("ab"[: positions.shape[-1]])
    return judge(positions, names, SamplerOptions(importance=False, seed=0, **options))


# numbers


@pytest.mark.parametrize(("tau", "steps"), [(1.0, 100), (5.0, 100), (20.0, 300), (60.0, 2000)])
def test_autocorrelation_time_of_a_known_process(tau, steps):
    estimates = [autocorrelation_time(first_order((256, steps), tau, seed)) for seed in range(5)]
    near, far = np.mean(estimates, axis=0)
    assert near == pytest.approx(tau, rel=0.08)
    assert far == pytest.approx(tau, rel=0.12)


def test_autocorrelation_time_agrees_with_emcee_on_long_series():
    from emcee.autocorr import integrated_time

    series = first_order((32, 20_000), 20.0)
    own, _ = autocorrelation_time(series)
    assert own == pytest.approx(integrated_time(series.T)[0], rel=0.02)


def test_autocorrelation_time_sees_what_the_series_own_mean_hides(caplog):
    """Series that sit at different places never decorrelate; with its own mean taken off each looks like noise."""
    from emcee.autocorr import integrated_time

    places = np.repeat([-5.0, 5.0], 16)[:, np.newaxis]
    series = places + np.random.default_rng(0).normal(size=(32, 500))
    assert autocorrelation_time(series)[0] == np.inf
    with caplog.at_level(logging.CRITICAL):
        assert integrated_time(series.T, quiet=True)[0] < 2.0


def test_autocorrelation_time_of_what_does_not_vary_or_is_too_short():
    assert np.isnan(autocorrelation_time(np.ones((4, 100)))[0])
    assert autocorrelation_time(np.ones((4, 3)))[0] == np.inf


def test_rank_normalise_with_ties():
    values = np.array([[3.0, 1.0, 3.0], [2.0, 1.0, 1.0]])
    expected = ndtri((rankdata(values.ravel()) - 0.375) / 6.25).reshape(2, 3)
    assert rank_normalise(values) == pytest.approx(expected, abs=1e-14)


def test_r_hat_by_hand():
    # within: (1 + 1)/2; between means 0 and 2: variance 2; (3 − 1)/3 + 2
    assert r_hat([[-1.0, 0.0, 1.0], [1.0, 2.0, 3.0]]) == pytest.approx(np.sqrt(2 / 3 + 2))
    assert np.isnan(r_hat([[1.0, 1.0], [1.0, 1.0]]))
    assert r_hat([[1.0, 1.0], [2.0, 2.0]]) == np.inf


@pytest.mark.parametrize("case", ["same", "shifted", "wider", "drifting", "tied"])
def test_r_hat_is_the_one_of_arviz(case):
    import arviz

    draws = first_order((4, 1000), 4.0, seed=3)
    if case == "shifted":
        draws[0] += 0.5
    if case == "wider":
        draws[1] *= 2.0
    if case == "drifting":
        draws += np.linspace(0.0, 1.0, 1000)
    if case == "tied":
        draws = draws.round(1)
    assert rank_r_hat(draws) == pytest.approx(float(arviz.rhat(draws)), abs=1e-9)


# the rule


def test_long_agreeing_chains_pass():
    report = verdict(chains(steps=400, tau=10.0))
    assert report.converged
    assert report.missing == ()
    assert report.tau == pytest.approx(10.0, rel=0.15)
    kept = 400 - report.burn_in
    assert report.ess_bulk == pytest.approx(4 * 64 * kept / 10.0, rel=0.15)
    assert report.ess_tail.min() > report.ess_bulk.min() * 0.5
    assert report.sentence().startswith("Converged after 400 steps")


def test_quantiles_that_mix_slowly_do_not_pass():
    # beyond its 5 and 95 % quantiles a walker stays where it is; the middle is fresh at every step
    positions = chains(steps=400, tau=1.0, dimension=1)
    tails = np.random.default_rng(1).random((4, 1, 64, 1)) < 0.1
    outside = np.where(np.random.default_rng(2).random(tails.shape) < 0.5, -3.0, 3.0)
    report = verdict(np.where(tails, outside + 0.01 * positions, positions), walkers=64)
    assert not report.converged
    assert any("5 and 95 % quantiles of a" in sentence for sentence in report.missing)


def test_short_chains_do_not_pass():
    report = verdict(chains(steps=100, tau=10.0))
    assert not report.converged
    assert report.burn_in == 50
    assert "autocorrelation" in report.sentence()


@pytest.mark.parametrize("steps", [1, 2, 3, 7])
def test_a_handful_of_steps_is_judged_without_complaint(steps):
    assert not verdict(chains(steps=steps, tau=2.0)).converged


def test_too_small_a_sample_does_not_pass():
    report = verdict(chains(steps=400, tau=10.0), ess=20_000)
    assert len(report.missing) == 1
    assert "effective sample size of" in report.missing[0]
    assert "20000 is asked for" in report.missing[0]


def test_heavy_autocorrelation_does_not_pass():
    report = verdict(chains(steps=400, tau=200.0))
    assert not report.converged
    assert "has not died out" in report.sentence()


def test_drift_does_not_pass():
    positions = chains(steps=400, tau=5.0)
    assert verdict(positions).converged
    positions[..., 0] += np.linspace(0.0, 1.0, 400)[:, np.newaxis]
    report = verdict(positions)
    assert not report.converged
    assert "a" in report.missing[0]


def test_one_ensemble_elsewhere_does_not_pass():
    positions = chains(steps=400, tau=5.0)
    positions[0, ..., 1] += 0.5
    report = verdict(positions)
    assert any("ensembles disagree about b" in sentence for sentence in report.missing)


def test_one_wider_ensemble_does_not_pass():
    """Same location, other spread: seen by the folded R-hat."""
    positions = chains(steps=400, tau=5.0)
    positions[0, ..., 1] *= 1.6
    report = verdict(positions)
    assert any("ensembles disagree about b" in sentence for sentence in report.missing)


def test_half_and_half_inside_every_ensemble_does_not_pass():
    """Ensembles agree with each other and each walker looks like noise; only walkers among themselves disagree."""
    positions = chains(steps=400, tau=1.0)
    positions[:, :, ::2, 0] += 30.0
    report = verdict(positions)
    assert report.r_hat.max() < 1.01
    assert any("single walkers disagree about a" in sentence for sentence in report.missing)
    assert report.walker_r_hat[1] < 1.05


def test_a_few_walkers_that_never_move_do_not_pass():
    positions = chains(steps=400, tau=5.0)
    assert verdict(positions).unmoved_walkers == 0
    positions[2, :, 7] = positions[2, 0, 7] * 0.1  # in the middle of the others, where R-hat sees nothing
    report = verdict(positions)
    assert report.unmoved_walkers == 1
    assert any("1 of all walkers never moved" in sentence for sentence in report.missing)


def test_a_coordinate_that_never_varies_does_not_pass():
    positions = chains(steps=400, tau=5.0)
    positions[..., 1] = 3.0
    report = verdict(positions)
    assert not report.converged
    assert "b" in report.sentence()


def test_burn_in_grows_with_tau_and_is_at_most_half():
    assert verdict(chains(steps=1000, tau=1.0)).burn_in == 200
    assert verdict(chains(steps=1000, tau=30.0)).burn_in == pytest.approx(300, rel=0.25)
    assert verdict(chains(steps=200, tau=30.0)).burn_in == 100


def test_a_transient_is_discarded():
    positions = chains(steps=600, tau=10.0)
    positions += 50.0 * np.exp(-np.arange(600) / 20.0)[:, np.newaxis, np.newaxis]
    report = verdict(positions)
    assert report.converged
    assert abs(positions[:, report.burn_in :].mean()) < 0.05


def test_long_chains_are_judged_as_short_ones():
    report = verdict(chains(steps=6000, tau=40.0, walkers=32))
    assert report.converged
    assert report.tau == pytest.approx(40.0, rel=0.15)
    assert report.ess_bulk == pytest.approx(4 * 32 * (6000 - report.burn_in) / 40.0, rel=0.15)


def test_checks_come_at_whole_blocks_and_ever_further_apart():
    checks = [steps for steps in range(100, 3000, 100) if is_check(steps, 100)]
    assert checks == [200, 300, 400, 500, 600, 800, 1000, 1300, 1700, 2200, 2800]
    assert [steps for steps in range(70, 700, 70) if is_check(steps, 70)] == [210, 280, 350, 490, 630]


def test_runs_in_two_modes_do_not_converge():
    options = SamplerOptions(importance=False, seed=1, max_steps=400, walkers=64)
    inside = run_ensembles(TwoModes(2), options).report
    assert inside.r_hat.max() < 1.01  # every ensemble sits half and half in both
    assert any("single walkers disagree about x0" in sentence for sentence in inside.missing)
    between = run_ensembles(EnsembleModes(2), options).report
    assert any("ensembles disagree about x0" in sentence for sentence in between.missing)


def test_a_run_stops_as_soon_as_it_may():
    chains = run_ensembles(UnitGaussian(2), SamplerOptions(importance=False, seed=1))
    assert chains.converged
    assert chains.steps == 200


def test_a_run_that_may_not_stop_says_what_is_missing():
    chains = run_ensembles(UnitGaussian(2), SamplerOptions(importance=False, seed=1, ess=1e6, max_steps=250))
    assert not chains.converged
    assert chains.steps == 200  # whole blocks
    assert "1000000 is asked for" in chains.report.sentence()
