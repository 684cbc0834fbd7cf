"""What a reduced recording says, in sentences."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from skinbayes.recordings.rows import ReducedRecording

DIFFERS = 2.0
"""Scatter of strokes, in their errors, that is remarkable."""


def recording_sentences(one: ReducedRecording) -> list[str]:
    """What there is to know about a recording."""
    used, said = one.used, []
    numbers = ", ".join(f"stroke {row.stroke} ({row.left_out})" for row in one.faulty[:6])
    if one.faulty:
        more = f" and {len(one.faulty) - 6} more" if len(one.faulty) > 6 else ""
        said.append(f"{len(one.faulty)} of {len(one.rows)} left out: {numbers}{more}.")
    if recipe := Counter(row.left_out for row in one.rows if row.by_recipe):
        said.append(
            "Not taken, as the recipe says: " + ", ".join(f"{n} ({why})" for why, n in recipe.items()) + "."
        )
    for name, zero in (("tangential", one.tangential_zero), ("normal", one.normal_zero)):
        if zero.how != "as recorded":
            said.append(
                f"Zero of the {name} force {zero.value:.3g} ± {zero.standard_error:.2g} N ({zero.how})."
            )
    independent = np.median([row.effective_samples for row in used])
    said.append(
        f"Friction forgets in {one.memory:.2g} s, so that a row of {np.median([row.samples for row in used]):.0f} samples holds "
        f"{independent:.0f} independent ones."
    )
    if one.period == one.period:
        said.append(
            f"It repeats itself every {one.period:.2g} s, as in stick and slip or a vibration: cycles are taken as wholes."
        )
    if one.trend is not None:
        said += _trend_sentences(one)
    changes = np.array([row.change for row in used]) / np.array([row.friction_coefficient for row in used])
    if len(used) > 2 and abs(np.mean(changes)) > 2 * np.std(changes, ddof=1) / np.sqrt(len(used)):
        said.append(f"Along the steady part friction changes by {100 * np.mean(changes):+.1f} % on average.")
    return [*said, *(f"{note[0].upper()}{note[1:]}." for note in one.notes)]


def _trend_sentences(one: ReducedRecording) -> list[str]:
    trend = one.trend
    assert trend is not None
    said = []
    if trend.kind != "constant":
        how = f"half of it within {trend.half:.2g} strokes" if trend.kind == "running in" else "evenly"
        said.append(
            f"Friction {'runs in' if trend.kind == 'running in' else 'drifts'} from {trend.first:.3g} to {trend.last:.3g}, {how}."
        )
    if trend.scatter > DIFFERS * trend.explained:
        said.append(
            f"Strokes scatter by {trend.scatter:.2g}, {trend.scatter / trend.explained:.1f} times what their errors explain: "
            "strokes differ, which the noise of a model has to learn."
        )
    return said


def overall_sentences(recordings: Sequence[ReducedRecording]) -> list[str]:
    """What a user of the table has to know."""
    said = []
    for one in recordings:
        for row in one.faulty:
            said.append(f"{one.name}, stroke {row.stroke}, is left out: {row.left_out}.")
    moved = [one for one in recordings if one.trend is not None and one.trend.kind != "constant"]
    said += [f"{one.name}: {text}" for one in moved for text in _trend_sentences(one)[:1]]
    return said
