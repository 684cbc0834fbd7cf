"""What roughness does to the flow between two surfaces, averaged over it: flow factors and friction factors.

The rough surface is the skin, which moves at v past the smooth body at rest. The averaged flow per width is
``q = −φ_p ū³/(12η) p′ + (v/2)(ū + Φ_s)``; the fluid drags the smooth body with
``∫ [(φ_f + φ_fs) ηv/ū + (1 − φ_fp/2) ū p′] dx``: shear stress on its surface, and the pressure on its slope by parts. (On the
rough side the sign of φ_fs is the other one, and pressure on the slopes of the roughness makes up for it.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError


class FrictionFactors(NamedTuple):
    """Factors of the frictional shear stress, dimensionless, each of the shape of the separation.

    Attributes
    ----------
    shear : φ_f + φ_fs, shear stress on the smooth surface by sliding, dimensionless
    pressure : φ_fp, shear stress by the pressure gradient, dimensionless
    """

    shear: FloatArray
    pressure: FloatArray


class FlowFactors(Protocol):
    """What the film solver asks about the flow between rough surfaces."""

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""


@dataclass(frozen=True)
class TrivialFlowFactors:
    """Smooth surfaces: φ_p = 1, φ_s = 0, φ_f = φ_fp = 1, φ_fs = 0 (Appendix C of the paper)."""

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""
        zero = np.zeros_like(separation)
        return np.ones_like(separation), zero, zero, zero

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""
        one = np.ones_like(separation)
        return FrictionFactors(one, one)


@dataclass(frozen=True)
class PatirCheng:
    """Fits of Patir and Cheng to computed flow between isotropic Gaussian surfaces, of which one is smooth.

    With H = ū/h_rms: ``φ_p = 1 − 0.90 exp(−0.56 H)``; ``Φ_s = h_rms 1.899 H^0.98 exp(−0.92 H + 0.05 H²)`` up to H = 5 and
    ``1.126 exp(−0.25 H)`` beyond; ``φ_fs = 11.1 H^2.31 exp(−2.38 H + 0.11 H²)`` up to H = 7 and 0 beyond;
    ``φ_fp = 1 − 1.40 exp(−0.66 H)``. φ_f is ū⟨1/u⟩ for heights of density (35/96)(1 − δ²/9)³, where gaps below h_rms/100
    do not count, in closed form. ū is the separation of the undeformed mean planes in the sources; here it is the mean gap.

    The two branches of Φ_s differ by 1e-3 of themselves at H = 5; φ_fs falls by 0.013 to 0 at H = 7.

    Attributes
    ----------
    rms_height : h_rms of the undeformed surface, m, > 0

    Raises
    ------
    InputError
        if it is not a finite number > 0

    References
    ----------
    Patir & Cheng, J. Lubr. Technol. 100 (1978) 12, doi 10.1115/1.3453177 (pressure flow).
    Patir & Cheng, J. Lubr. Technol. 101 (1979) 220, doi 10.1115/1.3453329 (shear flow and friction).

    Examples
    --------
    >>> import numpy as np
    >>> print(PatirCheng(22.4e-6).flow(np.array([14e-6]))[0].round(3))
    [0.366]
    """

    rms_height: float

    def __post_init__(self) -> None:
        if not 0 < self.rms_height < np.inf:
            raise InputError(f"rms_height is {self.rms_height:g} m, but must be a finite number > 0 m.")

    def flow(self, separation: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """φ_p (dimensionless), dφ_p/dū (1/m), Φ_s (m) and dΦ_s/dū (dimensionless) at ū in m."""
        ratio = np.maximum(separation / self.rms_height, 1e-12)
        lost = 0.90 * np.exp(-0.56 * ratio)
        near = np.minimum(ratio, 5.0)
        close = 1.899 * near**0.98 * np.exp(-0.92 * near + 0.05 * near * near)
        far = 1.126 * np.exp(-0.25 * ratio)
        is_close = ratio <= 5.0
        drag = np.where(is_close, close, far)
        slope = np.where(is_close, close * (0.98 / near - 0.92 + 0.1 * near), -0.25 * far)
        return 1 - lost, 0.56 * lost / self.rms_height, drag * self.rms_height, slope

    def friction(self, separation: FloatArray) -> FrictionFactors:
        """Friction factors, dimensionless, at ū in m."""
        ratio = np.maximum(separation / self.rms_height, 1e-12)
        near = np.minimum(ratio, 7.0)
        difference = np.where(
            ratio <= 7.0, 11.1 * near**2.31 * np.exp(-2.38 * near + 0.11 * near * near), 0.0
        )
        return FrictionFactors(_shear_factor(ratio / 3) + difference, 1 - 1.40 * np.exp(-0.66 * ratio))


def _shear_factor(z: FloatArray) -> FloatArray:
    """φ_f of Patir and Cheng for z = ū/(3 h_rms)."""
    near = np.minimum(z, 1.0)
    rest = np.polyval([147.0, 60.0, -405.0, -160.0, 345.0, 132.0, -55.0], near) / 60
    close = (1 - near**2) ** 3 * np.log(300 * (near + 1)) + rest
    far = np.clip(z, 1 + 1e-9, 10.0)
    open_ = (1 - far**2) ** 3 * np.log((far + 1) / (far - 1)) + far / 15 * (66 + far**2 * (30 * far**2 - 80))
    # beyond z = 10 the closed form loses its digits and 1 + ⟨δ²⟩/ū² + … is as good; ⟨δ²⟩ = h_rms²
    factor = np.where(z <= 1, near * close, far * open_) * 35 / 32
    return np.where(z <= 10, factor, 1 + 1 / (9 * np.clip(z, 1.0, 1e100) ** 2))
