"""Which parameters, or combinations of parameters, data can determine: found from sensitivities, before sampling.

At each of many prior draws the problem is linearised: S is the matrix of sensitivities, each column scaled by the
prior standard deviation of its parameter and each row by the noise of its datum. Along a right singular vector of S
with singular value s the posterior standard deviation is 1/√(1 + s²) of the prior one. A direction counts as
*informed* if that is below 0.9. Findings are medians and percentiles over the draws, because sensitivities at a
single point can mislead: what is silent here may speak elsewhere in the prior.

The linearisation is a description, not a bound: a posterior that is much narrower than the prior in a non-linear
problem is better judged afterwards (see :mod:`skinbayes.diagnose.prior_checks`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.diagnose.combinations import decompose
from skinbayes.diagnose.directions import INFORMED, equivalents, freedoms, group_finding, spread_ratios
from skinbayes.diagnose.findings import Identifiability
from skinbayes.diagnose.sensitivities import Derived, Predict, sensitivities
from skinbayes.errors import InputError

MAXIMUM_ELEMENTS = 1_000_000
"""Bound on the number of derivatives (draws · rows · parameters) while more than the fewest draws are used."""

FEWEST_DRAWS = 8


def identify(
    names: Sequence[str],
    predict: Predict,
    draws: FloatArray,
    noise_standard_deviation: ArrayLike,
    *,
    logarithmic: Sequence[bool] | None = None,
    prior_standard_deviation: ArrayLike | None = None,
    groups: Mapping[str, ArrayLike] | None = None,
    derived: Derived | None = None,
    rows: int | None = None,
    maximum_draws: int = 48,
) -> Identifiability:
    """Find out which combinations of parameters the data determine.

    Parameters
    ----------
    names : D parameters that enter the predictions (leave out those of the noise)
    predict : ``(B, D)`` to ``(B, N)``: the predictions on the scale on which the noise is given, usually their ln
    draws : prior draws, shape ``(B, D)``, natural coordinates (SI)
    noise_standard_deviation : typical noise of each row, shape ``(N,)`` or a scalar, on the scale of ``predict``
    logarithmic : for each parameter, True to work with its logarithm; by default where all draws are positive
    prior_standard_deviation : of each parameter (of its ln where logarithmic), shape ``(D,)``; by default of the draws
    groups : label to indices of rows, for groups that are looked at by themselves; all rows are always added
    derived : ``(B, D)`` to named quantities, each ``(B,)`` or ``(B, N)``; parameters that act only through one of
        them are replaced by it
    rows : number of data, if ``predict`` gives more numbers than data (those that data scattering together come down to)
    maximum_draws : number of draws that are used; fewer, but at least 8, for many thousands of rows

    Returns
    -------
    the findings

    Raises
    ------
    InputError
        if shapes do not fit, the noise is not positive, a prior has no spread, or no draw has finite predictions

    Examples
    --------
    >>> draws = np.exp(np.random.default_rng(0).normal(size=(30, 3)))
    >>> found = identify(["a", "b", "c"], lambda t: np.log(t[:, :1] / t[:, 1:2]), draws, 0.1)
    >>> print(found.joint.combinations[0].text, found.absent)
    a / b ('c',)
    """
    names = tuple(names)
    points = np.asarray(draws, dtype=float)
    if points.ndim != 2 or points.shape[1] != len(names):
        raise InputError(f"Prior draws have shape {points.shape}; expected (draws, {len(names)}).")
    positive = (points > 0.0).all(axis=0) if logarithmic is None else logarithmic
    logs = tuple(np.asarray(positive, dtype=bool).tolist())
    spread = _prior_spread(names, points, logs, prior_standard_deviation)
    with np.errstate(all="ignore"):
        columns = np.shape(predict(points[:1]))[1]
    affordable = MAXIMUM_ELEMENTS // (columns * len(names))
    count = min(maximum_draws, max(FEWEST_DRAWS, affordable))
    found = sensitivities(names, predict, points[:count], logs, spread, derived)
    noise = np.broadcast_to(np.asarray(noise_standard_deviation, dtype=float), (columns,))
    if not ((noise > 0.0) & np.isfinite(noise)).all():
        raise InputError("The noise of each row must be a finite number > 0.")
    everything = np.arange(columns)
    parts = {label: np.atleast_1d(np.asarray(index, dtype=int)) for label, index in (groups or {}).items()}
    parts = {label: index for label, index in parts.items() if len(set(index.tolist())) < columns}
    parts["all rows"] = everything
    scaled = found.scaled(noise, everything)
    effect = np.quantile(np.linalg.norm(scaled, axis=1), 0.9, axis=0)
    mute = effect < INFORMED
    counts = {"all rows": rows or columns}
    findings = tuple(
        group_finding(found, label, noise, index, counts.get(label, len(index)))
        for label, index in parts.items()
    )
    return Identifiability(
        names=names,
        points=len(scaled),
        failed_points=found.failed,
        groups=findings,
        equivalents=equivalents(found, findings),
        freedoms=freedoms(found, scaled, np.flatnonzero(~mute)),
        only_prior=tuple(name for name, is_mute in zip(names, mute, strict=True) if is_mute),
        absent=tuple(name for name, size in zip(names, effect, strict=True) if size < 1e-9),
        spread_ratios=dict(zip(names, spread_ratios(decompose(scaled), np.eye(len(names))), strict=True)),
    )


def _prior_spread(
    names: tuple[str, ...], points: FloatArray, logs: tuple[bool, ...], given: ArrayLike | None
) -> FloatArray:
    if given is None:
        with np.errstate(all="ignore"):
            coordinates = np.where(logs, np.log(points), points)
        # quartiles rather than moments: heavy-tailed priors have no standard deviation
        low, high = np.quantile(coordinates, [0.25, 0.75], axis=0)
        spread = (high - low) / 1.349
    else:
        spread = np.broadcast_to(np.asarray(given, dtype=float), (len(names),))
    for name, value in zip(names, spread, strict=True):
        if not (value > 0.0 and np.isfinite(value)):
            raise InputError(
                f"The prior of {name} has standard deviation {value:g}; expected a finite number > 0."
            )
    return np.asarray(spread)
