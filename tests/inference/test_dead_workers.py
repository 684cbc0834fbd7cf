"""A worker process that dies is started again once; the draws are the same, and a second death is one sentence."""

from __future__ import annotations

import multiprocessing
import os
import random
import signal
import threading
import time

import numpy as np
import pytest
from sampling_targets import Slow, UnitGaussian

from skinbayes.errors import MachineError
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.store import SampleStore

SHORT = {
    "seed": 3,
    "walkers": 16,
    "ensembles": 3,
    "block_steps": 20,
    "max_steps": 80,
    "ess": 1e6,
    "importance": False,
}
TARGET = UnitGaussian(2)


def same(first, second):
    return np.array_equal(first.positions, second.positions) and first.evaluations == second.evaluations


def kill(processes):
    for process in processes:
        process.kill()
        process.join()


@pytest.fixture(scope="module")
def serial():
    return run_ensembles(TARGET, SamplerOptions(**SHORT))


@pytest.mark.parametrize("count", [1, 2])
def test_workers_that_died_are_started_again(serial, count, capfd):
    def told(progress):
        if progress.steps == 40:
            kill(multiprocessing.active_children()[:count])

    chains = run_ensembles(TARGET, SamplerOptions(cores=2, **SHORT), progress=told)
    assert same(chains, serial)
    assert not multiprocessing.active_children()
    assert capfd.readouterr() == ("", "")


def test_a_second_death_is_one_sentence_and_steps_are_kept(serial, tmp_path):
    def told(progress):
        if progress.steps:
            kill(multiprocessing.active_children())

    options = SamplerOptions(cores=2, **SHORT)
    with pytest.raises(MachineError, match="worker process of the sampler died twice"):
        run_ensembles(TARGET, options, store=SampleStore(tmp_path), progress=told)
    assert not multiprocessing.active_children()
    assert len(list(tmp_path.glob("segment-*.h5"))) == 2
    assert same(run_ensembles(TARGET, options, store=SampleStore(tmp_path, resume=True)), serial)


def killed_once_while_sampling(moment):
    """Chains of a slow target on two cores, one worker of which is killed in the middle of its work; and how many were."""
    killed = []

    def assassin():
        time.sleep(moment)
        for process in multiprocessing.active_children()[:1]:
            os.kill(process.pid, signal.SIGKILL)
            killed.append(process.pid)

    thread = threading.Thread(target=assassin)

    def told(progress):
        if progress.steps == 10:
            thread.start()

    options = SamplerOptions(
        importance=False, seed=9, walkers=8, ensembles=2, block_steps=10, max_steps=100, ess=1e9, cores=2
    )
    chains = run_ensembles(Slow(2), options, progress=told)
    thread.join()
    return chains, len(killed)


@pytest.mark.slow
def test_killed_at_random_moments():
    whole = run_ensembles(
        Slow(2),
        SamplerOptions(
            importance=False, seed=9, walkers=8, ensembles=2, block_steps=10, max_steps=100, ess=1e9
        ),
    )
    moments = random.Random(1)
    deaths = 0
    for _ in range(20):
        chains, killed = killed_once_while_sampling(moments.uniform(0.0, 0.5))
        assert same(chains, whole)
        deaths += killed
    assert deaths >= 15  # of 20: the others came after the end
