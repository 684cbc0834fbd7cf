"""A recording of a tribometer as arrays in SI, and the rules by which friction is taken from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray

Zero = Literal["as recorded", "both directions", "rest"]


@dataclass(frozen=True, eq=False)
class Recording:
    """Forces in time, as recorded but for units, signs, factors and stated offsets; nan where a value is missing.

    Attributes
    ----------
    name : of the file, for people
    time : s, increasing, shape ``(n,)``
    tangential_force : N, positive towards one side, shape ``(n,)``
    normal_force : N, positive under load, shape ``(n,)``, or of shape ``()`` where it was not recorded but is stated
    position : m, shape ``(n,)``, or None
    sliding_speed : m/s, with or without the sign of the direction, shape ``(n,)``, or None
    quantities : name to what else was recorded, SI, shape ``(n,)``, or of shape ``()`` where it is stated
    labels : name to the label of all samples
    changing : name to the labels of a column that holds them, and the number of the label at each sample, shape ``(n,)``
    saturated : which samples are outside of the stated range of a sensor, shape ``(n,)``, or None
    lines : line of the file of each sample; of shape ``()`` that of the first, if one sample stands on each line
    """

    name: str
    time: FloatArray
    tangential_force: FloatArray
    normal_force: FloatArray
    position: FloatArray | None = None
    sliding_speed: FloatArray | None = None
    quantities: Mapping[str, FloatArray] = field(default_factory=dict)
    labels: Mapping[str, str] = field(default_factory=dict)
    changing: Mapping[str, tuple[tuple[str, ...], NDArray[np.int32]]] = field(default_factory=dict)
    saturated: NDArray[np.bool_] | None = None
    lines: NDArray[np.int64] = field(default_factory=lambda: np.array(1))

    @property
    def interval(self) -> float:
        """Typical time from sample to sample, s."""
        return float(np.median(np.diff(self.time)))

    def line(self, sample: int) -> int:
        """Line of the file on which a sample stands."""
        return int(self.lines[sample] if self.lines.ndim else self.lines + sample)


@dataclass(frozen=True)
class Rules:
    """How strokes are found and friction is taken; every number in SI.

    Attributes
    ----------
    strokes_from : what tells strokes; None takes the first of position, sliding speed and tangential force that there is
    minimum_length : of a stroke, m; None is a fifth of the range of positions
    minimum_duration : of a stroke, s
    directions : which strokes are taken
    skip_first : strokes at the beginning of a recording that are left out, as friction runs in
    steady : ``"central share"`` of each stroke, or ``"change points"``: the longest piece between changes
    share : central share, by distance where that is known, by time otherwise
    tangential_zero : how the zero of the tangential force is found
    normal_zero : how that of the normal force is found
    rest : from when to when nothing touches, s of the recorded time
    friction : of the means of both forces, or the mean of their ratio at each sample
    ramp_edges : loads between which each stroke is cut into bins, N; empty without a ramp
    minimum_normal_force : strokes with less are left out, N
    """

    strokes_from: Literal["position", "sliding_speed", "tangential_force", "whole"] | None = None
    minimum_length: float | None = None
    minimum_duration: float = 0.0
    directions: Literal["both", "forward", "backward"] = "both"
    skip_first: int = 0
    steady: Literal["central share", "change points"] = "central share"
    share: float = 0.6
    tangential_zero: Zero = "as recorded"
    normal_zero: Zero = "as recorded"
    rest: tuple[float, float] | None = None
    friction: Literal["ratio of means", "mean of ratios"] = "ratio of means"
    ramp_edges: tuple[float, ...] = ()
    minimum_normal_force: float = 0.0
