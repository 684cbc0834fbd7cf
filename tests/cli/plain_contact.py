"""Contact of layered, rough, elastoplastic skin once more, in plain SciPy and by other routes than the package.

The layer is solved as an elastic boundary-value problem (Airy function, six conditions) instead of by the closed
formula, moments and variances are adaptive quadratures, the corrected variance is found by root finding, and the parts
of the contact area are summed from the Fourier series alone.
"""

from __future__ import annotations

import itertools
from math import erf, exp, log, pi, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


class PlainContact:
    """One parameter set; pressures and moduli in Pa, lengths in m, wavevectors in 1/m."""

    def __init__(
        self, layer=7e6, bulk=20e3, nu_layer=0.5, nu_bulk=0.5, thickness=20e-6, height=22.4e-6, hurst=0.78,
        low=1e3, rolloff=6.345e3, high=1e9,
    ) -> None:  # fmt: skip
        self.layer, self.bulk, self.nu_layer, self.nu_bulk = layer, bulk, nu_layer, nu_bulk
        self.thickness, self.hurst, self.low, self.rolloff, self.high = thickness, hurst, low, rolloff, high
        self.amplitude = 1.0
        mean_square = 2 * pi * self._over_band(lambda q: q * self.power(q), high)
        self.amplitude = height**2 / mean_square

    def power(self, q: float) -> float:
        """C(q): a plateau up to the roll-off, then a power law."""
        return self.amplitude * (1.0 if q < self.rolloff else (q / self.rolloff) ** (-2 * (1 + self.hurst)))

    def _over_band(self, function, upper: float) -> float:
        edges = [
            self.low,
            *(q for q in (self.rolloff, *np.geomspace(self.low, self.high, 13)[1:-1]) if q < upper),
            upper,
        ]
        edges = sorted(edges)
        return sum(
            quad(lambda u: function(exp(u)) * exp(u), log(a), log(b), epsrel=1e-10, limit=200)[0]
            for a, b in itertools.pairwise(edges)
        )  # fmt: skip

    def rms_slope(self) -> float:
        """Root of 2π ∫ q³ C dq."""
        return sqrt(2 * pi * self._over_band(lambda q: q**3 * self.power(q), self.high))

    def response(self, q: float) -> float:
        """S(q) = E0*/E_eff from the displacement under cos(qx) pressure on a layer bonded to a half-space.

        With σzz = −q²f cos qx the Airy function is f = (A + Bz)e^{−z} + (C + Dz)e^{z−x} in the layer and (P + Qz)e^{−z}
        below, lengths in 1/q, x = qd. Displacements follow from Hooke's law in plane strain.
        """
        x = q * self.thickness
        if x > 30:
            return 1.0

        def rows(z: float, layer: bool) -> np.ndarray:
            """f, f′, f″, f‴ of each basis function at depth z."""
            down = exp(-z) * np.array([[1, z], [-1, 1 - z], [1, z - 2], [-1, 3 - z]])
            up = exp(z - x) * np.array([[1, z], [1, 1 + z], [1, z + 2], [1, z + 3]])
            return np.hstack([down, up]) if layer else down

        def displacements(f: np.ndarray, modulus: float, nu: float) -> np.ndarray:
            shear = modulus / (2 * (1 + nu))
            return np.stack([(1 - nu) * f[2] + nu * f[0], (1 - nu) * f[3] - (2 - nu) * f[1]]) / (2 * shear)

        top, inner, outer = rows(0.0, True), rows(x, True), rows(0.0, False)
        inside = displacements(inner, self.layer, self.nu_layer) * self.layer
        outside = displacements(outer, self.bulk, self.nu_bulk) * self.layer
        matrix = np.zeros((6, 6))
        matrix[:2, :4] = top[:2]
        matrix[2:4, :4], matrix[2:4, 4:] = inner[:2], -outer[:2]
        matrix[4:, :4], matrix[4:, 4:] = inside, -outside
        scale = np.abs(matrix).max(axis=1)
        solution = np.linalg.solve(matrix / scale[:, None], np.array([1.0, 0, 0, 0, 0, 0]) / scale)
        depth = displacements(top, self.layer, self.nu_layer)[1] @ solution[:4]
        reduced = self.layer / (1 - self.nu_layer**2)
        return float(depth * reduced / 2)

    def variance(self, q: float | None = None) -> float:
        """V(q) = π ∫ k³ C E_eff² dk."""
        reduced = self.layer / (1 - self.nu_layer**2)

        def integrand(k: float) -> float:
            return k**3 * self.power(k) * (reduced / self.response(k)) ** 2

        return pi * self._over_band(integrand, self.high if q is None else q)

    def area(self, pressure, q=None, correction=0.42, yield_stress=None) -> tuple[float, float]:
        """Elastic and plastic contact area over nominal area."""
        width = corrected(self.variance(q) / pressure**2, correction) * pressure**2
        if yield_stress is None:
            return erf(pressure / sqrt(width)), 0.0
        ratio, spread = pressure / yield_stress, sqrt(width) / yield_stress
        n = np.arange(1, int(14 / spread) + 3)
        decay = np.exp(-((n * pi * spread) ** 2) / 4) / n * np.sin(n * pi * ratio)
        elastic = 2 / pi * np.sum((1 - (-1.0) ** n) * decay)
        plastic = ratio + 2 / pi * np.sum((-1.0) ** n * decay)
        return float(elastic), float(plastic)


def corrected(variance: float, gamma: float) -> float:
    """Solve V/p² = ∫₀^y dy′/[γ + (1 − γ) erf²(y′^−½)] for y."""
    if gamma == 1.0:
        return variance

    def total(log_y: float) -> float:
        cuts = [-12.0, -2.0, 0.0, 2.0, 5.0, 9.0, 14.0]
        inner = [exp(-12.0)] if log_y > -12 else [exp(log_y)]
        edges = [c for c in cuts if c < log_y] + [log_y]
        inner += [
            quad(lambda u: exp(u) / (gamma + (1 - gamma) * erf(exp(-u / 2)) ** 2), a, b, epsrel=1e-11, limit=200)[0]
            for a, b in itertools.pairwise(edges)
        ]  # fmt: skip
        return sum(inner)

    return exp(
        brentq(lambda u: total(u) - variance, log(gamma * variance) - 1, log(variance) + 1, xtol=1e-12)
    )
