"""Friction of drying skin at 60 times for each of 64 parameter vectors: interpolated bridges against solving each skin.

Run with ``python benchmarks/drying.py [--json]``. Free are the modulus of the layer, the rms height, the contact angle on glass,
the film after wetting, its rate of evaporation and the shear stress: a prior of factors of about two either way, and vectors
about the paper's skin as late in a run. The baseline is the same model as it is before it is prepared: the bridges of each skin
solved, which `capillary.py` holds against plain NumPy. Errors are those of friction against the baseline; the table is
built once before a run.
"""

from __future__ import annotations

import time

import numpy as np
from common import COUNT, best_time, report

import skinbayes as sb
from skinbayes.forward import ForwardModel
from skinbayes.forward.base import Tables

TIMES = np.linspace(0.0, 708.0, 60)
SPREADS = {
    "frictional_shear_stress": 0.5,
    "young_modulus_layer": 0.5,
    "rms_height": 0.3,
    "initial_film": 0.2,
    "evaporation_rate": 0.2,
}
"""Standard deviations of ln in the prior."""


class Case:
    """A prepared model of drying skin, and 64 vectors about the paper's."""

    def __init__(self, seed: int = 1) -> None:
        problem = sb.load_problem("drying")
        self.model = problem.forward
        middle = problem.inputs(np.zeros((1, 0)))
        ranges = {n: (float(v.min()), float(v.max())) for n, v in middle.items() if np.isfinite(v).all()}
        for name, spread in SPREADS.items():
            value = float(middle[name][0, 0])
            ranges[name] = (value * np.exp(-3 * spread), value * np.exp(3 * spread))
        ranges["contact_angle_counterface"] = (0.0, np.radians(40.0))
        start = time.perf_counter()
        assert self.model.prepare is not None
        self.prepared = self.model.prepare(ranges, Tables(), None, 1)
        self.seconds = time.perf_counter() - start
        rng = np.random.default_rng(seed)
        drawn = {n: middle[n] * np.exp(0.25 * s * rng.normal(size=(COUNT, 1))) for n, s in SPREADS.items()}
        drawn["contact_angle_counterface"] = rng.uniform(0.0, np.radians(40.0), (COUNT, 1))
        self.inputs = {**middle, **drawn, "time": TIMES[np.newaxis]}

    def friction(self, model: ForwardModel) -> np.ndarray:
        """Friction at all times, shape ``(64, 60)``."""
        return model.evaluate(self.inputs, Tables())["friction_coefficient"]


def run() -> dict[str, float]:
    """Time both sides and compare their friction."""
    case = Case()
    error = np.abs(case.friction(case.prepared) / case.friction(case.model) - 1)
    plain = best_time(lambda: case.friction(case.model), 3)
    ours = best_time(lambda: case.friction(case.prepared), 10)
    return {
        "vectors": COUNT,
        "times": len(TIMES),
        "baseline_ms_per_vector": plain / COUNT * 1e3,
        "prepared_ms_per_vector": ours / COUNT * 1e3,
        "ratio": plain / ours,
        "largest_relative_error": float(error.max()),
        "rms_relative_error": float(np.sqrt(np.mean(np.square(error)))),
        "seconds_to_prepare": case.seconds,
    }


LINES = (
    ("each skin solved, ms per vector", "baseline_ms_per_vector", ".2f"),
    ("interpolated, ms per vector", "prepared_ms_per_vector", ".3f"),
    ("times faster", "ratio", ".1f"),
    ("largest relative error of friction", "largest_relative_error", ".1e"),
    ("root mean square of that error", "rms_relative_error", ".1e"),
    ("seconds to prepare", "seconds_to_prepare", ".1f"),
)

if __name__ == "__main__":
    report(__doc__, f"Friction at {len(TIMES)} times for each of {COUNT} parameter vectors", run, LINES)
