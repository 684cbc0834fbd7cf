"""Time a whole fit of ``forearm-glass`` against the plain script a user would write, both in one run.

Run it on an idle machine::

    python benchmarks/fit_forearm_glass.py [--steps 3000] [--json]

(a) ``skinbayes fit forearm-glass`` as a process of its own: wall seconds from start to exit, imports included; CPU seconds
of the process; the smallest effective sample size of all parameters.

(b) The plain script: ``scipy.integrate.quad`` for the integral of Eq. 3 with Eq. 4 inside, in a scalar log-probability with
the same priors (in logarithms of the parameters) and plain theory, sampled by emcee with 32 walkers and its default move. As
a user would write it, with NumPy functions and the default tolerances of quad; and tuned, with functions of the math module
and a tolerance of 1e-4. Both make the same evaluations, so one long chain of the tuned script gives the autocorrelation time
of both, and the time of an evaluation as written comes from a shorter chain. The effective sample size is steps times
walkers over emcee's autocorrelation time, after a quarter of the steps is discarded; what is discarded is not charged.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from math import erf, exp, inf, log, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
from common import timed_fit

WALKERS = 32
LOAD, RADIUS = 0.5, 8e-3
OBSERVED = {"dry": 0.3, "wet": 1.4}
NOISE = 0.1
# name: (median, sd of ln); the shear stress is log-uniform between two values
PRIORS = {
    "modulus_dry": (0.75e9, 0.7), "modulus_wet": (7e6, 0.5), "yield_stress": (50e6, 0.5), "bulk": (20e3, 0.35),
    "thickness": (20.5e-6, 0.15), "height": (22.4e-6, 0.35),
}  # fmt: skip
SHEAR_RANGE = (0.5e6, 500e6)
HURST, LOW, ROLLOFF, HIGH = 0.78, 1e3, 6.345e3, 1e9


def twice_stress_variance(
    modulus: float, bulk: float, thickness: float, height: float, tuned: bool = True
) -> float:
    """Eq. 3 times 4 p0², with the layer of Eq. 4, both for incompressible skin, by scipy.integrate.quad."""
    from scipy.integrate import quad

    mean_square = 2 * pi * (
        (ROLLOFF**2 - LOW**2) / 2 + ROLLOFF**2 / (2 * HURST) * (1 - (ROLLOFF / HIGH) ** (2 * HURST))
    )  # fmt: skip
    amplitude = height**2 / mean_square
    reduced, ratio = modulus / 0.75, modulus / bulk
    exponential = exp if tuned else np.exp

    def integrand(log_q: float) -> float:
        q = exponential(log_q)
        x = q * thickness
        power = amplitude * (1.0 if q < ROLLOFF else (q / ROLLOFF) ** (-2 * (1 + HURST)))
        if x > 30:
            response = 1.0
        else:
            # Eq. 4 for ν = 1/2: both of its constants are (G0 − G1)/(G0 + G1) up to sign
            m = 1 - bulk / modulus
            m /= 1 + bulk / modulus
            e2 = exponential(-2 * x)
            response = (1 + 4 * m * x * e2 - m * m * e2 * e2) / (
                1 - 2 * m * (1 + 2 * x * x) * e2 + m * m * e2 * e2
            )
            response = min(response, ratio)
        return q**4 * power * (reduced / response) ** 2

    options = {"epsrel": 1e-4} if tuned else {}
    return pi * quad(integrand, log(LOW), log(HIGH), limit=200, points=[log(ROLLOFF)], **options)[0]


def relative_area(pressure: float, twice_variance: float, yield_stress: float) -> float:
    """Elastic and plastic contact area of plain theory (Fourier series; erf if purely elastic)."""
    if yield_stress == inf:
        return erf(pressure / sqrt(twice_variance))
    ratio, spread = pressure / yield_stress, sqrt(twice_variance) / yield_stress
    total, n = ratio, 1
    while True:
        decay = exp(-((n * pi * spread) ** 2) / 4) / n * np.sin(n * pi * ratio)
        total += 2 / pi * decay * (1 if n % 2 else 0) * 2 + 2 / pi * (-1) ** n * decay
        n += 1
        if (n * pi * spread) ** 2 / 4 > 40:
            return float(total)


def log_probability(position: np.ndarray, tuned: bool = True) -> float:
    """Log-posterior of ln of the parameters: ln σ_f, then the order of PRIORS."""
    if not log(SHEAR_RANGE[0]) < position[0] < log(SHEAR_RANGE[1]):
        return -inf
    value = 0.0
    for at, (median, width) in zip(position[1:], PRIORS.values(), strict=True):
        value -= 0.5 * ((at - log(median)) / width) ** 2
    shear, dry, wet, yield_stress, bulk, thickness, height = (exp(v) for v in position)
    reduced = bulk / 0.75
    pressure = LOAD / (pi * (3 * LOAD * RADIUS / (4 * reduced)) ** (2 / 3))
    for state, modulus, limit in (("dry", dry, yield_stress), ("wet", wet, inf)):
        area = relative_area(pressure, twice_stress_variance(modulus, bulk, thickness, height, tuned), limit)
        friction = shear * area / pressure
        if not friction > 0:
            return -inf
        value -= 0.5 * (log(OBSERVED[state] / friction) / NOISE) ** 2
    return value


def run_emcee(steps: int, tuned: bool) -> tuple[Any, float]:
    """Sample the script; the sampler and its CPU seconds."""
    import emcee

    rng = np.random.RandomState(1)
    centre = np.array([log(15e6), *(log(median) for median, _ in PRIORS.values())])
    start = centre + 0.1 * rng.normal(size=(WALKERS, centre.size))
    sampler = emcee.EnsembleSampler(WALKERS, centre.size, log_probability, kwargs={"tuned": tuned})
    state = emcee.State(start, random_state=rng.get_state())
    began = time.process_time()
    sampler.run_mcmc(state, steps)
    return sampler, time.process_time() - began


def plain_script(steps: int) -> dict[str, dict[str, float]]:
    """Time the script as written and tuned."""
    sampler, seconds = run_emcee(steps, tuned=True)
    tau = float(np.max(sampler.get_autocorr_time(discard=steps // 4, quiet=True, tol=0)))
    short = max(steps // 30, 10)
    _, short_seconds = run_emcee(short, tuned=False)
    each = {"tuned": seconds / (steps * WALKERS), "as_written": short_seconds / (short * WALKERS)}
    return {
        kind: {
            "steps": steps if kind == "tuned" else short, "tau": tau, "steps_over_tau": 0.75 * steps / tau,
            "milliseconds_per_evaluation": 1e3 * time_of_one, "cpu_seconds_per_effective_sample": time_of_one * tau,
        }
        for kind, time_of_one in each.items()
    }  # fmt: skip


def whole_fit() -> dict[str, float]:
    """Run the command and read what it reports."""
    with tempfile.TemporaryDirectory() as folder:
        found, report = timed_fit(["forearm-glass", "--seed", "1", "-o", str(Path(folder) / "run")])
    return {**found, "converged": report["converged"]}


def sampling_only() -> dict[str, float]:
    """The same fit inside this process: CPU seconds of sampling, imports and tables apart."""
    from skinbayes.problem import load_problem
    from skinbayes.sampling.ensembles import run_ensembles
    from skinbayes.sampling.options import SamplerOptions

    target = load_problem("forearm-glass").target()
    target.log_density(target.starts(np.random.default_rng(0), 8))  # tables are made at the first use
    run_ensembles(target, SamplerOptions(seed=9, ess=1, walkers=32, max_steps=100, block_steps=50))
    began = time.process_time()
    chains = run_ensembles(target, SamplerOptions(seed=1, ess=2000))
    seconds = time.process_time() - began
    size = float(chains.report.ess_bulk.min())
    return {"cpu_seconds": seconds, "min_ess": size, "cpu_seconds_per_effective_sample": seconds / size}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--steps", type=int, default=3000, help="steps of the plain script")
    parser.add_argument("--json", action="store_true", help="one JSON document")
    chosen = parser.parse_args()
    fit, sampling, plain = whole_fit(), sampling_only(), plain_script(chosen.steps)
    ratios = {
        kind: {
            "sampling": one["cpu_seconds_per_effective_sample"]
            / sampling["cpu_seconds_per_effective_sample"],
            "whole_process": one["cpu_seconds_per_effective_sample"]
            / fit["cpu_seconds_per_effective_sample"],
        }
        for kind, one in plain.items()
    }
    if chosen.json:
        print(json.dumps({"fit": fit, "sampling": sampling, "plain": plain, "ratio": ratios}, indent=1))
        return
    print(f"skinbayes fit forearm-glass: {fit['wall_seconds']:.2f} s wall, {fit['cpu_seconds']:.2f} s CPU, "
          f"smallest ESS {fit['min_ess']:.0f}; sampling alone {sampling['cpu_seconds']:.2f} s CPU")  # fmt: skip
    for kind, one in plain.items():
        better = ratios[kind]
        print(
            f"plain script, {kind.replace('_', ' ')}: {one['milliseconds_per_evaluation']:.2f} ms an evaluation, "
            f"tau {one['tau']:.0f} steps (seen {one['steps_over_tau']:.0f} times)"
        )
        print(
            f"  CPU seconds per effective sample over those of skinbayes: {better['sampling']:.0f} sampling alone, "
            f"{better['whole_process']:.0f} whole process"
        )


if __name__ == "__main__":
    main()
