"""The noise families by name: those that come with skinbayes, and those that a user adds."""

from __future__ import annotations

from math import log, pi

import numpy as np
from scipy import special

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.statistics.noise import NoiseFamily

_HALF_LOG_TWO_PI = 0.5 * log(2.0 * pi)


def _normal_log_density(z: FloatArray) -> FloatArray:
    return -0.5 * z * z - _HALF_LOG_TWO_PI


def _normal_draw(rng: np.random.Generator, size: tuple[int, ...]) -> FloatArray:
    return rng.standard_normal(size)


def _student_log_density(z: FloatArray, degrees_of_freedom: FloatArray) -> FloatArray:
    half = 0.5 * degrees_of_freedom
    normalisation = -special.betaln(half, 0.5) - 0.5 * np.log(degrees_of_freedom)
    return normalisation - (half + 0.5) * np.log1p(z * z / degrees_of_freedom)


def _student_draw(
    rng: np.random.Generator, size: tuple[int, ...], degrees_of_freedom: FloatArray
) -> FloatArray:
    return rng.standard_t(np.broadcast_to(degrees_of_freedom, size))


_NARROW = 1e-3  # below this width the shape 1/w² is so large that ln Γ is taken from its Stirling series


def _gamma_log_density(r: FloatArray, width: FloatArray) -> FloatArray:
    """Of r = ln(y/f) where y is gamma distributed with mean f and standard deviation w f."""
    shape = 1.0 / (width * width)
    stirling = 0.5 * np.log(shape / (2 * pi)) - 1 / (12 * shape)
    exact = shape * np.log(shape) - shape - special.gammaln(shape)
    # r − expm1(r) loses all digits where r is small
    fall = np.where(np.abs(r) < 1e-4, -0.5 * r * r * (1 + r / 3 * (1 + r / 4)), r - np.expm1(r))
    return shape * fall + np.where(width < _NARROW, stirling, exact)


def _gamma_draw(rng: np.random.Generator, size: tuple[int, ...], width: FloatArray) -> FloatArray:
    # a width of zero is a datum without scatter; gamma variates of shape below 1 may underflow to 0, which no datum is
    shape = 1.0 / np.square(np.where(width > 0.0, width, 1.0))
    drawn = rng.standard_gamma(np.where(np.isfinite(shape), shape, 1.0), size) / shape
    value = np.log(np.maximum(drawn, np.finfo(float).tiny))
    return np.where(width > 0.0, value, np.where(width == 0.0, 0.0, np.nan))


def _normal(name: str, description: str, relative: bool, logarithmic: bool) -> NoiseFamily:
    return NoiseFamily(
        name, description, _normal_log_density, _normal_draw, relative, logarithmic, normal=True
    )


def _student(name: str, description: str, relative: bool, logarithmic: bool) -> NoiseFamily:
    return NoiseFamily(
        name,
        description,
        _student_log_density,
        _student_draw,
        relative,
        logarithmic,
        shape_parameters=("degrees_of_freedom",),
    )


NOISE_FAMILIES: dict[str, NoiseFamily] = {}
"""Every noise family by the name used in model files."""


def register_noise(family: NoiseFamily) -> NoiseFamily:
    """Make a noise family known, so that ``[noise]`` of a model file can name it.

    Parameters
    ----------
    family : its name must be free. Shape parameters that are no quantities of the vocabulary yet are declared with
        ``skinbayes.register_quantity`` before

    Returns
    -------
    the family

    Raises
    ------
    InputError
        if another family has that name

    Examples
    --------
    >>> def log_density(z):
    ...     return -np.abs(z) - np.log(2.0)
    >>> def draw(rng, size):
    ...     return rng.laplace(size=size)
    >>> family = NoiseFamily("doctest_laplace", "Laplace about f", log_density, draw, relative=False, logarithmic=False)
    >>> register_noise(family).log_density([1.0], [[3.0]], 2.0).round(4).tolist()
    [[-2.3863]]
    >>> del NOISE_FAMILIES["doctest_laplace"]
    """
    if NOISE_FAMILIES.get(family.name, family) != family:
        raise InputError(f"There is a noise family '{family.name}' already; give yours another name.")
    NOISE_FAMILIES[family.name] = family
    return family


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


for _family in (
    _normal("gaussian", "normal scatter of the same size everywhere", relative=False, logarithmic=False),
    _normal("relative", "normal scatter in proportion to the prediction", relative=True, logarithmic=False),
    _normal(
        "lognormal", "normal scatter of ln; scale is its standard deviation", relative=True, logarithmic=True
    ),
    _student(
        "student_t",
        "Student's t of the same scale everywhere; tolerates outliers",
        relative=False,
        logarithmic=False,
    ),
    _student(
        "log_student_t", "Student's t of ln; positive data with outliers", relative=True, logarithmic=True
    ),
    NoiseFamily(
        "gamma",
        "gamma about f; averages of positive numbers of exponential scatter, such as ordinates of a periodogram",
        _gamma_log_density,
        _gamma_draw,
        relative=True,
        logarithmic=True,
        one_shape=False,
    ),
):
    register_noise(_family)
