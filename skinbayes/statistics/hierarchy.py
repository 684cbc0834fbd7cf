"""The structure of a hierarchical model, as moves that go level by level need it.

A value of one level is, on the scale on which the population is normal, the sum of terms ``location + scale · deviate``. The
deviates have standard normal priors: the non-centred form, in which priors are independent and the density is what it is whatever
moves are used. Given everything that levels share, levels are independent of each other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinbayes.statistics.transforms import Transform


@dataclass(frozen=True, eq=False)
class Term:
    """Deviates of one population.

    Attributes
    ----------
    deviates : their places among the parameters, shape ``(J,)``
    location : place of what their values are about, −1 if that is fixed
    location_value : its value, on the scale of the population, if it is fixed
    natural : map of the location to that scale
    scale : place of their standard deviation, −1 if that is fixed
    scale_value : its value if it is fixed
    """

    deviates: NDArray[np.intp]
    location: int
    location_value: float
    natural: Transform
    scale: int
    scale_value: float

    @property
    def shared(self) -> list[int]:
        """Places of its location and scale as far as they are free."""
        return [place for place in (self.location, self.scale) if place >= 0]


@dataclass(frozen=True, eq=False)
class Grouping:
    """Levels of one column, each with deviates of its own.

    Attributes
    ----------
    column : name
    blocks : places of the deviates of each level, ``(J, K)``, −1 where a level has fewer
    terms : number of the term of each, same shape
    level : of each datum, shape ``(M,)``
    """

    column: str
    blocks: NDArray[np.intp]
    terms: NDArray[np.intp]
    level: NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Which parameters belong to single levels, and which all share.

    Attributes
    ----------
    terms : populations
    groupings : columns whose levels are moved one apart from the other; no deviate is in two of them
    dimension : number of parameters D
    """

    terms: tuple[Term, ...]
    groupings: tuple[Grouping, ...]
    dimension: int

    @property
    def shared(self) -> NDArray[np.intp]:
        """Places of the parameters that are no deviates."""
        deviates = np.concatenate([term.deviates for term in self.terms])
        return np.setdiff1d(np.arange(self.dimension), deviates)

    @property
    def together(self) -> int:
        """The largest number of parameters that are moved together."""
        return max(len(self.shared), *(grouping.blocks.shape[1] for grouping in self.groupings))
