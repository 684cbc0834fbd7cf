"""A problem whose data are simulated ones."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, overload

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.joint_densities import split
from skinbayes.problem.possible import has_value

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem


@overload
def with_data(problem: Problem, data: FloatArray) -> Problem: ...


@overload
def with_data(problem: JointProblem, data: FloatArray) -> JointProblem: ...


def with_data(problem: Problem | JointProblem, data: FloatArray) -> Problem | JointProblem:
    """The problem with other data at the same rows, such as simulated ones.

    A known spread stays that of its row; where ln of the data scatters it is the spread relative to the datum that stays, as that
    is what the simulated data scattered with.

    Parameters
    ----------
    problem : a problem with data, or several experiments
    data : shape ``(M,)``, SI: those of the first observable, then those of the second, … experiment by experiment

    Returns
    -------
    Problem or JointProblem
        what the forward model has prepared is shared

    Examples
    --------
    >>> from skinbayes.problem import load_problem
    >>> with_data(load_problem("forearm-glass"), np.array([0.4, 1.3])).observed.tolist()
    [0.4, 1.3]
    """
    if isinstance(problem, JointProblem):
        each = split(problem, data)
        return replace(
            problem,
            experiments={name: with_data(one, each[name]) for name, one in problem.experiments.items()},
        )
    parts = np.split(data, len(problem.observations))
    observations = tuple(
        replace(o, values=values, spread=o.spread * values / o.values if o.noise.logarithmic else o.spread)
        for o, values in zip(problem.observations, parts, strict=True)
    )
    changed = replace(problem, observations=observations)
    changed.__dict__["model"] = problem.model  # what is prepared depends on priors and rows only
    return changed


def draw_possible(problem: Problem | JointProblem, rng: np.random.Generator) -> FloatArray | None:
    """One draw of the prior, ``(D,)`` in SI; None where the forward model cannot predict all data.

    The posterior gives no weight to what cannot be predicted: the prior of simulated data is the one without it, so that
    who is given None draws again, the model too if there are several.

    Parameters
    ----------
    problem : with data
    rng : source of randomness
    """
    theta = problem.draw_prior(rng, 1)
    possible = all(
        has_value(name, values).all()
        for part, place in problem.parts.values()
        for name, values in part.predict(theta[:, place]).items()
        if name in part.observables
    )
    return theta[0] if possible else None
