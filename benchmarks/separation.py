"""Mean separation of 64 parameter vectors at 16 pressures: skinbayes against loops of scipy.integrate.quad.

Run with ``python benchmarks/separation.py [--json]``. Both sides start from the same parameters and end at ū. The plain loop is
the theory as it is written: an integral over ln q whose integrand needs the integral V(q) and the integral J(wp). It is
so slow that 16 of the 1024 values are computed, which also serve to state the error. The tuned loop has V of each vector
and J in tables, as one would do next, and a tolerance of 1e-6; 256 values are computed. Times are CPU times of one core.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from math import erf, exp, inf, log, pi, sqrt

import numpy as np
from common import COUNT, best_time, parameter_vectors, report
from scipy.integrate import IntegrationWarning, quad
from scipy.special import erf as erf_of_array
from scipy.special import exp1

from skinbayes.contact import LayeredSkin, gap_distribution, mean_separation, pressure_at_separation
from skinbayes.roughness import SelfAffineSpectrum

GAMMA = 0.42
PRESSURES = np.geomspace(1e3, 1e5, 16)
PLAIN = [(vector, pressure) for vector in range(0, 64, 8) for pressure in (2, 13)]
TUNED = [(vector, pressure) for vector in range(0, 64, 4) for pressure in range(16)]


def batch(p: dict[str, np.ndarray]) -> tuple[SelfAffineSpectrum, LayeredSkin]:
    """Surface and skin of all vectors."""
    surface, skin = (
        {name: p[name] for name in kind.__dataclass_fields__} for kind in (SelfAffineSpectrum, LayeredSkin)
    )
    return SelfAffineSpectrum(**surface), LayeredSkin(**skin)


class OneVector:
    """The integrands of one parameter vector, in plain Python."""

    def __init__(self, p: dict[str, float]) -> None:
        h, self.hurst, q0, q_r, q1, e0, e1, nu0, nu1, self.d, _ = p.values()
        self.q_r, self.ends = q_r, (log(q0), log(q_r), log(q1))
        area = (q_r**2 - q0**2) / 2 + q_r**2 * (1 - (q1 / q_r) ** (-2 * self.hurst)) / (2 * self.hurst)
        self.plateau = h**2 / (2 * pi * area)
        contrast = e0 / (1 + nu0) / (e1 / (1 + nu1))
        self.m = (contrast - 1) / (contrast + 3 - 4 * nu0)
        self.n = 1 - 4 * (1 - nu0) / (1 + contrast * (3 - 4 * nu1))
        self.layer = e0 / (1 - nu0**2)

    def parts(self, t: float) -> tuple[float, float]:
        """C(q) and E_eff(q) at ln q."""
        q = exp(t)
        x = q * self.d
        e = exp(-2 * x)
        m, n = self.m, self.n
        response = (1 + 4 * m * x * e - m * n * e * e) / (1 - (m + n + 4 * m * x * x) * e + m * n * e * e)
        power = self.plateau if q < self.q_r else self.plateau * (q / self.q_r) ** (-2 * (1 + self.hurst))
        return power, self.layer / response

    def stress(self, t: float) -> float:
        """dV/dln q."""
        power, modulus = self.parts(t)
        return pi * exp(4 * t) * power * modulus**2

    def separation(
        self,
        pressure: float,
        twice_variance: Callable[[float], float],
        inner: Callable[[float], float],
        tolerance: float,
    ) -> float:
        """ū by an integral over ln q, split at the roll-off."""

        def integrand(t: float) -> float:
            w = 1 / sqrt(max(twice_variance(t), 1e-300))
            if w * pressure > 20:
                return 0.0
            power, modulus = self.parts(t)
            return exp(3 * t) * power * modulus * w * inner(w * pressure)

        first, knee, last = self.ends
        pieces = ((first, knee), (knee, last))
        return sqrt(pi) * sum(
            quad(integrand, a, b, epsabs=0, epsrel=tolerance, limit=400)[0] for a, b in pieces
        )


def one_plainly(vector: OneVector, pressure: float) -> float:
    """ū with quad for everything."""
    first, knee, _ = vector.ends

    def twice_variance(t: float) -> float:
        pieces = ((first, min(t, knee)), (knee, t))
        return sum(quad(vector.stress, a, b, epsabs=0, epsrel=1e-9)[0] for a, b in pieces if b > a)

    def inner(x: float) -> float:
        erf_part = quad(lambda t: erf(t) ** 2 * exp(-t * t) / t, x, inf, epsrel=1e-9)[0]
        return GAMMA * exp1(x * x) / 2 + 3 * (1 - GAMMA) * erf_part

    return vector.separation(pressure, twice_variance, inner, 1e-7)


def inner_table() -> Callable[[float], float]:
    """I(x) from a table over ln x."""
    log_x = np.linspace(log(1e-8), log(25), 4001)
    x = np.exp(log_x)
    steps = erf_of_array(x) ** 2 * np.exp(-x * x)
    above = np.append(np.cumsum(((steps[1:] + steps[:-1]) / 2 * np.diff(log_x))[::-1])[::-1], 0.0)
    values = GAMMA * exp1(x * x) / 2 + 3 * (1 - GAMMA) * above
    return lambda value: float(np.interp(log(value), log_x, values))


def one_vector_tuned(
    vector: OneVector, pressures: list[float], inner: Callable[[float], float]
) -> list[float]:
    """ū at some pressures with a table of V."""
    first, knee, last = vector.ends
    t = np.concatenate([np.linspace(first, knee, 200), np.linspace(knee, last, 1000)[1:]])
    stress = np.array([vector.stress(value) for value in t])
    below = np.append(0.0, np.cumsum((stress[1:] + stress[:-1]) / 2 * np.diff(t)))
    return [vector.separation(p, lambda s: float(np.interp(s, t, below)), inner, 1e-6) for p in pressures]


def run() -> dict[str, float]:
    """Time both sides and compare their results."""
    warnings.simplefilter("ignore", IntegrationWarning)  # the outer quad sees the noise of the inner ones
    p = parameter_vectors()
    surface, skin = batch(p)
    vectors = [OneVector({name: float(values[i]) for name, values in p.items()}) for i in range(COUNT)]
    found = mean_separation(PRESSURES, surface, skin=skin)
    start = time.process_time()
    exact = np.array([one_plainly(vectors[i], float(PRESSURES[k])) for i, k in PLAIN])
    plain = (time.process_time() - start) / len(PLAIN)
    start = time.process_time()
    inner = inner_table()
    rows = sorted({i for i, _ in TUNED})
    tuned_values = np.array([one_vector_tuned(vectors[i], PRESSURES.tolist(), inner) for i in rows])
    tuned = (time.process_time() - start) / len(TUNED)
    ours = best_time(lambda: mean_separation(PRESSURES, surface, skin=skin), 200)
    inverse = best_time(lambda: pressure_at_separation(found, surface, skin=skin), 20)
    gaps = best_time(lambda: gap_distribution(PRESSURES, surface, skin=skin), 5)
    ours_per_value = ours / found.size
    return {
        "values": found.size,
        "plain_loop_us_per_value": plain * 1e6,
        "tuned_loop_us_per_value": tuned * 1e6,
        "skinbayes_us_per_value": ours_per_value * 1e6,
        "skinbayes_ms": ours * 1e3,
        "inverse_ms": inverse * 1e3,
        "gap_distribution_ms": gaps * 1e3,
        "ratio_to_plain_loop": plain / ours_per_value,
        "ratio_to_tuned_loop": tuned / ours_per_value,
        "largest_relative_error": float(
            np.max(np.abs(np.array([found[i, k] for i, k in PLAIN]) / exact - 1))
        ),
        "largest_relative_error_of_tuned_loop": float(np.max(np.abs(tuned_values / found[rows] - 1))),
    }


LINES = (
    ("plain loop of scipy.integrate.quad, us per value", "plain_loop_us_per_value", ".0f"),
    ("tuned loop of scipy.integrate.quad, us per value", "tuned_loop_us_per_value", ".0f"),
    ("skinbayes, us per value", "skinbayes_us_per_value", ".2f"),
    ("skinbayes, all 1024 values, ms", "skinbayes_ms", ".2f"),
    ("skinbayes, pressures at these separations, ms", "inverse_ms", ".1f"),
    ("skinbayes, gap distributions, ms", "gap_distribution_ms", ".0f"),
    ("times faster than the plain loop", "ratio_to_plain_loop", ".0f"),
    ("times faster than the tuned loop", "ratio_to_tuned_loop", ".0f"),
    ("largest relative error against the plain loop", "largest_relative_error", ".1e"),
    ("the same of the tuned loop, against skinbayes", "largest_relative_error_of_tuned_loop", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, f"mean separation of {COUNT} parameter vectors at {PRESSURES.size} pressures", run, LINES)
