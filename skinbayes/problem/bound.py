"""A forward model bound to parameters and rows: predictions, and what stands behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import FlowCurve, ForwardModel, Profile, Tables
from skinbayes.problem.batches import as_batch, unbatch
from skinbayes.problem.covariates import apply_covariates, factor_key
from skinbayes.problem.deduplicated_rows import DistinctRows, distinct_rows
from skinbayes.problem.failures import FAILED, explained, without_underflow
from skinbayes.problem.inputs import Conditions, InputPlan, plan_inputs
from skinbayes.problem.observations import Observation
from skinbayes.problem.pieces import named_in_pieces
from skinbayes.problem.ranges import input_ranges
from skinbayes.problem.rheology import flow_curves_of
from skinbayes.statistics.groups import CrossedGroups


@dataclass(frozen=True)
class BoundModel:
    """A forward model bound to its parameters and to the rows at which it is evaluated; frozen.

    ``theta`` below is one parameter vector ``(D,)`` in SI units in the order of :attr:`names`, or a batch ``(B, D)``; a batch
    is one vectorised evaluation and its rows agree to the last bit with single evaluations.

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
    tied : parameters that are multiples of free or fixed ones
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
    tied: tuple[ParameterSpec, ...] = ()

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.spec.name

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
    def observables(self) -> tuple[str, ...]:
        """The observables that the data hold.

        Raises :class:`InputError` if the model has no data.
        """
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
                ranges = input_ranges([p.prior for p in self.free if p.prior], self.inputs)
                prepared = prepared.prepare(prepared, ranges, self.tables, progress, cores)
        self.__dict__["model"] = prepared
        return prepared

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
        rows, tables, deduplicated = conditions or self.conditions, self.tables, self.deduplicated
        if conditions is not None:
            curves = flow_curves_of(self.flow_curves, self.spec.rheology_by, rows, self.spec.path)
            tables = replace(tables, flow_curves=curves)
            deduplicated = distinct_rows(plan_inputs(self.fixed, self.free, rows, self.tied), rows, tables)

        def piece(part: FloatArray) -> dict[str, FloatArray]:
            found = self.evaluate(self.inputs(part, conditions), tables, deduplicated)
            shape = (len(part), rows.n_rows)
            return {name: without_underflow(np.broadcast_to(value, shape)) for name, value in found.items()}

        predicted = named_in_pieces(piece, batch, rows.n_rows)
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
        found = named_in_pieces(self._derived, batch, self.conditions.n_rows)
        for name in self.spec.derived:
            # the same in all rows it is defined for, such as those of one state of skin
            if name in found and (found[name] == found[name][:, :1]).all():
                found[name] = np.ascontiguousarray(found[name][:, :1])
        return found

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
        raised = self.model.flags
        if raised is None:
            return {}

        def piece(part: FloatArray) -> dict[str, NDArray[np.bool_]]:
            with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
                found = raised(self.inputs(part), self.tables)
            shape = (len(part), self.conditions.n_rows)
            return {name: np.array(np.broadcast_to(value, shape)) for name, value in found.items()}

        return named_in_pieces(piece, batch, self.conditions.n_rows)

    @property
    def profiles(self) -> tuple[Profile, ...]:
        """Curves that the forward model offers for the inputs of this problem."""
        columns = set(self.conditions.values)
        given = {entry.name for entry in self.plan} | columns
        return tuple(
            profile
            for profile in self.model.profiles
            if given.issuperset(profile.needs) and columns.isdisjoint(profile.uniform)
        )

    def profile(self, profile: Profile, theta: FloatArray, row: int = 0) -> tuple[FloatArray, FloatArray]:
        """A curve of the forward model at the conditions of one row: abscissa ``(K,)`` and ordinate ``(B, K)``."""
        shape = self.conditions.n_rows
        inputs = {
            name: np.ascontiguousarray(np.broadcast_to(value, (value.shape[0], shape))[:, row])
            for name, value in self.inputs(theta).items()
        }
        tables = self.tables.at_row(row)
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            grid = profile.grid(inputs, tables)
            ordinate = profile.evaluate(inputs, tables, grid)
        return grid, np.array(np.broadcast_to(ordinate, (len(theta), len(grid))))

    def inputs(self, theta: FloatArray, conditions: Conditions | None = None) -> dict[str, FloatArray]:
        """All inputs of the forward model and the noise by name, each ``(B or 1, N or 1)``."""
        rows = conditions or self.conditions
        plan = self.plan if conditions is None else plan_inputs(self.fixed, self.free, rows, self.tied)
        same, varying = self._parted if conditions is None else _parted(plan, rows)
        values = same | {entry.name: entry.values(theta) for entry in varying}
        return apply_covariates(self.spec.covariates, rows.covariates, values, self.spec.observables)

    @cached_property
    def deduplicated(self) -> DistinctRows | None:
        """Rows of the data that the forward model need not tell apart; None if all differ."""
        return distinct_rows(self.plan, self.conditions, self.tables, self.input_spread)

    def evaluate(
        self,
        inputs: Mapping[str, FloatArray],
        tables: Tables | None = None,
        deduplicated: DistinctRows | None = None,
    ) -> dict[str, FloatArray]:
        """The forward model with discrepancy factors and covariates on observables; shapes as the forward model gives them.

        Rows that are ``alike`` are evaluated once.
        """
        tables = self.tables if tables is None else tables
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            if deduplicated is None:
                predicted = dict(self.model.evaluate(inputs, tables))
            else:
                distinct = self.model.evaluate(deduplicated.of_inputs(inputs), deduplicated.of_tables(tables))
                predicted = {name: deduplicated.at_rows(values) for name, values in distinct.items()}
        for name in self.spec.observables:
            for key in ("discrepancy_factor", f"discrepancy_factor[{name}]", factor_key(name)):
                if key in inputs:
                    predicted[name] = predicted[name] * inputs[key]
        return predicted

    # -- inner parts -------------------------------------------------------------------------------------------------

    @cached_property
    def plan(self) -> tuple[InputPlan, ...]:
        """Where each input comes from."""
        return plan_inputs(self.fixed, self.free, self.conditions, self.tied)

    @cached_property
    def _parted(self) -> tuple[dict[str, FloatArray], list[InputPlan]]:
        return _parted(self.plan, self.conditions)

    def _batch(self, theta: ArrayLike) -> tuple[FloatArray, bool]:
        return as_batch(theta, self.names)

    def _derived(self, theta: FloatArray) -> dict[str, FloatArray]:
        inputs = self.inputs(theta)
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            quantities = dict(self.model.derived(inputs, self.tables))
            known = inputs | quantities
            for name, block in self.spec.derived.items():
                product = np.ones((1, 1))
                for factor, power in block.product.items():
                    product = product * np.asarray(known[factor]) ** power
                chosen = self.conditions.matching(block.rows)
                if not chosen.any():  # data of the user's own without such rows
                    continue
                quantities[name] = product[:, chosen] if product.shape[-1] > 1 else product
        return {name: without_underflow(np.atleast_2d(value)) for name, value in quantities.items()}


def _parted(plan: tuple[InputPlan, ...], rows: Conditions) -> tuple[dict[str, FloatArray], list[InputPlan]]:
    """Inputs that are the same for all parameter vectors, and where the others come from."""
    wanted = [entry for entry in plan if entry.name not in rows.values]
    nothing = np.empty((1, 0))
    same = {entry.name: entry.values(nothing) for entry in wanted if not entry.varies}
    same |= {name: column[np.newaxis, :] for name, column in rows.values.items()}
    return same, [entry for entry in wanted if entry.varies]
