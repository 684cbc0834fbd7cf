"""Windows that take the edges of a map away before its Fourier transform, and what they do to the number of modes."""

from __future__ import annotations

from typing import Literal

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

Window = Literal["hann", "blackman", "none"]
"""Names of windows."""

_COSINES: dict[str, tuple[float, ...]] = {"hann": (0.5, -0.5), "blackman": (0.42, -0.5, 0.08), "none": (1.0,)}
"""Coefficients of cos(2πjn/N), j = 0, 1, …: Harris, Proc. IEEE 66 (1978) 51, Sect. V, doi 10.1109/PROC.1978.10837."""

REACH = 4
"""Modes further apart than this are independent under each window."""


def window_values(name: str, pixels: int) -> FloatArray:
    """A window along one axis, shape ``(pixels,)``, dimensionless, scaled to a mean square of 1: variance is kept on average."""
    if name not in _COSINES:
        raise InputError(f"window: found '{name}'; expected one of {', '.join(_COSINES)}")
    phase = 2 * np.pi * (np.arange(pixels) + 0.5) / pixels  # symmetric about the middle of the map
    values = sum(c * np.cos(j * phase) for j, c in enumerate(_COSINES[name])) * np.ones(pixels)
    return np.asarray(values / np.sqrt(np.mean(np.square(values))))


def mode_correlation(name: str) -> FloatArray:
    """Squared correlation of the amplitudes of modes 0, 1, … `REACH` steps apart along one axis, dimensionless.

    It is ``|Σ w² exp(2πijn/N)|²/(Σ w²)²`` for a field whose spectrum hardly changes over some steps: 1, 4/9, 1/36, 0, 0 for the
    window of Hann.
    """
    pixels = 8 * REACH  # sums of a few cosines are exact on any such grid
    squares = np.square(window_values(name, pixels))
    return np.square(np.abs(np.fft.fft(squares)[: REACH + 1]) / squares.sum())


def spread_of_modes(name: str) -> float:
    """Variance of the distance over which a window spreads a mode, in squares of the step between modes: 1/3 of Hann's."""
    power = [_COSINES[name][0] ** 2, *(np.square(c) / 4 for c in _COSINES[name][1:])]
    away = sum(2 * p * j**2 for j, p in enumerate(power))
    return float(away / (power[0] + 2 * sum(power[1:])))
