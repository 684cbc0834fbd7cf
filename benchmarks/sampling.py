"""Effective samples per CPU second: our moves against emcee's stretch move, in one run.

    python benchmarks/sampling.py [--json] [--repeats N]

All sample the same two targets in five dimensions: a Gaussian of correlated coordinates and a Student t with
four degrees of freedom. The stretch move runs as a script would use it (32 walkers, density vectorised), the
default moves with 128 walkers, the moves of expensive targets with 64. All start from the target, run for about the
same time, and are judged by the same estimate of the effective sample size, the smallest over coordinates. CPU
seconds include everything between the first and the last step.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from dataclasses import dataclass
from typing import Any

# One thread: small systems are slower on several, and CPU seconds would count the waiting.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.advance import EnsembleState, advance
from skinbayes.sampling.convergence import autocorrelation_time, rank_normalise
from skinbayes.sampling.moves import MoveFactory, WeightedMoves, default_moves, few_walkers_moves

DIMENSION = 5


@dataclass(frozen=True)
class Correlated:
    """Gaussian, or Student t with ``degrees`` degrees of freedom, with correlation 0.9 between neighbours."""

    degrees: float | None = None
    names = tuple(f"x{index}" for index in range(DIMENSION))
    fingerprint = "benchmark"

    def factor(self) -> FloatArray:
        """Cholesky factor of the correlation matrix."""
        places = np.arange(DIMENSION)
        return np.linalg.cholesky(0.9 ** np.abs(places[:, np.newaxis] - places))

    def log_density(self, position: FloatArray) -> FloatArray:
        """Log-density of each row."""
        square = np.square(position @ _INVERSE.T).sum(axis=1)
        if self.degrees is None:
            return -0.5 * square
        return -0.5 * (self.degrees + DIMENSION) * np.log1p(square / self.degrees)

    def starts(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Independent draws from the target."""
        position = rng.standard_normal((count, DIMENSION)) @ self.factor().T
        if self.degrees is None:
            return position
        return position / np.sqrt(rng.chisquare(self.degrees, (count, 1)) / self.degrees)


_INVERSE = np.linalg.inv(Correlated().factor())


def stretch_move() -> WeightedMoves:
    """emcee's default."""
    from emcee.moves import StretchMove

    return [(StretchMove(), 1.0)]


SAMPLERS: dict[str, tuple[MoveFactory, int, int]] = {
    "default moves, 128 walkers": (default_moves, 128, 1500),
    "moves for few walkers, 64 walkers": (few_walkers_moves, 64, 3000),
    "stretch move, 32 walkers": (stretch_move, 32, 6000),
}
TARGETS = {"correlated Gaussian": Correlated(), "Student t, 4 degrees of freedom": Correlated(4.0)}


def measure(target: Correlated, moves: MoveFactory, walkers: int, steps: int, seed: int) -> dict[str, float]:
    """Run one ensemble; effective sample size, evaluations and CPU seconds."""
    positions = target.starts(np.random.default_rng(seed), walkers)
    state = np.random.RandomState(seed).get_state(legacy=True)
    start = EnsembleState(positions, target.log_density(positions), tuple(state))
    begun = time.process_time()
    block = advance(target, start, steps, moves)
    seconds = time.process_time() - begun
    tau = max(
        autocorrelation_time(rank_normalise(block.positions[..., index]).T)[0] for index in range(DIMENSION)
    )
    return {
        "effective_sample_size": block.positions[..., 0].size / tau,
        "evaluations": block.evaluations,
        "cpu_seconds": seconds,
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="one JSON document instead of the table")
    parser.add_argument("--repeats", type=int, default=3, help="runs of each, of which the sums are taken")
    arguments = parser.parse_args()
    import emcee  # noqa: F401 - its import is not what is measured

    rows: list[dict[str, Any]] = []
    for target_name, target in TARGETS.items():
        for sampler, (moves, walkers, steps) in SAMPLERS.items():
            runs = [measure(target, moves, walkers, steps, seed) for seed in range(arguments.repeats)]
            total = {key: sum(run[key] for run in runs) for key in runs[0]}
            rows.append(
                {
                    "target": target_name,
                    "sampler": sampler,
                    "ess_per_cpu_second": total["effective_sample_size"] / total["cpu_seconds"],
                    "ess_per_evaluation": total["effective_sample_size"] / total["evaluations"],
                    **total,
                }
            )
    *ours, plain = SAMPLERS
    per_second = {(row["target"], row["sampler"]): row["ess_per_cpu_second"] for row in rows}
    ratios = {
        f"{target}, {sampler}": per_second[target, sampler] / per_second[target, plain]
        for target in TARGETS
        for sampler in ours
    }
    if arguments.json:
        print(json.dumps({"runs": rows, "ratio_of_ess_per_cpu_second": ratios}, indent=2))
        return
    print(f"{'target':<34}{'sampler':<36}{'ESS / CPU s':>12}{'ESS / evaluation':>18}{'CPU s':>8}")
    for row in rows:
        print(
            f"{row['target']:<34}{row['sampler']:<36}{row['ess_per_cpu_second']:>12.0f}"
            f"{row['ess_per_evaluation']:>18.4f}{row['cpu_seconds']:>8.1f}"
        )
    for name, ratio in ratios.items():
        print(f"{name}: {ratio:.1f} times the effective samples per CPU second of the stretch move")


if __name__ == "__main__":
    main()
