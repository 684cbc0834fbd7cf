"""Viscosity against shear rate: shear-thinning silicone oil, and measured flow curves."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from typing import Protocol

import numpy as np
from scipy.interpolate import PchipInterpolator

from skinbayes.arrays import ArrayLike, FloatArray, floats
from skinbayes.errors import InputError

SILICONE_SCALE = 1e4
"""B of Appendix C, SI: Pa s^(1 − n) times s^(n − 1), such that (η0/B) γ̇^n is dimensionless for η0 in Pa s and γ̇ in 1/s."""

SILICONE_EXPONENT = 0.8
"""n of Appendix C, dimensionless."""


class Rheology(Protocol):
    """What the film solver asks of a liquid.

    Attributes
    ----------
    low_shear_viscosity : η0, Pa s; speeds enter the curve as η0 v
    shear_rate_range : smallest and largest shear rate, 1/s, for which the viscosity is known
    """

    @property
    def low_shear_viscosity(self) -> float:
        """η0, Pa s."""

    @property
    def shear_rate_range(self) -> tuple[float, float]:
        """Smallest and largest shear rate, 1/s."""

    def relative(self, shear_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """η/η0 and d ln η/d ln γ̇, dimensionless, at shear rates in 1/s."""


def thinned_viscosity(
    low_shear_viscosity: ArrayLike,
    shear_rate: ArrayLike,
    *,
    scale: ArrayLike = SILICONE_SCALE,
    exponent: ArrayLike = SILICONE_EXPONENT,
) -> FloatArray:
    """Viscosity of a shear-thinning oil, ``η = η0/(1 + (η0/B) γ̇^n)`` (Appendix C of the paper, Fig. 21).

    Parameters
    ----------
    low_shear_viscosity : η0, Pa s, > 0, any shape
    shear_rate : γ̇, 1/s, ≥ 0, broadcasts; v/u in a film
    scale : B, in Pa s times s^-n, > 0, broadcasts
    exponent : n, dimensionless, ≥ 0, broadcasts

    Returns
    -------
    viscosity : η, Pa s, broadcast shape; nan where an argument is impossible

    Notes
    -----
    B = 1e4 and n = 0.8 describe silicone oils of many viscosities. Thinning sets in at γ̇ = (B/η0)^(1/n), 1e5 1/s for
    1 Pa s. For n < 1 the shear stress rises with the shear rate without bound.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix C).

    Examples
    --------
    >>> print(thinned_viscosity(1.0, [0.0, 1e4, 1e5]).round(4))
    [1.     0.8632 0.5   ]
    """
    eta, rate, constant, power = floats(low_shear_viscosity, shear_rate, scale, exponent)
    with np.errstate(all="ignore"):
        possible = (eta > 0) & (rate >= 0) & (constant > 0) & (power >= 0)
        fraction = eta / constant * rate**power
        # where next to nothing is left of η0, B γ̇^-n is
        viscosity = np.where(fraction < 1e100, eta / (1 + fraction), constant / rate**power)
        return np.where(possible, viscosity, np.nan)[()]


@dataclass(frozen=True)
class ShearThinning:
    """A liquid that thins as in Appendix C of the paper, for the film solver; see `thinned_viscosity`.

    Attributes
    ----------
    low_shear_viscosity : η0, Pa s, > 0
    scale : B, in Pa s times s^-n, > 0; inf does not thin
    exponent : n, dimensionless, ≥ 0

    Raises
    ------
    InputError
        if one of them is impossible
    """

    low_shear_viscosity: float
    _: KW_ONLY
    scale: float = SILICONE_SCALE
    exponent: float = SILICONE_EXPONENT

    def __post_init__(self) -> None:
        for name, value, possible, wanted in (
            (
                "low_shear_viscosity",
                self.low_shear_viscosity,
                0 < self.low_shear_viscosity < np.inf,
                "> 0 Pa s",
            ),
            ("scale", self.scale, self.scale > 0, "> 0"),
            ("exponent", self.exponent, 0 <= self.exponent < np.inf, ">= 0"),
        ):
            if not possible:
                raise InputError(
                    f"{name} of a shear-thinning liquid is {value:g}, but must be a number {wanted}."
                )

    @property
    def shear_rate_range(self) -> tuple[float, float]:
        """Everything: the law is a formula."""
        return 0.0, np.inf

    def relative(self, shear_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """η/η0 and d ln η/d ln γ̇, dimensionless, at shear rates in 1/s."""
        with np.errstate(over="ignore"):
            fraction = self.low_shear_viscosity / self.scale * shear_rate**self.exponent
        thinning = 1 / (1 + fraction)
        return thinning, -self.exponent * (1 - thinning)


@dataclass(frozen=True, eq=False)
class FlowCurve:
    """A measured flow curve η(γ̇): monotone cubics of ln η over ln γ̇ between the measured points.

    Monotone means that no bump appears between two points that the points do not have. Outside the measured shear rates the
    curve is not continued: `viscosity` gives nan there.

    Attributes
    ----------
    shear_rate : γ̇ of the points, 1/s, > 0, rising, shape ``(M,)``
    measured_viscosity : η of the points, Pa s, > 0, shape ``(M,)``

    Raises
    ------
    InputError
        if there are fewer than two points, if the shear rates do not rise, or if a value is not a finite number > 0

    References
    ----------
    Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980) 238, doi 10.1137/0717021 (monotone interpolation).

    Examples
    --------
    >>> curve = FlowCurve([1.0, 10.0, 100.0], [2.0, 1.0, 0.5])
    >>> print(curve.viscosity([3.0, 10.0, 200.0]).round(4), curve.measured_at([3.0, 200.0]))
    [1.4368 1.        nan] [ True False]
    """

    shear_rate: ArrayLike
    measured_viscosity: ArrayLike
    _curve: PchipInterpolator = field(init=False, repr=False)

    def __post_init__(self) -> None:
        rate, eta = floats(self.shear_rate, self.measured_viscosity)
        if rate.ndim != 1 or rate.shape != eta.shape or rate.size < 2:
            raise InputError(
                f"A flow curve has shear rates of shape {rate.shape} and viscosities of shape {eta.shape}, "
                "but needs two columns of equal length with at least two rows."
            )
        for name, unit, values in (("shear_rate", "1/s", rate), ("viscosity", "Pa s", eta)):
            wrong = np.flatnonzero(~(np.isfinite(values) & (values > 0)))
            if wrong.size:
                raise InputError(
                    f"{name} in row {wrong[0] + 1} of a flow curve is {values[wrong[0]]:g} {unit}, "
                    f"but must be a finite number > 0 {unit}."
                )
        if np.any(np.diff(rate) <= 0):
            row = int(np.flatnonzero(np.diff(rate) <= 0)[0])
            raise InputError(
                f"shear_rate in row {row + 2} of a flow curve is {rate[row + 1]:g} 1/s, "
                f"but must be larger than the {rate[row]:g} 1/s of the row before."
            )
        object.__setattr__(self, "shear_rate", rate)
        object.__setattr__(self, "measured_viscosity", eta)
        object.__setattr__(self, "_curve", PchipInterpolator(np.log(rate), np.log(eta)))

    @property
    def low_shear_viscosity(self) -> float:
        """η at the smallest measured shear rate, Pa s."""
        return float(np.asarray(self.measured_viscosity)[0])

    @property
    def shear_rate_range(self) -> tuple[float, float]:
        """Smallest and largest measured shear rate, 1/s."""
        rate = np.asarray(self.shear_rate)
        return float(rate[0]), float(rate[-1])

    def measured_at(self, shear_rate: ArrayLike) -> FloatArray:
        """Tell where shear rates (1/s, any shape) lie within the measured range."""
        rate, (low, high) = np.asarray(shear_rate, dtype=np.float64), self.shear_rate_range
        return np.asarray((rate >= low) & (rate <= high))

    def viscosity(self, shear_rate: ArrayLike) -> FloatArray:
        """η, Pa s, at shear rates in 1/s, any shape; nan outside the measured range."""
        rate = np.asarray(shear_rate, dtype=np.float64)
        inside = self.measured_at(rate)
        log_rate = np.log(np.where(inside, rate, self.shear_rate_range[0]))
        return np.where(inside, np.exp(self._curve(log_rate)), np.nan)[()]

    def relative(self, shear_rate: FloatArray) -> tuple[FloatArray, FloatArray]:
        """η/η0 and d ln η/d ln γ̇, dimensionless; outside the measured range the value at its end.

        The solver needs some viscosity in every corner of the inlet; what is reported is flagged where the film itself is
        sheared beyond the range.
        """
        low, high = np.log(self.shear_rate_range)
        with np.errstate(divide="ignore"):
            log_rate = np.log(shear_rate)
        inside = (log_rate > low) & (log_rate < high)
        clipped = np.clip(log_rate, low, high)
        relative = np.exp(self._curve(clipped)) / self.low_shear_viscosity
        return relative, np.where(inside, self._curve(clipped, nu=1), 0.0)
