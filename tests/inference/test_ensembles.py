"""Runs of several ensembles: the same draws however they are computed, and clear words when they cannot be."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest
from sampling_targets import Failing, Faulty, UnitGaussian

from skinbayes.errors import InputError
from skinbayes.sampling.advance import Density, advance
from skinbayes.sampling.ensembles import SamplingInterrupted, run_ensembles
from skinbayes.sampling.moves import default_moves
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.starts import initial_states

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
SHORT = {"max_steps": 60, "block_steps": 20, "walkers": 24, "ensembles": 3, "importance": False}


def same(first, second):
    return np.array_equal(first.positions, second.positions) and np.array_equal(
        first.log_density, second.log_density
    )


@pytest.fixture(scope="module")
def serial():
    return run_ensembles(UnitGaussian(3), SamplerOptions(seed=4, **SHORT))


def test_shapes_and_counts(serial):
    assert serial.positions.shape == (3, 60, 24, 3)
    assert serial.log_density.shape == (3, 60, 24)
    assert serial.evaluations == 3 * 24 * 61  # the starts and one a walker and step
    assert serial.invalid == 0
    flat = serial.positions.reshape(-1, 3)
    assert np.array_equal(UnitGaussian(3).log_density(flat), serial.log_density.ravel())
    assert 0.1 < serial.acceptance_fraction().min() <= serial.acceptance_fraction().max() < 0.8


def test_one_seed_fixes_everything(serial):
    np.random.seed(77)  # noqa: NPY002 - the global generator plays no part
    assert same(serial, run_ensembles(UnitGaussian(3), SamplerOptions(seed=4, **SHORT)))
    assert not same(serial, run_ensembles(UnitGaussian(3), SamplerOptions(seed=5, **SHORT)))


def test_ensembles_have_streams_of_their_own(serial):
    for first, second in ((0, 1), (0, 2), (1, 2)):
        assert not np.array_equal(serial.positions[first], serial.positions[second])


def test_an_ensemble_does_not_depend_on_how_many_others_there_are(serial):
    fewer = run_ensembles(UnitGaussian(3), SamplerOptions(seed=4, **{**SHORT, "ensembles": 2}))
    assert np.array_equal(fewer.positions, serial.positions[:2])


class RowByRow(UnitGaussian):
    """A density that is asked for each walker by itself."""

    def log_density(self, position):
        return np.concatenate([super(RowByRow, self).log_density(row[np.newaxis]) for row in position])


def test_walker_by_walker_is_vectorised(serial):
    assert same(serial, run_ensembles(RowByRow(3), SamplerOptions(seed=4, **SHORT)))


def test_processes_are_serial(serial):
    """Beside another thread, too: nothing is forked from this process. The workers end with the run."""
    stop = threading.Event()
    thread = threading.Thread(target=stop.wait)
    thread.start()
    try:
        shared = run_ensembles(UnitGaussian(3), SamplerOptions(seed=4, cores=2, **SHORT))
    finally:
        stop.set()
        thread.join()
    assert same(serial, shared)
    assert multiprocessing.active_children() == []


def test_block_length_does_not_change_draws(serial):
    options = SamplerOptions(seed=4, **{**SHORT, "block_steps": 30})
    assert same(serial, run_ensembles(UnitGaussian(3), options))


def test_pieces_of_a_block_are_the_block():
    target = UnitGaussian(3)
    start = initial_states(target, SamplerOptions(seed=4, **SHORT))[0]
    whole = advance(target, start, 10, default_moves)
    first = advance(target, start, 3, default_moves)
    second = advance(target, first.end, 7, default_moves)
    assert np.array_equal(whole.positions, np.concatenate((first.positions, second.positions)))
    assert np.array_equal(whole.random_state[1], second.random_state[1])
    assert whole.random_state[2:] == second.random_state[2:]


def test_nan_and_infinity_count_as_impossible():
    chains = run_ensembles(Faulty(2), SamplerOptions(seed=1, **SHORT))
    assert np.isfinite(chains.log_density).all()
    assert np.abs(chains.positions[..., 0]).max() <= 2.0
    assert chains.invalid > 0
    density = Density(Faulty(2))
    value = density(np.array([[3.0, 0.0], [-3.0, 0.0], [0.0, 0.0]]))
    assert value.tolist() == [-np.inf, -np.inf, 0.0]
    assert (density.evaluations, density.invalid) == (3, 2)
    assert density.first_invalid.tolist() == [3.0, 0.0]
    assert np.abs(chains.first_invalid[0]) > 2.0


def test_impossible_starts_are_named():
    with pytest.raises(
        InputError, match=r"ensemble 1: .* begin where .* first is walker \d+ at x0 = .*x1 = "
    ):
        run_ensembles(Faulty(2, spread=3.0), SamplerOptions(seed=1, **SHORT))


def test_starts_at_one_value_are_named():
    class Flat(UnitGaussian):
        def starts(self, rng, count):
            return np.column_stack((rng.normal(size=count), np.full(count, 2.0)))

    with pytest.raises(InputError, match="same x1"):
        run_ensembles(Flat(2), SamplerOptions(seed=1, **SHORT))


def test_starts_in_a_plane_are_refused():
    class Plane(UnitGaussian):
        def starts(self, rng, count):
            first = rng.normal(size=count)
            return np.column_stack((first, 3.0 * first))

    with pytest.raises(InputError, match="plane"):
        run_ensembles(Plane(2), SamplerOptions(seed=1, **SHORT))


@pytest.mark.parametrize("cores", [1, 2])
def test_errors_of_the_target_arrive(cores, capfd):
    with pytest.raises(ArithmeticError, match="the model broke"):
        run_ensembles(Failing(2), SamplerOptions(seed=1, cores=cores, **{**SHORT, "max_steps": 2000}))
    assert capfd.readouterr() == ("", "")


def test_progress_is_told():
    told = []
    chains = run_ensembles(UnitGaussian(2), SamplerOptions(seed=1, **SHORT), progress=told.append)
    assert [progress.steps for progress in told] == [0, 20, 40, 60]
    assert {progress.max_steps for progress in told} == {60}
    assert told[-1].report is chains.report


def test_ctrl_c_keeps_whole_blocks(serial, capfd):
    def interrupt(progress):
        if progress.steps == 40:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(SamplingInterrupted) as caught:
        run_ensembles(UnitGaussian(3), SamplerOptions(seed=4, **SHORT), progress=interrupt)
    assert np.array_equal(caught.value.chains.positions, serial.positions[:, :40])
    assert not caught.value.chains.converged
    assert capfd.readouterr() == ("", "")


def test_ctrl_c_in_a_terminal_reaches_workers_quietly(tmp_path):
    """A terminal signals the whole process group; one sentence comes from the caller and nothing from workers."""
    script = (
        "import sys\n"
        "from sampling_targets import Slow\n"
        "from skinbayes.sampling.ensembles import SamplingInterrupted, run_ensembles\n"
        "from skinbayes.sampling.options import SamplerOptions\n"
        "def told(progress):\n"
        "    print(progress.steps, flush=True)\n"
        "if __name__ == '__main__':\n"
        "    try:\n"
        "        options = SamplerOptions(importance=False, seed=1, cores=2, block_steps=5, walkers=8)\n"
        "        run_ensembles(Slow(2), options, progress=told)\n"
        "    except SamplingInterrupted:\n"
        "        sys.exit(130)\n"
    )
    file = tmp_path / "script.py"
    file.write_text(script)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join((str(HERE), str(ROOT)))}
    process = subprocess.Popen(
        [sys.executable, str(file)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    for line in process.stdout:
        if int(line) >= 10:
            os.killpg(process.pid, signal.SIGINT)
            break
    _, complaints = process.communicate(timeout=60)
    assert process.returncode == 130
    assert complaints == ""


def test_draws_are_thinned_and_in_order_of_time():
    chains = run_ensembles(UnitGaussian(2), SamplerOptions(importance=False, seed=2))
    positions, log_density = chains.draws()
    stride = chains.thinning()
    assert stride == np.ceil(chains.report.tau.max())
    kept = chains.steps - chains.report.burn_in
    assert positions.shape == (4, -(-kept // stride) * 128, 2)
    assert np.array_equal(UnitGaussian(2).log_density(positions.reshape(-1, 2)), log_density.ravel())
    assert np.array_equal(positions[:, -128:], chains.positions[:, -1])
    assert np.array_equal(positions[:, -256:-128], chains.positions[:, -1 - stride])
    few, few_density = chains.draws(max_per_chain=50)
    assert few.shape == (4, 50, 2)
    assert few_density.shape == (4, 50)


def test_chains_are_frozen_and_travel(serial):
    with pytest.raises(FrozenInstanceError):
        serial.invalid = 3
    assert same(serial, pickle.loads(pickle.dumps(serial)))


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("seed", -1),
        ("seed", 1.5),
        ("seed", True),
        ("ensembles", 1),
        ("walkers", 7),
        ("walkers", 2),
        ("ess", 0.0),
        ("ess", float("nan")),
        ("ess", float("inf")),
        ("r_hat", 1.0),
        ("steps_over_tau", -50),
        ("max_steps", 24),
        ("block_steps", 0),
        ("cores", 0),
    ],
)
def test_options_out_of_range_are_named(option, value):
    with pytest.raises(InputError, match=f"{option}: .* found, .* expected"):
        SamplerOptions(**{"seed": 1, option: value})


def test_too_few_walkers_for_the_dimension():
    with pytest.raises(InputError, match="walkers: 8 found, at least 10 expected"):
        run_ensembles(UnitGaussian(5), SamplerOptions(importance=False, seed=1, walkers=8))
