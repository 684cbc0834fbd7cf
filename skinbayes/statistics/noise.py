"""Noise families: how data scatter about a prediction.

Each family gives pointwise log-densities and draws for a batch of B parameter vectors and N rows of data.
Three contributions are added in quadrature to one width w for each row:

- ``scale``, the scatter that is fitted (dimensionless for the families marked ``relative``),
- ``spread``, a known standard deviation of each datum, in the unit of the observable,
- ``discrepancy``, an independent error of the model itself, as a share of the prediction.

============== ====================== ==============================================
family         distribution           w²
============== ====================== ==============================================
gaussian       normal about f         scale² + spread² + (discrepancy f)²
relative       normal about f         (scale f)² + spread² + (discrepancy f)²
lognormal      ln y normal about ln f scale² + (spread/y)² + discrepancy²
student_t      t about f              as gaussian
log_student_t  ln y t about ln f      as lognormal
============== ====================== ==============================================

For Student's t, w is the scale, not the standard deviation; the known spread is widened by the same tails.
In the logarithmic families spread/y is a property of the datum as it was reported: it does not change when
another value of y is drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, log, pi

import numpy as np
from scipy import special

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError

_HALF_LOG_TWO_PI = 0.5 * log(2.0 * pi)

Standardised = Callable[[FloatArray, FloatArray | None], FloatArray]


def _normal(z: FloatArray, degrees_of_freedom: FloatArray | None) -> FloatArray:
    return -0.5 * z * z - _HALF_LOG_TWO_PI


def _student(z: FloatArray, degrees_of_freedom: FloatArray | None) -> FloatArray:
    assert degrees_of_freedom is not None
    half = 0.5 * degrees_of_freedom
    normalisation = -special.betaln(half, 0.5) - 0.5 * np.log(degrees_of_freedom)
    return normalisation - (half + 0.5) * np.log1p(z * z / degrees_of_freedom)


@dataclass(frozen=True)
class NoiseFamily:
    """One family of scatter. Frozen, picklable.

    Attributes
    ----------
    name : the key in a model file
    description : one line
    parameters : names of its parameters: ``scale`` and, for heavy tails, ``degrees_of_freedom``
    relative : True if ``scale`` is dimensionless (a share of the prediction, or a standard deviation of ln)
    logarithmic : True if ln of the data scatters, so that data and predictions must be positive
    """

    name: str
    description: str
    parameters: tuple[str, ...]
    relative: bool
    logarithmic: bool

    @property
    def heavy_tailed(self) -> bool:
        """True if the family has ``degrees_of_freedom``."""
        return "degrees_of_freedom" in self.parameters

    @property
    def closed_form_groups(self) -> bool:
        """True if effects that groups of data share can be integrated out: normal, with a width that f does not set."""
        return not self.heavy_tailed and (self.logarithmic or not self.relative)

    def residual(self, observed: ArrayLike, predicted: ArrayLike) -> FloatArray:
        """What scatters: y − f, or ln y − ln f in the logarithmic families; NaN where that is not defined.

        Parameters
        ----------
        observed : data y, shape ``(N,)``, unit of the observable
        predicted : prediction f, shape ``(B, N)``, unit of the observable

        Returns
        -------
        r, shape ``(B, N)``: unit of the observable, or dimensionless for the logarithmic families
        """
        y, f = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
        if not self.logarithmic:
            return y - f
        with np.errstate(all="ignore"):
            return np.where((f > 0.0) & (y > 0.0), np.log(y) - np.log(f), np.nan)

    def width(
        self,
        predicted: ArrayLike,
        scale: ArrayLike,
        spread: ArrayLike = 0.0,
        discrepancy: ArrayLike = 0.0,
        observed: ArrayLike | None = None,
    ) -> FloatArray:
        """The combined width w of the module's table.

        Parameters
        ----------
        predicted : prediction f, shape ``(B, N)``, unit of the observable
        scale : fitted scatter, broadcasts to ``(B, N)``; dimensionless if ``relative``, else unit of the
            observable
        spread : known standard deviations, shape ``(N,)`` or 0, unit of the observable
        discrepancy : independent relative model error, broadcasts to ``(B, N)``, dimensionless
        observed : data that ``spread`` belongs to, shape ``(N,)``, unit of the observable; used by the
            logarithmic families to make the spread relative (by the prediction if None)

        Returns
        -------
        w, shape ``(B, N)``: unit of the observable, or dimensionless for the logarithmic families
        """
        f, s, e, d = (np.asarray(value, dtype=float) for value in (predicted, scale, spread, discrepancy))
        with np.errstate(all="ignore"):
            if self.logarithmic:
                # an exact datum stays exact where its value is zero
                known = np.where(
                    e > 0.0, e / (f if observed is None else np.asarray(observed, dtype=float)), 0.0
                )
                variance = s * s + known * known + d * d
            elif self.relative:
                variance = (s * s + d * d) * (f * f) + e * e
            else:
                variance = s * s + e * e + (d * f) * (d * f)
            # a negative scale is impossible, not a positive one in disguise
            return np.broadcast_to(
                np.where(s >= 0.0, np.sqrt(variance), np.nan), np.broadcast_shapes(f.shape, s.shape)
            )

    def log_density(
        self,
        observed: ArrayLike,
        predicted: ArrayLike,
        scale: ArrayLike,
        spread: ArrayLike = 0.0,
        degrees_of_freedom: ArrayLike | None = None,
        discrepancy: ArrayLike = 0.0,
    ) -> FloatArray:
        """Pointwise log-density of data.

        Parameters
        ----------
        observed : data y, shape ``(N,)``, unit of the observable
        predicted, scale, spread, discrepancy : see :meth:`width`
        degrees_of_freedom : of Student's t, broadcasts to ``(B, N)``, dimensionless, > 0

        Returns
        -------
        ln p(y), shape ``(B, N)``, in ln(1/unit); −inf (never NaN) for anything impossible: a prediction that
        is not finite, a width that is not positive, a prediction or datum ≤ 0 in a logarithmic family

        Raises
        ------
        TypeError
            if ``degrees_of_freedom`` is missing for a family that has it

        Examples
        --------
        >>> value = noise_family("gaussian").log_density([1.0], [[1.0], [3.0]], 1.0)
        >>> print(value.round(4).tolist())
        [[-0.9189], [-2.9189]]
        """
        y, f = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
        tails = self._tails(degrees_of_freedom)
        with np.errstate(all="ignore"):
            w = self.width(f, scale, spread, discrepancy, y)
            kernel = _normal if tails is None else _student
            if self.logarithmic:
                log_y = np.log(y)
                value = kernel((log_y - np.log(f)) / w, tails) - np.log(w) - log_y
                possible = (f > 0.0) & (y > 0.0)
            else:
                value = kernel((y - f) / w, tails) - np.log(w)
                possible = np.isfinite(f) & np.isfinite(y)
            possible = possible & (w > 0.0) & (w < inf) & (value < inf)
        return np.where(possible, value, -inf)

    def draw(
        self,
        rng: np.random.Generator,
        predicted: ArrayLike,
        scale: ArrayLike,
        spread: ArrayLike = 0.0,
        degrees_of_freedom: ArrayLike | None = None,
        discrepancy: ArrayLike = 0.0,
        observed: ArrayLike | None = None,
    ) -> FloatArray:
        """Data drawn about predictions.

        Parameters
        ----------
        rng : source of randomness
        predicted, scale, spread, discrepancy, observed : see :meth:`width`
        degrees_of_freedom : see :meth:`log_density`

        Returns
        -------
        draws, shape ``(B, N)``, unit of the observable; NaN where :meth:`log_density` is −inf for all data
        """
        f = np.asarray(predicted, dtype=float)
        tails = self._tails(degrees_of_freedom)
        w = self.width(f, scale, spread, discrepancy, observed)
        shape = w.shape
        z = rng.standard_normal(shape) if tails is None else rng.standard_t(np.broadcast_to(tails, shape))
        with np.errstate(all="ignore"):
            if self.logarithmic:
                return np.where(f > 0.0, f * np.exp(w * z), np.nan)
            return np.where(np.isfinite(f), f + w * z, np.nan)

    def check_observed(self, observed: ArrayLike) -> None:
        """Refuse data that this family can never produce.

        Parameters
        ----------
        observed : data, shape ``(N,)``, unit of the observable

        Raises
        ------
        InputError
            if a datum is not finite, or not positive in a logarithmic family; names the row, counted from 1
        """
        y = np.asarray(observed, dtype=float)
        bad = ~np.isfinite(y) | ((y <= 0.0) if self.logarithmic else False)
        if bad.any():
            row = int(np.flatnonzero(bad)[0])
            expected = "a finite number > 0" if self.logarithmic else "a finite number"
            raise InputError(
                f"Row {row + 1} of the data is {y[row]:g}; noise '{self.name}' expects {expected}."
            )

    def _tails(self, degrees_of_freedom: ArrayLike | None) -> FloatArray | None:
        if not self.heavy_tailed:
            return None
        if degrees_of_freedom is None:
            raise TypeError(f"Noise '{self.name}' needs degrees_of_freedom.")
        tails = np.asarray(degrees_of_freedom, dtype=float)
        return np.where(tails > 0.0, tails, np.nan)


_ALL = (
    NoiseFamily("gaussian", "normal scatter of the same size everywhere", ("scale",), False, False),
    NoiseFamily("relative", "normal scatter in proportion to the prediction", ("scale",), True, False),
    NoiseFamily("lognormal", "normal scatter of ln; scale is its standard deviation", ("scale",), True, True),
    NoiseFamily(
        "student_t",
        "Student's t of the same scale everywhere; tolerates outliers",
        ("scale", "degrees_of_freedom"),
        False,
        False,
    ),
    NoiseFamily(
        "log_student_t",
        "Student's t of ln; positive data with outliers",
        ("scale", "degrees_of_freedom"),
        True,
        True,
    ),
)

NOISE_FAMILIES: dict[str, NoiseFamily] = {family.name: family for family in _ALL}
"""Every noise family by the name used in model files."""


def noise_family(name: str) -> NoiseFamily:
    """The noise family called ``name``.

    Raises
    ------
    InputError
        if there is none of that name

    Examples
    --------
    >>> noise_family("student_t").parameters
    ('scale', 'degrees_of_freedom')
    """
    if name not in NOISE_FAMILIES:
        raise InputError(f"There is no noise family '{name}'. Known: {', '.join(NOISE_FAMILIES)}.")
    return NOISE_FAMILIES[name]
