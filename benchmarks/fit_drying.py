"""Time a whole fit of a drying series of 60 points against the same model without table, moved by emcee's default.

Run it on an idle machine::

    python benchmarks/fit_drying.py [--steps 6000] [--json]

The model is the one that docs/drying.md offers to copy: nine parameters of skin, film and evaporation, and the noise. Its
series is drawn from it at the paper's values with 5 % of noise.

(a) ``skinbayes fit my-drying.toml --ess 1000 --cores 2`` as a process of its own: wall seconds from start to exit, imports and
table included; the smallest effective sample size; CPU seconds of the same with one core, where no time of workers can be
missed.

(b) The baseline: each skin solved for each vector, half of emcee's usual 32 walkers at once, moved by the stretch move. It makes
the same evaluations as a run from the table, which gives its autocorrelation time, and the time of an evaluation comes from a
few batches of the posterior. Its effective sample size is steps times walkers over the autocorrelation time, from the
posterior on: its burn-in is not charged.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import tempfile
import time
from dataclasses import replace
from pathlib import Path

# one thread, as the command line has it
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from common import ROOT, timed_fit

import skinbayes as sb
from skinbayes.problem import Problem
from skinbayes.sampling.advance import EnsembleState, advance
from skinbayes.sampling.convergence import autocorrelation_time, rank_normalise
from skinbayes.sampling.moves import WeightedMoves

WALKERS, BATCHES = 32, 6
TIMES = np.concatenate([[0.0, 8.0, 16.0, 24.0], np.linspace(40.0, 640.0, 56)])
TRUTH = {
    "frictional_shear_stress": 15e6, "young_modulus_layer": 7e6, "yield_stress": 50e6, "rms_height": 22.4e-6,
    "contact_angle_counterface": 0.17, "contact_angle_skin": 1.4, "initial_film": 90e-6, "evaporation_rate": 1.743e-7,
    "film_spread": 3e-7, "noise_scale": 0.05,
}  # fmt: skip


def prepare(folder: Path) -> Path:
    """Write the model of the documents and a simulated series; the path of the model file."""
    page = (ROOT / "docs" / "drying.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"```toml\n(format = 1\n.*?)```", page, re.DOTALL)
    model = folder / "my-drying.toml"
    model.write_text(text, encoding="utf-8")

    def write(friction: np.ndarray) -> Problem:
        rows = [f"{t!r},{mu!r}" for t, mu in zip(TIMES.tolist(), friction.tolist(), strict=True)]
        lines = "\n".join(["time [s],friction_coefficient [1]", *rows])
        (folder / "my-series.csv").write_text(lines + "\n", encoding="utf-8")
        return sb.load_problem(str(model))

    blank = write(np.ones(TIMES.size))
    truth = np.array([TRUTH[name] for name in blank.names])
    write(blank.simulate(truth, np.random.default_rng(3)))
    return model


def whole_fit(model: Path, cores: str) -> dict[str, float]:
    """Run the command and read what it reports."""
    run = str(model.parent / f"run{cores}")
    found, report = timed_fit([str(model), "--ess", "1000", "--cores", cores, "-o", run])
    inside = sum(
        report["parameters"][name]["q05"] < value < report["parameters"][name]["q95"]
        for name, value in TRUTH.items()
    )
    return {**found, "steps": report["steps"], "truths_in_their_90_percent_intervals": inside}


def stretch_move() -> WeightedMoves:
    """emcee's default."""
    from emcee.moves import StretchMove

    return [(StretchMove(), 1.0)]


def baseline(model: Path, steps: int) -> dict[str, float]:
    """Autocorrelation time of the stretch move, and CPU time of an evaluation without table."""
    problem = sb.load_problem(str(model))
    target = problem.target()
    fit = sb.load_fit(model.parent / "run1")
    posterior = target.transform.forward(np.stack([fit.draws(name) for name in problem.names], axis=-1))
    rng = np.random.default_rng(1)
    start = posterior[rng.choice(len(posterior), WALKERS, replace=False)]
    state = np.random.RandomState(1).get_state(legacy=True)
    block = advance(
        target, EnsembleState(start, target.log_density(start), tuple(state)), steps, stretch_move
    )
    series = block.positions.transpose(2, 1, 0)
    tau = max(autocorrelation_time(rank_normalise(each))[0] for each in series)
    unprepared = replace(problem, forward=replace(problem.forward, prepare=None)).target()
    batches = [rng.choice(posterior, WALKERS // 2, replace=False) for _ in range(BATCHES)]
    unprepared.log_density(batches[0])
    began = time.process_time()
    for batch in batches:
        unprepared.log_density(batch)
    each = (time.process_time() - began) / (BATCHES * WALKERS // 2)
    return {
        "tau": tau, "steps_over_tau": steps / tau, "milliseconds_per_evaluation": 1e3 * each,
        "cpu_seconds_per_effective_sample": each * tau,
    }  # fmt: skip


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--steps", type=int, default=6000, help="steps of the stretch move")
    parser.add_argument("--json", action="store_true", help="one JSON document")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        model = prepare(Path(folder))
        fit, alone = whole_fit(model, "2"), whole_fit(model, "1")
        fit |= {name: alone[name] for name in ("cpu_seconds", "cpu_seconds_per_effective_sample")}
        plain = baseline(model, chosen.steps)
    ratio = plain["cpu_seconds_per_effective_sample"] / fit["cpu_seconds_per_effective_sample"]
    if chosen.json:
        print(json.dumps({"fit": fit, "baseline": plain, "ratio": ratio}, indent=1))
        return
    print(
        f"skinbayes fit: {fit['wall_seconds']:.1f} s wall on two cores, {fit['cpu_seconds']:.1f} s CPU on one, "
        f"{fit['steps']:.0f} steps, smallest ESS {fit['min_ess']:.0f}, "
        f"{fit['truths_in_their_90_percent_intervals']} of {len(TRUTH)} truths in their 90 % intervals"
    )
    print(
        f"baseline: {plain['milliseconds_per_evaluation']:.2f} ms an evaluation, tau {plain['tau']:.0f} steps "
        f"(seen {plain['steps_over_tau']:.0f} times)"
    )
    print(f"CPU seconds per effective sample over those of skinbayes, whole process: {ratio:.0f}")


if __name__ == "__main__":
    main()
