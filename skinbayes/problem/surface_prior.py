"""What an earlier fit says about a surface, as parameters of the next one."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.files.surface_draws import SurfaceDraws
from skinbayes.roughness import SelfAffineSpectrum, rms_slope
from skinbayes.statistics.copula import GaussianCopula
from skinbayes.statistics.priors import make_prior
from skinbayes.units import format_quantity
from skinbayes.vocabulary import QUANTITIES

DEVIATE = "surface_deviate"

COMPARED = 4000
"""Surfaces drawn to compare with those of the fit."""


@dataclass(frozen=True, eq=False)
class SurfacePrior:
    """Roughness parameters that depend on each other, as functions of independent normal ones, which are sampled.

    Attributes
    ----------
    draws : of the surface
    copula : from the deviates to the roughness parameters that are not given otherwise
    """

    draws: SurfaceDraws
    copula: GaussianCopula

    @property
    def names(self) -> tuple[str, ...]:
        """The roughness parameters."""
        return self.copula.names

    @property
    def map(self) -> tuple[FloatArray, FloatArray]:
        """The numbers that make the prior."""
        return self.copula.quantiles, self.copula.factor

    @cached_property
    def parameters(self) -> tuple[ParameterSpec, ...]:
        """The free parameters, ``surface_deviate[rms_height]`` and so on."""
        return tuple(
            ParameterSpec(
                DEVIATE, QUANTITIES[DEVIATE].unit, "roughness", name, None, make_prior("normal", [0.0, 1.0]),
                {"normal": [0, 1]}, f"the surface of {self.draws.source}",
            )
            for name in self.names
        )  # fmt: skip

    def inputs(self, values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """The roughness parameters of deviates among the inputs, each ``(B, 1)``, SI."""
        deviates = np.stack([values[f"{DEVIATE}[{name}]"] for name in self.names], axis=-1)
        found = self.copula.values(deviates)
        return {name: np.ascontiguousarray(found[..., i]) for i, name in enumerate(self.names)}

    def sentence(self) -> str:
        """Where the roughness comes from, and how well it is entered."""
        return (
            f"The roughness is what the draws of '{self.draws.source}' say, {', '.join(self.names)} together, with their margins "
            f"and the correlations of their normal scores; so entered, quantiles of the rms slope are off by at most "
            f"{self.departure():.1g} of the standard deviation of its logarithm."
        )

    def departure(self) -> float:
        """By how much quantiles of ln of the rms slope differ between the draws and the prior, in standard deviations.

        The rms slope is what the contact area depends on. The largest difference of the 5, 25, 50, 75 and 95 % quantiles; that of
        two sets of 4,000 independent draws is 0.05 or so.
        """
        draws = self.draws.draws
        others = dict(self.draws.fixed)
        others |= {name: float(np.median(values)) for name, values in draws.items() if name not in self.names}
        entered = self.copula.values(np.random.default_rng(6).standard_normal((COMPARED, len(self.names))))
        fitted = _log_slope(others | {name: draws[name] for name in self.names})
        prior = _log_slope(others | {name: entered[:, i] for i, name in enumerate(self.names)})
        first, second = (np.nanquantile(slope, [0.05, 0.25, 0.5, 0.75, 0.95]) for slope in (fitted, prior))
        return float(np.abs(first - second).max() / np.nanstd(fitted))


def _log_slope(parameters: Mapping[str, FloatArray | float]) -> FloatArray:
    with np.errstate(all="ignore"):
        return np.log(rms_slope(SelfAffineSpectrum(**parameters)))


HEIGHT = "rms_height"
"""The roughness parameter that tables of films hold."""


def refuse_shapes(prior: SurfacePrior, model: str, where: str) -> None:
    """Refuse draws of the shape of a spectrum where a model without a table for them would solve every row anew."""
    if shape := [name for name in prior.names if name != HEIGHT]:
        medians = [float(np.median(prior.draws.draws[name])) for name in shape]
        units = [QUANTITIES[name].unit for name in shape]
        lines = ", ".join(
            f"{name} = " + (f"{middle:.4g}" if unit == "1" else f'"{format_quantity(middle, unit, 4)}"')
            for name, middle, unit in zip(shape, medians, units, strict=True)
        )
        raise InputError(
            f"{where}: surface.posterior: '{model}' reads friction from a table, which holds any {HEIGHT} of a spectrum of one "
            f"shape; with draws of {', '.join(shape)} every row would be solved anew, for weeks. Expected these fixed under "
            f"[parameters], such as at their medians: {lines}. {HEIGHT} stays as the draws have it, and what is not known of "
            "the shape is left out"
        )


def surface_prior(draws: SurfaceDraws | None, given: Collection[str], where: str) -> SurfacePrior | None:
    """The prior that draws of a surface make for those roughness parameters that are not ``given``; None if there are none."""
    names = [] if draws is None else [name for name in draws.draws if name not in given]
    if draws is None or not names:
        return None
    try:
        copula = GaussianCopula.of_draws(names, np.stack([draws.draws[name] for name in names], axis=-1))
    except InputError as error:
        raise InputError(f"{where}: surface.posterior: {error}") from None
    return SurfacePrior(draws, copula)
