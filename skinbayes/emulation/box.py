"""A box of named inputs, and places in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import reduce
from itertools import product

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.emulation.chebyshev import lobatto

Places = Mapping[str, FloatArray]
"""Name of an input to its values at M places, shape ``(M,)``, or ``(1,)`` if they are the same at all."""

_ROUNDING = 1e-9  # by which a place may lie outside
_MOST_VARYING = 12


@dataclass(frozen=True, eq=False)
class Box:
    """Inputs between two ends each.

    Attributes
    ----------
    ends : name of an input to its smallest and largest value, equal for one that does not vary
    """

    ends: Mapping[str, tuple[float, float]]

    @classmethod
    def around(cls, places: Places) -> Box:
        """The smallest box that holds some places."""
        return cls({name: (float(np.min(x)), float(np.max(x))) for name, x in places.items()})

    @property
    def varying(self) -> tuple[str, ...]:
        """Names of the inputs that vary."""
        return tuple(name for name, (low, high) in self.ends.items() if high > low)

    def covers(self, places: Places, last: Places | None = None) -> BoolArray:
        """Where places, or all from there to ``last``, are inside, up to rounding."""
        end = places if last is None else last
        inside = [
            (places[name] >= low - _ROUNDING) & (end[name] <= high + _ROUNDING)
            for name, (low, high) in self.ends.items()
        ]
        return np.asarray(reduce(np.logical_and, inside))

    def scaled(self, places: Places) -> list[FloatArray]:
        """Inputs that vary, each from −1 to 1."""
        ends = [(name, *self.ends[name]) for name in self.varying]
        return [np.asarray(2 * (places[name] - low) / (high - low) - 1) for name, low, high in ends]

    def corners(self) -> dict[str, FloatArray] | None:
        """All inputs at the corners; None if more than twelve of them vary.

        Examples
        --------
        >>> Box({"rms_height": (1e-5, 3e-5), "temperature": (293.0, 293.0)}).corners()
        {'rms_height': array([1.e-05, 3.e-05]), 'temperature': array([293., 293.])}
        """
        if len(self.varying) > _MOST_VARYING:
            return None
        found = np.array(list(product(*(sorted(set(ends)) for ends in self.ends.values())))).T
        return dict(zip(self.ends, found, strict=True))

    def whole(self, places: Places) -> dict[str, FloatArray]:
        """Places given by the inputs that vary, with the others."""
        return {name: np.array([low]) for name, (low, _) in self.ends.items()} | dict(places)

    def grid(self, counts: Mapping[str, int]) -> dict[str, FloatArray]:
        """All inputs at all combinations of given numbers of Chebyshev nodes, the last input changing first."""
        ends = [(*self.ends[name], count) for name, count in counts.items()]
        nodes = [low + (high - low) * lobatto(count) for low, high, count in ends]
        mesh = (x.reshape(-1) for x in np.meshgrid(*nodes, indexing="ij"))
        return self.whole(dict(zip(counts, mesh, strict=True)))

    def random(self, count: int, seed: int) -> dict[str, FloatArray]:
        """All inputs at random places."""
        rng = np.random.default_rng(seed)
        return self.whole({name: rng.uniform(*self.ends[name], count) for name in self.varying})

    def line(self, name: str) -> Box:
        """The line along one input through the middle of the others."""
        middle = {other: ((low + high) / 2,) * 2 for other, (low, high) in self.ends.items()}
        return Box({**middle, name: self.ends[name]})
