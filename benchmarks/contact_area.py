"""Relative contact area of 64 parameter vectors at full magnification: skinbayes against a loop of scipy.integrate.quad.

Run with ``python benchmarks/contact_area.py [--json]``. Both sides start from the same parameters and end at A/A0. The plain
loop is Eqs. 2–4 of the paper with NumPy functions and the default tolerances of quad. The tuned loop is the fastest that
was found without arrays: functions of the math module and a tolerance of 1e-4. Both already split the integral at
the roll-off, run over ln q, and use the closed form of the mean square height.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from math import erf, log, pi, sqrt

import numpy as np
from common import COUNT, best_time, parameter_vectors, report
from scipy.integrate import quad

from skinbayes.contact import LayeredSkin, relative_contact_area, twice_stress_variance
from skinbayes.roughness import SelfAffineSpectrum


def batch(p: dict[str, np.ndarray], area_correction: float) -> np.ndarray:
    """A/A0 of all vectors at once."""
    spectrum = SelfAffineSpectrum(
        rms_height=p["rms_height"],
        hurst_exponent=p["hurst_exponent"],
        wavevector_min=p["wavevector_min"],
        wavevector_rolloff=p["wavevector_rolloff"],
        wavevector_max=p["wavevector_max"],
    )
    skin = LayeredSkin(
        young_modulus_layer=p["young_modulus_layer"],
        young_modulus_bulk=p["young_modulus_bulk"],
        poisson_ratio_layer=p["poisson_ratio_layer"],
        poisson_ratio_bulk=p["poisson_ratio_bulk"],
        layer_thickness=p["layer_thickness"],
    )
    return relative_contact_area(
        p["nominal_pressure"], twice_stress_variance(spectrum, skin), area_correction=area_correction
    )


def one_by_quad(
    p: dict[str, float], tolerance: float = 1.49e-8, exp: Callable[[float], float] = np.exp
) -> float:
    """A/A0 of one vector, plain Persson theory, with scipy.integrate.quad over ln q."""
    hurst, q0, q_r, q1 = (
        p[name] for name in ("hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
    )
    e0, e1, nu0, nu1 = (
        p[name]
        for name in ("young_modulus_layer", "young_modulus_bulk", "poisson_ratio_layer", "poisson_ratio_bulk")
    )
    d = p["layer_thickness"]
    area = (q_r**2 - q0**2) / 2 + q_r**2 * (1 - (q1 / q_r) ** (-2 * hurst)) / (2 * hurst)
    plateau = p["rms_height"] ** 2 / (2 * pi * area)
    contrast = e0 / (1 + nu0) / (e1 / (1 + nu1))
    m = (contrast - 1) / (contrast + 3 - 4 * nu0)
    n = 1 - 4 * (1 - nu0) / (1 + contrast * (3 - 4 * nu1))

    def integrand(t: float) -> float:
        q = exp(t)
        x = q * d
        e = exp(-2 * x)
        response = (1 + 4 * m * x * e - m * n * e * e) / (1 - (m + n + 4 * m * x * x) * e + m * n * e * e)
        spectrum = plateau if q < q_r else plateau * (q / q_r) ** (-2 * (1 + hurst))
        return pi * q**4 * spectrum / response**2

    parts = [
        quad(integrand, log(a), log(b), epsabs=0, epsrel=tolerance, limit=400)[0]
        for a, b in ((q0, q_r), (q_r, q1))
    ]
    return erf(p["nominal_pressure"] / (e0 / (1 - nu0**2) * sqrt(sum(parts))))


def run() -> dict[str, float]:
    """Time both sides and compare their results."""
    p = parameter_vectors()
    vectors = [{name: float(values[i]) for name, values in p.items()} for i in range(COUNT)]
    exact = np.array([one_by_quad(vector, 1e-10, math.exp) for vector in vectors])
    error = float(np.max(np.abs(batch(p, 1.0) / exact - 1)))
    plain_loop = best_time(lambda: [one_by_quad(vector) for vector in vectors], 3, 1)
    tuned_loop = best_time(lambda: [one_by_quad(vector, 1e-4, math.exp) for vector in vectors], 5, 1)
    ours = best_time(lambda: batch(p, 1.0), 200, 5)
    corrected = best_time(lambda: batch(p, 0.42), 200, 5)
    return {
        "vectors": COUNT,
        "plain_loop_us_per_vector": plain_loop / COUNT * 1e6,
        "tuned_loop_us_per_vector": tuned_loop / COUNT * 1e6,
        "skinbayes_us_per_vector": ours / COUNT * 1e6,
        "skinbayes_corrected_us_per_vector": corrected / COUNT * 1e6,
        "ratio_to_plain_loop": plain_loop / ours,
        "ratio_to_tuned_loop": tuned_loop / ours,
        "largest_relative_error": error,
    }


LINES = (
    ("plain loop of scipy.integrate.quad, us per vector", "plain_loop_us_per_vector", ".1f"),
    ("tuned loop of scipy.integrate.quad, us per vector", "tuned_loop_us_per_vector", ".1f"),
    ("skinbayes, plain Persson, us per vector", "skinbayes_us_per_vector", ".2f"),
    ("skinbayes, Yang-Persson correction, us per vector", "skinbayes_corrected_us_per_vector", ".2f"),
    ("times faster than the plain loop", "ratio_to_plain_loop", ".0f"),
    ("times faster than the tuned loop", "ratio_to_tuned_loop", ".0f"),
    ("largest relative error of A/A0", "largest_relative_error", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, f"A/A0 of {COUNT} parameter vectors at full magnification", run, LINES)
