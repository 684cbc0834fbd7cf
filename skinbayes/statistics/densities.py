"""Two types that must not be confused: densities of parameters, and likelihoods of data given parameters.

A density has mass, so a change of coordinates multiplies it by the Jacobian; a likelihood is a plain function
of the parameters, so a change of coordinates leaves it as it is. A posterior is a prior (density) times a
likelihood; the product of two densities has no meaning here and is refused.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.priors import IndependentPriors, Prior
from skinbayes.statistics.transforms import VectorTransform

BatchFunction = Callable[[FloatArray], FloatArray]
"""``(B, D)`` to ``(B,)``."""


@dataclass(frozen=True)
class _WithJacobian:
    function: BatchFunction
    transform: VectorTransform

    def __call__(self, z: FloatArray) -> FloatArray:
        with np.errstate(all="ignore"):
            value = self.function(self.transform.inverse(z))
            # where the density is zero the Jacobian may be infinite: 0 · ∞ is 0 here
            return np.where(value > -inf, value + self.transform.log_jacobian(z), -inf)


@dataclass(frozen=True)
class _Product:
    prior: BatchFunction
    likelihood: BatchFunction

    def __call__(self, theta: FloatArray) -> FloatArray:
        value = self.prior(theta)
        possible = value > -inf  # the likelihood is never asked about parameters that the prior excludes
        if possible.all():
            return value + self.likelihood(theta)
        value = np.array(value, dtype=float)
        if possible.any():
            value[possible] += self.likelihood(theta[possible])
        return value


@dataclass(frozen=True)
class LogLikelihood:
    """ln p(data | θ) as a function of a batch of parameters. Picklable if ``function`` is.

    Attributes
    ----------
    function : ``(B, D)`` to ``(B,)``; −inf where the data are impossible
    """

    function: BatchFunction

    def __call__(self, theta: FloatArray) -> FloatArray:
        """Log-likelihood of each row of ``theta``, shape ``(B,)``."""
        return self.function(theta)


@dataclass(frozen=True)
class LogDensity:
    """ln of a (possibly unnormalised) density of a batch of parameters. Picklable if ``function`` is.

    Attributes
    ----------
    function : ``(B, D)`` to ``(B,)``; −inf where the density is zero, never NaN

    Examples
    --------
    >>> from skinbayes.statistics.priors import make_prior
    >>> prior = LogDensity.independent([make_prior("exponential", [1.0])])
    >>> z = VectorTransform.for_supports([(0.0, float("inf"))])
    >>> point = np.array([[0.0]])
    >>> print(prior(np.exp(point)), prior.transformed(z)(point + 1.0))
    [-1.] [-1.71828183]
    """

    function: BatchFunction

    @staticmethod
    def independent(priors: list[Prior] | tuple[Prior, ...]) -> LogDensity:
        """The joint density of D independent priors, normalised."""
        return LogDensity(IndependentPriors(tuple(priors)))

    def __call__(self, theta: FloatArray) -> FloatArray:
        """Log-density of each row of ``theta``, shape ``(B,)``."""
        return self.function(theta)

    def transformed(self, transform: VectorTransform) -> LogDensity:
        """The density of the unconstrained coordinates: ln p(x(z)) + ln |dx/dz|."""
        return LogDensity(_WithJacobian(self.function, transform))

    def times(self, likelihood: LogLikelihood) -> LogDensity:
        """Prior times likelihood: the unnormalised posterior density, in the same coordinates.

        Raises
        ------
        TypeError
            if ``likelihood`` is a density: the Jacobian would be counted twice
        """
        if not isinstance(likelihood, LogLikelihood):
            raise TypeError("A density can only be multiplied by a likelihood, not by another density.")
        return LogDensity(_Product(self.function, likelihood.function))
