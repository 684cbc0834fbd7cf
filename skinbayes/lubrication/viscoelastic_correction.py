"""What memory of the tissue adds to a table of films: a smooth correction, and films at given parameters with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.emulation.chebyshev import summed
from skinbayes.lubrication.film_contraction import ContractedFilms, contract, held_coordinates
from skinbayes.lubrication.film_reference import SmoothFilms
from skinbayes.lubrication.film_table import ANCHORS, HYSTERESIS, FilmTable
from skinbayes.lubrication.smooth_memory import SMOOTH_OUTPUTS, SmoothWithMemory

NARROWEST = 1e-6
"""Width of the axis of a place that does not vary."""

_TURN = 3.0  # ln of the Deborah number over which its axis bends towards the elastic limits at both ends
_SLACK = 1e-9


@dataclass(frozen=True, eq=False, kw_only=True)
class MemoryCorrection:
    """What a `FilmTable` lacks for tissue that remembers.

    Attributes
    ----------
    substrate : "standard_linear_solid" or "constant_loss"
    largest_strength : ln(1 + Δ) or n, dimensionless; the axis begins at 0
    first_place, last_place : ends of the axis of the place, see `bent`, dimensionless
    coefficients : Chebyshev coefficients over strength, place and the axes of the table, shape ``(n1, …, 2 + 7 (S + 2))``,
        of the shift and stretch of speeds and of the B-spline coefficients of what is added to the six outputs, over the
        strength, and of those of the hysteresis
    smooth : the same of smooth films, shape ``(n1, n2, 5 (S′ + 2))``
    held_out : median, 99th percentile and largest relative error of the friction coefficient at random places,
        dimensionless, shape ``(3,)``
    held_out_count : number of these places, dimensionless
    """

    substrate: str
    largest_strength: float
    first_place: float
    last_place: float
    coefficients: FloatArray
    smooth: FloatArray
    held_out: FloatArray
    held_out_count: int

    def coordinates(self, strength: FloatArray, place: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both axes scaled to −1 … 1."""
        width = self.last_place - self.first_place
        return 2 * strength / self.largest_strength - 1, 2 * (bent(place) - self.first_place) / width - 1


@dataclass(frozen=True, eq=False, kw_only=True)
class RememberingTissue:
    """Memory of the tissue under lubricated balls, with the correction of a table; see `tissue_in_contact`.

    Attributes
    ----------
    correction : `MemoryCorrection`
    strength, place, loss : of `TissueInContact`, dimensionless, scalars or of shape ``(B, 1)``, ``(N,)`` or ``(B, N)``
    terms : that suffice between the moduli which the rows of a vector meet, where these differ by little; None for all
    """

    correction: MemoryCorrection
    strength: ArrayLike
    place: ArrayLike
    loss: ArrayLike
    terms: int | None = None


def bent(place: FloatArray) -> FloatArray:
    """Axis of a place, −1 … 1: the tissue is elastic at both of its ends."""
    return np.asarray(place / np.hypot(_TURN, place))


def unbent(axis: FloatArray) -> FloatArray:
    """The place of `bent`."""
    return np.asarray(_TURN * axis / np.sqrt(1 - np.square(axis)))


def contract_remembering(
    table: FilmTable,
    tissue: RememberingTissue,
    log_parameters: Sequence[FloatArray],
    memory: Sequence[FloatArray],
) -> ContractedFilms:
    """`contract` with all outputs and the hysteresis, for tissue with strength, place and loss, ``(B, 1)`` or ``(B, N)`` each."""
    correction = tissue.correction
    films = contract(table, log_parameters, HYSTERESIS, local=tissue.terms)
    strength, place, loss = memory
    scaled = correction.coordinates(strength, place)
    inside = films.inside
    for part in scaled:
        inside = inside & (np.abs(part) <= 1 + _SLACK)
    held = [np.where(np.abs(part) <= 1 + _SLACK, part, 0.0) for part in scaled]
    vectors = len(strength)
    strength = np.where(strength <= correction.largest_strength * (1 + _SLACK), strength, 0.0)
    axes = held_coordinates(table.axes, log_parameters)
    added = summed(correction.coefficients, [*held, *axes], vectors)
    smooth = summed(correction.smooth, held, vectors)
    # all but the hysteresis is counted over the strength
    of_hysteresis = added.shape[-1] - (added.shape[-1] - ANCHORS) // (HYSTERESIS + 1)
    added[..., :of_hysteresis] *= strength[..., None]
    smooth[..., : (SMOOTH_OUTPUTS - 1) * (smooth.shape[-1] // SMOOTH_OUTPUTS)] *= strength[..., None]
    known = films.flat.reshape(*films.start.shape, -1)
    flat = added if added.shape[1] >= known.shape[1] else np.repeat(added, known.shape[1], axis=1)
    flat[..., ANCHORS:of_hysteresis] += known[..., ANCHORS:]
    shift, stretch = flat[..., 0], 1 + flat[..., 1]
    anchor, unit = films.anchor + films.unit * shift, films.unit * stretch
    start = np.arange(0, flat.size, flat.shape[-1]).reshape(flat.shape[:2])
    assert isinstance(films.smooth, SmoothFilms)
    return replace(
        films,
        flat=flat.reshape(-1),
        start=start,
        anchor=anchor,
        unit=unit,
        smooth=SmoothWithMemory(
            films.smooth,
            smooth.reshape(-1),
            np.arange(0, smooth.size, smooth.shape[-1]).reshape(smooth.shape[:2]),
        ),
        inside=inside,
        log_loss=np.log(loss),
    )
