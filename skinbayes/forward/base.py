"""The shape of a forward model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from skinbayes.arrays import FloatArray
from skinbayes.roughness import PowerSpectrum

ROUGHNESS_INPUTS = ("rms_height", "hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
"""Inputs of a self-affine spectrum; a named surface supplies all of them."""

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
    exclusive : further sets of alternatives of which at most one may be given, such as wavevector or magnification
    derived_names : names of the ``derived`` quantities
    blocks : those of them that may stand for the parameters behind them when combinations are named (``rms_slope``)
    accepted : further inputs that may be given and have no default
    evaluate : ``(inputs, table) -> {observable: (B, N)}``; ``table`` is a tabulated spectrum or None
    derived : quantities between inputs and observables (``rms_slope``, ``nominal_pressure``), same calling convention
    profiles : curves for plots
    validate : raises InputError saying in words which inputs cannot be (evaluation itself gives NaN), or None
    explain : sentences on why predictions are missing (NaN) or doubtful, or None
    uses_surface : True if a roughness spectrum enters: the five roughness inputs, or a tabulated spectrum
    """

    name: str
    summary: str
    observables: tuple[str, ...]
    required: tuple[str | tuple[tuple[str, ...], ...], ...]
    optional: Mapping[str, float]
    evaluate: Callable[[Inputs, PowerSpectrum | None], dict[str, FloatArray]]
    derived: Callable[[Inputs, PowerSpectrum | None], dict[str, FloatArray]]
    exclusive: tuple[tuple[tuple[str, ...], ...], ...] = ()
    derived_names: tuple[str, ...] = ()
    blocks: tuple[str, ...] = ()
    accepted: tuple[str, ...] = ()
    profiles: tuple[Profile, ...] = field(default=())
    uses_surface: bool = True
    validate: Callable[[Inputs, PowerSpectrum | None], None] | None = None
    explain: Callable[[Inputs, PowerSpectrum | None], list[str]] | None = None

    def required_names(self) -> tuple[str, ...]:
        """All names that occur in ``required``, alternatives included."""
        flat: list[str] = []
        for entry in self.required:
            flat += [entry] if isinstance(entry, str) else [name for names in entry for name in names]
        return tuple(dict.fromkeys(flat))

    def input_names(self) -> tuple[str, ...]:
        """All inputs the model takes, sorted; roughness inputs included if it has a surface."""
        roughness = ROUGHNESS_INPUTS if self.uses_surface else ()
        return tuple(sorted({*self.required_names(), *self.optional, *self.accepted, *roughness}))

    def alternatives(self) -> tuple[tuple[tuple[str, ...], ...], ...]:
        """All sets of alternatives, required or not."""
        return (*(entry for entry in self.required if not isinstance(entry, str)), *self.exclusive)
