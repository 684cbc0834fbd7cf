"""One rule for what data say about a parameter, before sampling and after it."""

from __future__ import annotations

from typing import Literal, TypeAlias

Verdict: TypeAlias = Literal["updated", "moved", "not updated", "contradicted"]

UNCHANGED = 0.9
"""Posterior over prior standard deviation from which on the width has told nothing."""

MOVED = 0.2
"""A posterior median in this tail of the prior means that the data moved a parameter even if they did not narrow it."""

CONTRADICTED = 0.01
"""A posterior median in this tail of the prior means that data and prior contradict each other."""

MUCH, SOMETHING = 0.25, 0.7
"""Posterior over prior standard deviation below which data say much, and something, about a parameter."""


def verdict(ratio: float, prior_quantile: float = 0.5) -> Verdict:
    """What data do to a parameter; location counts as well as width.

    Parameters
    ----------
    ratio : posterior over prior standard deviation in the coordinate of the sampler
    prior_quantile : fraction of the prior below the posterior median; 0.5, the least telling one, before there is a posterior

    Examples
    --------
    >>> verdict(0.3), verdict(0.95), verdict(0.95, 0.9), verdict(0.3, 0.995)
    ('updated', 'not updated', 'moved', 'contradicted')
    """
    if not CONTRADICTED <= prior_quantile <= 1.0 - CONTRADICTED:
        return "contradicted"
    if ratio < UNCHANGED:
        return "updated"
    return "not updated" if MOVED <= prior_quantile <= 1.0 - MOVED else "moved"
