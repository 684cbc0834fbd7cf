"""Looking at several experiments before sampling: each by itself, and what all of their data can tell together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.diagnose.identifiability import identify
from skinbayes.phrases import and_list
from skinbayes.problem.check import (
    DRAWS,
    FEW_POINTS,
    FEWEST_DRAWS,
    POINTS,
    PREDICTIONS,
    CheckReport,
    entering,
    predictions_over,
    prior_sentences,
    scattered,
    setup,
    solved_anew,
    with_others,
)
from skinbayes.problem.failures import explained

if TYPE_CHECKING:
    from skinbayes.problem.joint_densities import JointModel


def check_joint(problem: JointModel, seed: int = 1) -> CheckReport:
    """Check experiments that share parameters before sampling.

    Parameters
    ----------
    problem : the experiments
    seed : seed of the prior draws

    Raises
    ------
    InputError
        No prior draw gives finite predictions for one of the experiments.
    """
    parts = problem.parts
    slow = any(solved_anew(part) for part, _ in parts.values())
    rows = max(part.conditions.n_rows for part, _ in parts.values())
    count = max(FEWEST_DRAWS, min(FEWEST_DRAWS if slow else DRAWS, PREDICTIONS // rows))
    draws = problem.draw_prior(np.random.default_rng([seed, 3]), count) if problem.free else np.zeros((1, 0))
    said: list[str] = []
    positive, usable = {}, np.ones(len(draws), dtype=bool)
    for name, (part, place) in parts.items():
        sentences, finite, positive[name] = predictions_over(part, draws[:, place])
        said += [f"{name}: {sentence}" for sentence in sentences]
        usable &= finite
    places = entering(problem)
    found = None
    if places and usable.any():
        centre = problem.prior_medians()
        each = [
            (scattered(part, centre[place], positive[name]), place) for name, (part, place) in parts.items()
        ]
        full = with_others(centre, places)

        def predict(theta: FloatArray) -> FloatArray:
            vectors = full(theta)
            return np.concatenate([one(vectors[:, place]) for one, place in each], axis=-1)

        ends = np.cumsum([0, *(one(centre[np.newaxis, place]).shape[-1] for one, place in each)])
        with explained(problem.spec.path, "what the data can tell cannot be computed"):
            found = identify(
                [problem.names[i] for i in places],
                predict,
                draws[usable][:, places],
                1.0,
                rows=len(problem.observed),
                groups={name: np.arange(*ends[i : i + 2]) for i, name in enumerate(parts)},
                maximum_draws=FEW_POINTS if slow else POINTS,
            )
    return CheckReport(problem.name, _setup(problem), prior_sentences(problem), tuple(said), found)


def _setup(problem: JointModel) -> tuple[str, ...]:
    said = [
        f"'{problem.name}' has {len(problem.free)} free inputs for {len(problem.experiments)} experiments on one skin: "
        f"{and_list(list(problem.experiments))}."
    ]
    if common := shared_names(problem):
        said.append(f"Informed by more than one of them: {and_list(common)}.")
    else:
        said.append("They share no free parameter: each could as well be fitted alone.")
    said += [f"{name}: {entry}" for name, part in problem.experiments.items() for entry in setup(part)[1:]]
    return tuple(said)


def shared_names(problem: JointModel) -> list[str]:
    """Free parameters that more than one experiment has."""
    count = np.bincount(np.concatenate(list(problem.places.values())), minlength=problem.dimension)
    return [name for name, experiments in zip(problem.names, count, strict=True) if experiments > 1]
