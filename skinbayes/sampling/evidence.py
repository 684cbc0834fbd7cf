"""The evidence, ln of the integral of prior times likelihood, from draws of the posterior and of a proposal that resembles it.

Bridge sampling (Meng & Wong 1996, Statistica Sinica 6, 831), with the errors of Frühwirth-Schnatter (2004, doi
10.1111/j.1368-423X.2004.00125.x). Where the proposal is close to the posterior it is hardly better than plain importance
sampling, which is the check: the two share the draws of the proposal, but weigh its tails differently.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import expit, logsumexp

from skinbayes.arrays import FloatArray

ITERATIONS = 200

_CLOSE = 1e-10


@dataclass(frozen=True)
class Evidence:
    """ln Z and what it rests on.

    Attributes
    ----------
    value, error : ln Z and its standard error
    plain, plain_error : the same by plain importance sampling
    """

    value: float
    error: float
    plain: float
    plain_error: float


def bridge(posterior: FloatArray, proposal: FloatArray, effective: float) -> Evidence:
    """ln Z from ln(target/proposal) at draws of both.

    Parameters
    ----------
    posterior : at draws of the posterior, shape ``(chains, n)``; chains are independent of each other, at least two
    proposal : at independent draws of the proposal, −inf where the target is 0, shape ``(m,)``
    effective : number of independent draws that those of the posterior are worth

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> wide, narrow = rng.normal(0, 1.5, 4000), rng.normal(size=(4, 1000))
    >>> found = bridge(*(np.log(1.5) - x**2 / 2 + (x / 1.5) ** 2 / 2 + 3.0 for x in (narrow, wide)), 4000)
    >>> round(found.value, 1)  # the target is 20 times a normal density
    3.0
    """
    plain = float(logsumexp(proposal) - np.log(proposal.size))
    weights = np.exp(proposal - plain)
    plain_error = float(weights.std() / np.sqrt(proposal.size))
    odds = np.log(effective / proposal.size)
    value = plain
    for _ in range(ITERATIONS):
        # the optimal bridge function weighs either kind of draws by the probability of being of the other
        of_proposal = logsumexp(proposal - value - np.logaddexp(0.0, odds + proposal - value)) - np.log(
            proposal.size
        )
        of_posterior = logsumexp(-np.logaddexp(0.0, odds + posterior - value)) - np.log(posterior.size)
        step = float(of_proposal - of_posterior)
        value += step
        if abs(step) < _CLOSE:
            break
    first = np.exp(proposal - value - np.logaddexp(0.0, odds + proposal - value))
    second = expit(-odds - posterior + value)
    means = second.mean(axis=1) / second.mean()
    variance = first.var() / first.mean() ** 2 / proposal.size
    # independent draws of the same number, or what the chains differ by if that is more
    variance += max(second.var() / second.mean() ** 2 / effective, means.var(ddof=1) / len(means))
    return Evidence(value, float(np.sqrt(variance)), plain, plain_error)


def combined(estimates: Sequence[tuple[float, float]], shared: bool = False) -> tuple[float, float]:
    """Mean of equally good estimates and its standard error.

    Parameters
    ----------
    estimates : values and standard errors
    shared : whether they may have all their errors in common; otherwise these are independent of each other

    Examples
    --------
    >>> combined([(1.0, 0.3), (2.0, 0.4)])
    (1.5, 0.25)
    """
    values, errors = np.array(estimates).T
    count = 1 if shared else len(values)
    return float(values.mean()), float(np.sqrt(np.square(errors).mean() / count))
