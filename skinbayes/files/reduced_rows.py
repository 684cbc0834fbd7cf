"""Rows of recordings as columns of a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.recipe import Recipe
from skinbayes.recordings import FrictionRow, ReducedRecording, averaged
from skinbayes.recordings.averages import paired
from skinbayes.recordings.rows import DIRECTIONS
from skinbayes.vocabulary import QUANTITIES

Rows = list[tuple[FrictionRow, int]]
"""Rows, each with the number of its recording."""


def grouped_rows(found: Sequence[ReducedRecording], recipe: Recipe) -> tuple[Rows, int]:
    """The rows that the recipe asks for, and how many were left out because they lie before the zero of time."""
    rows = [
        (replace(row, time=row.time - recipe.time_zero), i) for i, one in enumerate(found) for row in one.used
    ]
    after = [(row, i) for row, i in rows if row.time >= 0]
    before = len(rows) - len(after)
    if not after:
        raise InputError(f"{recipe.path}: rows.time_zero: all strokes lie before {recipe.time_zero:g} s")
    if recipe.each == ("stroke",):
        return after, before
    if recipe.each == ("pair",):
        pairs = [(row, i) for i in range(len(found)) for row in paired([r for r, j in after if j == i])]
        if not pairs:
            raise InputError(
                f"{recipe.path}: rows.each: no forward stroke beside a backward one; expected pairs of them"
            )
        return pairs, before
    groups: dict[tuple[Any, ...], Rows] = {}
    for row, i in after:
        key = (i,) if recipe.each == ("recording",) else tuple(row.labels[name] for name in recipe.each)
        groups.setdefault((row.load_bin, *key), []).append((row, i))
    return [
        (averaged([row for row, _ in members], [i for _, i in members]), members[0][1])
        for members in groups.values()
    ], before


def table_columns(rows: Rows, found: Sequence[ReducedRecording], recipe: Recipe) -> dict[str, Any]:
    """Headers to values of the table, in SI; what no row has is no column."""
    single, pairs = recipe.each == ("stroke",), recipe.each == ("pair",)
    by_recording = single or pairs or recipe.each == ("recording",)
    columns: dict[str, Any] = {"recording": [found[i].name for _, i in rows]} if by_recording else {}
    for name in dict.fromkeys(name for row, _ in rows for name in row.labels):
        columns[name] = [row.labels.get(name, "several") for row, _ in rows]
    if single or pairs:
        columns["stroke_number"] = [str(row.stroke) for row, _ in rows]
    if single:
        columns["direction"] = [DIRECTIONS[row.direction] for row, _ in rows]
    if recipe.rules.ramp_edges:
        columns["load_bin"] = [f"{row.load_bin}" for row, _ in rows]
    numbers = {
        "time [s]": [row.time for row, _ in rows],
        "friction_coefficient [1]": [row.friction_coefficient for row, _ in rows],
        "friction_coefficient_standard_error [1]": [row.standard_error for row, _ in rows],
        "normal_force [N]": [row.normal_force for row, _ in rows],
        "normal_force_standard_error [N]": [row.normal_force_error for row, _ in rows],
        "normal_force_scatter [N]": [row.normal_force_scatter for row, _ in rows],
        "sliding_speed [m/s]": [row.sliding_speed for row, _ in rows],
        "static_friction [1]": [row.static_friction_coefficient for row, _ in rows],
        "friction_change_in_stroke [1]": [row.change for row, _ in rows],
        "friction_scatter_in_stroke [1]": [row.scatter for row, _ in rows],
        "effective_samples [1]": [row.effective_samples for row, _ in rows],
    }
    for name in rows[0][0].quantities:
        numbers[f"{name} [{QUANTITIES[name].unit}]"] = [row.quantities[name] for row, _ in rows]
    for header, values in numbers.items():
        array = np.asarray(values, dtype=np.float64)
        # a constant load has no error, and reading a spread of 0 is refused
        wanted = (
            np.all(array > 0)
            if "_standard_error" in header or "_scatter " in header
            else np.isfinite(array).any()
        )
        if wanted and header not in columns:
            columns[header] = array
    if not single:
        columns["n"] = [row.strokes for row, _ in rows]
    columns["flag"] = ["; ".join(row.notes) for row, _ in rows]
    return columns
