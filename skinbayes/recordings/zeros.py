"""Zeros of the forces: from both directions of sliding, or from a part in which nothing touches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.recordings.memory import FEWEST_SAMPLES, error_of_mean, memory_of
from skinbayes.recordings.recording import Recording


@dataclass(frozen=True)
class ForceZero:
    """What a sensor shows without force.

    Attributes
    ----------
    value : N
    standard_error : N; 0 where the zero is taken as it is
    how : in words
    """

    value: float
    standard_error: float
    how: str


AS_RECORDED = ForceZero(0.0, 0.0, "as recorded")


def zero_at_rest(recording: Recording, force: FloatArray, rest: tuple[float, float], name: str) -> ForceZero:
    """Mean of a force in a part of the recording in which nothing touches.

    Raises
    ------
    InputError
        if that part holds fewer than eight values
    """
    inside = (recording.time >= rest[0]) & (recording.time <= rest[1])
    values = force[inside & np.isfinite(force)]
    if values.size < FEWEST_SAMPLES:
        raise InputError(
            f"{recording.name}: {values.size} values of the {name} from {rest[0]:g} s to {rest[1]:g} s, where nothing should "
            f"touch; expected at least {FEWEST_SAMPLES}. The recording goes from {recording.time[0]:g} s to "
            f"{recording.time[-1]:g} s: change rest under [zero] of the recipe"
        )
    error = error_of_mean(values, memory_of([values]))
    return ForceZero(
        float(values.mean()),
        error.standard_error,
        f"mean from {rest[0]:g} s to {rest[1]:g} s, where nothing touches",
    )


def zero_of_directions(
    name: str, tangential: FloatArray, normal: FloatArray, direction: FloatArray
) -> ForceZero:
    """The zero with which neighbouring strokes of opposite directions have the same friction coefficient.

    With means T₁, T₂ and N₁, N₂ of two strokes it is (T₁ N₂ + T₂ N₁)/(N₁ + N₂), averaged over all neighbours: forward after
    backward and backward after forward, so that friction which drifts moves it only at the ends.

    Parameters
    ----------
    name : of the recording
    tangential, normal : means over the steady parts in the order of time, N, shape ``(S,)``
    direction : 1 or −1, shape ``(S,)``

    Raises
    ------
    InputError
        if no two neighbours have opposite directions
    """
    opposite = np.flatnonzero(direction[1:] * direction[:-1] < 0)
    if not opposite.size:
        raise InputError(
            f"{name}: no forward stroke beside a backward one; expected both directions, as the recipe takes the zero of the "
            'tangential force from them: write tangential_force = "rest" or "as recorded" under [zero]'
        )
    t1, t2, n1, n2 = tangential[opposite], tangential[opposite + 1], normal[opposite], normal[opposite + 1]
    zeros = (t1 * n2 + t2 * n1) / (n1 + n2)
    count = zeros.size
    # neighbours share strokes: pairs k and k + 1 have half of their variance in common
    scatter = float(np.std(zeros, ddof=1)) if count > 1 else float("nan")
    return ForceZero(
        float(zeros.mean()),
        scatter * float(np.sqrt((2 * count - 1) / count**2)) if count > 1 else float("nan"),
        f"half way between both directions, {count} neighbours",
    )
