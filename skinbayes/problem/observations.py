"""What was observed, and what is known about its scatter before any fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.statistics.noise import NoiseFamily

NOISE_WORDS = {"noise_scale": "scale", "discrepancy_scale": "discrepancy"}
"""Parameters of ``[noise]`` that make the width of the noise, and what the noise families call them."""


@dataclass(frozen=True)
class Observation:
    """One observed quantity at all rows.

    Attributes
    ----------
    name : observable of the forward model
    values : observed values, shape ``(N,)``, SI
    spread : known standard deviation of each datum, shape ``(N,)``, SI; zero if not used
    noise : how data scatter about the prediction
    several : True if the problem has further observables, so that parameters of the noise carry its name
    """

    name: str
    values: FloatArray
    spread: FloatArray
    noise: NoiseFamily
    several: bool

    def key(self, parameter: str) -> str:
        """Name among the inputs of a parameter of this observable's noise."""
        return f"{parameter}[{self.name}]" if self.several else parameter

    def noise_arguments(
        self, inputs: Mapping[str, FloatArray], propagated: FloatArray | None = None
    ) -> dict[str, FloatArray]:
        """Arguments of the noise family from the inputs; ``propagated`` is an uncertainty that adds to the known spread."""
        return self.width_arguments(inputs, propagated) | self.shape_arguments(inputs)

    def shape_arguments(self, inputs: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """Those of :meth:`noise_arguments` that set the shape of the noise."""
        return {name: inputs[self.key(name)] for name in self.noise.shape_parameters}

    def width_arguments(
        self, inputs: Mapping[str, FloatArray], propagated: FloatArray | None = None
    ) -> dict[str, FloatArray]:
        """Those of :meth:`noise_arguments` that set the width of the noise."""
        found = {
            word: inputs[self.key(name)] for name, word in NOISE_WORDS.items() if self.key(name) in inputs
        }
        spread = self.spread if propagated is None else np.hypot(self.spread, propagated)
        return found | {"spread": spread}


def propagated_spread(
    evaluate: Callable[[Mapping[str, FloatArray]], FloatArray],
    inputs: Mapping[str, FloatArray],
    relative_spread: Mapping[str, FloatArray],
    observation: Observation,
) -> FloatArray:
    """Uncertainty of the prediction that the known spread of inputs makes, by central differences of one standard deviation.

    Parameters
    ----------
    evaluate : inputs to predictions of the observable, ``(B, N)``
    inputs : name to values, each broadcasts to ``(B, N)``
    relative_spread : input to its standard deviation over its value, shape ``(N,)``
    observation : what is predicted; in a logarithmic noise family the difference is one of ln

    Returns
    -------
    ndarray
        Shape ``(B, N)``, unit of the observable. Exact where the prediction (its ln, in a logarithmic family) is linear in ln
        of the input; a curvature c of it adds errors of relative order (c σ)².
    """
    variance: FloatArray | float = 0.0
    for name, spread in relative_spread.items():
        sides = [evaluate({**inputs, name: inputs[name] * np.exp(sign * spread)}) for sign in (1.0, -1.0)]
        with np.errstate(all="ignore"):
            if observation.noise.logarithmic:
                # the family divides a spread by the datum, so that this becomes the spread of ln
                half = (np.log(sides[0]) - np.log(sides[1])) / 2 * observation.values
            else:
                half = (sides[0] - sides[1]) / 2
        variance = variance + half * half
    return np.sqrt(np.asarray(variance))
