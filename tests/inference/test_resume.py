"""An interrupted and resumed run is the uninterrupted one, however and whenever it was interrupted."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from sampling_targets import UnitGaussian

from skinbayes.errors import FingerprintMismatch, InputError
from skinbayes.sampling.ensembles import SamplingInterrupted, run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.store import SampleStore

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
TARGET = UnitGaussian(3)
SHORT = {
    "seed": 4,
    "walkers": 24,
    "ensembles": 2,
    "block_steps": 20,
    "max_steps": 100,
    "ess": 1e6,
    "importance": False,
}


def same(first, second):
    return (
        np.array_equal(first.positions, second.positions)
        and np.array_equal(first.log_density, second.log_density)
        and first.evaluations == second.evaluations
    )


@pytest.fixture(scope="module")
def uninterrupted():
    return run_ensembles(TARGET, SamplerOptions(**SHORT))


def interrupt_after(steps):
    def told(progress):
        if progress.steps == steps:
            raise KeyboardInterrupt

    return told


@pytest.mark.parametrize("steps", [0, 20, 40, 60, 80, 100])
def test_interrupted_after_any_block(tmp_path, uninterrupted, steps):
    options = SamplerOptions(**SHORT)
    with pytest.raises(SamplingInterrupted) as caught:
        run_ensembles(TARGET, options, store=SampleStore(tmp_path), progress=interrupt_after(steps))
    if steps == 0:
        assert caught.value.chains is None
    else:
        assert np.array_equal(caught.value.chains.positions, uninterrupted.positions[:, :steps])
    resumed = run_ensembles(TARGET, options, store=SampleStore(tmp_path, resume=True))
    assert same(resumed, uninterrupted)
    assert resumed.report.sentence() == uninterrupted.report.sentence()


def test_interrupted_at_every_block_and_resumed_otherwise(tmp_path, uninterrupted):
    """Each piece computed in another way."""
    ways = [{}, {"cores": 2}, {}, {"cores": 3}]
    for number, way in enumerate(ways):
        with pytest.raises(SamplingInterrupted):
            run_ensembles(
                TARGET,
                SamplerOptions(**SHORT, **way),
                store=SampleStore(tmp_path, resume=True),
                progress=interrupt_after(20 * (number + 1)),
            )
    resumed = run_ensembles(TARGET, SamplerOptions(**SHORT), store=SampleStore(tmp_path, resume=True))
    assert same(resumed, uninterrupted)


def test_interrupted_in_the_middle_of_a_block(tmp_path, uninterrupted):
    calls = []

    class Interrupting(UnitGaussian):
        def log_density(self, position):
            calls.append(1)
            if len(calls) == 150:
                raise KeyboardInterrupt
            return super().log_density(position)

        @property
        def fingerprint(self):
            return TARGET.fingerprint

    with pytest.raises(SamplingInterrupted):
        run_ensembles(Interrupting(3), SamplerOptions(**SHORT), store=SampleStore(tmp_path))
    assert len(list(tmp_path.glob("segment-*.h5"))) == 1
    resumed = run_ensembles(TARGET, SamplerOptions(**SHORT), store=SampleStore(tmp_path, resume=True))
    assert same(resumed, uninterrupted)


def test_totals_are_totals(tmp_path, uninterrupted):
    """A run that ended is not prolonged by resuming it; a larger total is reached, not added."""
    shorter = SamplerOptions(**{**SHORT, "max_steps": 60})
    run_ensembles(TARGET, shorter, store=SampleStore(tmp_path))
    again = run_ensembles(TARGET, shorter, store=SampleStore(tmp_path, resume=True))
    assert again.steps == 60
    longer = run_ensembles(TARGET, SamplerOptions(**SHORT), store=SampleStore(tmp_path, resume=True))
    assert same(longer, uninterrupted)


def test_a_converged_run_is_returned_at_once_and_continued_for_more(tmp_path):
    class Counting(UnitGaussian):
        calls = 0

        def log_density(self, position):
            Counting.calls += 1
            return super().log_density(position)

    first = run_ensembles(
        Counting(2), SamplerOptions(importance=False, seed=1, walkers=40), store=SampleStore(tmp_path)
    )
    assert first.converged
    Counting.calls = 0
    again = run_ensembles(
        Counting(2),
        SamplerOptions(importance=False, seed=1, walkers=40),
        store=SampleStore(tmp_path, resume=True),
    )
    assert Counting.calls == 0
    assert same(first, again)
    assert again.report.sentence() == first.report.sentence()
    more = SamplerOptions(importance=False, seed=1, walkers=40, ess=1.5 * first.report.ess_bulk.min())
    longer = run_ensembles(Counting(2), more, store=SampleStore(tmp_path, resume=True))
    assert longer.converged
    assert longer.steps > first.steps
    assert same(longer, run_ensembles(Counting(2), more))


def test_another_model_or_setting_is_refused(tmp_path):
    options = SamplerOptions(**SHORT)
    run_ensembles(TARGET, options, store=SampleStore(tmp_path))
    with pytest.raises(FingerprintMismatch, match="model or data"):
        run_ensembles(UnitGaussian(3, spread=2.0), options, store=SampleStore(tmp_path, resume=True))
    other = SamplerOptions(**{**SHORT, "seed": 5})
    with pytest.raises(FingerprintMismatch, match="seed is 4 there and 5 here"):
        run_ensembles(TARGET, other, store=SampleStore(tmp_path, resume=True))
    with pytest.raises(InputError, match="Resume it, or give another directory"):
        run_ensembles(TARGET, options, store=SampleStore(tmp_path))


SCRIPT = """
import sys
import emcee  # before the first line is written, so that kills do not fall into the import
from sampling_targets import Slow
from skinbayes.sampling.ensembles import run_ensembles
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.store import SampleStore

if __name__ == "__main__":
    options = SamplerOptions(
        seed=9, walkers=8, ensembles=2, block_steps=2, max_steps=200, ess=1e9, cores=int(sys.argv[2]), importance=False
    )
    told = lambda progress: print(progress.steps, flush=True)
    run_ensembles(Slow(2), options, store=SampleStore(sys.argv[1], resume=True), progress=told)
"""


def killed_and_resumed(folder, cores, kills, seed):
    """Run the script, killing it at random moments; the chains at the end."""
    from sampling_targets import Slow

    file = folder / "script.py"
    file.write_text(SCRIPT)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(HERE), str(ROOT)))}
    moments = random.Random(seed)
    steps = folder / "steps"
    survived = []
    for _ in range(kills):
        process = subprocess.Popen(
            [sys.executable, str(file), str(steps), str(cores)], env=environment, stdout=subprocess.PIPE
        )
        begun = int(process.stdout.readline())
        time.sleep(moments.uniform(0.0, 0.4))
        process.send_signal(signal.SIGKILL)
        process.communicate(timeout=60)
        survived.append(begun)
    options = SamplerOptions(
        importance=False, seed=9, walkers=8, ensembles=2, block_steps=2, max_steps=200, ess=1e9
    )
    store = SampleStore(steps, resume=True)
    target = Slow(2)
    resumed = run_ensembles(target, options, store=store)
    return survived, resumed, run_ensembles(target, options)


def test_killed_at_random_moments(tmp_path):
    survived, resumed, uninterrupted = killed_and_resumed(tmp_path, cores=1, kills=3, seed=1)
    assert survived == sorted(survived)
    assert 0 < survived[-1] < 200  # it was killed under way
    assert same(resumed, uninterrupted)


@pytest.mark.slow
@pytest.mark.parametrize("cores", [1, 2])
def test_killed_at_many_random_moments(tmp_path, cores):
    survived, resumed, uninterrupted = killed_and_resumed(tmp_path, cores=cores, kills=25, seed=2)
    assert survived == sorted(survived)
    assert same(resumed, uninterrupted)
