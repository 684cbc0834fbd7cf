"""A joint distribution made of draws: margins as they are, dependence as that of normal variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

FEWEST_DRAWS = 100
"""Draws below which quantiles and correlations say too little."""

_SCORES = np.linspace(-3.5, 3.5, 141)
"""Normal scores at which quantiles are kept; beyond them, in 5e-4 of a margin, its ends stand."""


@dataclass(frozen=True, eq=False)
class GaussianCopula:
    """A map from independent standard normal variables to dependent quantities.

    Each quantity has the distribution that draws of it have, interpolated between quantiles; the dependence between them is that
    of normal variables with the correlations of their normal scores. Exact for any monotone functions of normal variables.

    Attributes
    ----------
    names : of the D quantities
    quantiles : of each at normal scores from −3.5 to 3.5, shape ``(D, Q)``, in its unit
    factor : lower triangular Cholesky factor of the correlations, shape ``(D, D)``

    References
    ----------
    Nelsen, An Introduction to Copulas (2006), Sect. 2.3, doi 10.1007/0-387-28678-0.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> height = np.exp(rng.normal(size=2000))
    >>> copula = GaussianCopula.of_draws(["height", "twice"], np.stack([height, 2 * height], axis=-1))
    >>> copula.values(np.zeros(2)).round(1).tolist()
    [1.0, 2.0]
    """

    names: tuple[str, ...]
    quantiles: FloatArray
    factor: FloatArray

    @classmethod
    def of_draws(cls, names: Sequence[str], draws: FloatArray) -> GaussianCopula:
        """The distribution of draws of equal weight.

        Parameters
        ----------
        names : of the D quantities
        draws : shape ``(n, D)``, finite

        Returns
        -------
        GaussianCopula

        Raises
        ------
        InputError
            Fewer than 100 draws, some that are not finite, or a quantity that does not vary.

        Examples
        --------
        >>> GaussianCopula.of_draws(["height"], height[:, None]).names
        ('height',)
        """
        from scipy.stats import rankdata

        draws = np.asarray(draws, dtype=float)
        if len(draws) < FEWEST_DRAWS or not np.isfinite(draws).all():
            raise InputError(f"{len(draws)} draws; expected at least {FEWEST_DRAWS}, all of them finite")
        for name, column in zip(names, draws.T, strict=True):
            if column.min() == column.max():
                raise InputError(f"{name} is {column[0]:g} in all draws; expected draws that differ")
        quantiles = np.quantile(draws, special.ndtr(_SCORES), axis=0).T
        scores = special.ndtri((rankdata(draws, axis=0) - 0.5) / len(draws))
        correlation = np.corrcoef(scores, rowvar=False).reshape(len(names), len(names))
        # two that determine each other leave a matrix that is singular by rounding
        factor = np.linalg.cholesky(correlation + 1e-12 * np.eye(len(names)))
        return cls(tuple(names), quantiles, factor)

    def values(self, normal: FloatArray) -> FloatArray:
        """The quantities for independent standard normal variables.

        Parameters
        ----------
        normal : shape ``(..., D)``

        Returns
        -------
        ndarray
            Shape ``(..., D)``, each quantity in its unit.

        Examples
        --------
        >>> bool(np.median(copula.values(rng.normal(size=(999, 2)))[:, 0]) > 0.9)
        True
        """
        normal = np.asarray(normal, dtype=float)
        # sums along a contiguous last axis, so that a batch and its rows agree to the last bit
        scores = np.ascontiguousarray(normal[..., None, :] * self.factor).sum(axis=-1)
        columns = [
            np.interp(scores[..., i], _SCORES, quantiles) for i, quantiles in enumerate(self.quantiles)
        ]
        return np.stack(columns, axis=-1)
