"""Liquids that thin by a law in place of a measured flow curve: oils of known viscosity at low shear rates (Appendix C)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from skinbayes.emulation import Progress
from skinbayes.errors import InputError
from skinbayes.forward.base import ForwardModel, Inputs, Ranges, Tables
from skinbayes.lubrication import FlowCurve, thinned_viscosity

SHEAR_THINNING = ("none", "silicone-oil")
"""Laws by name: none, and that of the paper for silicone oils of any viscosity."""

_SPEED = ("viscosity", "sliding_speed")
_RATES = np.geomspace(1e-8, 1e12, 241)  # 1/s


def thinning(model: ForwardModel) -> ForwardModel:
    """A forward model that takes flow curves, for liquids that thin as silicone oils of the ``viscosity`` of each row."""
    required: list[Any] = []
    for entry in model.required:
        required += _SPEED if not isinstance(entry, str) and _SPEED in entry else [entry]
    return replace(
        _with_curves(model),
        required=tuple(required),
        prepare=_Prepared(model.prepare),
        uses_flow_curves=False,
    )


def _with_curves(model: ForwardModel) -> ForwardModel:
    return replace(
        model,
        evaluate=_OfLiquids(model.evaluate),
        flags=model.flags and _OfLiquids(model.flags),
        explain=model.explain and _OfLiquids(model.explain),
        abscissa=model.abscissa and _OfLiquids(model.abscissa),
    )


@dataclass(frozen=True)
class _OfLiquids:
    """A function of inputs and tables that finds the flow curves of the rows among its tables; picklable."""

    function: Callable[..., Any]

    def __call__(self, inputs: Inputs, tables: Tables) -> Any:
        rows = max(np.shape(value)[-1] for value in inputs.values())
        viscosity = np.asarray(inputs["viscosity"])
        if (viscosity != viscosity[:1]).any():
            raise InputError(
                "viscosity: an oil that thins has its own law for each viscosity; expected one for each row, not a free one"
            )
        curves = tuple(_curve(float(value)) for value in np.broadcast_to(viscosity[0], (rows,)))
        return self.function(inputs, replace(tables, flow_curves=curves))


@dataclass(frozen=True)
class _Prepared:
    """Preparation of a model whose liquids thin."""

    prepare: Callable[..., ForwardModel] | None

    def __call__(
        self, model: ForwardModel, ranges: Ranges, tables: Tables, progress: Progress | None, cores: int
    ) -> ForwardModel:
        if self.prepare is None:
            return model
        found = self.prepare(model, ranges, tables, progress, cores)
        return found if found.evaluate is model.evaluate else _with_curves(found)


@lru_cache(maxsize=1024)
def _curve(viscosity: float) -> FlowCurve:
    """The law as a flow curve, over all shear rates that a film can have; the same object for the same viscosity, Pa s."""
    return FlowCurve(_RATES, thinned_viscosity(viscosity, _RATES))
