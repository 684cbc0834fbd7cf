"""A model bound to its data: log-prior, log-likelihood, predictions and simulated data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import FlowCurve, ForwardModel, Profile, Tables
from skinbayes.forward.base import Progress
from skinbayes.problem import quantities
from skinbayes.problem.alike import DistinctRows, distinct_rows
from skinbayes.problem.batches import as_batch, unbatch
from skinbayes.problem.covariates import apply_covariates, factor_key
from skinbayes.problem.failures import FAILED, explained, impossible
from skinbayes.problem.fingerprint import digest_data, digest_model
from skinbayes.problem.inputs import Conditions, InputPlan, plan_inputs
from skinbayes.problem.likelihood import Likelihood
from skinbayes.problem.observations import Observation
from skinbayes.problem.ranges import input_ranges
from skinbayes.problem.summary import summary
from skinbayes.statistics.densities import LogDensity, LogLikelihood
from skinbayes.statistics.groups import CrossedGroups

if TYPE_CHECKING:
    from skinbayes.problem.check import CheckReport
    from skinbayes.problem.target import PosteriorTarget

MANY_ROWS = 1_000  # with so many a likelihood takes far longer than a step of the sampler


@dataclass(frozen=True, repr=False)
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
    observations : what was observed, each at all rows; empty without data
    input_spread : inputs to their known standard deviation over their value, shape ``(N,)``, if that is to be used
    groups : group effects that are integrated out, or None
    tables : tabulated roughness spectrum and flow curves of the rows, where there are any
    flow_curves : flow curve of each liquid, empty without ``[rheology]``
    settings : values set over the model file, as given
    surface_file : file of the tabulated spectrum, or None
    """

    spec: ModelSpec
    forward: ForwardModel
    free: tuple[ParameterSpec, ...]
    fixed: tuple[ParameterSpec, ...]
    conditions: Conditions
    dataset: Dataset | None
    observations: tuple[Observation, ...]
    input_spread: Mapping[str, FloatArray]
    groups: CrossedGroups | None
    tables: Tables
    flow_curves: Mapping[str, FlowCurve]
    settings: Mapping[str, str] = field(default_factory=dict)
    surface_file: Path | None = None

    def __repr__(self) -> str:
        return summary(self)

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

    @cached_property
    def fingerprint(self) -> str:
        """Digest of everything the posterior depends on; a run is only continued where it is the same."""
        return digest_model(
            self.spec, self.forward, (*self.free, *self.fixed), self.conditions, self.observations, self.input_spread,
            self.groups, self.tables, self.data_fingerprint,
        )  # fmt: skip

    @cached_property
    def data_fingerprint(self) -> str:
        """Digest of the data alone; models are compared where it is the same."""
        return digest_data(self.dataset, self.observations)

    @property
    def observables(self) -> tuple[str, ...]:
        """The observables that the data hold; :class:`InputError` if the model has no data."""
        if not self.observations:
            hint = "give them with --data FILE.csv" if self.spec.observables else "it serves 'predict' only"
            raise InputError(f"{self.spec.path}: the model '{self.name}' has no data; {hint}")
        return tuple(observation.name for observation in self.observations)

    @property
    def observed(self) -> FloatArray | None:
        """All data, one observable after the other, shape ``(M,)``, SI; None without data."""
        if not self.observations:
            return None
        return np.concatenate([observation.values for observation in self.observations])

    def datum_labels(self) -> list[str]:
        """A short name for each datum: its row, its observable, or both."""
        rows = self.conditions.row_labels()
        if len(self.observations) < 2:
            return rows
        if len(rows) == 1:
            return list(self.observables)
        return [f"{name}, {row}" for name in self.observables for row in rows]

    @cached_property
    def model(self) -> ForwardModel:
        """The forward model as it is evaluated: prepared for the ranges of the priors if it can be and there are any."""
        return self.prepare()

    def prepare(self, progress: Progress | None = None, cores: int = 1) -> ForwardModel:
        """Build what the forward model wants to have ready before many evaluations, such as a table; once.

        ``progress`` is called with steps done and their total; ``cores`` processes share the work. Without data or free
        parameters nothing is built.
        """
        if "model" in self.__dict__:
            return self.model
        prepared = self.forward
        if prepared.prepare is not None and self.observations and self.free:
            with explained(self.spec.path, "no table can be made for the priors"), np.errstate(all="ignore"):
                prepared = prepared.prepare(input_ranges(self), self.tables, progress, cores)
        self.__dict__["model"] = prepared
        return prepared

    # -- densities ---------------------------------------------------------------------------------------------------

    def log_prior(self, theta: ArrayLike) -> FloatArray:
        """Log prior density per SI unit of each parameter; ``-inf`` outside the support. Shape ``(B,)`` or scalar."""
        batch, single = self._batch(theta)
        return unbatch(self.prior_density()(batch), single)

    def log_likelihood(self, theta: ArrayLike, pointwise: bool = False) -> FloatArray:
        """Log-likelihood of the data, shape ``(B,)``; ``pointwise=True`` gives ``(B, M)``, one for each datum.

        With group effects the pointwise terms are ln p(datum | all others, θ), which is what leaving one out needs; they do
        not sum to the whole. NaN and +inf from the forward model become −inf.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.
        """
        batch, single = self._batch(theta)
        value = self._likelihood.pointwise(batch) if pointwise else self._likelihood.total(batch)
        return unbatch(impossible(value), single)

    def log_likelihood_left_out(self, theta: ArrayLike, column: str) -> FloatArray:
        """ln p(all data of one level | all other data, θ) for each level of a grouping column, shape ``(B, levels)``.

        What leaving out one person, or one liquid, needs. Levels in the order of their first row.

        Raises
        ------
        InputError
            The model has no data, several observables, or no such column.
        """
        batch, single = self._batch(theta)
        return unbatch(impossible(self._likelihood.left_out(batch, column)), single)

    def log_posterior(self, theta: ArrayLike) -> FloatArray:
        """Log of prior times likelihood (not normalised), shape ``(B,)`` or scalar."""
        batch, single = self._batch(theta)
        return unbatch(impossible(self.prior_density().times(self.data_likelihood())(batch)), single)

    def prior_transform(self, u: ArrayLike) -> FloatArray:
        """Map the unit hypercube to parameters by the prior quantiles, as nested samplers need it; shape as ``u``."""
        batch, single = self._batch(u)
        columns = [
            parameter.prior.quantile(batch[:, i]) for i, parameter in enumerate(self.free) if parameter.prior
        ]
        return unbatch(np.stack(columns, axis=-1), single)

    def prior_density(self) -> LogDensity:
        """The prior as a density: it gains a Jacobian when coordinates change."""
        return LogDensity.independent([parameter.prior for parameter in self.free if parameter.prior])

    def data_likelihood(self) -> LogLikelihood:
        """The likelihood: it stays as it is when coordinates change; NaN where the forward model has no answer."""
        return LogLikelihood(self._likelihood.total)

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
            Observable to predictions, ``(N,)`` or ``(B, N)``, SI. Observables of the data include the model's discrepancy
            factor and covariates that act on them. Effects of groups are those of the median group, 0.
        """
        batch, single = self._batch(theta)
        predicted = quantities.predicted(self, batch, conditions)
        return {name: unbatch(value, single) for name, value in predicted.items()}

    def predict_data(self, theta: ArrayLike) -> FloatArray:
        """Predictions of all data, one observable after the other, shape ``(M,)`` or ``(B, M)``, SI."""
        predicted = self.predict(theta)
        return np.concatenate([predicted[name] for name in self.observables], axis=-1)

    def derived(self, theta: ArrayLike) -> dict[str, FloatArray]:
        """Quantities between inputs and observables at the problem's rows, and the products named in the model file.

        Returns
        -------
        dict
            Name to values, SI: ``(B, 1)`` if they are the same for all rows (of those the product is defined for), else
            ``(B, N)``, or ``(B, n)`` for a product that is defined for n of the rows.
        """
        batch, _ = self._batch(theta)
        return quantities.derived(self, batch)

    def explain(self, theta: ArrayLike, row: int | None = None) -> list[str]:
        """Sentences on why predictions at ``theta`` are missing or doubtful, at all rows or one; empty if there is nothing."""
        batch, _ = self._batch(theta)
        if self.forward.explain is None:
            return []
        inputs, tables = self.inputs(batch), self.tables
        if row is not None:
            inputs = {n: v[:, [row]] if v.shape[1] > 1 else v for n, v in inputs.items()}
            tables = tables.at_row(row)
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            return self.forward.explain(inputs, tables)

    def flags(self, theta: ArrayLike) -> dict[str, NDArray[np.bool_]]:
        """Where predictions lie at the edge of what the theory is good for, by flag, each ``(B, N)``."""
        batch, _ = self._batch(theta)
        return quantities.flags(self, batch)

    def simulate(
        self, theta: ArrayLike, rng: np.random.Generator, effects: FloatArray | None = None
    ) -> FloatArray:
        """Draw data of the size of the observed ones for each parameter vector, noise included; ``(M,)`` or ``(B, M)``.

        Group effects are drawn anew, for other people and liquids, unless ``effects`` ``(B, G)`` are given.
        """
        batch, single = self._batch(theta)
        return unbatch(self._likelihood.draw(batch, rng, effects), single)

    def draw_effects(self, theta: ArrayLike, rng: np.random.Generator) -> FloatArray:
        """Draw the effects of all levels of all groups given parameters and data, shape ``(B, G)``.

        Raises :class:`InputError` if the model has no groups.
        """
        batch, _ = self._batch(theta)
        return self._likelihood.draw_effects(batch, rng)

    @property
    def profiles(self) -> tuple[Profile, ...]:
        """Curves that the forward model offers for the inputs of this problem."""
        columns = set(self.conditions.values)
        given = {entry.name for entry in self._plan} | columns
        return tuple(
            profile
            for profile in self.model.profiles
            if given.issuperset(profile.needs) and columns.isdisjoint(profile.uniform)
        )

    def profile(self, profile: Profile, theta: FloatArray, row: int = 0) -> tuple[FloatArray, FloatArray]:
        """A curve of the forward model at the conditions of one row: abscissa ``(K,)`` and ordinate ``(B, K)``."""
        return quantities.profile(self, profile, theta, row)

    def inputs(self, theta: FloatArray, conditions: Conditions | None = None) -> dict[str, FloatArray]:
        """All inputs of the forward model and the noise by name, each ``(B or 1, N or 1)``."""
        rows = conditions or self.conditions
        plan = self._plan if conditions is None else plan_inputs(self.fixed, self.free, rows)
        values = {entry.name: entry.values(theta) for entry in plan if entry.name not in rows.values}
        values |= {name: column[np.newaxis, :] for name, column in rows.values.items()}
        return apply_covariates(self.spec.covariates, rows.covariates, values, self.spec.observables)

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
        """Width of the noise of each datum at one parameter vector ``(D,)``, shape ``(M,)``.

        In the unit of the observable; for logarithmic noise families the width of its ln. Group effects are not in it.
        """
        batch, _ = self._batch(theta)
        return self._likelihood.width(batch)[0]

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
        """
        return self._likelihood.independent(theta, changes)

    @property
    def noise_is_logarithmic(self) -> NDArray[np.bool_]:
        """Whether it is ln of a datum that scatters, for each datum, shape ``(M,)``."""
        return np.repeat([o.noise.logarithmic for o in self.observations], self.conditions.n_rows)

    @cached_property
    def alike(self) -> DistinctRows | None:
        """Rows of the data that the forward model need not tell apart; None if all differ."""
        return distinct_rows(self._plan, self.conditions, self.tables, self.input_spread)

    @property
    def costly(self) -> bool:
        """Whether a likelihood takes so long that fewer walkers are better: a costly forward model, or very many rows."""
        return self.forward.costly or self.conditions.n_rows >= MANY_ROWS

    def evaluate(
        self,
        inputs: Mapping[str, FloatArray],
        tables: Tables | None = None,
        alike: DistinctRows | None = None,
    ) -> dict[str, FloatArray]:
        """The forward model with discrepancy factors and covariates on observables; rows that are ``alike`` once."""
        tables = self.tables if tables is None else tables
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            if alike is None:
                predicted = dict(self.model.evaluate(inputs, tables))
            else:
                distinct = self.model.evaluate(alike.of_inputs(inputs), alike.of_tables(tables))
                predicted = {name: alike.at_rows(values) for name, values in distinct.items()}
        for name in self.spec.observables:
            for key in ("discrepancy_factor", f"discrepancy_factor[{name}]", factor_key(name)):
                if key in inputs:
                    predicted[name] = predicted[name] * inputs[key]
        return predicted

    # -- inner parts -------------------------------------------------------------------------------------------------

    @cached_property
    def _plan(self) -> tuple[InputPlan, ...]:
        return plan_inputs(self.fixed, self.free, self.conditions)

    @cached_property
    def _likelihood(self) -> Likelihood:
        return Likelihood(self)

    def _batch(self, theta: ArrayLike) -> tuple[FloatArray, bool]:
        return as_batch(theta, self.names)
