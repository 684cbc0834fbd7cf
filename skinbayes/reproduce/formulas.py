"""The paper's formulas as they stand there, evaluated by themselves: what the package is held against."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.special import erf

from skinbayes.contact import LayeredSkin
from skinbayes.roughness import SelfAffineSpectrum


def response(q: float, skin: LayeredSkin) -> float:
    """S(q) of Eq. 4 with m and n, q in 1/m."""
    nu0, nu1 = float(skin.poisson_ratio_layer), float(skin.poisson_ratio_bulk)
    shear0 = float(skin.young_modulus_layer) / (2 * (1 + nu0))
    shear1 = float(skin.young_modulus_bulk) / (2 * (1 + nu1))
    ratio, qd = shear0 / shear1, q * float(skin.layer_thickness)
    m = (ratio - 1) / (ratio + 3 - 4 * nu0)
    n = 1 - 4 * (1 - nu0) / (1 + ratio * (3 - 4 * nu1))
    once, twice = np.exp(-2 * qd), np.exp(-4 * qd)
    numerator = 1 + 4 * m * qd * once - m * n * twice
    return float(numerator / (1 - (m + n + 4 * m * qd**2) * once + m * n * twice))


def mean_square_height(surface: SelfAffineSpectrum) -> float:
    """⟨h²⟩, m², as Eq. 1 has it: the integral of C(q) over the plane of wavevectors."""

    def of_log(log_q: float) -> float:
        q = float(np.exp(log_q))
        return 2 * np.pi * q * q * float(surface.power(np.array([q]))[0])

    edges = surface.wavevector_min, surface.wavevector_rolloff, surface.wavevector_max
    return _over_logs(of_log, [float(edge) for edge in edges])


def _over_logs(function: Callable[[float], float], edges: list[float]) -> float:
    """Integral over ln q, in pieces between edges in 1/m."""
    pieces = pairwise(np.log(edges))
    return float(sum(quad(function, low, high, epsrel=1e-9, limit=400)[0] for low, high in pieces))


def gradient(surface: SelfAffineSpectrum, skin: LayeredSkin, pressure: float) -> float:
    """G of Eq. 3 at the largest wavevector, with M_zz = −2S/(q E0*)."""
    stiff = float(skin.young_modulus_layer) / (1 - float(skin.poisson_ratio_layer) ** 2)

    def of_log(log_q: float) -> float:
        q = float(np.exp(log_q))
        m_zz = -2 * response(q, skin) / (q * stiff)
        return q * q * (pressure * m_zz) ** -2 * float(surface.power(np.array([q]))[0])

    edges = [surface.wavevector_min, surface.wavevector_rolloff, 1e5, 1e6, surface.wavevector_max]
    return float(np.pi * _over_logs(of_log, [float(edge) for edge in edges]))


def area(gradient_value: float) -> float:
    """A/A0 of Eq. 2."""
    return float(erf(1 / (2 * np.sqrt(gradient_value))))


def sphere_pressure(load: float, modulus: float, radius: float) -> float:
    """Mean pressure as printed in Sect. 6.1, with E* where Appendix B has its square; the unit does not come out."""
    return 2 / (3 * np.pi) * (6 * load * modulus / radius**2) ** (1 / 3)


def sphere_pressure_of_appendix(load: float, modulus: float, radius: float) -> float:
    """Mean pressure of Appendix B for a circle (F1 = 1)."""
    return 2 / (3 * np.pi) * (6 * load * modulus**2 / radius**2) ** (1 / 3)


def sphere_contact_radius(load: float, modulus: float, radius: float) -> float:
    """r0 of Sect. 6.1."""
    return (3 * load * radius / (4 * modulus)) ** (1 / 3)


def cylinder_pressure(load: float, modulus: float, radius: float) -> float:
    """Mean pressure of the cylinder of Sect. 6.1; load per length."""
    return float(np.pi / 4 * np.sqrt(load * modulus / (np.pi * radius)))


def cylinder_width(load: float, modulus: float, radius: float) -> float:
    """w of Sect. 6.1."""
    return float(4 * np.sqrt(load * radius / (np.pi * modulus)))


RADIUS_CONSTANT = np.pi**2 / 32 * 1.5**1.5
"""C as it is defined below Eq. 9."""

LOAD_CONSTANT = 6 ** (1 / 6) / np.pi
"""C′ as it is defined below Eq. 9."""


def elliptic_integrals(e: float) -> tuple[float, float]:
    """K(e) and E(e) of Appendix B by their integrals."""
    first = quad(lambda phi: (1 - (e * np.sin(phi)) ** 2) ** -0.5, 0, np.pi / 2, epsrel=1e-11)[0]
    second = quad(lambda phi: (1 - (e * np.sin(phi)) ** 2) ** 0.5, 0, np.pi / 2, epsrel=1e-11)[0]
    return float(first), float(second)


def ellipse(ratio: float) -> tuple[float, float, float]:
    """F1, G1 and (R2/R1) of an ellipse of a/b, after Appendix B; the last after the textbook that it cites."""
    e = np.sqrt(1 - ratio**-2)
    first, second = elliptic_integrals(float(e))
    long, short = ratio**2 * second - first, first - second
    f1 = (4 / (np.pi * e**2) * ratio**-1.5 * np.sqrt(long * short)) ** (1 / 3)
    return float(f1), float(f1 / np.sqrt((ratio + 1 / ratio) / 2)), float(long / short)
