"""Pixels without a height: filled with the smoothest surface, or left outside of a rectangle."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.errors import InputError
from skinbayes.topography.height_map import LEAST_PIXELS, HeightMap, LineProfile

Surface = TypeVar("Surface", bound=HeightMap | LineProfile)

MOST_FILLED = 0.1
"""Largest share of undefined pixels that is filled: short waves lose as much of their power as there are such pixels."""

_FINE = 400
"""Blocks along each side in which the largest rectangle is looked for."""


def undefined_share(surface: HeightMap | LineProfile) -> float:
    """Share of the pixels without a height, dimensionless."""
    return float(np.isnan(surface.height).mean())


def fill_undefined(surface: Surface, most: float = MOST_FILLED) -> Surface:
    """Fill undefined pixels with the solution of Laplace's equation between the heights around them.

    ``∇²h = 0`` on the pixels of a hole, heights at its edge as measured, no slope across the edge of the map: the smoothest
    surface in the sense of the mean square slope, without a maximum or minimum of its own. Along a line it is a straight line.
    Waves much shorter than the holes lose the share of undefined pixels of their power, longer ones less.

    Parameters
    ----------
    surface : map or line
    most : largest share of undefined pixels that is filled, dimensionless

    Returns
    -------
    surface : the same with a height (m) at each pixel and, if any were undefined, one more step

    Raises
    ------
    InputError
        if a larger share is undefined

    References
    ----------
    Chan & Shen, SIAM J. Appl. Math. 62 (2001) 1019, Sect. 3, doi 10.1137/S0036139900368844.

    Examples
    --------
    >>> import numpy as np
    >>> line = LineProfile(np.array([0.0, 1.0, np.nan, np.nan, 4.0, 5.0, 6.0, 7.0]), pixel_size=1e-6)
    >>> fill_undefined(line, most=0.3).height.tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    """
    hole = np.isnan(surface.height)
    share = float(hole.mean())
    if not share:
        return surface
    if share > most:
        raise InputError(
            f"{100 * share:.3g} % of the pixels are undefined; expected at most {100 * most:.3g} % to be filled: keep the "
            f"{'largest rectangle' if isinstance(surface, HeightMap) else 'longest part'} without them (--undefined rectangle)"
        )
    if isinstance(surface, LineProfile):
        place = np.arange(hole.size)
        height = np.interp(place, place[~hole], surface.height[~hole])
    else:
        height = surface.height.copy()
        height[hole] = _harmonic(height, hole, surface.pixel_size_x, surface.pixel_size_y)
    step = f"{int(hole.sum())} undefined pixels ({100 * share:.2g} %) filled smoothly"
    return replace(surface, height=height, steps=(*surface.steps, step))


def _harmonic(height: FloatArray, hole: BoolArray, pixel_x: float, pixel_y: float) -> FloatArray:
    """Heights at the pixels of holes, in their order, by conjugate gradients to a millionth of the rms height."""
    from scipy.sparse import coo_array, diags_array
    from scipy.sparse.linalg import cg

    number = np.full(hole.shape, -1, dtype=np.int32)
    count = int(hole.sum())
    number[hole] = np.arange(count, dtype=np.int32)
    middle = float(np.nanmean(height))
    diagonal, right = np.zeros(count), np.zeros(count)
    rows, columns, values = [], [], []
    for axis, weight in ((0, (pixel_x / pixel_y) ** 2), (1, 1.0)):
        before, after = (
            (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1)),
            (slice(1, None), slice(None)) if axis == 0 else (slice(None), slice(1, None)),
        )
        for here, there in ((before, after), (after, before)):
            inside = hole[here]
            mine, other = number[here][inside], number[there][inside]
            np.add.at(diagonal, mine, weight)
            edge = other < 0
            right += weight * np.bincount(mine[edge], height[there][inside][edge] - middle, count)
            rows.append(mine[~edge])
            columns.append(other[~edge])
            values.append(np.full(rows[-1].size, -weight))
    laplacian = coo_array(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (count, count)
    ).tocsr() + diags_array(diagonal)
    root = 1 / np.sqrt(diagonal)
    scaled = diags_array(root) @ laplacian @ diags_array(root)
    found, left = cg(scaled, right * root, rtol=1e-7, atol=0.0, maxiter=20 * sum(hole.shape))
    if left:
        raise InputError("the undefined pixels could not be filled: their areas are too large")
    return np.asarray(found * root + middle)


def largest_defined_rectangle(surface: HeightMap) -> HeightMap:
    """Keep the largest rectangle of pixels that all have a height.

    Of maps with more than 400 pixels along a side it is looked for in blocks of pixels, so that it may miss up to a block along
    each edge. A map that is cut is not periodic any more.

    Parameters
    ----------
    surface : map

    Returns
    -------
    surface : the rectangle (heights in m), with one more step if anything was cut

    Raises
    ------
    InputError
        if no rectangle of 8 × 8 pixels is defined

    References
    ----------
    The search goes row by row over histograms of defined pixels above each: Morgan, Programming from Specifications (1994),
    Chap. 21; the same rectangle is what doi 10.1088/2051-672X/aa51f8 asks for, spectra of maps without gaps.

    Examples
    --------
    >>> import numpy as np
    >>> height = np.zeros((20, 30))
    >>> height[3, 4] = np.nan
    >>> largest_defined_rectangle(HeightMap(height, pixel_size_x=1.0, pixel_size_y=1.0)).height.shape
    (20, 25)
    """
    hole = np.isnan(surface.height)
    if not hole.any():
        return surface
    rows, columns = hole.shape
    block = max(1, -(-max(rows, columns) // _FINE))
    fits = hole[: rows // block * block, : columns // block * block]
    coarse = fits.reshape(rows // block, block, columns // block, block).any(axis=(1, 3))
    top, bottom, left, right = (edge * block for edge in _rectangle(np.logical_not(coarse)))
    if min(bottom - top, right - left) < LEAST_PIXELS:
        raise InputError(
            f"{100 * hole.mean():.3g} % of the pixels are undefined, and no rectangle of {LEAST_PIXELS} × {LEAST_PIXELS} "
            "pixels is without them"
        )
    kept = f"{bottom - top} of {rows} rows, {right - left} of {columns} columns"
    step = f"cut to the largest rectangle without undefined pixels: {kept}"
    return replace(
        surface, height=surface.height[top:bottom, left:right], periodic=False, steps=(*surface.steps, step)
    )


def largest_defined_part(surface: HeightMap | LineProfile) -> HeightMap | LineProfile:
    """The largest rectangle of a map, or the longest part of a line, whose pixels all have a height (m), with one more step."""
    if isinstance(surface, HeightMap):
        return largest_defined_rectangle(surface)
    edges = np.flatnonzero(np.diff(np.r_[True, np.isnan(surface.height), True].astype(int)))
    begin, end = edges[::2], edges[1::2]
    longest = int(np.argmax(end - begin))
    first, last = int(begin[longest]), int(end[longest])
    if last - first < LEAST_PIXELS:
        raise InputError(
            f"{100 * undefined_share(surface):.3g} % of the pixels are undefined, and no {LEAST_PIXELS} in a row are defined"
        )
    step = f"cut to the longest part without undefined pixels: {last - first} of {surface.height.size}"
    return replace(surface, height=surface.height[first:last], periodic=False, steps=(*surface.steps, step))


def _rectangle(good: BoolArray) -> tuple[int, int, int, int]:
    """First and last + 1 row and column of the largest rectangle of true entries."""
    best, found = 0, (0, 0, 0, 0)
    above = [0] * good.shape[1]
    for row, line in enumerate(good.tolist()):
        above = [n + 1 if ok else 0 for n, ok in zip(above, line, strict=True)]
        open_: list[tuple[int, int]] = []  # where a rectangle began, and its height, rising
        for column, height in enumerate([*above, 0]):
            start = column
            while open_ and open_[-1][1] >= height:
                start, tall = open_.pop()
                if tall * (column - start) > best:
                    best, found = tall * (column - start), (row + 1 - tall, row + 1, start, column)
            open_.append((start, height))
    return found
