"""A forward model bound to parameters and rows: predictions, and what stands behind them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.population_block import POPULATION, PopulationSpec
from skinbayes.forward import FlowCurve, ForwardModel, Tables
from skinbayes.forward.base import TiedRanges
from skinbayes.problem.covariates import apply_covariates
from skinbayes.problem.deduplicated_rows import DistinctRows, distinct_rows
from skinbayes.problem.failures import explained
from skinbayes.problem.inputs import Conditions, InputPlan, plan_inputs
from skinbayes.problem.observations import Observation
from skinbayes.problem.populations import Part, Populations
from skinbayes.problem.posterior import Posterior
from skinbayes.problem.ranges import input_ranges
from skinbayes.problem.shared_scatter import SharedScatter
from skinbayes.problem.surface_prior import SurfacePrior, refuse_shapes
from skinbayes.problem.tied import whole_ties
from skinbayes.statistics.correlated_scatter import CorrelatedScatter
from skinbayes.statistics.groups import CrossedGroups


@dataclass(frozen=True)
class BoundModel(Posterior):
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
    surface_prior : what draws of a surface say about its roughness, or None
    populations : parameters that differ from person to person as a population does, or None
    correlated : group effects together with the discrepancy and correlated noise, or None if there is neither of these two

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.load_problem("forearm-glass")
    >>> middle = problem.prior_medians()
    >>> problem.observables, problem.conditions.n_rows
    (('friction_coefficient',), 2)
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
    correlated: SharedScatter | None = None
    surface_prior: SurfacePrior | None = None
    populations: Populations | None = None

    @property
    def name(self) -> str:
        """Name of the model."""
        return self.spec.name

    @property
    def shared(self) -> CrossedGroups | CorrelatedScatter | None:
        """What rows share beside the prediction, integrated out; None if they are independent."""
        return self.groups if self.correlated is None else self.correlated.scatter

    @property
    def shared_parameters(self) -> tuple[str, ...]:
        """Names among the inputs of the scales of what rows share, in their order."""
        if self.correlated is not None:
            return self.correlated.parameters
        return () if self.groups is None else tuple(f"group_scale[{c}]" for c in self.groups.columns)

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
        """A short name for each datum: its row, its observable, or both.

        Returns
        -------
        list of str
            One for each datum.

        Examples
        --------
        >>> problem.datum_labels()
        ['dry', 'wet']
        """
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

        Parameters
        ----------
        progress : called with the number of steps done and their total
        cores : processes that share the work

        Returns
        -------
        ForwardModel
            Prepared; as it is without data or free parameters, or if there is nothing to prepare.

        Raises
        ------
        InputError
            No table can be made for the priors.

        Examples
        --------
        >>> problem.prepare().name
        'friction'
        """
        if "model" in self.__dict__:
            return self.model
        if self.observations:
            return self.prepared_for_many(progress, cores)
        self.__dict__["model"] = self.forward
        return self.forward

    def ranges(self) -> TiedRanges:
        """How far each input reaches over the rows and nearly all of the priors, and which inputs vary together.

        Returns
        -------
        TiedRanges
            Name to smallest and largest value, SI.

        Examples
        --------
        >>> low, high = problem.ranges()["rms_height"]
        >>> low < 22.4e-6 < high
        True
        """
        priors = [p.prior for p in self.free if p.prior]
        return input_ranges(priors, self.inputs, multiples=whole_ties(self.tied))

    def prepared_for_many(
        self, progress: Progress | None = None, cores: int = 1, ranges: TiedRanges | None = None
    ) -> ForwardModel:
        """:meth:`prepare` also where there are no observations, but many parameter vectors to evaluate.

        Parameters
        ----------
        progress, cores : as :meth:`prepare` takes them
        ranges : those to prepare for, which hold :meth:`ranges`, if it is to serve other problems too

        Returns
        -------
        ForwardModel
            Prepared; as it is without free parameters, or if there is nothing to prepare.

        Raises
        ------
        InputError
            No table can be made for the priors, or none for spectra of the many shapes that draws of a surface have.

        Examples
        --------
        >>> problem.prepared_for_many() is problem.model
        True
        """
        prepared = self.forward
        if prepared.prepare is not None and self.free:
            with explained(self.spec.path, "no table can be made for the priors"), np.errstate(all="ignore"):
                prepared = prepared.prepare(prepared, ranges or self.ranges(), self.tables, progress, cores)
            if (
                self.surface_prior is not None
                and self.forward.expensive
                and prepared.evaluate is self.forward.evaluate
            ):
                refuse_shapes(self.surface_prior, self.forward.name, str(self.spec.path))
        self.__dict__["model"] = prepared
        return prepared

    def inputs(self, theta: FloatArray, conditions: Conditions | None = None) -> dict[str, FloatArray]:
        """All inputs of the forward model and the noise by name.

        Parameters
        ----------
        theta : ``(B, D)``, SI
        conditions : rows; the data's own if omitted

        Returns
        -------
        dict
            Input to values, ``(B or 1, N or 1)``, SI.

        Examples
        --------
        >>> problem.inputs(middle[np.newaxis])["normal_force"].shape
        (1, 2)
        """
        rows = conditions or self.conditions
        plan = self.plan if conditions is None else self.planned(rows)
        same, varying = self._parted if conditions is None else _parted(plan, rows)
        values = same | {entry.name: entry.values(theta) for entry in varying}
        if self.surface_prior is not None:
            values |= self.surface_prior.inputs(values)
        if self.populations is not None:
            at = self._population_rows if conditions is None else self.populations.at(rows)
            values |= self.populations.inputs(theta, values, at)
        return apply_covariates(self.spec.covariates, rows.covariates, values, self.spec.observables)

    @cached_property
    def deduplicated(self) -> DistinctRows | None:
        """Rows of the data that the forward model need not tell apart; None if all differ."""
        further: dict[str, NDArray[np.generic]] = dict(self.input_spread)
        if self.populations is not None:
            further |= self.populations.levels_of_rows(self.conditions)
        return distinct_rows(self.plan, self.conditions, self.tables, further)

    # -- inner parts -------------------------------------------------------------------------------------------------

    @cached_property
    def plan(self) -> tuple[InputPlan, ...]:
        """Where each input comes from."""
        return self.planned(self.conditions)

    def planned(self, conditions: Conditions) -> tuple[InputPlan, ...]:
        """Where each input at some rows comes from; what only populations have is no input.

        Parameters
        ----------
        conditions : the rows

        Returns
        -------
        tuple of InputPlan
            One for each input.

        Raises
        ------
        InputError
            A parameter differs by a column that the rows lack, or a row has a level without a value.

        Examples
        --------
        >>> sorted(entry.name for entry in problem.planned(problem.conditions))[:2]
        ['area_correction', 'frictional_shear_stress']
        """
        plan = plan_inputs(self.fixed, self.free, conditions, self.tied)
        added = {p.label for p in (*self.free, *self.fixed) if p.by == POPULATION}
        return tuple(entry for entry in plan if entry.name not in added)

    @cached_property
    def _population_rows(self) -> list[tuple[PopulationSpec, list[Part]]]:
        return [] if self.populations is None else self.populations.at(self.conditions)

    @cached_property
    def _parted(self) -> tuple[dict[str, FloatArray], list[InputPlan]]:
        return _parted(self.plan, self.conditions)


def _parted(plan: tuple[InputPlan, ...], rows: Conditions) -> tuple[dict[str, FloatArray], list[InputPlan]]:
    """Inputs that are the same for all parameter vectors, and where the others come from."""
    wanted = [entry for entry in plan if entry.name not in rows.values]
    nothing = np.empty((1, 0))
    same = {entry.name: entry.values(nothing) for entry in wanted if not entry.varies}
    same |= {name: column[np.newaxis, :] for name, column in rows.values.items()}
    return same, [entry for entry in wanted if entry.varies]
