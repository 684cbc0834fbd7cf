"""Noise families: how data scatter about a prediction.

Each family gives pointwise log-densities and draws for a batch of B parameter vectors and N rows of data.
Three contributions are added in quadrature to one width w for each row:

- ``scale``, the scatter that is fitted (dimensionless for the families marked ``relative``),
- ``spread``, a known standard deviation of each datum, in the unit of the observable,
- ``discrepancy``, an independent error of the model itself, as a fraction of the prediction.

============== ====================== ==============================================
family         distribution           w²
============== ====================== ==============================================
gaussian       normal about f         scale² + spread² + (discrepancy f)²
relative       normal about f         (scale f)² + spread² + (discrepancy f)²
lognormal      ln y normal about ln f scale² + (spread/y)² + discrepancy²
student_t      t about f              as gaussian
log_student_t  ln y t about ln f      as lognormal
gamma          gamma of mean f        as lognormal
============== ====================== ==============================================

The shape of the distribution – its density and draws at width 1 – is part of the family, see
:mod:`skinbayes.statistics.noise_families`, where the families of this table are. For Student's t, w is the scale, not the
standard deviation; the known spread is widened by the same tails. For gamma, w is the standard deviation over the mean, and the
shape of the distribution changes with it.
In the logarithmic families spread/y is a property of the datum as it was reported: it does not change when
another value of y is drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError


@dataclass(frozen=True)
class NoiseFamily:
    """One family of scatter. Frozen; picklable if its two functions are (functions of a module, no lambdas).

    Attributes
    ----------
    name : the key in a model file
    description : one line
    standard_log_density : of the residual over its width: a function of ``z``, shape ``(B, N)``, dimensionless, and of the
        shape parameters as keywords, each of which broadcasts to ``(B, N)``; returns ln p(z), shape ``(B, N)``
    standard_draw : the same distribution: a function of a random generator, of a shape ``(B, N)``, and of the shape
        parameters; returns draws of ``z``
    relative : True if ``scale`` is dimensionless (a fraction of the prediction, or a standard deviation of ln)
    logarithmic : True if ln of the data scatters, so that data and predictions must be positive
    shape_parameters : names of the parameters beside the scale, dimensionless and positive, such as ``degrees_of_freedom``
    normal : True if the residual is normally distributed; only then can effects of groups be integrated out
    one_shape : False if the distribution of the residual changes its shape with the width: then the two functions are of the
        residual itself, not of the residual over its width, and take the width as a keyword

    Examples
    --------
    Examples of methods go on from this one.

    >>> from skinbayes.statistics import noise_family
    >>> gaussian, lognormal = noise_family("gaussian"), noise_family("lognormal")
    >>> lognormal.parameters, lognormal.logarithmic
    (('scale',), True)
    """

    name: str
    description: str
    standard_log_density: Callable[..., FloatArray]
    standard_draw: Callable[..., FloatArray]
    relative: bool
    logarithmic: bool
    shape_parameters: tuple[str, ...] = ()
    normal: bool = False
    one_shape: bool = True

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all its parameters: ``scale`` and those of the shape."""
        return ("scale", *self.shape_parameters)

    @property
    def closed_form_groups(self) -> bool:
        """True if effects that groups of data share can be integrated out: normal, with a width that f does not set."""
        return self.normal and (self.logarithmic or not self.relative)

    def residual(self, observed: ArrayLike, predicted: ArrayLike) -> FloatArray:
        """What scatters: y − f, or ln y − ln f in the logarithmic families; NaN where that is not defined.

        Parameters
        ----------
        observed : data y, shape ``(N,)``, unit of the observable
        predicted : prediction f, shape ``(B, N)``, unit of the observable

        Returns
        -------
        r, shape ``(B, N)``: unit of the observable, or dimensionless for the logarithmic families

        Examples
        --------
        >>> gaussian.residual([1.0], [[3.0]]).tolist(), lognormal.residual([1.0], [[np.e]]).tolist()
        ([[-2.0]], [[-1.0]])
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

        Examples
        --------
        >>> gaussian.width([[1.0]], 3.0, spread=4.0).tolist()
        [[5.0]]
        """
        f = np.asarray(predicted, dtype=float)
        with np.errstate(all="ignore"):
            width = self._width(f, scale, spread, discrepancy, observed)
        return np.broadcast_to(width, np.broadcast_shapes(f.shape, width.shape))

    def _width(
        self,
        f: FloatArray,
        scale: ArrayLike,
        spread: ArrayLike,
        discrepancy: ArrayLike,
        observed: ArrayLike | None,
    ) -> FloatArray:
        """The same, of a shape that broadcasts to ``(B, N)``; silences no warnings."""
        s, e, d = (np.asarray(value, dtype=float) for value in (scale, spread, discrepancy))
        if self.logarithmic:
            # an exact datum stays exact where its value is zero
            known = np.where(e > 0.0, e / (f if observed is None else np.asarray(observed, dtype=float)), 0.0)
            variance = s * s + known * known + d * d
        elif self.relative:
            variance = (s * s + d * d) * (f * f) + e * e
        else:
            variance = s * s + e * e + (d * f) * (d * f)
        # a negative scale is impossible, not a positive one in disguise
        return np.where(s >= 0.0, np.sqrt(variance), np.nan)

    def log_density(
        self,
        observed: ArrayLike,
        predicted: ArrayLike,
        scale: ArrayLike,
        spread: ArrayLike = 0.0,
        discrepancy: ArrayLike = 0.0,
        **shape: ArrayLike,
    ) -> FloatArray:
        """Pointwise log-density of data.

        Parameters
        ----------
        observed : data y, shape ``(N,)``, unit of the observable
        predicted, scale, spread, discrepancy : see :meth:`width`
        shape : the shape parameters of the family, such as ``degrees_of_freedom``; each broadcasts to ``(B, N)``,
            dimensionless, > 0

        Returns
        -------
        ln p(y), shape ``(B, N)``, in ln(1/unit); −inf (never NaN) for anything impossible: a prediction that
        is not finite, a width that is not positive, a prediction or datum ≤ 0 in a logarithmic family

        Raises
        ------
        TypeError
            if a shape parameter of the family is missing, or one is given that it does not have

        Examples
        --------
        >>> value = gaussian.log_density([1.0], [[1.0], [3.0]], 1.0)
        >>> print(value.round(4).tolist())
        [[-0.9189], [-2.9189]]
        """
        y, f = np.asarray(observed, dtype=float), np.asarray(predicted, dtype=float)
        with np.errstate(all="ignore"):
            return self.log_density_at(y, f, self._width(f, scale, spread, discrepancy, y), **shape)

    def log_density_at(
        self, observed: FloatArray, predicted: FloatArray, width: FloatArray, **shape: ArrayLike
    ) -> FloatArray:
        """:meth:`log_density` for a known width, such as one that no parameter changes; silences no warnings.

        Parameters
        ----------
        observed, predicted : arrays that broadcast, SI
        width : scale of the residuals, in their unit, from :meth:`width`
        **shape : values of the shape parameters

        Returns
        -------
        ndarray
            ln p(y | f), broadcast shape; −inf where the data are impossible.

        Examples
        --------
        >>> one = np.ones(1)
        >>> print(gaussian.log_density_at(one, one, one).round(4))
        [-0.9189]
        """
        known = self._shape(shape)
        log_y = np.log(observed) if self.logarithmic else 0.0
        z = (log_y - np.log(predicted)) if self.logarithmic else (observed - predicted)
        if self.one_shape:
            z = z / width
            value = self.standard_log_density(z, **known) - np.log(width) - log_y
        else:
            value = self.standard_log_density(z, width=width, **known) - log_y
        # z is not finite for all that is impossible but a width without end, whose density is zero
        return np.where(np.isfinite(z) & (value < inf), value, -inf)

    def draw(
        self,
        rng: np.random.Generator,
        predicted: ArrayLike,
        scale: ArrayLike,
        spread: ArrayLike = 0.0,
        discrepancy: ArrayLike = 0.0,
        observed: ArrayLike | None = None,
        **shape: ArrayLike,
    ) -> FloatArray:
        """Data drawn about predictions.

        Parameters
        ----------
        rng : source of randomness
        predicted, scale, spread, discrepancy, observed : see :meth:`width`
        shape : see :meth:`log_density`

        Returns
        -------
        draws, shape ``(B, N)``, unit of the observable; NaN where :meth:`log_density` is −inf for all data

        Raises
        ------
        TypeError
            as :meth:`log_density` does

        Examples
        --------
        >>> lognormal.draw(np.random.default_rng(1), [[1.0, -1.0]], 0.0).tolist()
        [[1.0, nan]]
        """
        f = np.asarray(predicted, dtype=float)
        return self.draw_at(rng, f, self.width(f, scale, spread, discrepancy, observed), **shape)

    def draw_at(
        self, rng: np.random.Generator, predicted: FloatArray, width: FloatArray, **shape: ArrayLike
    ) -> FloatArray:
        """:meth:`draw` for a known width, as :meth:`log_density_at` is of the density.

        Parameters
        ----------
        rng : source of randomness
        predicted : prediction f, shape ``(B, N)``, SI
        width : scale of the residuals, in their unit, from :meth:`width`, shape ``(B, N)``
        **shape : values of the shape parameters

        Returns
        -------
        ndarray
            Shape ``(B, N)``, SI.

        Examples
        --------
        >>> gaussian.draw_at(np.random.default_rng(1), np.ones((1, 2)), np.zeros((1, 2))).tolist()
        [[1.0, 1.0]]
        """
        with np.errstate(all="ignore"):
            if self.one_shape:
                residual = width * self.standard_draw(rng, width.shape, **self._shape(shape))
            else:
                residual = self.standard_draw(rng, width.shape, width=width, **self._shape(shape))
            if self.logarithmic:
                return np.where(predicted > 0.0, predicted * np.exp(residual), np.nan)
            return np.where(np.isfinite(predicted), predicted + residual, np.nan)

    def check_observed(self, observed: ArrayLike) -> None:
        """Refuse data that this family can never produce.

        Parameters
        ----------
        observed : data, shape ``(N,)``, unit of the observable

        Raises
        ------
        InputError
            if a datum is not finite, or not positive in a logarithmic family; names the row, counted from 1

        Examples
        --------
        >>> gaussian.check_observed([0.0, 1.0])
        >>> lognormal.check_observed([0.0, 1.0])
        Traceback (most recent call last):
        skinbayes.errors.InputError: Row 1 of the data is 0; noise 'lognormal' expects a finite number > 0.
        """
        y = np.asarray(observed, dtype=float)
        bad = ~np.isfinite(y) | ((y <= 0.0) if self.logarithmic else False)
        if bad.any():
            row = int(np.flatnonzero(bad)[0])
            expected = "a finite number > 0" if self.logarithmic else "a finite number"
            raise InputError(
                f"Row {row + 1} of the data is {y[row]:g}; noise '{self.name}' expects {expected}."
            )

    def _shape(self, given: Mapping[str, ArrayLike]) -> dict[str, FloatArray]:
        """The shape parameters as arrays, NaN where they are not positive."""
        if given.keys() != set(self.shape_parameters):
            raise TypeError(
                f"Noise '{self.name}' needs {' and '.join(self.shape_parameters) or 'no shape parameter'}; "
                f"got {', '.join(given) or 'none'}."
            )
        arrays = {name: np.asarray(value, dtype=float) for name, value in given.items()}
        return {name: np.where(value > 0.0, value, np.nan) for name, value in arrays.items()}
