"""Forward model ``indentation``: the force that presses a ball into skin, or into a homogeneous solid.

Elastic contact of Hertz, F = (4/3) E* √R δ^(3/2). On skin E* is that of the tissue below the layer, which is far thinner than
the contact is wide, as it is where friction models take the mean Hertz pressure of a ball.
"""

from __future__ import annotations

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import reduced_modulus, sphere_force
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.indentation_viscoelastic import indentation_of_relaxing
from skinbayes.lubrication.viscoelastic_memory import ELASTIC, SUBSTRATES

SHALLOW = 0.1
"""Depth over radius of the ball above which predictions are marked: Hertz's paraboloid needs 1 % more force than a ball."""


def _evaluate(inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
    solid = "" if "young_modulus" in inputs else "_bulk"
    modulus = reduced_modulus(inputs[f"young_modulus{solid}"], inputs[f"poisson_ratio{solid}"])
    force = sphere_force(inputs["indentation_depth"], inputs["sphere_radius"], reduced_modulus=modulus)
    return {"indentation_force": force}


def _flags(inputs: Inputs, tables: Tables) -> dict[str, BoolArray]:
    return {"deep_indentation": inputs["indentation_depth"] > SHALLOW * inputs["sphere_radius"]}


def indentation_model(substrate: str = ELASTIC) -> ForwardModel:
    """Return the forward model of elastic skin, or of skin that relaxes, pressed in at a constant rate."""
    elastic = ForwardModel(
        name="indentation",
        summary="force of a ball pressed into elastic skin, Hertz",
        observables=("indentation_force",),
        options={"substrate": SUBSTRATES},
        variant=indentation_model,
        chosen={"substrate": substrate},
        required=("indentation_depth", "sphere_radius", (("young_modulus_bulk",), ("young_modulus",))),
        optional={"poisson_ratio_bulk": 0.5, "poisson_ratio": 0.5},
        goes_with={"poisson_ratio_bulk": "young_modulus_bulk", "poisson_ratio": "young_modulus"},
        evaluate=_evaluate,
        flags=_flags,
        flag_meanings={
            "deep_indentation": f"the ball is pressed deeper than {SHALLOW:g} of its radius, where it is no paraboloid any more"
        },
        uses_surface=False,
    )
    return elastic if substrate == ELASTIC else indentation_of_relaxing(elastic, substrate)


MODEL = indentation_model()
