"""Forward model ``indentation`` of tissue that relaxes: force on the way in and loss of a cycle, at a constant rate."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from skinbayes.arrays import FloatArray
from skinbayes.contact.indentation_loss import (
    loss_fraction_of_constant_loss,
    loss_fraction_of_relaxation,
    stiffening_of_constant_loss,
    stiffening_of_relaxation,
)
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.stribeck_viscoelastic import REFERENCE_ANGULAR_FREQUENCY
from skinbayes.lubrication.viscoelastic_memory import STANDARD_LINEAR_SOLID


def indentation_of_relaxing(elastic: ForwardModel, substrate: str) -> ForwardModel:
    """The forward model of elastic skin for another substrate: the ball is pressed in at `indentation_rate`, and drawn back."""
    relaxing = substrate == STANDARD_LINEAR_SOLID
    material = ("relaxation_strength_bulk", "relaxation_time_bulk") if relaxing else ("loss_tangent_bulk",)
    return replace(
        elastic,
        summary="force of a ball pressed into skin that relaxes, and the work that a cycle loses",
        observables=("indentation_force", "indentation_loss_fraction"),
        required=("indentation_depth", "indentation_rate", "sphere_radius", "young_modulus_bulk", *material),
        optional={"poisson_ratio_bulk": 0.5}
        | ({} if relaxing else {"reference_angular_frequency": REFERENCE_ANGULAR_FREQUENCY}),
        goes_with={},
        evaluate=partial(_relaxing if relaxing else _of_constant_loss, elastic=elastic),
    )


def _relaxing(inputs: Inputs, tables: Tables, elastic: ForwardModel) -> dict[str, FloatArray]:
    strength = inputs["relaxation_strength_bulk"]
    turns = inputs["indentation_depth"] / inputs["indentation_rate"] / inputs["relaxation_time_bulk"]  # t/τ
    force = elastic.evaluate(inputs, tables)["indentation_force"]
    return {
        "indentation_force": force * stiffening_of_relaxation(strength, turns),
        "indentation_loss_fraction": loss_fraction_of_relaxation(strength, 1 / turns),
    }


def _of_constant_loss(inputs: Inputs, tables: Tables, elastic: ForwardModel) -> dict[str, FloatArray]:
    tangent = inputs["loss_tangent_bulk"]
    turns = inputs["reference_angular_frequency"] * inputs["indentation_depth"] / inputs["indentation_rate"]
    force = elastic.evaluate(inputs, tables)["indentation_force"]
    return {
        "indentation_force": force * stiffening_of_constant_loss(tangent, turns),
        "indentation_loss_fraction": loss_fraction_of_constant_loss(tangent) + 0.0 * force,
    }
