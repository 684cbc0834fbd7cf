"""What the forward model says at the rows of a problem, for batches ``(B, D)`` of any length."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.forward import Profile
from skinbayes.problem.alike import distinct_rows
from skinbayes.problem.failures import FAILED, explained, without_underflow
from skinbayes.problem.inputs import Conditions, plan_inputs
from skinbayes.problem.pieces import named_in_pieces
from skinbayes.problem.rheology import flow_curves_of

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem


def predicted(problem: Problem, batch: FloatArray, conditions: Conditions | None) -> dict[str, FloatArray]:
    """Predictions at the rows of the data or at other ones, each ``(B, N)``; rows of equal inputs are evaluated once."""
    rows, tables, alike = conditions or problem.conditions, problem.tables, problem.alike
    if conditions is not None:
        curves = flow_curves_of(problem.flow_curves, problem.spec.rheology_by, rows, problem.spec.path)
        tables = replace(tables, flow_curves=curves)
        alike = distinct_rows(plan_inputs(problem.fixed, problem.free, rows), rows, tables)

    def piece(theta: FloatArray) -> dict[str, FloatArray]:
        found = problem.evaluate(problem.inputs(theta, conditions), tables, alike)
        shape = (len(theta), rows.n_rows)
        return {name: without_underflow(np.broadcast_to(value, shape)) for name, value in found.items()}

    return named_in_pieces(piece, batch, rows.n_rows)


def derived(problem: Problem, batch: FloatArray) -> dict[str, FloatArray]:
    """Derived quantities, as :meth:`skinbayes.problem.Problem.derived` says."""

    def piece(theta: FloatArray) -> dict[str, FloatArray]:
        inputs = problem.inputs(theta)
        with explained(problem.spec.path, FAILED), np.errstate(all="ignore"):
            quantities = dict(problem.model.derived(inputs, problem.tables))
            known = inputs | quantities
            for name, block in problem.spec.derived.items():
                product = np.ones((1, 1))
                for factor, power in block.product.items():
                    product = product * np.asarray(known[factor]) ** power
                chosen = problem.conditions.matching(block.rows)
                if not chosen.any():  # data of the user's own without such rows
                    continue
                quantities[name] = product[:, chosen] if product.shape[-1] > 1 else product
        return {name: without_underflow(np.atleast_2d(value)) for name, value in quantities.items()}

    found = named_in_pieces(piece, batch, problem.conditions.n_rows)
    for name in problem.spec.derived:
        # the same in all rows it is defined for, such as those of one state of skin
        if name in found and (found[name] == found[name][:, :1]).all():
            found[name] = np.ascontiguousarray(found[name][:, :1])
    return found


def flags(problem: Problem, batch: FloatArray) -> dict[str, NDArray[np.bool_]]:
    """Where predictions lie at the edge of the theory, by flag, each ``(B, N)``."""
    raised = problem.model.flags
    if raised is None:
        return {}

    def piece(theta: FloatArray) -> dict[str, NDArray[np.bool_]]:
        with explained(problem.spec.path, FAILED), np.errstate(all="ignore"):
            found = raised(problem.inputs(theta), problem.tables)
        shape = (len(theta), problem.conditions.n_rows)
        return {name: np.array(np.broadcast_to(value, shape)) for name, value in found.items()}

    return named_in_pieces(piece, batch, problem.conditions.n_rows)


def profile(problem: Problem, curve: Profile, theta: FloatArray, row: int) -> tuple[FloatArray, FloatArray]:
    """A curve of the forward model at the conditions of one row: abscissa ``(K,)`` and ordinate ``(B, K)``."""
    inputs = {
        name: np.ascontiguousarray(
            np.broadcast_to(value, (value.shape[0], problem.conditions.n_rows))[:, row]
        )
        for name, value in problem.inputs(theta).items()
    }
    tables = problem.tables.at_row(row)
    with explained(problem.spec.path, FAILED), np.errstate(all="ignore"):
        grid = curve.grid(inputs, tables)
        ordinate = curve.evaluate(inputs, tables, grid)
    return grid, np.array(np.broadcast_to(ordinate, (len(theta), len(grid))))
