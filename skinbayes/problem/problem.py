"""A model bound to its data: log-prior, log-likelihood, predictions and simulated data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import ForwardModel, Profile, Tables
from skinbayes.problem.inputs import Conditions, InputPlan, plan_inputs
from skinbayes.statistics.densities import LogDensity, LogLikelihood
from skinbayes.statistics.noise import NoiseFamily, noise_family

if TYPE_CHECKING:
    from skinbayes.problem.check import CheckReport
    from skinbayes.problem.target import PosteriorTarget

_NOISE_WORDS = {
    "noise_scale": "scale",
    "discrepancy_scale": "discrepancy",
    "degrees_of_freedom": "degrees_of_freedom",
}
"""Parameters of ``[noise]`` and what the noise families call them."""


@dataclass(frozen=True)
class Problem:
    """A statistical model bound to its data; frozen.

    Build one with :func:`skinbayes.load_problem`. ``theta`` below is one parameter vector ``(D,)`` in SI units in the
    order of :attr:`names`, or a batch ``(B, D)``; a batch is one vectorised evaluation and its rows agree to the last
    bit with single evaluations.

    Attributes
    ----------
    spec : the model file
    forward : the forward model
    free, fixed : parameters with a prior, and parameters with a value
    conditions : the rows of the data set (or the default conditions of a model without data)
    dataset : the data set after row selection, or None
    observed : observed values, shape ``(N,)``, SI; None without data
    observed_spread : known standard deviation of each datum, shape ``(N,)``, zero if not used
    tables : tabulated roughness spectrum and flow curves of the rows, where there are any
    fingerprint : digest of everything the posterior depends on
    data_fingerprint : digest of the data alone
    settings : values set over the model file, as given
    surface_file : file of the tabulated spectrum, or None
    """

    spec: ModelSpec
    forward: ForwardModel
    free: tuple[ParameterSpec, ...]
    fixed: tuple[ParameterSpec, ...]
    conditions: Conditions
    dataset: Dataset | None
    observed: FloatArray | None
    observed_spread: FloatArray | None
    tables: Tables
    fingerprint: str
    data_fingerprint: str
    _plan: tuple[InputPlan, ...]
    settings: Mapping[str, str] = field(default_factory=dict)
    surface_file: Path | None = None

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.spec.name

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the free parameters; ``name[level]`` where a parameter differs by a grouping column."""
        return tuple(parameter.label for parameter in self.free)

    @property
    def dimension(self) -> int:
        """Number of free parameters D."""
        return len(self.free)

    @property
    def observable(self) -> str:
        """The observable that the data hold."""
        if self.spec.observable is None:
            raise InputError(
                f"{self.spec.path}: the model '{self.name}' has no data; it serves 'predict' only"
            )
        return self.spec.observable

    # -- densities ---------------------------------------------------------------------------------------------------

    def log_prior(self, theta: ArrayLike) -> FloatArray:
        """Log prior density per SI unit of each parameter; ``-inf`` outside the support. Shape ``(B,)`` or scalar."""
        batch, single = self._batch(theta)
        return _unbatch(self.prior_density()(batch), single)

    def log_likelihood(self, theta: ArrayLike, pointwise: bool = False) -> FloatArray:
        """Log-likelihood of the data, shape ``(B,)``; ``pointwise=True`` gives ``(B, N)``.

        NaN and +inf from the forward model become −inf.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.
        """
        batch, single = self._batch(theta)
        value = self._pointwise(batch) if pointwise else self._log_likelihood(batch)
        return _unbatch(_impossible(value), single)

    def log_posterior(self, theta: ArrayLike) -> FloatArray:
        """Log of prior times likelihood (not normalised), shape ``(B,)`` or scalar."""
        batch, single = self._batch(theta)
        return _unbatch(_impossible(self.prior_density().times(self.data_likelihood())(batch)), single)

    def prior_transform(self, u: ArrayLike) -> FloatArray:
        """Map the unit hypercube to parameters by the prior quantiles, as nested samplers need it; shape as ``u``."""
        batch, single = self._batch(u)
        columns = [
            parameter.prior.quantile(batch[:, i]) for i, parameter in enumerate(self.free) if parameter.prior
        ]
        return _unbatch(np.stack(columns, axis=-1), single)

    def prior_density(self) -> LogDensity:
        """The prior as a density: it gains a Jacobian when coordinates change."""
        return LogDensity.independent([parameter.prior for parameter in self.free if parameter.prior])

    def data_likelihood(self) -> LogLikelihood:
        """The likelihood: it stays as it is when coordinates change; NaN where the forward model has no answer."""
        return LogLikelihood(self._log_likelihood)

    # -- predictions -------------------------------------------------------------------------------------------------

    def predict(self, theta: ArrayLike, conditions: Conditions | None = None) -> dict[str, FloatArray]:
        """Evaluate the forward model.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI
        conditions : rows to predict; the data's own if omitted

        Returns
        -------
        dict
            Observable to predictions, ``(N,)`` or ``(B, N)``, SI. The observable of the data includes the model's
            discrepancy factor, if it has one.
        """
        batch, single = self._batch(theta)
        rows = conditions or self.conditions
        predicted = self._evaluate(self.inputs(batch, conditions))
        shape = (batch.shape[0], rows.n_rows)
        return {
            name: _unbatch(np.array(np.broadcast_to(value, shape)), single)
            for name, value in predicted.items()
        }

    def derived(self, theta: ArrayLike) -> dict[str, FloatArray]:
        """Quantities between inputs and observables at the problem's rows, and the products named in the model file.

        Returns
        -------
        dict
            Name to values, SI: ``(B, 1)`` if they are the same for all rows (of those the product is defined for), else
            ``(B, N)``, or ``(B, n)`` for a product that is defined for n of the rows.
        """
        batch, _ = self._batch(theta)
        inputs = self.inputs(batch)
        with np.errstate(all="ignore"):
            quantities = dict(self.forward.derived(inputs, self.tables))
            known = inputs | quantities
            for name, block in self.spec.derived.items():
                product = np.ones((1, 1))
                for factor, power in block.product.items():
                    product = product * np.asarray(known[factor]) ** power
                chosen = self.conditions.matching(block.rows)
                if not chosen.any():  # data of the user's own without such rows
                    continue
                quantities[name] = product[:, chosen] if product.shape[-1] > 1 else product
        return {name: np.array(np.atleast_2d(value)) for name, value in quantities.items()}

    def explain(self, theta: ArrayLike) -> list[str]:
        """Sentences on why predictions at ``theta`` are missing or doubtful, empty if nothing is to be said."""
        batch, _ = self._batch(theta)
        if self.forward.explain is None:
            return []
        with np.errstate(all="ignore"):
            return self.forward.explain(self.inputs(batch), self.tables)

    def simulate(self, theta: ArrayLike, rng: np.random.Generator) -> FloatArray:
        """Draw data of the size of the observed ones for each parameter vector, noise included; ``(N,)`` or ``(B, N)``."""
        batch, single = self._batch(theta)
        predicted = self.predict(batch)[self.observable]
        arguments = self._noise_arguments(self.inputs(batch))
        return _unbatch(self._noise.draw(rng, predicted, observed=self.observed, **arguments), single)

    def profile(self, profile: Profile, theta: FloatArray, row: int = 0) -> tuple[FloatArray, FloatArray]:
        """A curve of the forward model at the conditions of one row: abscissa ``(K,)`` and ordinate ``(B, K)``."""
        inputs = {
            name: np.ascontiguousarray(
                np.broadcast_to(value, (value.shape[0], self.conditions.n_rows))[:, row]
            )
            for name, value in self.inputs(theta).items()
        }
        with np.errstate(all="ignore"):
            grid = profile.grid(inputs, self.tables)
            curve = profile.evaluate(inputs, self.tables, grid)
        return grid, np.array(np.broadcast_to(curve, (len(theta), len(grid))))

    def inputs(self, theta: FloatArray, conditions: Conditions | None = None) -> dict[str, FloatArray]:
        """All inputs of the forward model and the noise by name, each ``(B or 1, N or 1)``."""
        rows = conditions or self.conditions
        plan = self._plan if conditions is None else plan_inputs(self.fixed, self.free, rows)
        values = {entry.name: entry.values(theta) for entry in plan if entry.name not in rows.values}
        return values | {name: column[np.newaxis, :] for name, column in rows.values.items()}

    # -- prior draws, checks, sampling -------------------------------------------------------------------------------

    def draw_prior(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw parameter vectors from the prior, shape ``(count, D)``, SI."""
        return np.stack([p.prior.draw(rng, count) for p in self.free if p.prior], axis=-1)

    def prior_medians(self) -> FloatArray:
        """Prior median of each free parameter, shape ``(D,)``, SI."""
        return np.array([p.prior.median for p in self.free if p.prior], dtype=float)

    def check(self) -> CheckReport:
        """Look at the problem before sampling: priors, finite predictions, and what the data can tell apart, in words."""
        from skinbayes.problem.check import check_problem

        return check_problem(self)

    def target(self) -> PosteriorTarget:
        """The posterior as samplers see it: on the whole real space, with Jacobian."""
        from skinbayes.problem.target import PosteriorTarget

        return PosteriorTarget(self)

    def noise_width(self, theta: FloatArray) -> FloatArray:
        """Width of the noise of each row at one parameter vector ``(D,)``, shape ``(N,)``.

        In the unit of the observable; for logarithmic noise families the width of its ln.
        """
        batch, _ = self._batch(theta)
        arguments = self._noise_arguments(self.inputs(batch))
        arguments.pop("degrees_of_freedom", None)
        width = self._noise.width(self.predict(batch)[self.observable], observed=self.observed, **arguments)
        return np.array(np.broadcast_to(width, (1, self.conditions.n_rows))[0])

    @property
    def noise_is_logarithmic(self) -> bool:
        """Whether it is ln of the observable that scatters."""
        return self._noise.logarithmic

    # -- inner parts -------------------------------------------------------------------------------------------------

    @property
    def _noise(self) -> NoiseFamily:
        return noise_family(str(self.spec.noise))

    def _batch(self, theta: ArrayLike) -> tuple[FloatArray, bool]:
        array = np.asarray(theta, dtype=float)
        if array.ndim not in (1, 2) or array.shape[-1] != self.dimension:
            raise InputError(
                f"theta has shape {array.shape}; expected ({self.dimension},) or (B, {self.dimension}): {', '.join(self.names)}"
            )
        return (array[np.newaxis, :], True) if array.ndim == 1 else (array, False)

    def _log_likelihood(self, theta: FloatArray) -> FloatArray:
        return self._pointwise(theta).sum(axis=-1)

    def _pointwise(self, theta: FloatArray) -> FloatArray:
        if self.observed is None:
            raise InputError(f"{self.spec.path}: '{self.name}' has no data here, so there is no likelihood")
        inputs = self.inputs(theta)
        predicted = np.broadcast_to(
            self._evaluate(inputs)[self.observable], (len(theta), self.conditions.n_rows)
        )
        density = self._noise.log_density(self.observed, predicted, **self._noise_arguments(inputs))
        # NaN where the forward model has no answer: samplers count those apart from data that are impossible
        return np.where(np.isnan(predicted), np.nan, density)

    def _evaluate(self, inputs: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """The forward model with the discrepancy factor, if there is one; shapes as the forward model gives them."""
        with np.errstate(all="ignore"):
            predicted = self.forward.evaluate(inputs, self.tables)
        if "discrepancy_factor" in inputs:
            predicted[self.observable] = predicted[self.observable] * inputs["discrepancy_factor"]
        return predicted

    def _noise_arguments(self, inputs: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        arguments = {_NOISE_WORDS[name]: inputs[name] for name in _NOISE_WORDS if name in inputs}
        if self.observed_spread is not None:
            arguments["spread"] = self.observed_spread
        return arguments


def _unbatch(values: FloatArray, single: bool) -> FloatArray:
    return values[0] if single else values


def _impossible(values: FloatArray) -> FloatArray:
    return np.where(np.isnan(values) | (values == np.inf), -np.inf, values)
