"""Priors of the same kind and middle, but wider or narrower.

What "twice as wide" means: the standard deviation or scale is twice as large – of the logarithm for ``lognormal``; cut-offs
stay where they are. ``uniform`` and ``loguniform`` reach twice as far from their middle, the latter in logarithms, but not beyond
what is possible. Families that begin at zero and have nothing but a scale get twice that scale, so that their mean grows too.
``gamma`` keeps its mean as long as its density stays finite at zero, and then its shape. ``beta`` is raised to the power 1/4, as
doubles the standard deviation of a normal distribution, unless its density is infinite at an end: then it stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, inf, isclose, log, sqrt

from skinbayes.statistics.families import FAMILIES, Arguments
from skinbayes.statistics.priors import Prior

LOGARITHMIC = ("lognormal", "loguniform")
"""Families that are stated for the logarithm of a parameter."""

FROM_ZERO = ("half_normal", "exponential", "gamma", "half_student_t", "half_cauchy")
"""Families that begin at zero and become larger as they become wider."""

BOUNDED = ("uniform", "loguniform")
"""Families whose ends move."""


def widened(prior: Prior, factor: float, lower: float = -inf, upper: float = inf) -> Prior:
    """The prior, ``factor`` times as wide; itself if that has no meaning for its family.

    Parameters
    ----------
    prior : any
    factor : above 0; below 1 makes it narrower
    lower, upper : what is possible, in the unit of the parameter; ends of ``uniform`` and ``loguniform`` go no further

    Raises
    ------
    InputError
        Cut-offs would leave nothing of a narrower prior.

    Examples
    --------
    >>> from skinbayes.statistics.priors import make_prior
    >>> widened(make_prior("lognormal", [2.0, 0.5]), 2.0).arguments
    (2.0, 1.0)
    >>> widened(make_prior("uniform", [1.0, 3.0]), 4.0, lower=0.0).support
    (0.0, 6.0)
    """
    if prior.family in BOUNDED:
        first, last = _stretched(prior.family, prior.support, factor)
        return Prior(prior.family, (max(first, lower), min(last, upper)))
    return Prior(prior.family, _RULES[prior.family].widened(prior.arguments, factor), *prior.support)


def factor_of_reach(prior: Prior, reach: float) -> float:
    """How many times as wide a prior becomes if what it covers goes ``reach`` times further.

    That is ``reach`` itself, but of priors stated for the logarithm: their ends – bounds, or the 5 % and 95 % quantiles – become
    ``reach`` times smaller and larger.

    Examples
    --------
    >>> from skinbayes.statistics.priors import make_prior
    >>> factor_of_reach(make_prior("loguniform", [1.0, 100.0]), 10.0)
    2.0
    """
    if prior.family not in LOGARITHMIC:
        return reach
    low, high = prior.support if prior.family in BOUNDED else prior.interval(0.9)
    return 1.0 + 2.0 * log(reach) / log(high / low)


def width_ratio(first: Prior, second: Prior) -> float | None:
    """How many times as wide the second prior is, if they differ in nothing else; None if they do.

    Examples
    --------
    >>> from skinbayes.statistics.priors import make_prior
    >>> width_ratio(make_prior("normal", [1.0, 0.5]), make_prior("normal", [1.0, 1.5]))
    3.0
    """
    if first.family != second.family:
        return None
    name = first.family
    arguments = [p.support if name in BOUNDED else p.arguments for p in (first, second)]
    factor = _RULES[name].width(arguments[1]) / _RULES[name].width(arguments[0])
    stretched = (
        _stretched(name, first.support, factor)
        if name in BOUNDED
        else _RULES[name].widened(arguments[0], factor)
    )
    same = all(isclose(a, b, rel_tol=1e-6) for a, b in zip(stretched, arguments[1], strict=True))
    return factor if same and (name in BOUNDED or first.support == second.support) else None


def _stretched(family: str, ends: tuple[float, float], factor: float) -> tuple[float, float]:
    low, high = ends
    if family == "loguniform":
        low, high = log(low), log(high)
    middle, reach = (low + high) / 2, factor * (high - low) / 2
    if family == "uniform":
        return middle - reach, middle + reach
    # no smaller or larger than what numbers can hold
    return exp(max(middle - reach, -700.0)), exp(min(middle + reach, 700.0))


@dataclass(frozen=True)
class _Rule:
    """Arguments of a family to its width, and to those of the same family ``factor`` times as wide."""

    width: Callable[[Arguments], float]
    widened: Callable[[Arguments, float], Arguments]


def _scale(place: int) -> _Rule:
    """The width is one of the arguments."""
    return _Rule(lambda a: a[place], lambda a, f: (*a[:place], f * a[place], *a[place + 1 :]))


def _gamma(arguments: Arguments, factor: float) -> Arguments:
    shape, scale = arguments
    about_the_mean = min(factor, sqrt(shape)) if shape > 1.0 else 1.0
    return shape / about_the_mean**2, scale * about_the_mean * factor


def _beta(arguments: Arguments, factor: float) -> Arguments:
    powers = tuple(1.0 + (a - 1.0) / factor**2 for a in arguments)
    return powers if min(arguments) >= 1.0 else arguments


_RULES = {
    "lognormal": _scale(1),
    "normal": _scale(1),
    "truncated_normal": _scale(1),
    "uniform": _Rule(lambda a: a[1] - a[0], lambda a, f: a),
    "loguniform": _Rule(lambda a: log(a[1] / a[0]), lambda a, f: a),
    "half_normal": _scale(0),
    "exponential": _scale(0),
    "gamma": _Rule(lambda a: sqrt(a[0]) * a[1], _gamma),
    "beta": _Rule(lambda a: 1.0 / sqrt(max(sum(a) - 2.0, 1e-12)), _beta),
    "student_t": _scale(1),
    "half_student_t": _scale(0),
    "half_cauchy": _scale(0),
}
assert set(_RULES) == set(FAMILIES)
