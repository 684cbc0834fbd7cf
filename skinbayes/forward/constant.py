"""Forward model ``constant``: friction that depends on nothing, the null model that every theory has to beat."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.forward.base import ForwardModel, Inputs, Tables


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    return {"friction_coefficient": np.asarray(inputs["typical_friction_coefficient"], dtype=float)}


MODEL = ForwardModel(
    name="constant",
    summary="one friction coefficient for all rows; with effects of groups, the null model",
    observables=("friction_coefficient",),
    required=("typical_friction_coefficient",),
    evaluate=_evaluate,
    uses_surface=False,
)
