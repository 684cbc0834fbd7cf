"""The shape of a forward model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from skinbayes.arrays import FloatArray
from skinbayes.roughness import PowerSpectrum

Inputs = Mapping[str, FloatArray]
"""Name to SI values; each array broadcasts to ``(B, N)``: B parameter vectors, N rows of conditions."""


@dataclass(frozen=True)
class Profile:
    """A curve that a forward model can draw beyond its observables, such as contact area against wavevector.

    Attributes
    ----------
    name, title : identifier and title for plots
    abscissa, ordinate : names of quantities in the vocabulary
    grid : abscissa values for given inputs, shape ``(K,)``, SI
    evaluate : ordinate for inputs that broadcast to ``(B,)`` at the grid, shape ``(B, K)``
    """

    name: str
    title: str
    abscissa: str
    ordinate: str
    grid: Callable[[Inputs, PowerSpectrum | None], FloatArray]
    evaluate: Callable[[Inputs, PowerSpectrum | None, FloatArray], FloatArray]


@dataclass(frozen=True)
class ForwardModel:
    """Physics with names.

    Attributes
    ----------
    name : the name used in model files
    summary : one line
    observables : names this model predicts
    required : inputs that must be given, as a parameter or as a column of conditions; a tuple inside is a set of
        alternatives, each alternative a tuple of names, the first complete one is used
    optional : inputs with default values, SI
    evaluate : ``(inputs, table) -> {observable: (B, N)}``; ``table`` is a tabulated spectrum or None
    derived : quantities between inputs and observables (``rms_slope``, ``nominal_pressure``), same calling convention
    profiles : curves for plots
    """

    name: str
    summary: str
    observables: tuple[str, ...]
    required: tuple[str | tuple[tuple[str, ...], ...], ...]
    optional: Mapping[str, float]
    evaluate: Callable[[Inputs, PowerSpectrum | None], dict[str, FloatArray]]
    derived: Callable[[Inputs, PowerSpectrum | None], dict[str, FloatArray]]
    profiles: tuple[Profile, ...] = field(default=())
