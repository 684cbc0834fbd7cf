"""What the uncertainty of a posterior owes to the surface, to the other parameters of the theory, and to the data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.surface_draws import ROUGHNESS, SurfaceDraws, surface_draws
from skinbayes.problem.check import entering
from skinbayes.problem.surface_prior import DEVIATE
from skinbayes.statistics.variance_shares import variance_shares

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult
    from skinbayes.problem import Problem

FEWEST_DRAWS = 200


@dataclass(frozen=True)
class SurfaceVariance:
    """Shares of the posterior variance of ln of one quantity, which sum to 1.

    Attributes
    ----------
    quantity : label of a parameter
    standard_deviation : of its ln
    surface : of roughness parameters
    moduli : of all other parameters of the theory
    data : what is left when both are known: scatter and finite number of data
    standard_errors : of the three shares, from the finite number of draws
    """

    quantity: str
    standard_deviation: float
    surface: float
    moduli: float
    data: float
    standard_errors: tuple[float, float, float]

    def sentence(self) -> str:
        """The shares in words."""
        factor = np.exp(self.standard_deviation)
        return (
            f"{self.quantity} is known to a factor of {factor:.2g} (one standard deviation); of its variance "
            f"{self.surface:.0%} goes with the surface, {self.moduli:.0%} with the other parameters of the theory, and "
            f"{self.data:.0%} would remain if all of these were known."
        )


def surface_variance(fit: FitResult, quantity: str | None = None) -> SurfaceVariance:
    """See :meth:`FitResult.surface_variance`."""
    problem = _problem_of(fit)
    labels = [problem.names[i] for i in entering(problem)]
    if quantity is None:
        quantity = next((label for label in labels if label.startswith("frictional_shear_stress")), labels[0])
    if quantity not in labels:
        raise InputError(
            f"{quantity:.60}: no free parameter of the theory; expected one of {', '.join(labels)}"
        )
    name = quantity.partition("[")[0]
    of_surface = [label for label in labels if label.partition("[")[0] in (DEVIATE, *ROUGHNESS)]
    others = [label for label in labels if label not in of_surface and label.partition("[")[0] != name]
    if not of_surface or quantity in of_surface:
        raise InputError(f"{fit.name}: no free roughness beside {quantity}: the surface adds no variance")
    count = len(fit.draws(quantity))
    if count < FEWEST_DRAWS:
        raise InputError(f"{count} draws; expected at least {FEWEST_DRAWS}")
    found = variance_shares(
        _scaled(fit, quantity),
        {
            key: np.stack([_scaled(fit, label) for label in chosen], axis=-1)
            if chosen
            else np.empty((count, 0))
            for key, chosen in (("surface", of_surface), ("moduli", others))
        },
    )
    surface, moduli, data = (found.shares[key] for key in ("surface", "moduli", "residual"))
    errors = found.standard_errors
    return SurfaceVariance(
        quantity,
        float(np.sqrt(found.variance)),
        surface,
        moduli,
        data,
        (errors["surface"], errors["moduli"], errors["residual"]),
    )


def surface_shares(fit: FitResult) -> list[str]:
    """Sentences on what the surface does to the frictional shear stress; none where no free roughness meets one."""
    problem = fit.problem
    if problem is None:
        return []
    said = [] if problem.surface_prior is None else [problem.surface_prior.sentence()]
    names = [name.partition("[")[0] for name in problem.names]
    if "frictional_shear_stress" not in names or not {DEVIATE, *ROUGHNESS} & set(names):
        return said
    stresses = [label for label in problem.names if label.startswith("frictional_shear_stress")]
    try:
        return said + [surface_variance(fit, label).sentence() for label in stresses]
    except InputError:  # too few draws
        return said


def fitted_surface(fit: FitResult) -> SurfaceDraws:
    """See :meth:`AskedFit.surface`."""
    _problem_of(fit)
    posterior = fit.groups["posterior"]
    values = {
        name: posterior[name].values
        for name in ROUGHNESS
        if name in posterior and set(posterior[name].dims) == {"chain", "draw"}
    }
    fixed = {
        name: float(entry["value"]) for name, entry in fit.provenance["fixed"].items() if name in ROUGHNESS
    }
    if fit.provenance.get("options", {}).get("shape") == "free-form":
        raise InputError(f"{fit.name}: a free form is not given by five roughness parameters")
    return surface_draws(values, fixed, fit.name)


def _problem_of(fit: FitResult) -> Problem:
    if fit.problem is None:
        raise InputError(f"{fit.name}: the model file or the data of the fit are gone")
    return fit.problem


def _scaled(fit: FitResult, label: str) -> FloatArray:
    """Draws of a parameter, of its ln if it is positive: products of powers become sums."""
    draws = fit.draws(label)
    return np.log(draws) if (draws > 0).all() else draws
