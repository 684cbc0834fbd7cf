"""What a reader of a spectrum has to know about the surface that it was computed from, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from skinbayes.topography.analysis import SurfaceAnalysis
from skinbayes.topography.artefacts import MOST_SPIKES
from skinbayes.topography.height_map import HeightMap, LineProfile

LARGEST_FIELD = 1.0
"""m: instruments that measure roughness see no more."""

SLOPES = (1e-6, 10.0)
"""rms slopes of surfaces that are flatter than a polished wafer, or steeper than any that an instrument sees from above."""

UNEVEN = 1.6
"""Ratio of rms heights with and without a window, either way, from which on a field is not of one kind."""

OPEN_EDGES = 4.0
"""rms step across the edges over that between neighbours from which on a surface does not go on as it begins."""


def surface_findings(one: SurfaceAnalysis) -> list[str]:
    """Sentences about saturation, spikes, edges, filled pixels, trend, direction, and numbers that no surface has."""
    return list(_findings(one))


def _findings(one: SurfaceAnalysis) -> Iterator[str]:
    surface = one.surface
    yield from _implausible(one)
    for plateau in one.plateaus:
        end = "largest" if plateau.highest else "smallest"
        yield (
            f"{100 * plateau.share:.2g} % of the pixels have exactly the {end} height that was read: the instrument was "
            "saturated there, and the spectrum is that of a surface cut off."
        )
    yield from _spikes(one)
    if (uneven := one.whole.rms_height / one.own.rms_height) > UNEVEN or uneven < 1 / UNEVEN:
        yield (
            f"Under the window the rms height is {uneven:.2g} times that of the whole field: the surface is not of one kind all "
            "over it, and the spectrum is that of its middle."
        )
    if one.window == "none" and not surface.periodic:
        yield (
            "Without a window the edges of a field that is not periodic add a spectrum of their own, which falls as 1/q³ and "
            "hides steeper ones."
        )
    if surface.periodic and (ratio := edge_step(surface)) > OPEN_EDGES:
        yield (
            f"Heights step {ratio:.2g} times as much across the edges of the field as between neighbours: a periodic surface "
            "does not, and the steps add a spectrum of their own. Is this one period?"
        )
    filled = one.undefined if any("filled" in step for step in surface.steps) else 0.0
    if filled > 0.01:
        yield f"Waves shorter than the filled areas lack up to {100 * filled:.2g} % of their power."
    taken = one.trend_share[one.spectrum.reliable]
    if taken.size and taken[0] > 0.02:
        yield f"Removing the trend took {100 * taken[0]:.2g} % of the longest waves in the band, and less of shorter ones."
    found = one.anisotropy
    if found is not None and found.slope_degree > max(0.1, found.slope_degree_by_chance):
        ratio = np.sqrt((1 - found.slope_degree) / (1 + found.slope_degree))
        yield (
            f"The surface is not isotropic: the slope along {np.degrees(found.slope_direction):.0f}° is largest, at right "
            f"angles to it it is {ratio:.2g} times as large. C(q) is the mean over directions."
        )


def _implausible(one: SurfaceAnalysis) -> Iterator[str]:
    surface, slope = one.surface, one.own.rms_slope
    side = max(surface.size_x, surface.size_y) if isinstance(surface, HeightMap) else surface.size
    if side > LARGEST_FIELD:
        yield f"The field is {side:.3g} m long: does the file state its pixels in the right unit?"
    if not SLOPES[0] < slope < SLOPES[1]:
        yield f"An rms slope of {slope:.2g} is that of no surface: check the units of heights and of pixels."


def _spikes(one: SurfaceAnalysis) -> Iterator[str]:
    pixels = one.surface.height.size
    if not one.spikes or any("spike" in step for step in one.surface.steps):
        return
    who = "1 pixel" if one.spikes == 1 else f"{one.spikes} pixels"
    told = f"{who} ({100 * one.spikes / pixels:.2g} %) stand{'s' if one.spikes == 1 else ''} far out of the neighbours"
    if one.spikes > max(1.0, MOST_SPIKES * pixels):
        yield f"{told}; so many are no spikes, but steps, or heights in coarse counts."
    elif one.spike_share > 0.05:
        yield (
            f"{told} like spikes, with {100 * one.spike_share:.0f} % of the mean square slope beside them: use --remove-spikes, "
            "unless they are of the surface."
        )
    else:
        yield f"{told} like spikes and {'was' if one.spikes == 1 else 'were'} kept."


def edge_step(surface: HeightMap | LineProfile) -> float:
    """rms step from the last pixel to the first over that between neighbours, the larger one of both axes, dimensionless."""
    found = []
    for axis in range(surface.height.ndim):
        across = np.take(surface.height, 0, axis) - np.take(surface.height, -1, axis)
        inside = float(np.sqrt(np.mean(np.square(np.diff(surface.height, axis=axis)))))
        found.append(float(np.sqrt(np.mean(np.square(across)))) / inside if inside else 0.0)
    return max(found)
