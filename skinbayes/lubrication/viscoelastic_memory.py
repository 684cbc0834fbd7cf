"""What tissue remembers of a contact that passes, in the units of the contact, and which moduli it has there.

A kernel in these units depends on few numbers. For a standard linear solid they are Δ = E_g/E∞ − 1 and the Deborah number vτ/b,
for a constant loss angle it is the power n of ``E ∝ (iω)^n`` alone. Tables take ``strength``, ln(1 + Δ) or n, which is 0 for
elastic tissue, and ``place``, ln of vτ√(1 + Δ)/b, which is 0 where tan δ is largest; it is 0 of a constant loss angle.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.viscoelastic_line_contact import AnyPassage, Passage, PowerLawPassage
from skinbayes.errors import InputError
from skinbayes.lubrication.film_axes import unit_contact

ELASTIC, STANDARD_LINEAR_SOLID, CONSTANT_LOSS = SUBSTRATES = (
    "elastic", "standard_linear_solid", "constant_loss",
)  # fmt: skip
"""Materials of the skin: without loss, with one relaxation time, with a loss angle that is the same at all frequencies."""

RELAXATION_PARAMETERS = {
    ELASTIC: (),
    STANDARD_LINEAR_SOLID: (
        "relaxation_strength_bulk", "relaxation_time_bulk", "relaxation_strength_layer", "relaxation_time_layer",
    ),
    CONSTANT_LOSS: ("loss_tangent_bulk", "loss_tangent_layer", "reference_angular_frequency"),
}  # fmt: skip
"""What a substrate takes beside its moduli."""

_STEPS = 7  # of Newton's iteration for ln |E|, which closes quadratically from a slope of at most 1/3


class TissueInContact(NamedTuple):
    """Moduli and memory of skin under a ball that slides; all of the broadcast shape of speed, ball and skin.

    Attributes
    ----------
    log_modulus_layer, log_modulus_bulk : ln of |E0| and |E1| at the frequency v/b, moduli in Pa
    log_frequency : ln of v/b, v/b in 1/s
    strength : ln(1 + Δ) or n of the tissue, dimensionless, 0 if it is elastic
    place : ln(vτ√(1 + Δ)/b), dimensionless; 0 of a constant loss angle
    loss : sin δ of the tissue at v/b, dimensionless
    """

    log_modulus_layer: FloatArray
    log_modulus_bulk: FloatArray
    log_frequency: FloatArray
    strength: FloatArray
    place: FloatArray
    loss: FloatArray


def tissue_in_contact(
    substrate: str,
    sliding_speed: ArrayLike,
    *,
    parameters: Mapping[str, ArrayLike],
    relaxation: Mapping[str, ArrayLike],
    poisson_ratio_bulk: float,
) -> TissueInContact:
    """Skin at the frequency v/b of the contact that it makes: modulus and half-width b depend on each other.

    Parameters
    ----------
    substrate : "standard_linear_solid" or "constant_loss"
    sliding_speed : v, m/s, broadcasts
    parameters : ``young_modulus_layer``, ``young_modulus_bulk`` (Pa), ``normal_force`` (N), ``sphere_radius`` (m); the moduli are
        relaxed ones, or |E| at the reference frequency of a constant loss angle
    relaxation : the `RELAXATION_PARAMETERS` of the substrate, SI
    poisson_ratio_bulk : ν1, dimensionless

    Returns
    -------
    tissue : `TissueInContact`; nan where an argument is impossible
    """
    half_width, _ = unit_contact(poisson_ratio_bulk)
    with np.errstate(all="ignore"):
        speed, layer, bulk, force, radius = (
            np.log(np.asarray(x, dtype=np.float64))
            for x in (
                sliding_speed,
                *(
                    parameters[name]
                    for name in ("young_modulus_layer", "young_modulus_bulk", "normal_force", "sphere_radius")
                ),
            )
        )
        given = {
            name: np.asarray(relaxation[name], dtype=np.float64) for name in RELAXATION_PARAMETERS[substrate]
        }
        # of the contact on tissue of the given modulus; b goes as its power −1/3
        frequency = speed - (half_width + (force + radius - bulk) / 3)
        if substrate == STANDARD_LINEAR_SOLID:
            fast, time = (
                np.log(x) for x in (1 + given["relaxation_strength_bulk"], given["relaxation_time_bulk"])
            )
            fast = np.where(fast >= 0, fast, np.nan)
            growth = np.zeros(np.broadcast_shapes(frequency.shape, fast.shape, time.shape))
            for _ in range(_STEPS):
                stiffer, slope = _stiffer(frequency + time + growth / 3, fast)
                growth = growth - (growth - stiffer) / (1 - slope / 3)
            frequency = frequency + growth / 3
            turn = frequency + time
            loss = np.expm1(fast) / (np.exp(turn) + np.exp(-turn)) * np.exp(-growth)
            strength, place = fast, turn + fast / 2
            fast, time = (
                np.log(x) for x in (1 + given["relaxation_strength_layer"], given["relaxation_time_layer"])
            )
            layer = layer + _stiffer(frequency + time, np.where(fast >= 0, fast, np.nan))[0]
        elif substrate == CONSTANT_LOSS:
            power, of_layer = (
                np.where((x >= 0) & (x < 1), 2 / np.pi * np.arctan(x), np.nan)
                for x in (given["loss_tangent_bulk"], given["loss_tangent_layer"])
            )
            reference = np.log(given["reference_angular_frequency"])
            growth = power / (1 - power / 3) * (frequency - reference)
            frequency = frequency + growth / 3
            strength, place, loss = power, np.zeros(np.shape(power)), np.sin(np.pi / 2 * power)
            layer = layer + of_layer * (frequency - reference)
        else:
            raise InputError(
                f"substrate is {substrate!r:.60}, but must be {' or '.join(map(repr, SUBSTRATES[1:]))}."
            )
        return TissueInContact(layer, bulk + growth, frequency, strength, place, loss)


def _stiffer(log_turn: FloatArray, log_fast: FloatArray) -> tuple[FloatArray, FloatArray]:
    """ln |E|/E∞ of a standard linear solid at ln ωτ and its derivative, for ln(1 + Δ)."""
    fast, slow = 2 * (log_turn + log_fast), 2 * log_turn
    # ln |E|²/E∞² = ln(1 + (1+Δ)²(ωτ)²) − ln(1 + (ωτ)²)
    rise = (np.logaddexp(0.0, fast) - np.logaddexp(0.0, slow)) / 2
    return rise, 1 / (1 + np.exp(-fast)) - 1 / (1 + np.exp(-slow))


def passage_in_contact(
    substrate: str, strength: float, place: float, *, modulus: float, half_width: float
) -> tuple[AnyPassage, float]:
    """Kernel of tissue with |E*| (Pa) at v/b under a contact of half-width b (m), and its sin δ there."""
    if substrate == CONSTANT_LOSS:
        return PowerLawPassage(modulus, half_width, strength), float(np.sin(np.pi / 2 * strength))
    fast, turn = float(np.exp(strength)), float(np.exp(place - strength / 2))
    size = float(np.hypot(1.0, fast * turn) / np.hypot(1.0, turn))
    loss = (fast - 1) / (turn + 1 / turn) / size
    compliance, length = np.array([size * (1 - 1 / fast)]), np.array([turn * fast])
    return Passage(modulus, half_width, size / fast, compliance, length), loss
