"""What the benchmarks share: timing a call, and printing the result as a table or as JSON."""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from math import log
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]

COUNT = 64
"""Parameter vectors in a batch: half of an ensemble of 128 walkers."""


def parameter_vectors(seed: int = 1) -> dict[str, np.ndarray]:
    """Skins and loads over their ranges, log-uniform where they are scales; SI units, each of shape ``(COUNT,)``."""
    rng = np.random.default_rng(seed)

    def scale(low: float, high: float) -> np.ndarray:
        return np.exp(rng.uniform(log(low), log(high), COUNT))

    return {
        "rms_height": scale(5e-6, 8e-5),
        "hurst_exponent": rng.uniform(0.6, 0.95, COUNT),
        "wavevector_min": scale(5e2, 3e3),
        "wavevector_rolloff": scale(4e3, 2e4),
        "wavevector_max": scale(1e8, 1e10),
        "young_modulus_layer": scale(1e6, 2e9),
        "young_modulus_bulk": scale(5e3, 1e5),
        "poisson_ratio_layer": rng.uniform(0.3, 0.5, COUNT),
        "poisson_ratio_bulk": rng.uniform(0.3, 0.5, COUNT),
        "layer_thickness": scale(1e-5, 1e-4),
        "nominal_pressure": scale(1e3, 3e4),
    }


def best_time(
    function: Callable[[], object],
    repeats: int,
    calls: int = 1,
    clock: Callable[[], float] = time.process_time,
) -> float:
    """Seconds a call, the best of ``repeats`` rounds; CPU seconds unless another clock is given."""
    times = []
    for _ in range(repeats):
        start = clock()
        for _ in range(calls):
            function()
        times.append((clock() - start) / calls)
    return min(times)


def timed_fit(arguments: Sequence[str]) -> tuple[dict[str, float], dict[str, Any]]:
    """Run ``skinbayes fit ARGUMENTS --json`` as a process of its own.

    Returns
    -------
    wall and CPU seconds (without those of workers), smallest effective sample size, evaluations, CPU seconds per effective
    sample; and what the command reports
    """
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    command = [sys.executable, "-c", "from skinbayes.cli import main; main()", "fit", *arguments, "--json"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.perf_counter()
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env={**os.environ, "PYTHONPATH": path}
    )
    wall = time.perf_counter() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = json.loads(done.stdout)
    size = min(parameter["ess_bulk"] for parameter in found["parameters"].values())
    return {
        "wall_seconds": wall, "cpu_seconds": cpu, "min_ess": size, "evaluations": found["log_likelihood_evaluations"],
        "cpu_seconds_per_effective_sample": cpu / size,
    }, found  # fmt: skip


def report(
    description: str | None,
    title: str,
    run: Callable[[], dict[str, float]],
    lines: Sequence[tuple[str, str, str]],
) -> None:
    """Run a benchmark and print it.

    Parameters
    ----------
    description : docstring of the benchmark, whose first line is the help text
    title : first line of the table
    run : makes the measurement
    lines : label, key of the result and number format of each line
    """
    parser = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one JSON document on standard output")
    as_json = parser.parse_args().json
    result = run()
    if as_json:
        print(json.dumps(result, indent=2))
        return
    print(title)
    for label, key, style in lines:
        print(f"  {label:<52}{result[key]:>10{style}}")
