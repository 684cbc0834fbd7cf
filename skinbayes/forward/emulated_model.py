"""A forward model of anybody, interpolated over the priors instead of being evaluated at every vector."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import prod
from typing import Any

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.emulation import (
    Box,
    Interpolant,
    Places,
    Progress,
    Tasks,
    Unfinished,
    counts_along,
    kept_table,
    refined,
)  # fmt: skip
from skinbayes.errors import InputError
from skinbayes.forward.base import ForwardModel, Inputs, Multiples, Ranges, Tables, multiples_of

_TRIALS = 100
_WEIGHTS = 1 << 21  # of nodes, held at a time
_VERSION = 2  # of what is kept on disk


def emulated(
    over: Sequence[str] | None = None,
    *,
    tolerance: float = 1e-3,
    most: int = 2000,
    version: str | None = None,
) -> Callable[[ForwardModel, Ranges, Tables, Progress | None, int], ForwardModel]:
    """What a `ForwardModel` is given as ``prepare`` so that it is interpolated between evaluations at Chebyshev nodes.

    Parameters
    ----------
    over : inputs to interpolate in, parameters or columns; all that vary if None. Where another one varies, or the rows have
        flow curves, the model itself is evaluated
    tolerance : largest error at 100 random places: relative where an observable is positive, else as part of its largest value
    most : evaluations, at most, on a grid; a model that needs more is evaluated itself
    version : of the model: with one, what was computed is kept on disk until another one is stated; None keeps nothing

    Returns
    -------
    callable
        ``(model, ranges, tables, progress, cores)`` to the faster model; its ``accuracy`` says what it does

    Notes
    -----
    Inputs that are positive are interpolated in their logarithm, and so are observables that are positive. Beyond the ranges,
    which hold each prior but for 0.001 % on either side, the model itself is evaluated.

    Examples
    --------
    >>> def decay(inputs, tables):
    ...     return {"friction_coefficient": np.exp(-inputs["time"] / inputs["drying_time"])}
    >>> model = ForwardModel("decay", "friction that fades", ("friction_coefficient",), ("time", "drying_time"), decay)
    >>> ranges = {"time": (1.0, 60.0), "drying_time": (20.0, 80.0)}
    >>> fast = emulated(tolerance=1e-4)(model, ranges, Tables(), None, 1)
    >>> inputs = {"time": np.array([[10.0, 30.0]]), "drying_time": np.array([[30.0], [50.0]])}
    >>> np.allclose(fast.evaluate(inputs, Tables())["friction_coefficient"], np.exp(-np.array([10, 30]) / [[30], [50]]), 1e-4)
    True
    """
    return partial(_prepare, over=over, tolerance=tolerance, most=most, version=version)


@dataclass(frozen=True, eq=False)
class Emulated:
    """Evaluation by interpolation; picklable.

    Attributes
    ----------
    model : what is interpolated
    found : columns are the observables
    scales : of each input of the box: what it is divided by, 0 for a logarithm
    held : inputs that are not finite, at the value they have
    multiples : inputs of the model that are multiples of others, and no inputs of the box
    positive : which observables are interpolated in their logarithm
    """

    model: ForwardModel
    found: Interpolant
    scales: Mapping[str, float]
    held: Mapping[str, float]
    multiples: Multiples
    positive: Sequence[bool]

    def evaluate(self, inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
        """Observables ``(B, N)``."""
        with np.errstate(all="ignore"):
            places = _scaled(inputs, self.scales)
        inside = self.found.box.covers(places) & (tables.flow_curves is None)
        for name, value in self.held.items():
            inside = inside & (inputs.get(name, value) == value)
        for name, (of, times) in self.multiples.items():
            inside = inside & np.isclose(inputs[name], times * inputs[of], rtol=1e-9, atol=0.0)
        vectors, rows = inside.shape
        near = [np.where(np.abs(x) < 1 + 1e-6, x, 0.0) for x in self.found.box.scaled(places)]
        near = [np.broadcast_to(x, (vectors, x.shape[1])) for x in near]
        step = max(1, _WEIGHTS // (max(rows, 1) * prod(self.found.counts.values())))
        values = [
            self.found.of([x[first : first + step] for x in near], min(step, vectors - first))
            for first in range(0, vectors, step)
        ]
        found = np.broadcast_to(np.concatenate(values), (vectors, rows, len(self.positive)))
        found = np.where(self.positive, np.exp(np.where(self.positive, found, 0.0)), found)
        if (few := ~inside.all(axis=1)).any():
            some = {name: x[few] if len(x) > 1 else x for name, x in inputs.items()}
            direct = _columns(self.model.evaluate(some, tables), self.model.observables, found[few].shape[:2])
            found[few] = np.where(inside[few, :, None], found[few], direct)
        return dict(zip(self.model.observables, np.moveaxis(found, -1, 0), strict=True))


def _prepare(
    model: ForwardModel,
    ranges: Ranges,
    tables: Tables,
    progress: Progress | None,
    cores: int,
    *,
    over: Sequence[str] | None,
    tolerance: float,
    most: int,
    version: str | None,
) -> ForwardModel:
    known = {**{name: (x, x) for name, x in model.optional.items()}, **ranges}
    known = {name: ends for name, ends in known.items() if name in model.input_names()}
    if unknown := sorted(set(over or ()) - set(model.input_names())):
        raise InputError(
            f"the forward model '{model.name}' is emulated over {', '.join(unknown)}, which it does not take"
        )
    multiples = {name: tie for name, tie in multiples_of(ranges).items() if {name, tie[0]} <= set(known)}
    varying = {name for name, (low, high) in known.items() if high > low and name not in multiples}
    others = sorted(varying - set(varying if over is None else over))
    if others or tables.flow_curves is not None:
        return _directly(model, f"{' and '.join(others) or 'the liquid'} may vary, too")
    if not varying:
        return replace(model, prepare=None)
    held = {name: low for name, (low, high) in known.items() if not np.isfinite([low, high]).all()}
    finite = {name: ends for name, ends in known.items() if name not in (*held, *multiples)}
    scales = {
        name: 0.0 if low > 0 else max(abs(low), abs(high)) or 1.0 for name, (low, high) in finite.items()
    }
    box = Box.around(_scaled({name: np.array(ends) for name, ends in finite.items()}, scales))
    shared: Any = {"model": model, "tables": tables, "scales": scales, "held": held, "multiples": multiples}

    def build(unfinished: Unfinished) -> _Found | None:
        with Tasks(cores, progress=progress, kept=unfinished) as tasks:
            trial = box.random(_TRIALS, seed=0)
            exact = tasks.at("trial", partial(_solve, **shared), trial, 1)
            positive: Any = (exact > 0).all(axis=0)
            exact = np.where(positive, np.log(np.where(positive, exact, 1.0)), exact)
            solve, judge = partial(_solve, **shared, positive=positive), partial(_error, positive=positive)
            counts = counts_along(box, solve, judge, tolerance / 2, tasks, 1)
            if counts is None:
                return None
            aims: Any = {"trial": trial, "exact": exact, "worst": tolerance, "most": most}
            table = refined(box, counts, solve, judge, **aims, tasks=tasks, block=1)
        return None if table is None else _Found(table, tuple(positive.tolist()))

    key = {"version": [_VERSION, version], "model": model.name, "chosen": dict(model.chosen), "ends": known,
           "observables": model.observables, "tolerance": tolerance, "most": most, "spectrum": tables.digest(),
           **({"multiples": {**multiples}} if multiples else {})}  # fmt: skip
    kept = kept_table("emulated", None if version is None else key, _Found, build)
    if kept is None:
        return _directly(
            model, f"it does not come to {tolerance:g} on {most} nodes, or gives no number at some"
        )
    found = kept.table
    fast = Emulated(model, found, scales, held, multiples, kept.positive)
    return replace(
        model,
        evaluate=fast.evaluate,
        prepare=None,
        accuracy=f"Predictions are interpolated between {prod(found.counts.values())} evaluations of the model over "
        f"{', '.join(found.counts)}; at {_TRIALS} places that they were not made from they differ from it by "
        f"{100 * found.error:.2g} % at most. Beyond the priors but for 0.001 % the model itself is evaluated.",
    )


@dataclass(frozen=True, eq=False)
class _Found:
    table: Interpolant
    positive: tuple[bool, ...]


def _directly(model: ForwardModel, why: str) -> ForwardModel:
    return replace(model, prepare=None, accuracy=f"The model itself is evaluated, not interpolated: {why}.")


def _scaled(inputs: Inputs, scales: Mapping[str, float]) -> dict[str, FloatArray]:
    return {name: inputs[name] / scale if scale else np.log(inputs[name]) for name, scale in scales.items()}


def _solve(
    places: Places,
    model: ForwardModel,
    tables: Tables,
    scales: Mapping[str, float],
    held: Mapping[str, float],
    multiples: Multiples,
    positive: ArrayLike = False,
) -> FloatArray:
    """Observables, or their logarithms, at M places, shape ``(M, observables)``."""
    size = max(len(x) for x in places.values())
    inputs = {name: x * scales[name] if scales[name] else np.exp(x) for name, x in places.items()}
    inputs |= {name: np.array([value]) for name, value in held.items()}
    inputs |= {name: times * inputs[of] for name, (of, times) in multiples.items()}
    with np.errstate(all="ignore"):
        found = model.evaluate({name: x[:, None] for name, x in inputs.items()}, tables)
        values = _columns(found, model.observables, (size, 1))[:, 0]
        return np.where(positive, np.log(np.where(positive, values, 1.0)), values)


def _columns(found: Mapping[str, FloatArray], names: Sequence[str], shape: tuple[int, int]) -> FloatArray:
    return np.stack([np.broadcast_to(found[name], shape) for name in names], axis=-1)


def _error(found: FloatArray, exact: FloatArray, places: Places, positive: ArrayLike) -> float:
    """Largest error, relative to the value where observables are positive, else to their largest one."""
    difference = np.where(positive, np.expm1(np.where(positive, found - exact, 0.0)), found - exact)
    unit = np.where(positive, 1.0, np.maximum(np.abs(exact).max(axis=0), np.finfo(float).tiny))
    return float(np.nan_to_num(np.abs(difference) / unit, nan=np.inf).max())
