"""Forward model ``indentation`` of tissue that relaxes: force on the way in and loss of a cycle, at a constant rate."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from scipy.special import dawsn, gamma

from skinbayes.arrays import FloatArray
from skinbayes.contact import loss_fraction_of_constant_loss, loss_fraction_of_relaxation
from skinbayes.forward.base import ForwardModel, Inputs, Tables
from skinbayes.forward.stribeck_viscoelastic import REFERENCE_ANGULAR_FREQUENCY
from skinbayes.lubrication.viscoelastic_memory import STANDARD_LINEAR_SOLID

_SHORT = 1e-4  # t/τ below which nothing has relaxed


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
    strength, time = inputs["relaxation_strength_bulk"], inputs["relaxation_time_bulk"]
    turns = inputs["indentation_depth"] / inputs["indentation_rate"] / time  # t/τ
    root = np.sqrt(turns)
    # ∫E(t − s) d(s^(3/2))/(E∞ t^(3/2)) − 1 over Δ; by the series of Dawson's integral where it has no digits
    remaining = np.where(turns < _SHORT, 1 - 2 / 5 * turns, 1.5 * (root - dawsn(root)) / turns**1.5)
    force = elastic.evaluate(inputs, tables)["indentation_force"]
    return {
        "indentation_force": force * (1 + strength * remaining),
        "indentation_loss_fraction": loss_fraction_of_relaxation(strength, 1 / turns),
    }


def _of_constant_loss(inputs: Inputs, tables: Tables, elastic: ForwardModel) -> dict[str, FloatArray]:
    power = 2 / np.pi * np.arctan(inputs["loss_tangent_bulk"])
    turns = inputs["reference_angular_frequency"] * inputs["indentation_depth"] / inputs["indentation_rate"]
    stiffer = turns**-power * 1.5 * gamma(1.5) / gamma(2.5 - power)
    force = elastic.evaluate(inputs, tables)["indentation_force"]
    loss = loss_fraction_of_constant_loss(inputs["loss_tangent_bulk"])
    return {"indentation_force": force * stiffer, "indentation_loss_fraction": loss + 0.0 * force}
