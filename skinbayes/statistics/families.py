"""The families of priors: their arguments as a person writes them, and their log-densities in closed form.

Every family is one row of :data:`FAMILIES`. Log-densities are written out here, because the sampler asks for
them at each half-step (measured times stand in ``Prior.log_density``). Distribution functions and quantiles,
which are needed seldom, are those of ``scipy.stats``; the tests hold the two against each other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, log, pi, sqrt
from typing import Any, Literal

import numpy as np
from scipy import special

from skinbayes.arrays import FloatArray

Constants = tuple[float, ...]
"""Numbers that a kernel needs."""

Columns = tuple[float, ...] | tuple[FloatArray, ...]
"""The same for several priors at once: one array for each number."""

Kernel = Callable[[FloatArray, Columns], FloatArray]
"""Values inside the support, and the numbers of their priors, to log-densities."""

Arguments = tuple[float, ...]


@dataclass(frozen=True)
class Argument:
    """One argument of a family.

    Attributes
    ----------
    name : word for messages and documentation
    kind : ``"value"`` carries the unit of the parameter, ``"number"`` is dimensionless
    positive : True if only values > 0 make sense
    infinite_allowed : True if ±inf is meaningful (an absent bound)
    """

    name: str
    kind: Literal["value", "number"]
    positive: bool = False
    infinite_allowed: bool = False

    @property
    def is_width(self) -> bool:
        """True if it is a difference of values: a width of 2 degC is 2 K."""
        return self.kind == "value" and self.name in ("sd", "scale")


@dataclass(frozen=True)
class Family:
    """One family of distributions.

    Attributes
    ----------
    name : the key in a model file
    arguments : in the order in which they are written
    description : one line
    support : arguments to ``(lower, upper)``
    constants : arguments to the numbers that ``kernel`` needs, computed once per prior
    kernel : ``(x, constants)`` to the log-density inside the support, elementwise
    distribution : arguments to a frozen ``scipy.stats`` distribution (before truncation to ``support``)
    closed : True if a finite end of the support belongs to it (its density there is finite and not zero)
    """

    name: str
    arguments: tuple[Argument, ...]
    description: str
    support: Callable[[Arguments], tuple[float, float]]
    constants: Callable[[Arguments], Constants]
    kernel: Kernel
    distribution: Callable[[Arguments], Any]
    closed: bool = True

    @property
    def dimensionless(self) -> bool:
        """True if no argument carries a unit, so that only a dimensionless parameter can have this prior."""
        return all(argument.kind == "number" for argument in self.arguments)

    def signature(self) -> str:
        """The family as it is written: ``"lognormal [median, sd of ln]"``."""
        return f"{self.name} [{', '.join(argument.name for argument in self.arguments)}]"


_HALF_LOG_TWO_PI = 0.5 * log(2.0 * pi)
_positive_axis = (0.0, inf)


def _normal_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    mean, inverse_sd, offset = constants
    z = (x - mean) * inverse_sd
    return offset - 0.5 * z * z


def _normal_constants(mean: float, sd: float) -> Constants:
    return (mean, 1.0 / sd, -log(sd) - _HALF_LOG_TWO_PI)


def _lognormal_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    mean, inverse_sd, offset = constants
    log_x = np.log(x)
    z = (log_x - mean) * inverse_sd
    return offset - 0.5 * z * z - log_x


def _student_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    location, inverse_scale, power, offset = constants
    z = (x - location) * inverse_scale
    return offset - power * np.log1p(z * z)


def _student_constants(location: float, scale: float, degrees_of_freedom: float) -> Constants:
    half = 0.5 * degrees_of_freedom
    # ln Γ(ν/2 + 1/2) − ln Γ(ν/2) through the beta function keeps its digits for large ν
    normalisation = -float(special.betaln(half, 0.5)) - 0.5 * log(degrees_of_freedom) - log(scale)
    return (location, 1.0 / (scale * sqrt(degrees_of_freedom)), half + 0.5, normalisation)


def _flat_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    return np.full_like(x, constants[0])


def _loguniform_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    return constants[0] - np.log(x)


def _exponential_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    return constants[1] - x * constants[0]


def _gamma_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    power, inverse_scale, offset = constants
    return power * np.log(x) - x * inverse_scale + offset


def _beta_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    power, other_power, offset = constants
    return power * np.log(x) + other_power * np.log1p(-x) + offset


def _half_cauchy_kernel(x: FloatArray, constants: Columns) -> FloatArray:
    z = x * constants[0]
    return constants[1] - np.log1p(z * z)


def _stats() -> Any:
    from scipy import stats  # 1.4 s to import

    return stats


def _value(name: str, positive: bool = False) -> Argument:
    return Argument(name, "value", positive)


def _number(name: str) -> Argument:
    return Argument(name, "number", positive=True)


_ALL = (
    Family(
        "lognormal",
        (_value("median", positive=True), _number("sd of ln")),
        "ln of the parameter is normal; for positive quantities known within a factor",
        lambda a: _positive_axis,
        lambda a: _normal_constants(log(a[0]), a[1]),
        _lognormal_kernel,
        lambda a: _stats().lognorm(s=a[1], scale=a[0]),
        closed=False,
    ),
    Family(
        "normal",
        (_value("mean"), _value("sd", positive=True)),
        "normal (Gaussian)",
        lambda a: (-inf, inf),
        lambda a: _normal_constants(a[0], a[1]),
        _normal_kernel,
        lambda a: _stats().norm(a[0], a[1]),
    ),
    Family(
        "truncated_normal",
        (
            _value("mean"),
            _value("sd", positive=True),
            Argument("lower", "value", infinite_allowed=True),
            Argument("upper", "value", infinite_allowed=True),
        ),
        "normal, cut off below lower and above upper",
        lambda a: (a[2], a[3]),
        lambda a: _normal_constants(a[0], a[1]),
        _normal_kernel,
        lambda a: _stats().norm(a[0], a[1]),
    ),
    Family(
        "uniform",
        (_value("lower"), _value("upper")),
        "equally probable everywhere between two values",
        lambda a: (a[0], a[1]),
        lambda a: (-log(a[1] - a[0]),),
        _flat_kernel,
        lambda a: _stats().uniform(a[0], a[1] - a[0]),
    ),
    Family(
        "loguniform",
        (_value("lower", positive=True), _value("upper", positive=True)),
        "each decade between two positive values equally probable",
        lambda a: (a[0], a[1]),
        lambda a: (-log(log(a[1]) - log(a[0])),),
        _loguniform_kernel,
        lambda a: _stats().loguniform(a[0], a[1]),
    ),
    Family(
        "half_normal",
        (_value("scale", positive=True),),
        "positive half of a normal centred at zero; for scales of scatter",
        lambda a: _positive_axis,
        lambda a: (0.0, 1.0 / a[0], log(2.0) - log(a[0]) - _HALF_LOG_TWO_PI),
        _normal_kernel,
        lambda a: _stats().halfnorm(scale=a[0]),
    ),
    Family(
        "exponential",
        (_value("mean", positive=True),),
        "exponential; positive, most probable at zero",
        lambda a: _positive_axis,
        lambda a: (1.0 / a[0], -log(a[0])),
        _exponential_kernel,
        lambda a: _stats().expon(scale=a[0]),
    ),
    Family(
        "gamma",
        (_number("shape"), _value("scale", positive=True)),
        "gamma; positive, mean = shape · scale",
        lambda a: _positive_axis,
        lambda a: (a[0] - 1.0, 1.0 / a[1], -float(special.gammaln(a[0])) - a[0] * log(a[1])),
        _gamma_kernel,
        lambda a: _stats().gamma(a[0], scale=a[1]),
        closed=False,
    ),
    Family(
        "beta",
        (_number("a"), _number("b")),
        "beta; between 0 and 1, mean = a / (a + b)",
        lambda a: (0.0, 1.0),
        lambda a: (a[0] - 1.0, a[1] - 1.0, -float(special.betaln(a[0], a[1]))),
        _beta_kernel,
        lambda a: _stats().beta(a[0], a[1]),
        closed=False,
    ),
    Family(
        "student_t",
        (_value("location"), _value("scale", positive=True), _number("degrees of freedom")),
        "Student's t; like normal, with tails that admit surprises",
        lambda a: (-inf, inf),
        lambda a: _student_constants(a[0], a[1], a[2]),
        _student_kernel,
        lambda a: _stats().t(a[2], loc=a[0], scale=a[1]),
    ),
    Family(
        "half_student_t",
        (_value("scale", positive=True), _number("degrees of freedom")),
        "positive half of a Student's t centred at zero",
        lambda a: _positive_axis,
        lambda a: _student_constants(0.0, a[0], a[1]),
        _student_kernel,
        lambda a: _stats().t(a[1], scale=a[0]),
    ),
    Family(
        "half_cauchy",
        (_value("scale", positive=True),),
        "positive half of a Cauchy centred at zero; the scale is its median",
        lambda a: _positive_axis,
        lambda a: (1.0 / a[0], log(2.0 / pi) - log(a[0])),
        _half_cauchy_kernel,
        lambda a: _stats().halfcauchy(scale=a[0]),
    ),
)

FAMILIES: dict[str, Family] = {family.name: family for family in _ALL}
"""Every family by the name used in model files."""
