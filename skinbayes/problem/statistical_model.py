"""Prior, likelihood and simulated data of a model bound to its data."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.problem.batches import unbatch
from skinbayes.problem.failures import impossible
from skinbayes.problem.fingerprint import digest_data, digest_model
from skinbayes.problem.likelihood import Likelihood
from skinbayes.problem.predicting import PredictingModel
from skinbayes.statistics.densities import LogLikelihood

MANY_ROWS = 1_000  # with so many a likelihood takes far longer than a step of the sampler


@dataclass(frozen=True)
class StatisticalModel(PredictingModel):
    """A bound model with the densities of its parameters and of its data.

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> middle = problem.prior_medians()
    >>> rng = np.random.default_rng(1)
    >>> problem.dimension, problem.conditions.n_rows
    (4, 165)
    """

    @cached_property
    def fingerprint(self) -> str:
        """Digest of everything the posterior depends on; a run is only continued where it is the same."""
        return digest_model(
            self.spec, self.forward, self.parameters, self.conditions, self.observations, self.input_spread,
            self.groups, self.correlated, self.tables, self.data_fingerprint, self.surface_prior,
        )  # fmt: skip

    @cached_property
    def data_fingerprint(self) -> str:
        """Digest of the data alone; models are compared where it is the same."""
        return digest_data(self.dataset, self.observations)

    @property
    def parts(self) -> dict[str, tuple[StatisticalModel, NDArray[np.intp]]]:
        """Itself, under no name, with all of its parameters."""
        return {"": (self, np.arange(self.dimension))}

    # -- densities ---------------------------------------------------------------------------------------------------

    def log_likelihood(self, theta: ArrayLike, pointwise: bool = False) -> FloatArray:
        """Log-likelihood of the data.

        Where rows share effects, a discrepancy or correlated noise, the pointwise terms are ln p(datum | all others, θ), which is
        what leaving one out needs; they do not sum to the whole. NaN and +inf from the forward model become −inf.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        pointwise : give one number for each datum

        Returns
        -------
        ndarray
            Shape ``(B,)`` or scalar; pointwise ``(B, M)`` or ``(M,)``.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> problem.log_likelihood(middle).shape, problem.log_likelihood(middle, pointwise=True).shape
        ((), (165,))
        """
        batch, single = self._batch(theta)
        value = self.likelihood.pointwise(batch) if pointwise else self.likelihood.total(batch)
        return unbatch(impossible(value), single)

    def log_likelihood_left_out(self, theta: ArrayLike, column: str) -> FloatArray:
        """ln p(all data of one level | all other data, θ) for each level of a grouping column.

        What leaving out one person, or one liquid, needs.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        column : of labels of the rows

        Returns
        -------
        ndarray
            Shape ``(B, levels)`` or ``(levels,)``, levels in the order of their first row.

        Raises
        ------
        InputError
            The model has no data, several observables, or no such column.

        Examples
        --------
        >>> problem.log_likelihood_left_out(middle, "person").shape
        (11,)
        """
        batch, single = self._batch(theta)
        return unbatch(impossible(self.likelihood.left_out(batch, column)), single)

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
        return LogLikelihood(self.likelihood.total)

    # -- prior draws, checks, sampling -------------------------------------------------------------------------------

    def simulate(
        self, theta: ArrayLike, rng: np.random.Generator, effects: FloatArray | None = None
    ) -> FloatArray:
        """Draw data of the size of the observed ones for each parameter vector, noise included.

        Group effects are drawn anew, for other people and liquids, unless they are given.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        rng : source of randomness
        effects : of all levels, shape ``(B, G)``, from :meth:`draw_effects`

        Returns
        -------
        ndarray
            Shape ``(B, M)`` or ``(M,)``, SI.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> problem.simulate(middle, rng).shape
        (165,)
        """
        batch, single = self._batch(theta)
        return unbatch(self.likelihood.draw(batch, rng, effects), single)

    def draw_effects(self, theta: ArrayLike, rng: np.random.Generator) -> FloatArray:
        """Draw all that rows share given parameters and data: effects of groups, curves of the discrepancy, drifts.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        rng : source of randomness

        Returns
        -------
        ndarray
            Shape ``(B, G)``: in the unit of the observable, or of its ln if the noise is logarithmic.

        Raises
        ------
        InputError
            The model has neither groups nor a discrepancy nor a drift, or no data.

        Examples
        --------
        >>> problem.draw_effects(middle, rng).shape
        (1, 26)
        """
        batch, _ = self._batch(theta)
        return self.likelihood.draw_effects(batch, rng)

    def noise_width(self, theta: FloatArray) -> FloatArray:
        """Width of the noise of each datum at one parameter vector. Group effects are not in it.

        Parameters
        ----------
        theta : one parameter vector ``(D,)``, SI

        Returns
        -------
        ndarray
            Shape ``(M,)``: in the unit of the observable, or of its ln if the noise is logarithmic.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> bool((problem.noise_width(middle) == middle[1]).all())
        True
        """
        batch, _ = self._batch(theta)
        return self.likelihood.width(batch)[0]

    def independent_scatter(self, theta: FloatArray, changes: FloatArray) -> FloatArray:
        """Changes of what scatters as numbers that scatter independently, with width 1.

        Parameters
        ----------
        theta : one parameter vector ``(D,)``, SI
        changes : of the data, on the scale on which they scatter, shape ``(B, M)``

        Returns
        -------
        ndarray
            Shape ``(B, M + G)`` with G effects of groups: the inner products are those of the changes with the inverse of the
            covariance of the data between them.

        Examples
        --------
        >>> problem.independent_scatter(middle, np.ones((1, 165))).shape
        (1, 191)
        """
        return self.likelihood.independent(theta, changes)

    @property
    def noise_is_logarithmic(self) -> NDArray[np.bool_]:
        """Whether it is ln of a datum that scatters, for each datum, shape ``(M,)``."""
        return np.repeat([o.noise.logarithmic for o in self.observations], self.conditions.n_rows)

    @property
    def expensive(self) -> bool:
        """Whether a likelihood takes so long that fewer walkers are better: an expensive forward model, or very many rows."""
        return self.forward.expensive or self.conditions.n_rows >= MANY_ROWS

    @cached_property
    def likelihood(self) -> Likelihood:
        """What the densities and draws of data are made of, for batches ``(B, D)`` without checks of their shape."""
        return Likelihood(self)
