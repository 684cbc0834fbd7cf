"""Types of what comes out of a recording: rows of friction, and what is said about the whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.recordings.recording import Recording
from skinbayes.recordings.trend import StrokeTrend
from skinbayes.recordings.zeros import ForceZero

DIRECTIONS = {1: "forward", -1: "backward", 0: "both"}

NAN = float("nan")

MOST_DRAWN = 1500
"""Pieces of a recording of which a picture shows the smallest and the largest value."""


@dataclass(frozen=True)
class FrictionRow:
    """Friction of one stroke, of one bin of load of it, or of several strokes together; SI.

    Attributes
    ----------
    stroke : number of the stroke in its recording, from 1; the first of several
    direction : 1 forward, −1 backward, 0 both
    load_bin : number of the bin of load, from 1; 0 without a ramp
    start, begin, end, stop : samples of the reversals and of the steady part
    time : of the middle of the steady part, s
    friction_coefficient : dimensionless
    own_error : its standard error from the scatter within the stroke, dimensionless
    zero_error, load_error : from the zeros of tangential and normal force, which all strokes share, dimensionless
    scatter : standard deviation of single samples, dimensionless
    samples, effective_samples : in the steady part, and how many of them are independent
    static_friction_coefficient : of the peak before the steady part, dimensionless; nan if none stands out
    change : of the friction coefficient along the steady part by a straight line, dimensionless
    normal_force, normal_force_error, normal_force_scatter : mean, its standard error, and deviation of single samples, N
    sliding_speed : m/s, nan where it is not known
    quantities : means of what else was recorded, SI
    labels : of the row
    notes : what there is to know
    left_out : why it is not among the rows; empty if it is
    by_recipe : whether the recipe left it out, not a fault
    strokes : number of strokes in it
    """

    stroke: int
    direction: int
    start: int
    begin: int
    end: int
    stop: int
    load_bin: int = 0
    time: float = NAN
    friction_coefficient: float = NAN
    own_error: float = NAN
    zero_error: float = 0.0
    load_error: float = 0.0
    scatter: float = NAN
    samples: int = 0
    effective_samples: float = NAN
    static_friction_coefficient: float = NAN
    change: float = NAN
    normal_force: float = NAN
    normal_force_error: float = NAN
    normal_force_scatter: float = NAN
    sliding_speed: float = NAN
    quantities: Mapping[str, float] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    left_out: str = ""
    by_recipe: bool = False
    strokes: int = 1

    @property
    def standard_error(self) -> float:
        """Of the friction coefficient, with that of the zeros, dimensionless."""
        return float(np.sqrt(self.own_error**2 + self.zero_error**2 + self.load_error**2))


@dataclass(frozen=True, eq=False)
class Preview:
    """A recording in few points: the smallest and the largest value of each piece.

    Attributes
    ----------
    time : middles of the pieces, s, shape ``(m,)``
    tangential_force, normal_force : N, shape ``(2, m)``, zeros taken off
    way : m, shape ``(m,)``, or None
    """

    time: FloatArray
    tangential_force: FloatArray
    normal_force: FloatArray
    way: FloatArray | None


def preview_of(
    recording: Recording, tangential: FloatArray, normal: FloatArray, way: FloatArray | None
) -> Preview:
    """Reduce forces (N) and way (m) of a recording, shape ``(n,)`` each, to what a picture can show."""
    starts = np.unique(np.linspace(0, recording.time.size, MOST_DRAWN, endpoint=False).astype(np.intp))
    both = [
        np.stack((np.fmin.reduceat(f, starts), np.fmax.reduceat(f, starts))) for f in (tangential, normal)
    ]
    return Preview(recording.time[starts], both[0], both[1], None if way is None else way[starts])


@dataclass(frozen=True, eq=False)
class ReducedRecording:
    """What a recording says about friction.

    Attributes
    ----------
    name : of the recording
    samples, duration, interval : number of samples, and s
    rows : all strokes, those left out with their reasons
    tangential_zero, normal_zero : of the forces
    memory : of friction within strokes: time that one independent sample takes, s
    period : of stick and slip, s; nan where friction does not repeat itself
    trend : from stroke to stroke, None with too few strokes
    preview : for a picture
    times : time at the samples that ``rows`` name, s: ``times[sample]``
    notes : what there is to know about the recording
    """

    name: str
    samples: int
    duration: float
    interval: float
    rows: tuple[FrictionRow, ...]
    tangential_zero: ForceZero
    normal_zero: ForceZero
    memory: float
    period: float
    trend: StrokeTrend | None
    preview: Preview
    times: Mapping[int, float]
    notes: tuple[str, ...] = ()

    @property
    def used(self) -> list[FrictionRow]:
        """Rows that are taken."""
        return [row for row in self.rows if not row.left_out]

    @property
    def faulty(self) -> list[FrictionRow]:
        """Rows that are left out for a fault, not by the recipe."""
        return [row for row in self.rows if row.left_out and not row.by_recipe]
