"""Prior and likelihood of named parameters, of one experiment or of several."""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.problem.batches import as_batch, unbatch
from skinbayes.problem.failures import impossible
from skinbayes.statistics.densities import LogDensity, LogLikelihood

if TYPE_CHECKING:
    from skinbayes.files.joint_model import JointSpec
    from skinbayes.files.modelfile import ModelSpec


class Posterior:
    """Free parameters with their priors, and the likelihood of data.

    Attributes
    ----------
    spec : the model file
    free, fixed, tied : parameters with a prior, with a value, and that are multiples of others

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> middle = problem.prior_medians()
    >>> rng = np.random.default_rng(1)
    >>> problem.dimension
    4
    """

    spec: ModelSpec | JointSpec
    free: tuple[ParameterSpec, ...]
    fixed: tuple[ParameterSpec, ...]
    tied: tuple[ParameterSpec, ...]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters; ``name[level]`` where a parameter differs by a grouping column."""
        return tuple(parameter.label for parameter in self.free)

    @property
    def parameters(self) -> tuple[ParameterSpec, ...]:
        """All parameters: free, fixed, and tied to others."""
        return (*self.free, *self.fixed, *self.tied)

    @property
    def dimension(self) -> int:
        """Number of free parameters D."""
        return len(self.free)

    @property
    @abstractmethod
    def fingerprint(self) -> str:
        """Digest of everything the posterior depends on; a run is only continued where it is the same."""

    @abstractmethod
    def data_likelihood(self) -> LogLikelihood:
        """The likelihood: it stays as it is when coordinates change.

        Returns
        -------
        LogLikelihood
            A function of ``(B, D)``, SI, that returns ``(B,)``; NaN where the forward model has no answer.

        Examples
        --------
        >>> problem.data_likelihood()(middle[np.newaxis]).shape
        (1,)
        """

    def log_prior(self, theta: ArrayLike) -> FloatArray:
        """Log prior density, per SI unit of each parameter.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        ndarray
            Shape ``(B,)`` or scalar; −inf outside the support.

        Raises
        ------
        InputError
            ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> bool(problem.log_prior(middle) > problem.log_prior(3.0 * middle))
        True
        """
        batch, single = self._batch(theta)
        return unbatch(self._prior(batch), single)

    def log_posterior(self, theta: ArrayLike) -> FloatArray:
        """Log of prior times likelihood, not normalised.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        ndarray
            Shape ``(B,)`` or scalar.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> found = problem.log_posterior(middle)
        >>> bool(np.isclose(found, problem.log_prior(middle) + problem.log_likelihood(middle)))
        True
        """
        batch, single = self._batch(theta)
        return unbatch(impossible(self._posterior(batch)), single)

    def prior_transform(self, u: ArrayLike) -> FloatArray:
        """Parameters at quantiles of their priors, as nested samplers need them.

        Parameters
        ----------
        u : ``(D,)`` or ``(B, D)``, between 0 and 1

        Returns
        -------
        ndarray
            Shape of ``u``, SI.

        Raises
        ------
        InputError
            ``u`` has the wrong number of parameters.

        Examples
        --------
        >>> np.array_equal(problem.prior_transform(np.full(4, 0.5)), middle)
        True
        """
        batch, single = self._batch(u)
        columns = [
            parameter.prior.quantile(batch[:, i]) for i, parameter in enumerate(self.free) if parameter.prior
        ]
        return unbatch(np.stack(columns, axis=-1), single)

    def prior_density(self) -> LogDensity:
        """The prior as a density: it gains a Jacobian when coordinates change.

        Returns
        -------
        LogDensity
            A function of ``(B, D)``, SI, that returns ``(B,)``.

        Examples
        --------
        >>> problem.prior_density()(middle[np.newaxis]).shape
        (1,)
        """
        return self._prior

    def draw_prior(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw parameter vectors from the prior.

        Parameters
        ----------
        rng : source of randomness
        count : how many

        Returns
        -------
        ndarray
            Shape ``(count, D)``, SI.

        Examples
        --------
        >>> problem.draw_prior(rng, 3).shape
        (3, 4)
        """
        return np.stack([p.prior.draw(rng, count) for p in self.free if p.prior], axis=-1)

    def prior_medians(self) -> FloatArray:
        """Prior median of each free parameter.

        Returns
        -------
        ndarray
            Shape ``(D,)``, SI.

        Examples
        --------
        >>> problem.prior_medians().shape
        (4,)
        """
        return np.array([p.prior.median for p in self.free if p.prior], dtype=float)

    @cached_property
    def _prior(self) -> LogDensity:
        return LogDensity.independent([parameter.prior for parameter in self.free if parameter.prior])

    @cached_property
    def _posterior(self) -> LogDensity:
        return self._prior.times(self.data_likelihood())

    def _batch(self, theta: ArrayLike) -> tuple[FloatArray, bool]:
        return as_batch(theta, self.names)
