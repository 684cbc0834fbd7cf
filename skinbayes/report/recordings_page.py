"""The page about reduced recordings: what was taken of each, what came out, and what to know."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.files.reduced_provenance import rule_sentences
from skinbayes.phrases import row_count
from skinbayes.plot.numbers import quantity
from skinbayes.plot.recording import plot_recording
from skinbayes.recordings.words import recording_sentences
from skinbayes.report.drawings import Drawing
from skinbayes.report.figures import drawn
from skinbayes.report.rendering import rendered, write_whole

if TYPE_CHECKING:
    from skinbayes.files.reduced import ReducedRecordings
    from skinbayes.recordings import ReducedRecording

HEADERS = (
    "recording",
    "recorded",
    "strokes",
    "left out",
    "friction",
    "90 % of rows",
    "normal force",
    "independent",
)
"""Of the table of recordings."""

READING = (
    "Blue areas are the steady parts that were taken, red ones strokes that were left out for a fault. Below: friction of each "
    "stroke with its 90 % interval; triangles are static peaks."
)

MOST_PICTURES = 60
"""Recordings that a page draws; of more those with faults come first."""


def recording_row(one: ReducedRecording) -> tuple[str, ...]:
    """What a table says of a recording, under `HEADERS`."""
    used = one.used
    friction = np.array([row.friction_coefficient for row in used])
    low, high = np.quantile(friction, (0.05, 0.95))
    return (
        one.name,
        f"{one.duration:.4g} s at {1.0 / one.interval:.4g} 1/s",
        str(len({row.stroke for row in one.rows})),
        str(len({row.stroke for row in one.rows}) - len({row.stroke for row in used})),
        f"{np.median(friction):.3g} ± {np.median([row.standard_error for row in used]):.2g}",
        f"{low:.3g} to {high:.3g}",
        quantity(float(np.median([row.normal_force for row in used])), "N"),
        f"{np.median([row.effective_samples for row in used]):.0f} of {np.median([row.samples for row in used]):.0f}",
    )


def write_recordings_page(reduced: ReducedRecordings, path: Path) -> Path:
    """Write one self-contained HTML page about reduced recordings.

    Parameters
    ----------
    reduced : the recordings with their rows
    path : the file to write

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written.
    MachineError
        The disk is full.
    """
    return write_whole(Path(path), rendered("recordings.html", _context(reduced)))


def _context(reduced: ReducedRecordings) -> dict[str, Any]:
    recordings = list(reduced.recordings)
    if len(recordings) > MOST_PICTURES:
        recordings.sort(key=lambda one: not one.faulty)
    drawn_ones = recordings[:MOST_PICTURES]
    left_out = sum(len(one.faulty) for one in reduced.recordings)
    said = [
        f"{row_count(len(reduced.rows))} from {len(reduced.recordings)} recording{'s' if len(reduced.recordings) > 1 else ''}; "
        + (
            f"{left_out} strokes were left out for faults."
            if left_out
            else "no stroke was left out for a fault."
        )
    ]
    if len(recordings) > MOST_PICTURES:
        said.append(f"{MOST_PICTURES} recordings are drawn, those with faults first; the table has all.")
    return {
        "title": reduced.recipe.block.title,
        "converged": True,
        "said": said,
        "rules": [f"{sentence[0].upper()}{sentence[1:]}." for sentence in rule_sentences(reduced)],
        "headers": HEADERS,
        "rows": [recording_row(one) for one in reduced.recordings],
        "recordings": [_recording(one, i) for i, one in enumerate(drawn_ones)],
        "recipe": reduced.recipe.text,
        "sources": [(name, digest or "a data frame") for name, digest in reduced.sources.items()],
    }


def _recording(one: ReducedRecording, number: int) -> dict[str, Any]:
    drawing = Drawing(
        f"recording-{number}", plot_recording, "What was taken",
        "Tangential and normal force against time with the parts that were taken, and the friction coefficient of each stroke.",
        READING,
    )  # fmt: skip
    return {"name": one.name, "said": recording_sentences(one), "picture": drawn(one, drawing)}
