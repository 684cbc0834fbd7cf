"""Log-density of rows that are not independent: a smooth curve over 2000 rows, correlated noise of 20 000, beside the physics.

Run with ``python benchmarks/discrepancy.py [--json]``. Times are CPU time for one vector of a batch of 32, least of five.
The physics is the friction of an elastomer at so many different loads. Errors are against
dense normal distributions, of 400 rows.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from common import report
from scipy.stats import multivariate_normal

from skinbayes.forward import Tables, forward_model
from skinbayes.statistics.correlated_noise import CorrelatedNoise
from skinbayes.statistics.correlated_scatter import CorrelatedScatter
from skinbayes.statistics.smooth_curves import SmoothCurves, nodes_for

VECTORS, SMOOTH, SERIES, DENSE = 32, 2000, 20_000, 400
SIZE, LENGTH, MEMORY, FRACTION, DRIFT, WIDTH = 0.2, 0.2, 5.0, 0.3, 0.1, 0.05


def smooth(rows: int) -> tuple[CorrelatedScatter, list[float], np.ndarray]:
    """A curve along one column, its scales and the covariance of at most `DENSE` rows."""
    x = np.linspace(0.0, 1.0, rows)
    scatter = CorrelatedScatter(rows, curves=(SmoothCurves(x, np.zeros(rows, np.intp), 1, nodes_for(0.1)),))
    x = x[:DENSE]
    kernel = SIZE**2 * np.exp(-0.5 * ((x[:, None] - x) / LENGTH) ** 2)
    return scatter, [SIZE, LENGTH], kernel + WIDTH**2 * np.eye(len(x))


def series(rows: int, independent: bool) -> tuple[CorrelatedScatter, list[float], np.ndarray]:
    """Correlated noise with a drift."""
    t = np.arange(float(rows))
    noise = CorrelatedNoise.of(t, np.zeros(rows, np.intp), independent)
    scatter = CorrelatedScatter(rows, noise=noise, drift=True)
    t, since = t[:DENSE], t[:DENSE] / (rows - 1)
    correlation = np.exp(-np.abs(t[:, None] - t) / MEMORY)
    if independent:
        correlation = (1 - FRACTION) * correlation + FRACTION * np.eye(len(t))
    scales = [MEMORY, FRACTION, DRIFT] if independent else [MEMORY, DRIFT]
    return scatter, scales, WIDTH**2 * correlation + DRIFT**2 * np.outer(since, since)


def cpu_time(function: Callable[[], object]) -> float:
    """Least of five, for one vector, s."""
    function()
    found = []
    for _ in range(5):
        start = time.process_time()
        function()
        found.append((time.process_time() - start) / VECTORS)
    return min(found)


def measure(
    made: Callable[[int], tuple[CorrelatedScatter, list[float], np.ndarray]], rows: int
) -> tuple[float, float]:
    """Time for all rows, and the error of the log-density of some of them."""
    scatter, scales, _ = made(rows)
    residual = WIDTH * np.random.default_rng(1).normal(size=(VECTORS, rows))
    spent = cpu_time(lambda: scatter.log_density(residual, WIDTH, np.tile(scales, (VECTORS, 1))))
    scatter, scales, covariance = made(DENSE)
    found = scatter.log_density(residual[:1, :DENSE], WIDTH, [scales])[0]
    return spent, abs(
        float(found - multivariate_normal(np.zeros(DENSE), covariance).logpdf(residual[0, :DENSE]))
    )


def physics(rows: int) -> float:
    """Time for the friction of an elastomer at so many different loads."""
    model = forward_model("friction", "benchmark")
    values = {
        "frictional_shear_stress": 1e5, "young_modulus": 1.3e5, "rms_height": 5e-6, "hurst_exponent": 0.8,
        "wavevector_min": 1.6e3, "wavevector_rolloff": 3e4, "wavevector_max": 1e7, "nominal_contact_area": 16e-6,
        "poisson_ratio": 0.5,
    }  # fmt: skip
    inputs = {name: np.full((VECTORS, 1), value) for name, value in values.items()}
    inputs |= {
        name: np.array([[value]]) for name, value in model.defaults(set(values) | {"normal_force"}).items()
    }
    inputs["young_modulus"] = inputs["young_modulus"] * np.linspace(0.9, 1.1, VECTORS)[:, None]
    inputs["normal_force"] = np.geomspace(0.01, 1.0, rows)[None]
    return cpu_time(lambda: model.evaluate(inputs, Tables(None, None)))


def run() -> dict[str, float]:
    """All measurements."""
    found = {}
    for name, made, rows in (
        ("smooth", smooth, SMOOTH),
        ("memory", lambda rows: series(rows, False), SERIES),
        ("independent", lambda rows: series(rows, True), SERIES),
    ):
        spent, found[f"{name}_error"] = measure(made, rows)
        found[f"{name}_ms"] = 1e3 * spent
    return found | {"friction_smooth_ms": 1e3 * physics(SMOOTH), "friction_series_ms": 1e3 * physics(SERIES)}


LINES = (
    ("smooth curve, 2000 rows, ms per vector", "smooth_ms", ".2f"),
    ("friction of 2000 rows, ms per vector", "friction_smooth_ms", ".2f"),
    ("AR(1) noise and drift, 20 000 rows, ms per vector", "memory_ms", ".2f"),
    ("the same with an independent part, ms per vector", "independent_ms", ".2f"),
    ("friction of 20 000 rows, ms per vector", "friction_series_ms", ".2f"),
    ("error of ln p of the smooth curve, 400 rows", "smooth_error", ".1e"),
    ("error of ln p of AR(1) noise and drift, 400 rows", "memory_error", ".1e"),
    ("the same with an independent part, 400 rows", "independent_error", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, "ln p of rows that are not independent, beside the physics", run, LINES)
