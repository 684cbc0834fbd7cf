"""Errors of friction hold what they promise: 90 % intervals of recordings whose friction is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from synthetic_recordings import synthetic, without_strokes

from skinbayes.recordings import Recording, Rules, reduce_recording
from skinbayes.recordings.averages import averaged

RECORDINGS = 200
WIDTH = 3 * np.sqrt(0.9 * 0.1 / RECORDINGS)
"""Three standard errors of a share of 90 % of so many independent recordings."""

BOTH = Rules(tangential_zero="both directions")
HALTED = (3, 4, 7)


def made(case: str, seed: int) -> Recording:
    if case == "missing strokes":
        return without_strokes(synthetic(seed), 4.0, HALTED)
    options: dict[str, dict[str, Any]] = {
        "noise": {},
        "long memory": {"memory": 0.3},
        "drift": {"drift": 0.1},
        "stick and slip": {"slip": 0.3},
        "large offset": {"zero": 0.3},
    }
    return synthetic(seed, **options[case])


def share_inside(case: str) -> tuple[float, float]:
    """Shares of strokes, and of means of recordings, whose 90 % interval holds the friction that was put in."""
    strokes, means = [], []
    for seed in range(RECORDINGS):
        used = reduce_recording(made(case, seed), BOTH).used
        strokes += [abs(row.friction_coefficient - 0.5) < 1.645 * row.standard_error for row in used]
        mean = averaged(used, [0] * len(used))
        means.append(abs(mean.friction_coefficient - 0.5) < 1.645 * mean.standard_error)
    return float(np.mean(strokes)), float(np.mean(means))


@pytest.mark.slow
@pytest.mark.parametrize(
    "case", ["noise", "long memory", "drift", "stick and slip", "large offset", "missing strokes"]
)
def test_ninety_per_cent_intervals_hold_ninety_per_cent(case: str) -> None:
    strokes, means = share_inside(case)
    assert strokes == pytest.approx(0.9, abs=WIDTH), f"{case}: {strokes:.3f} of the strokes"
    assert means == pytest.approx(0.9, abs=WIDTH), f"{case}: {means:.3f} of the means"
