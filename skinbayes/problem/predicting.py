"""What a model bound to rows predicts, and what stands behind it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.forward import Profile, Tables
from skinbayes.problem.batches import unbatch
from skinbayes.problem.bound import BoundModel
from skinbayes.problem.covariates import factor_key
from skinbayes.problem.deduplicated_rows import DistinctRows, distinct_rows
from skinbayes.problem.failures import FAILED, explained, without_underflow
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.pieces import named_in_pieces
from skinbayes.problem.rheology import flow_curves_of


@dataclass(frozen=True)
class PredictingModel(BoundModel):
    """A bound model that is evaluated.

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> problem = sb.load_problem("forearm-glass")
    >>> middle = problem.prior_medians()
    >>> problem.observables, problem.conditions.n_rows
    (('friction_coefficient',), 2)
    """

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

        Raises
        ------
        InputError
            ``theta`` has the wrong number of parameters, or the forward model cannot be evaluated at these rows.

        Examples
        --------
        >>> problem.predict(middle)["friction_coefficient"].shape
        (2,)
        """
        batch, single = self._batch(theta)
        rows, tables, deduplicated = conditions or self.conditions, self.tables, self.deduplicated
        if conditions is not None:
            curves = flow_curves_of(self.flow_curves, self.spec.rheology_by, rows, self.spec.path)
            tables = replace(tables, flow_curves=curves)
            further = None if self.populations is None else self.populations.levels_of_rows(rows)
            deduplicated = distinct_rows(self.planned(rows), rows, tables, further)

        def piece(part: FloatArray) -> dict[str, FloatArray]:
            found = self.evaluate(self.inputs(part, conditions), tables, deduplicated)
            shape = (len(part), rows.n_rows)
            return {name: without_underflow(np.broadcast_to(value, shape)) for name, value in found.items()}

        predicted = named_in_pieces(piece, batch, rows.n_rows)
        return {name: unbatch(value, single) for name, value in predicted.items()}

    def predict_data(self, theta: ArrayLike) -> FloatArray:
        """Predictions of all data, one observable after the other.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        ndarray
            Shape ``(M,)`` or ``(B, M)``, SI.

        Raises
        ------
        InputError
            The model has no data, or ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> problem.predict_data(middle).shape
        (2,)
        """
        predicted = self.predict(theta)
        return np.concatenate([predicted[name] for name in self.observables], axis=-1)

    def derived(self, theta: ArrayLike) -> dict[str, FloatArray]:
        """Quantities between inputs and observables at the problem's rows, and the products named in the model file.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI

        Returns
        -------
        dict
            Name to values, SI: ``(B, 1)`` if they are the same for all rows (of those the product is defined for), else
            ``(B, N)``, or ``(B, n)`` for a product that is defined for n of the rows.

        Raises
        ------
        InputError
            ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> problem.derived(middle)["nominal_pressure"].shape
        (1, 2)
        """
        batch, _ = self._batch(theta)
        found = named_in_pieces(self._derived, batch, self.conditions.n_rows)
        for name in self.spec.derived:
            # the same in all rows it is defined for, such as those of one state of skin
            if name in found and (found[name] == found[name][:, :1]).all():
                found[name] = np.ascontiguousarray(found[name][:, :1])
        return found

    def explain(self, theta: ArrayLike, row: int | None = None) -> list[str]:
        """Why predictions are missing or doubtful.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`
        row : at which to look; all rows if omitted

        Returns
        -------
        list of str
            Sentences; none if there is nothing to say.

        Raises
        ------
        InputError
            ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> problem.explain(middle)
        []
        """
        batch, _ = self._batch(theta)
        # of all rows what a table knows will do; why one of them has no value is for the physics to say
        explain = (self.model if row is None else self.forward).explain
        if explain is None:
            return []
        inputs, tables = self.inputs(batch), self.tables
        if row is not None:
            inputs = {n: v[:, [row]] if v.shape[1] > 1 else v for n, v in inputs.items()}
            tables = tables.at_row(row)
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            return explain(inputs, tables)

    def flags(self, theta: ArrayLike) -> dict[str, NDArray[np.bool_]]:
        """Where predictions lie at the edge of what the theory is good for.

        Parameters
        ----------
        theta : ``(D,)`` or ``(B, D)``, SI, in the order of :attr:`names`

        Returns
        -------
        dict
            Flag to ``(B, N)``; empty if the forward model has no flags.

        Raises
        ------
        InputError
            ``theta`` has the wrong number of parameters.

        Examples
        --------
        >>> {name: values.shape for name, values in problem.flags(middle).items()}
        {'small_contact': (1, 2)}
        """
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
        """A curve of the forward model at the conditions of one row.

        Parameters
        ----------
        profile : one of :attr:`profiles`
        theta : ``(B, D)``, SI
        row : number of the row, from 0

        Returns
        -------
        tuple of ndarray
            Abscissa ``(K,)`` and ordinate ``(B, K)``, SI.

        Raises
        ------
        InputError
            The forward model cannot be evaluated there.

        Examples
        --------
        >>> curve = problem.profiles[0]
        >>> abscissa, ordinate = problem.profile(curve, middle[np.newaxis])
        >>> curve.abscissa, ordinate.shape == (1, len(abscissa))
        ('wavevector', True)
        """
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

    def evaluate(
        self,
        inputs: Mapping[str, FloatArray],
        tables: Tables | None = None,
        deduplicated: DistinctRows | None = None,
    ) -> dict[str, FloatArray]:
        """The forward model with discrepancy factors and covariates on observables.

        Parameters
        ----------
        inputs : as :meth:`inputs` gives them, SI
        tables : spectrum and flow curves; those of the problem if omitted
        deduplicated : rows that are alike and are evaluated once; none if omitted

        Returns
        -------
        dict
            Observable to values, SI; shapes as the forward model gives them.

        Raises
        ------
        InputError
            The forward model cannot be evaluated there.

        Examples
        --------
        >>> problem.evaluate(problem.inputs(middle[np.newaxis]))["friction_coefficient"].shape
        (1, 2)
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

    def _levels(self, theta: FloatArray) -> dict[str, FloatArray]:
        """Values of parameters that differ by a column, ``name[level]`` to ``(B, 1)``, where a product names them."""
        named = {factor for block in self.spec.derived.values() for factor in block.product if "[" in factor}
        free = {p.label: theta[:, [place]] for place, p in enumerate(self.free) if p.label in named}
        return free | {p.label: np.array([[p.value]]) for p in self.fixed if p.label in named}

    def _derived(self, theta: FloatArray) -> dict[str, FloatArray]:
        inputs = self.inputs(theta)
        with explained(self.spec.path, FAILED), np.errstate(all="ignore"):
            quantities = dict(self.model.derived(inputs, self.tables))
            if self.surface_prior is not None:
                quantities |= {name: inputs[name] for name in self.surface_prior.names}
            known = inputs | quantities | self._levels(theta)
            for name, block in self.spec.derived.items():
                product = np.ones((1, 1))
                for factor, power in block.product.items():
                    product = product * np.asarray(known[factor]) ** power
                chosen = self.conditions.matching(block.rows)
                if not chosen.any():  # data of the user's own without such rows
                    continue
                quantities[name] = product[:, chosen] if product.shape[-1] > 1 else product
        return {name: without_underflow(np.atleast_2d(value)) for name, value in quantities.items()}
