"""Prior and likelihood of several experiments on one skin, which share parameters."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.files.joint_model import EXPERIMENT, JointSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.problem.batches import unbatch
from skinbayes.problem.failures import impossible
from skinbayes.problem.posterior import Posterior
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.statistics.densities import LogLikelihood

Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True)
class JointModel(Posterior):
    """Experiments on one skin that share parameters: their densities, predictions and simulated data.

    Vectors ``theta`` hold the parameters of all of them, data stand experiment by experiment.

    Attributes
    ----------
    spec : the model file
    experiments : the model of each experiment by name
    free, fixed, tied : parameters of all experiments; what is not shared is ``name[experiment]``
    places : which of the free parameters each experiment has, in its order
    settings : values set over the model file, as given

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> constant = {"forward": "constant", "noise": {"family": "gaussian", "noise_scale": 0.1}}
    >>> problem = sb.build_joint_problem(
    ...     {
    ...         "left": constant | {"data": {"friction_coefficient": [0.4, 0.5]}},
    ...         "right": constant | {"data": {"friction_coefficient": [0.6]}},
    ...     },
    ...     parameters={"typical_friction_coefficient": {"uniform": [0, 2]}},
    ... )
    >>> theta = problem.prior_medians()
    >>> problem.names, list(problem.experiments)
    (('typical_friction_coefficient',), ['left', 'right'])
    """

    spec: JointSpec
    experiments: Mapping[str, StatisticalModel]
    free: tuple[ParameterSpec, ...]
    fixed: tuple[ParameterSpec, ...]
    tied: tuple[ParameterSpec, ...]
    places: Mapping[str, NDArray[np.intp]]
    settings: Mapping[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.spec.name

    @property
    def parts(self) -> dict[str, tuple[StatisticalModel, NDArray[np.intp]]]:
        """The problem of each experiment, and which of the free parameters it has."""
        return {name: (problem, self.places[name]) for name, problem in self.experiments.items()}

    @cached_property
    def fingerprint(self) -> str:
        """Digest of everything the posterior depends on; a run is only continued where it is the same."""
        places = {name: place.tolist() for name, place in self.places.items()}
        each = {name: problem.fingerprint for name, problem in self.experiments.items()}
        priors = [(p.label, repr(p.prior)) for p in self.free]
        return hashlib.sha256(json.dumps([list(each.items()), places, priors]).encode()).hexdigest()

    @cached_property
    def data_fingerprint(self) -> str:
        """Digest of the data of all experiments; models are compared where it is the same."""
        each = {name: problem.data_fingerprint for name, problem in self.experiments.items()}
        return hashlib.sha256(json.dumps(list(each.items())).encode()).hexdigest()

    @property
    def expensive(self) -> bool:
        """Whether a likelihood takes so long that fewer walkers are better."""
        return any(problem.expensive for problem in self.experiments.values())

    @property
    def observed(self) -> FloatArray:
        """All data, one experiment after the other, shape ``(M,)``, SI."""
        return np.concatenate([np.asarray(problem.observed) for problem in self.experiments.values()])

    @property
    def noise_is_logarithmic(self) -> NDArray[np.bool_]:
        """Whether it is ln of a datum that scatters, for each datum, shape ``(M,)``."""
        return np.concatenate([problem.noise_is_logarithmic for problem in self.experiments.values()])

    def counts(self) -> dict[str, int]:
        """Number of data of each experiment.

        Returns
        -------
        dict
            By the name of the experiment.

        Examples
        --------
        >>> problem.counts()
        {'left': 2, 'right': 1}
        """
        return {name: len(np.asarray(problem.observed)) for name, problem in self.experiments.items()}

    def datum_labels(self) -> list[str]:
        """A short name for each datum: its experiment and its name in there.

        Returns
        -------
        list of str
            One for each datum.

        Examples
        --------
        >>> problem.datum_labels()
        ['left, 1', 'left, 2', 'right, 1']
        """
        return [
            f"{name}, {label}"
            for name, problem in self.experiments.items()
            for label in problem.datum_labels()
        ]

    def prepare(self, progress: Progress | None = None, cores: int = 1) -> None:
        """Build what the forward models want to have ready before many evaluations, such as tables; once.

        Parameters
        ----------
        progress : called with the number of steps done and their total, for each experiment anew
        cores : processes that share the work

        Examples
        --------
        >>> problem.prepare()
        """
        for problem in self.experiments.values():
            problem.prepare(progress, cores)

    def data_likelihood(self) -> LogLikelihood:
        """The likelihood: it stays as it is when coordinates change.

        Returns
        -------
        LogLikelihood
            A function of ``(B, D)``, SI, that returns ``(B,)``; NaN where a forward model has no answer.

        Examples
        --------
        >>> problem.data_likelihood()(theta[np.newaxis]).shape
        (1,)
        """
        return LogLikelihood(self._total)

    def log_likelihood(self, theta: ArrayLike, pointwise: bool = False) -> FloatArray:
        """Log-likelihood of the data of all experiments.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        pointwise : give one number for each datum, as :meth:`Problem.log_likelihood` does

        Returns
        -------
        ndarray
            Shape ``(B,)`` or scalar; pointwise ``(B, M)`` or ``(M,)``.

        Examples
        --------
        >>> problem.log_likelihood(theta).shape, problem.log_likelihood(theta, pointwise=True).shape
        ((), (3,))
        """
        batch, single = self._batch(theta)
        if not pointwise:
            return unbatch(impossible(self._total(batch)), single)
        each = [part.log_likelihood(batch[:, place], pointwise=True) for part, place in self.parts.values()]
        return unbatch(np.concatenate(each, axis=-1), single)

    def log_likelihood_left_out(self, theta: ArrayLike, column: str = EXPERIMENT) -> FloatArray:
        """ln p(all data of one experiment | θ) for each experiment: what leaving out one of them needs.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        column : ``"experiment"``

        Returns
        -------
        ndarray
            Shape ``(B, experiments)`` or ``(experiments,)``.

        Raises
        ------
        InputError
            Another column, which only some of the data have.

        Examples
        --------
        >>> problem.log_likelihood_left_out(theta).shape
        (2,)
        """
        if column != EXPERIMENT:
            raise InputError(
                f"{self.spec.path}: found '{column:.60}'; of several experiments whole ones are left out, expected '{EXPERIMENT}'"
            )
        batch, single = self._batch(theta)
        each = [part.log_likelihood(batch[:, place]) for part, place in self.parts.values()]
        return unbatch(np.stack(each, axis=-1), single)

    def predict(self, theta: ArrayLike) -> dict[str, dict[str, FloatArray]]:
        """Evaluate the forward model of each experiment.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        dict
            Experiment to what :meth:`Problem.predict` gives.

        Examples
        --------
        >>> problem.predict(theta)["left"]["friction_coefficient"].tolist()
        [1.0, 1.0]
        """
        batch, single = self._batch(theta)
        return {
            name: self.experiments[name].predict(batch[0, place] if single else batch[:, place])
            for name, place in self.places.items()
        }

    def predict_data(self, theta: ArrayLike) -> FloatArray:
        """Predictions of all data, one experiment after the other.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        ndarray
            Shape ``(M,)`` or ``(B, M)``, SI.

        Examples
        --------
        >>> problem.predict_data(theta).tolist()
        [1.0, 1.0, 1.0]
        """
        batch, single = self._batch(theta)
        each = [part.predict_data(batch[:, place]) for part, place in self.parts.values()]
        return unbatch(np.concatenate(each, axis=-1), single)

    def simulate(self, theta: ArrayLike, rng: np.random.Generator) -> FloatArray:
        """Draw data of the size of the observed ones for each parameter vector, noise included.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        rng : source of randomness

        Returns
        -------
        ndarray
            Shape ``(B, M)`` or ``(M,)``, SI.

        Examples
        --------
        >>> problem.simulate(theta, np.random.default_rng(1)).shape
        (3,)
        """
        batch, single = self._batch(theta)
        each = [part.simulate(batch[:, place], rng) for part, place in self.parts.values()]
        return unbatch(np.concatenate(each, axis=-1), single)

    # -- inner parts -------------------------------------------------------------------------------------------------

    def _total(self, theta: FloatArray) -> FloatArray:
        total = np.zeros(len(theta))
        for part, place in self.parts.values():
            total = total + part.likelihood.total(theta[:, place])
        return total


def split(problem: JointModel, values: NDArray[Scalar]) -> dict[str, NDArray[Scalar]]:
    """What stands datum by datum along the last axis, for each experiment."""
    ends = np.cumsum(list(problem.counts().values()))[:-1]
    return dict(zip(problem.experiments, np.split(values, ends, axis=-1), strict=True))
