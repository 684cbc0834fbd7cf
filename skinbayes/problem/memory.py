"""Coordinates of a problem whose noise has a memory."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np

from skinbayes.problem.joint_densities import JointModel
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.statistics.innovations import Innovations, InnovationTransform
from skinbayes.statistics.transforms import Transform, VectorTransform

LOGARITHM = Transform("log", 0.0, inf)


def with_innovations(problem: StatisticalModel | JointModel, usual: VectorTransform) -> VectorTransform:
    """The coordinates of a problem, with innovations in place of the scale of noise whose length of memory is free too.

    Parameters
    ----------
    problem : of one experiment or several
    usual : its coordinates so far
    """
    memories: list[Innovations] = []
    for part, place in problem.parts.values():
        memory = _memory(part, place.tolist())
        if memory is not None and all(memory.places.isdisjoint(other.places) for other in memories):
            memories.append(memory)
    if not memories:
        return usual
    transforms = list(usual.transforms)
    for i in (i for memory in memories for i in memory.scales):
        transforms[i] = LOGARITHM  # a bounded scale gets walls: its logit would bend the ridge
    return InnovationTransform(
        tuple(transforms), replace(usual, transforms=tuple(transforms)), tuple(memories)
    )


def _memory(part: StatisticalModel, place: list[int]) -> Innovations | None:
    """The memory of the noise of one experiment; None without one, or if scale or length of the noise are not free."""
    noise = getattr(part.shared, "noise", None)
    labels = part.names
    scales = tuple(place[i] for i, p in enumerate(part.free) if p.name == "noise_scale")
    if noise is None or not scales or "correlation_length" not in labels:
        return None
    independent: int | float = 0.0
    if "independent_fraction" in labels:
        independent = place[labels.index("independent_fraction")]
    elif noise.independent:
        independent = float(next(p.value or 0.0 for p in part.fixed if p.name == "independent_fraction"))
    gap = float(np.median(noise.gap[np.isfinite(noise.gap)]))
    return Innovations(scales, place[labels.index("correlation_length")], gap, independent)
