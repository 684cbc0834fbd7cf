"""Maps between the support of a parameter and the whole real line, and their Jacobians."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import inf, isnan
from typing import Literal

import numpy as np
from scipy import special

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError

Kind = Literal["identity", "log", "log_below", "logit", "log_logit"]

WIDE_RANGE = 10.0
"""A positive range whose ends differ by more than this factor is spread evenly in ln x rather than in x."""


def _forward(kind: Kind, x: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    if kind == "identity":
        return x
    if kind == "log":
        return np.log(x - lower)
    if kind == "log_below":
        return -np.log(upper - x)
    if kind == "logit":
        return np.log(x - lower) - np.log(upper - x)
    return np.log(np.log(x / lower)) - np.log(np.log(upper / x))


def _between(z: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    # measured from the nearer end, so that small distances to either end keep their digits
    width = upper - lower
    return np.where(z < 0.0, lower + width * special.expit(z), upper - width * special.expit(-z))


def _inverse(kind: Kind, z: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    if kind == "identity":
        return z
    if kind == "log":
        return lower + np.exp(z)
    if kind == "log_below":
        return upper - np.exp(-z)
    if kind == "logit":
        return _between(z, lower, upper)
    ratio = np.log(upper / lower)
    return np.where(
        z < 0.0, lower * np.exp(ratio * special.expit(z)), upper * np.exp(-ratio * special.expit(-z))
    )


def _log_jacobian(kind: Kind, z: FloatArray, lower: FloatArray, upper: FloatArray) -> FloatArray:
    if kind == "identity":
        return np.zeros_like(z)
    if kind == "log":
        return z
    if kind == "log_below":
        return -z
    slope = special.log_expit(z) + special.log_expit(-z)
    if kind == "logit":
        return slope + np.log(upper - lower)
    ratio = np.log(upper / lower)
    log_x = np.where(
        z < 0.0, np.log(lower) + ratio * special.expit(z), np.log(upper) - ratio * special.expit(-z)
    )
    return slope + np.log(ratio) + log_x


@dataclass(frozen=True)
class Transform:
    """An increasing map of one coordinate, x in its support to z on the real line. Frozen, picklable.

    Attributes
    ----------
    kind : ``identity`` z = x; ``log`` z = ln(x − lower); ``log_below`` z = −ln(upper − x);
        ``logit`` z = ln[(x − lower)/(upper − x)]; ``log_logit`` the same for
        ln x between the logarithms of the ends
    lower, upper : the support, in the unit of the parameter
    """

    kind: Kind = "identity"
    lower: float = -inf
    upper: float = inf

    def _ends(self) -> tuple[FloatArray, FloatArray]:
        return np.asarray(self.lower), np.asarray(self.upper)

    def forward(self, x: ArrayLike) -> FloatArray:
        """z of ``x`` (any shape, unit of the parameter); ±inf at the ends of the support, NaN beyond."""
        with np.errstate(all="ignore"):
            return _forward(self.kind, np.asarray(x, dtype=float), *self._ends())

    def inverse(self, z: ArrayLike) -> FloatArray:
        """x of ``z`` (any shape, dimensionless), in the unit of the parameter.

        Examples
        --------
        >>> float(transform_for((0.0, 4.0)).inverse(0.0))
        2.0
        """
        with np.errstate(all="ignore"):
            return _inverse(self.kind, np.asarray(z, dtype=float, order="C"), *self._ends())

    def log_jacobian(self, z: ArrayLike) -> FloatArray:
        """ln |dx/dz| at ``z`` (any shape), in ln(unit); log-density of z = that of x plus this."""
        with np.errstate(all="ignore"):
            return _log_jacobian(self.kind, np.asarray(z, dtype=float, order="C"), *self._ends())


def transform_for(support: tuple[float, float]) -> Transform:
    """The map that suits a support.

    Parameters
    ----------
    support : ``(lower, upper)``, in the unit of the parameter; either may be infinite

    Returns
    -------
    identity for the whole line, ``log`` for a lower end, ``log_below`` for an upper end, ``logit`` for both,
    and ``log_logit`` for two positive ends more than a factor 10 apart (so that a range of decades is not
    squeezed into the last one)

    Raises
    ------
    InputError
        if lower is not below upper

    Examples
    --------
    >>> transform_for((0.0, float("inf"))).kind, transform_for((1e3, 1e9)).kind
    ('log', 'log_logit')
    """
    lower, upper = float(support[0]), float(support[1])
    if isnan(lower) or isnan(upper) or not lower < upper:
        raise InputError(f"A support from {lower:g} to {upper:g} is empty; lower must be below upper.")
    kind: Kind
    if lower == -inf:
        kind = "identity" if upper == inf else "log_below"
    elif upper == inf:
        kind = "log"
    else:
        kind = "log_logit" if lower > 0.0 and upper / lower > WIDE_RANGE else "logit"
    return Transform(kind, lower, upper)


@dataclass(frozen=True)
class VectorTransform:
    """One :class:`Transform` per coordinate, applied to batches of vectors. Frozen, picklable.

    Attributes
    ----------
    transforms : D maps, in the order of the coordinates
    """

    transforms: tuple[Transform, ...]

    @staticmethod
    def for_supports(supports: Sequence[tuple[float, float]]) -> VectorTransform:
        """The maps that suit the supports of D coordinates (see :func:`transform_for`)."""
        return VectorTransform(tuple(transform_for(support) for support in supports))

    @cached_property
    def _blocks(self) -> tuple[tuple[Kind, slice | list[int], FloatArray, FloatArray], ...]:
        """Coordinates of the same kind together: one NumPy call for each kind, not for each coordinate."""
        blocks = []
        for kind in dict.fromkeys(transform.kind for transform in self.transforms):
            index = [i for i, transform in enumerate(self.transforms) if transform.kind == kind]
            lower = np.array([self.transforms[i].lower for i in index])
            upper = np.array([self.transforms[i].upper for i in index])
            columns = slice(None) if len(index) == len(self.transforms) else index
            blocks.append((kind, columns, lower, upper))
        return tuple(blocks)

    def forward(self, x: FloatArray) -> FloatArray:
        """Natural coordinates ``(B, D)`` to unconstrained ones ``(B, D)``; NaN outside the support."""
        result = np.empty(x.shape)
        with np.errstate(all="ignore"):
            for kind, columns, lower, upper in self._blocks:
                result[..., columns] = _forward(kind, np.ascontiguousarray(x[..., columns]), lower, upper)
        return result

    def inverse(self, z: FloatArray) -> FloatArray:
        """Unconstrained coordinates ``(B, D)`` to natural ones ``(B, D)``."""
        result = np.empty(z.shape)
        with np.errstate(all="ignore"):
            for kind, columns, lower, upper in self._blocks:
                result[..., columns] = _inverse(kind, np.ascontiguousarray(z[..., columns]), lower, upper)
        return result

    def log_jacobian(self, z: FloatArray) -> FloatArray:
        """ln |det dx/dz| of each row of ``z`` (shape ``(B, D)``), shape ``(B,)``."""
        return np.asarray(self.log_jacobian_each(z).sum(axis=-1))

    def log_jacobian_each(self, z: FloatArray) -> FloatArray:
        """ln |dx/dz| of each coordinate, shape of ``z``."""
        terms = np.empty(z.shape)
        with np.errstate(all="ignore"):
            for kind, columns, lower, upper in self._blocks:
                terms[..., columns] = _log_jacobian(kind, np.ascontiguousarray(z[..., columns]), lower, upper)
        return terms
