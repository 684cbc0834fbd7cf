"""A table of films under rough lubricated balls: what it holds, and how it is stored."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.lubrication.film_axes import FILM_PARAMETERS, FilmAxes, film_parameters
from skinbayes.lubrication.film_reference import SmoothFilms

VERSION = 1
"""Of what the numbers in a table mean; tables of another version are refused."""

ANCHORS = 2
"""Numbers before the outputs of a material: ln λ that speeds are counted from, and the unit of ln λ."""

SLOWEST, FASTEST = -1.3, 1.35
"""Ends of the speeds in the unit of a material. Asperities carry half of the load at 0 and 1e-3 of it at 1."""


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmTable:
    """Films of a rough ball as functions of λ and the axes: Chebyshev polynomials of the axes, cubic splines of ln λ.

    Attributes
    ----------
    axes : what varies, and within which ranges
    poisson_ratio_bulk : ν1, dimensionless
    coefficients : dimensionless, shape ``(n1, …, nA, 2 + 6 (S + 2))``; Chebyshev coefficients along the axes of the
        anchors and of the B-spline coefficients of the six outputs
    speeds : S, number of speeds, dimensionless
    smooth : films of the smooth ball, which the outputs but the boundary term and the load share are relative to
    held_out : median, 99th percentile and largest relative error of the friction coefficient at random places,
        dimensionless, shape ``(3,)``
    held_out_count : number of these places, dimensionless
    """

    axes: FilmAxes
    poisson_ratio_bulk: float
    coefficients: FloatArray
    speeds: int
    smooth: SmoothFilms
    held_out: FloatArray
    held_out_count: int

    def to_arrays(self) -> tuple[dict[str, FloatArray], dict[str, Any]]:
        """Everything as arrays by name, and the rest as numbers and texts that JSON can hold; no objects."""
        axes = self.axes
        arrays = {
            "coefficients": self.coefficients,
            "smooth_coefficients": self.smooth.coefficients,
            "held_out": self.held_out,
            **{f"axes_{name}": getattr(axes, name) for name in _AXES_ARRAYS},
        }
        metadata = {
            "version": VERSION,
            "axes": list(axes.names),
            "counts": list(axes.counts),
            "homogeneous": axes.homogeneous,
            "ended": axes.ended,
            "side": axes.side,
            "end_offset": axes.end_offset,
            "speeds": self.speeds,
            "smooth_lowest": self.smooth.lowest,
            "smooth_step": self.smooth.step,
            "poisson_ratio_bulk": self.poisson_ratio_bulk,
            "held_out_count": self.held_out_count,
        }
        return arrays, metadata

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Any], metadata: Mapping[str, Any]) -> FilmTable:
        """The table that `to_arrays` took apart.

        Raises
        ------
        InputError
            if it is of another version or something is missing
        """
        if metadata.get("version") != VERSION:
            raise InputError(
                f"A table of films has version {metadata.get('version')}, but this program reads version {VERSION}."
            )
        try:
            parts = {name: np.asarray(array, dtype=np.float64) for name, array in arrays.items()}
            axes = FilmAxes(
                names=tuple(metadata["axes"]),
                homogeneous=bool(metadata.get("homogeneous", False)),
                ended=int(metadata["ended"]),
                side=float(metadata["side"]),
                end_offset=float(metadata["end_offset"]),
                counts=tuple(int(count) for count in metadata["counts"]),
                **{name: parts[f"axes_{name}"] for name in _AXES_ARRAYS},
            )
            smooth = SmoothFilms(
                parts["smooth_coefficients"], float(metadata["smooth_lowest"]), float(metadata["smooth_step"])
            )
            return cls(
                axes=axes,
                coefficients=np.ascontiguousarray(parts["coefficients"]),
                speeds=int(metadata["speeds"]),
                smooth=smooth,
                poisson_ratio_bulk=float(metadata["poisson_ratio_bulk"]),
                held_out=parts["held_out"],
                held_out_count=int(metadata["held_out_count"]),
            )
        except KeyError as missing:
            raise InputError(f"A table of films lacks {missing.args[0]}.") from None

    def contains(self, **parameters: Any) -> NDArray[np.bool_]:
        """Where the table holds parameters (SI, broadcast), or balls that are similar.

        They are named as `FILM_PARAMETERS`, or as `HOMOGENEOUS_PARAMETERS`.
        """
        with np.errstate(all="ignore"):
            named = film_parameters(parameters, 1.0)
            logs = [np.log(np.asarray(named[name], dtype=np.float64)) for name in FILM_PARAMETERS]
        return self.axes.contains(logs)


_AXES_ARRAYS = ("combination", "offset", "excluded", "excluded_at", "reference", "low", "high", "end")
