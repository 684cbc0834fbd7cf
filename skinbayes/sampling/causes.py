"""Why a run has not converged, as far as its steps tell: walkers in two places, a ridge, or too few steps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.chains import Chains
from skinbayes.sampling.convergence import rank_normalise

RIDGE = 0.9
"""Rank correlation from which two quantities are said to lie on a ridge."""

GAP = 3.0
"""Standard deviations of a single walker that two kinds of walkers are apart at least."""

_POSITIONS = 4000  # of all kept ones, enough for a correlation to 1 %


@dataclass(frozen=True)
class Cause:
    """What keeps a run from converging.

    Attributes
    ----------
    slowest : the coordinate that is known worst
    apart : walkers that stay away from the others in ``slowest``, the fewer of two kinds
    walkers : of all ensembles together
    partner, correlation : the quantity that ``slowest`` moves with most, and their rank correlation; None below :data:`RIDGE`
    """

    slowest: str
    apart: int
    walkers: int
    partner: str | None
    correlation: float


def slowest(chains: Chains) -> int:
    """Place of the coordinate that is known worst: over its limits by R-hat of ensembles, of walkers, then by autocorrelation."""
    report = chains.report
    between, single = (
        np.nan_to_num(r, nan=np.inf, posinf=np.inf) for r in (report.r_hat, report.walker_r_hat)
    )
    # disagreement that sampling would not explain comes first
    return int(
        np.lexsort((np.nan_to_num(report.tau, nan=np.inf), single, np.where(between > 1.1, between, 0.0)))[-1]
    )


def thinned(chains: Chains) -> FloatArray:
    """Kept positions, evenly thinned, shape ``(n, D)``."""
    kept = chains.positions[:, chains.kept].reshape(-1, chains.positions.shape[-1])
    return np.asarray(kept[:: max(1, len(kept) // _POSITIONS)])


def cause(chains: Chains, shared: dict[str, FloatArray] | None = None) -> Cause:
    """Look for the cause in the kept steps.

    Parameters
    ----------
    chains : a run that has not converged
    shared : further quantities at the positions of :func:`thinned`, such as effects that were integrated out, each ``(n,)``
    """
    worst = slowest(chains)
    values = chains.positions[:, chains.kept, :, worst]
    positions = thinned(chains)
    quantities = {
        **(shared or {}),
        **{name: positions[:, i] for i, name in enumerate(chains.names) if i != worst},
    }
    found = {name: _correlation(positions[:, worst], series) for name, series in quantities.items()}
    partner = max(found, key=lambda name: abs(found[name]), default=None)
    ridge = partner is not None and abs(found[partner]) >= RIDGE
    if not ridge and shared:
        partner = max(shared, key=lambda name: abs(found[name]))
        ridge = abs(found[partner]) >= RIDGE
    return Cause(
        slowest=chains.names[worst],
        apart=_apart(values),
        walkers=int(values.shape[0] * values.shape[2]),
        partner=partner if ridge else None,
        correlation=found[partner] if ridge and partner is not None else 0.0,
    )


def _apart(values: FloatArray) -> int:
    """Walkers, the fewer of two kinds, beyond the widest gap between the medians of walkers; values of shape (E, S, W).

    0 if the gap is not wide against what a walker covers and against the bulk of all of them.
    """
    medians = np.sort(np.median(values, axis=1).ravel())
    gaps = np.diff(medians)
    place = int(np.argmax(gaps))
    bulk = np.median(np.abs(values - np.median(values)))
    wide = gaps[place] > GAP * np.median(values.std(axis=1)) and gaps[place] > bulk
    return min(place + 1, len(gaps) - place) if wide else 0


def _correlation(one: FloatArray, other: FloatArray) -> float:
    if np.ptp(one) == 0.0 or np.ptp(other) == 0.0:
        return 0.0
    return float(np.corrcoef(rank_normalise(one), rank_normalise(other))[0, 1])
