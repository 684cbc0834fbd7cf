"""What is in a map that is not of the surface: spikes, saturated areas, and a replica that shows the surface upside down."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from skinbayes.arrays import BoolArray
from skinbayes.errors import InputError
from skinbayes.topography.height_map import HeightMap, LineProfile

Surface = TypeVar("Surface", bound=HeightMap | LineProfile)

SPIKE = 12.0
"""Distance of a spike from the median of its neighbours, in robust standard deviations of that distance over the map: none of a
Gaussian surface, and few of one with steps."""

MOST_SPIKES = 1e-3
"""Largest share of pixels that are taken for spikes; more of them are the surface, or a map that nothing can be done about."""

_NORMAL_95 = 1.96
"""95th percentile of the absolute value of a normal variable, in standard deviations."""


def invert_replica(surface: Surface) -> Surface:
    """Turn a negative replica over, so that heights are those of the skin.

    Spectrum, rms height and slope stay as they are; skewness and what is a furrow change.

    Parameters
    ----------
    surface : map or line of the replica, heights in m

    Returns
    -------
    surface : heights with the other sign (m), with one more step

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, Sect. 2, doi 10.1007/s11249-012-0053-2.

    Examples
    --------
    >>> import numpy as np
    >>> float(invert_replica(LineProfile(np.arange(8.0), pixel_size=1e-6)).height.min())
    -7.0
    """
    return replace(surface, height=-surface.height, steps=(*surface.steps, "negative replica inverted"))


def find_spikes(surface: HeightMap | LineProfile) -> BoolArray:
    """Pixels that stand out of the median of the 3 × 3 (of lines 5) pixels about them, shape of the heights.

    More than `SPIKE` = 12 robust standard deviations of that distance over the map: its 95th percentile over 1.96, which spikes
    do not move. (The median would be too small: on a slope a pixel often is the median of its neighbours.)

    Parameters
    ----------
    surface : map or line, heights in m

    Returns
    -------
    spikes : truth values, dimensionless

    References
    ----------
    Rousseeuw & Croux, J. Am. Stat. Assoc. 88 (1993) 1273, Sect. 1, doi 10.1080/01621459.1993.10476408, on robust scales.

    Examples
    --------
    >>> import numpy as np
    >>> height = np.sin(np.arange(100.0))
    >>> height[40] = 100.0
    >>> np.flatnonzero(find_spikes(LineProfile(height, pixel_size=1e-6))).tolist()
    [40]
    """
    from scipy.ndimage import distance_transform_edt, median_filter

    height = surface.height
    defined = ~np.isnan(height)
    filled = height
    if not defined.all():  # an undefined pixel takes part as the one next to it
        nearest = distance_transform_edt(~defined, return_distances=False, return_indices=True)
        filled = height[tuple(nearest)]
    away = np.abs(filled - median_filter(filled, size=3 if height.ndim == 2 else 5, mode="nearest"))
    scale = float(np.quantile(away[defined], 0.95)) / _NORMAL_95
    if scale == 0.0:  # nearly all pixels are flat: nothing to compare with
        return np.zeros(height.shape, dtype=bool)
    return np.asarray((away > SPIKE * scale) & defined)


def remove_spikes(surface: Surface) -> Surface:
    """Make spikes undefined pixels, see `find_spikes`; fill these afterwards.

    Parameters
    ----------
    surface : map or line, heights in m

    Returns
    -------
    surface : the same, heights in m with nan at spikes, and one more step if there are any

    Raises
    ------
    InputError
        if more than 0.1 % of the pixels stand out

    References
    ----------
    Rousseeuw & Croux, J. Am. Stat. Assoc. 88 (1993) 1273, Sect. 1, doi 10.1080/01621459.1993.10476408, on robust scales.

    Examples
    --------
    >>> import numpy as np
    >>> height = np.sin(np.arange(1000.0))
    >>> height[40] = 100.0
    >>> remove_spikes(LineProfile(height, pixel_size=1e-6)).steps
    ('1 spike made undefined',)
    """
    spikes = find_spikes(surface)
    count = int(spikes.sum())
    if not count:
        return surface
    if count > max(1.0, MOST_SPIKES * spikes.size):
        raise InputError(
            f"{count} pixels ({100 * count / spikes.size:.2g} %) stand out of their neighbours; expected at most "
            f"{100 * MOST_SPIKES:.2g} % spikes: so many belong to the surface, or the map is damaged"
        )
    step = f"{count} spike{'s' if count > 1 else ''} made undefined"
    return replace(surface, height=np.where(spikes, np.nan, surface.height), steps=(*surface.steps, step))


class Plateau(NamedTuple):
    """Pixels that share one extreme height.

    Attributes
    ----------
    height : m
    highest : whether it is the largest height, not the smallest
    share : of the defined pixels, dimensionless
    """

    height: float
    highest: bool
    share: float


MARK = 3.0
"""Range of all other heights over which a plateau must stand apart from them to be no height, but a mark."""


def refuse_marks(surface: HeightMap | LineProfile, plateaus: tuple[Plateau, ...]) -> None:
    """Refuse a surface on which one height that many pixels have lies far from all others, as marks of undefined pixels do."""
    height = surface.height[~np.isnan(surface.height)]
    for plateau in plateaus:
        others = height[height != plateau.height]
        low, high = float(others.min()), float(others.max())
        gap = low - plateau.height if not plateau.highest else plateau.height - high
        if gap > MARK * (high - low):
            micrometres = f"{1e6 * plateau.height:.10g} um"
            raise InputError(
                f"{100 * plateau.share:.2g} % of the pixels have exactly the height {micrometres}, and all others lie between "
                f"{1e6 * low:.4g} and {1e6 * high:.4g} um: it seems to mark undefined pixels. Expected nan there, or "
                f"--undefined-height '{micrometres}'"
            )


def undefined_at(surface: Surface, height: float) -> Surface:
    """Make pixels undefined that have the height (m, to 1e-9 of it) with which a file marks them; InputError if none has."""
    there = np.isclose(surface.height, height, rtol=1e-9, atol=1e-15)
    if not there.any():
        raise InputError(f"no pixel has the height {1e6 * height:.10g} um that is to mark undefined ones")
    step = f"{int(there.sum())} pixels of the height {1e6 * height:.10g} µm taken as undefined"
    return replace(surface, height=np.where(there, np.nan, surface.height), steps=(*surface.steps, step))


def find_plateaus(surface: HeightMap | LineProfile) -> tuple[Plateau, ...]:
    """Saturated areas: one extreme height that far more pixels have than the height next to it.

    At least 16 pixels and 0.01 % of them have exactly the largest (smallest) height, and twice as many as have the second
    one. An instrument that ran out of its range leaves such areas; a rough surface, quantised or not, thins out towards its
    extremes.

    Parameters
    ----------
    surface : map or line as it was read, heights in m

    Returns
    -------
    plateaus : `Plateau` at the largest and at the smallest height, those that there are

    References
    ----------
    Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, Sect. 3, doi 10.1088/2051-672X/aa51f8, on artefacts.

    Examples
    --------
    >>> import numpy as np
    >>> wave = np.sin(np.linspace(0, 60, 5000))
    >>> find_plateaus(LineProfile(wave, pixel_size=1e-6))
    ()
    >>> [one.highest for one in find_plateaus(LineProfile(np.minimum(wave, 0.5), pixel_size=1e-6))]
    [True]
    """
    height = surface.height[~np.isnan(surface.height)]
    found = []
    for highest in (True, False):
        extreme = height.max() if highest else height.min()
        beside = height[height < extreme] if highest else height[height > extreme]
        if not beside.size:
            continue  # a constant map
        count = height.size - beside.size
        second = int(np.count_nonzero(beside == (beside.max() if highest else beside.min())))
        if count >= max(16, 1e-4 * height.size, 2 * second):
            found.append(Plateau(float(extreme), highest, count / height.size))
    return tuple(found)
