"""Fits of shipped models with importance sampling after exploration, against walkers until the stopping rule is met.

Run with ``python benchmarks/importance.py [MODEL …] [--seeds N] [--json]``. Both sides sample the same target in one process, one
after the other, to the same effective sample size; CPU seconds are without imports and tables.
"""

from __future__ import annotations

import argparse
import json
import time

import numpy as np

from skinbayes import load_problem
from skinbayes.sampling.ensemble_engine import EnsembleEngine
from skinbayes.sampling.options import SamplerOptions

MODELS = ("forearm-glass", "forearm-glass-separate", "finger-null", "finger-water", "finger-descriptive")


def measured(name: str, seed: int, importance: bool) -> dict[str, object]:
    """One fit in numbers."""
    problem = load_problem(name)
    target = problem.target()
    target.log_density(target.starts(np.random.default_rng(seed), 4))  # tables are built or read here
    started = time.process_time()
    options = SamplerOptions(seed=seed, importance=importance, expensive=problem.expensive)
    draws = EnsembleEngine().run(target, options)
    seconds = time.process_time() - started
    found = draws.diagnostics
    ess = float(np.min(found["ess_bulk"]))
    return {
        "model": name,
        "seed": seed,
        "importance": importance,
        "accepted": draws.log_weights is not None,
        "converged": bool(found["converged"]),
        "cpu_seconds": seconds,
        "evaluations": int(found["evaluations"]),
        "effective_sample_size": ess,
        "evaluations_per_effective_draw": found["evaluations"] / ess,
        "log_evidence": draws.log_evidence,
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("models", nargs="*", default=MODELS, metavar="MODEL")
    parser.add_argument("--seeds", type=int, default=1, help="runs of each side")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    arguments = parser.parse_args()
    results = []
    for name in arguments.models:
        for seed in range(1, arguments.seeds + 1):
            pair = [measured(name, seed, importance) for importance in (True, False)]
            results += pair
            if not arguments.json:
                new, old = pair
                kind = "importance" if new["accepted"] else "refused"
                print(
                    f"{name}, seed {seed}: {kind} {new['evaluations_per_effective_draw']:.1f} evaluations for an effective draw "
                    f"({new['cpu_seconds']:.1f} CPU s), walkers {old['evaluations_per_effective_draw']:.1f} "
                    f"({old['cpu_seconds']:.1f} CPU s): {old['cpu_seconds'] / new['cpu_seconds']:.1f} times less",
                    flush=True,
                )
    if arguments.json:
        print(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
