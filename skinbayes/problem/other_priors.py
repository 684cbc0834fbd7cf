"""A problem with other priors on its parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, overload

from skinbayes.problem.joint import JointProblem
from skinbayes.statistics.priors import Prior
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem


def priors_of(problem: Problem | JointProblem) -> tuple[Prior, ...]:
    """The priors of the free parameters, in their order."""
    return tuple(parameter.prior for parameter in problem.free if parameter.prior)


@overload
def with_priors(problem: Problem, priors: Sequence[Prior]) -> Problem: ...


@overload
def with_priors(problem: JointProblem, priors: Sequence[Prior]) -> JointProblem: ...


def with_priors(problem: Problem | JointProblem, priors: Sequence[Prior]) -> Problem | JointProblem:
    """The problem with other priors on its free parameters; all else, and their order, stays.

    Parameters
    ----------
    problem : any problem, or several experiments
    priors : one for each free parameter

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> problem = load_problem("forearm-glass")
    >>> with_priors(problem, priors_of(problem)).fingerprint == problem.fingerprint
    True
    """
    free = tuple(replace(p, prior=prior) for p, prior in zip(problem.free, priors, strict=True))
    if isinstance(problem, JointProblem):
        experiments = {
            name: with_priors(one, [priors[i] for i in problem.places[name]])
            for name, one in problem.experiments.items()
        }
        return replace(problem, free=free, experiments=experiments)
    return replace(problem, free=free)


def possible_range(problem: Problem | JointProblem, label: str) -> tuple[float, float]:
    """What a free parameter can be, and parameters tied to it with it, in SI.

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> possible_range(load_problem("forearm-glass"), "layer_thickness")
    (0.0, inf)
    """
    name = label.partition("[")[0]
    tied = [(p.name, p.times) for p in problem.tied if p.same_as in (name, label)]
    known = [(quantity, times) for n, times in [(name, 1.0), *tied] if (quantity := lookup(n))]
    return (
        max((quantity.lower / times for quantity, times in known), default=-inf),
        min((quantity.upper / times for quantity, times in known), default=inf),
    )
