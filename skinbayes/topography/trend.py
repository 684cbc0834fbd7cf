"""Tilt and curvature: the smooth surface of least squares that is taken away, and what it takes of the spectrum."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, TypeVar

import numpy as np
from scipy.special import spherical_jn

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.errors import InputError
from skinbayes.topography.height_map import HeightMap, LineProfile

Trend = Literal["none", "tilt", "curvature"]
DEGREES: dict[str, int] = {"none": 0, "tilt": 1, "curvature": 2}
"""Degree of the polynomial of each trend."""

Surface = TypeVar("Surface", bound=HeightMap | LineProfile)


def remove_trend(surface: Surface, trend: Trend = "curvature") -> Surface:
    """Take the mean, a plane, or a paraboloid away, by least squares over the defined pixels.

    The polynomial has the total degree 0, 1 or 2 in the coordinates. Its share of the variance is recorded among the steps.
    What it takes of the long waves is `trend_share`.

    Parameters
    ----------
    surface : map or line
    trend : ``"none"`` (the mean only), ``"tilt"`` or ``"curvature"``

    Returns
    -------
    surface : the same with other heights (m) and one more step

    Raises
    ------
    InputError
        if there is no such trend, or the defined pixels do not determine it

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, Sect. 3, doi 10.1088/2051-672X/aa51f8.

    Examples
    --------
    >>> import numpy as np
    >>> slope = LineProfile(np.arange(100.0), pixel_size=1.0)
    >>> flat = remove_trend(slope, "tilt")
    >>> bool(np.ptp(flat.height) < 1e-10), flat.steps
    (True, ('tilt removed by least squares: 100 % of the variance',))
    """
    if trend not in DEGREES:
        raise InputError(f"trend: found '{trend}'; expected one of {', '.join(DEGREES)}")
    height = surface.height
    defined = ~np.isnan(height)
    everything = bool(defined.all())
    weight = np.ones(1) if everything else defined.astype(np.float64)
    filled = height if everything else np.where(defined, height, 0.0)
    mean = float(filled.sum() / defined.sum())
    filled = np.where(defined, height - mean, 0.0) if not everything else height - mean
    before = float(np.mean(np.square(filled)) * height.size / defined.sum())
    degree = DEGREES[trend]
    if degree == 0:
        return replace(surface, height=height - mean, steps=(*surface.steps, "mean removed"))
    coefficients = _fitted(filled, weight, degree)
    left = filled - _evaluated(coefficients, height.shape)
    if not everything:
        left[~defined] = np.nan
    after = float(np.nanmean(np.square(left)))
    share = 0.0 if before == 0 else max(0.0, 1 - after / before)
    what = "tilt" if trend == "tilt" else "tilt and curvature"
    return replace(
        surface,
        height=left,
        steps=(*surface.steps, f"{what} removed by least squares: {100 * share:.3g} % of the variance"),
    )


def _basis(pixels: int, degree: int) -> FloatArray:
    """Legendre polynomials 0 … degree at the pixels of one axis, dimensionless, shape ``(degree + 1, pixels)``."""
    x = (2 * np.arange(pixels) + 1) / pixels - 1
    return np.array(np.polynomial.legendre.legvander(x, degree).T, dtype=np.float64)


def _terms(degree: int, axes: int) -> list[tuple[int, ...]]:
    """Degrees along each axis of the products of polynomials of at most a total degree."""
    if axes == 1:
        return [(i,) for i in range(degree + 1)]
    return [(i, j) for i in range(degree + 1) for j in range(degree + 1 - i)]


def _fitted(height: FloatArray, weight: FloatArray, degree: int) -> FloatArray:
    """Coefficients of the products of polynomials, an array of ``degree + 1`` along each axis; sums go axis by axis."""
    axes = height.ndim
    terms = _terms(degree, axes)
    bases = [_basis(pixels, degree) for pixels in height.shape]
    squares = [np.einsum("ax,bx->abx", base, base).reshape(-1, base.shape[1]) for base in bases]
    if axes == 1:
        right = bases[0] @ height
        normal = (squares[0] @ np.broadcast_to(weight, height.shape)).reshape(degree + 1, degree + 1)
    else:
        right = bases[0] @ (height @ bases[1].T)
        if weight.size == 1:
            sums = np.outer(squares[0].sum(axis=1), squares[1].sum(axis=1))
        else:
            sums = squares[0] @ (weight @ squares[1].T)
        normal = sums.reshape((degree + 1,) * 4)  # (y, y′, x, x′)
    matrix = np.array([[_entry(normal, a, b) for b in terms] for a in terms])
    vector = np.array([right[a] for a in terms])
    if np.linalg.cond(matrix) > 1e10:
        raise InputError("the defined pixels do not determine a trend: they lie on too few rows or columns")
    found = np.zeros((degree + 1,) * axes)
    for term, value in zip(terms, np.linalg.solve(matrix, vector), strict=True):
        found[term] = value
    return found


def _entry(normal: FloatArray, a: tuple[int, ...], b: tuple[int, ...]) -> float:
    return float(normal[a[0], b[0]] if len(a) == 1 else normal[a[0], b[0], a[1], b[1]])


def _evaluated(coefficients: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    degree = coefficients.shape[0] - 1
    bases = [_basis(pixels, degree) for pixels in shape]
    if len(shape) == 1:
        return np.asarray(coefficients @ bases[0])
    return np.asarray(bases[0].T @ (coefficients @ bases[1]))


def trend_share(
    wavevector_x: ArrayLike, wavevector_y: ArrayLike | None = None, *, size_x: float, size_y: float = np.inf,
    trend: Trend = "curvature",
) -> FloatArray:  # fmt: skip
    """Share of a wave that removing a trend takes, averaged over its phases.

    ``Σ (2l + 1)(2m + 1) j_l(q_x L_x/2)² j_m(q_y L_y/2)²`` over the terms of the trend but the mean, with spherical Bessel
    functions j: the projection of a plane wave on the Legendre polynomials of a full rectangle. A wave as long as the
    field loses 30 % to the tilt, 77 % to tilt and curvature; one of half that length 8 and 11 %.

    Parameters
    ----------
    wavevector_x, wavevector_y : components of the wavevector, 1/m, any shapes that broadcast; one only for lines
    size_x, size_y : sides of the field, m
    trend : as in `remove_trend`

    Returns
    -------
    share : dimensionless, 0 to 1, common shape

    Examples
    --------
    >>> import numpy as np
    >>> print(np.round(trend_share(2 * np.pi * np.array([1.0, 2.0, 4.0]), size_x=1.0, trend="tilt"), 3))
    [0.304 0.076 0.019]
    """
    degree = DEGREES[trend]
    along = _projections(np.asarray(wavevector_x, dtype=np.float64) * size_x / 2, degree)
    if wavevector_y is None:
        return np.asarray(sum(along[1:], start=np.zeros_like(along[0])))[()]
    across = _projections(np.asarray(wavevector_y, dtype=np.float64) * size_y / 2, degree)
    terms = [term for term in _terms(degree, 2) if term != (0, 0)]
    return np.asarray(sum((across[i] * along[j] for i, j in terms), start=np.zeros(1)))[()]


def _projections(x: FloatArray, degree: int) -> list[FloatArray]:
    return [(2 * l + 1) * np.square(spherical_jn(l, np.abs(x))) for l in range(degree + 1)]  # noqa: E741
