"""Capillary bridges (Sect. 5, Figs. 8 to 10)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from skinbayes.contact import (
    gap_distribution,
    mean_separation,
    pressure_at_separation,
    relative_contact_area,
)
from skinbayes.phrases import number
from skinbayes.reproduce.choices import FILMS, KELVIN_RADIUS, SMOOTHER
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.statements import printed_value
from skinbayes.reproduce.words import growing, largest_change
from skinbayes.wetting import CapillaryState, kelvin_gap, surface_tension_of_water


def pull(state: CapillaryState, paper: Paper) -> float:
    """Capillary pressure over p0."""
    return float(state.capillary_pressure) / paper.pressure


@computes("capillary-pressure")
def _pull(paper: Paper) -> Found:
    sharp = pull(paper.strongest(closure="sharp"), paper)
    return Found(
        pull(paper.strongest_bridges, paper),
        f"With a Gaussian distribution of gaps, which boundary elements confirm; with sharp gaps {number(sharp)}.",
    )


@computes("capillary-pressure-red")
def _pull_red(paper: Paper) -> Found:
    sharp = pull(paper.strongest(angle="angle-glass-red", closure="sharp"), paper)
    return Found(
        pull(paper.strongest(angle="angle-glass-red"), paper),
        f"The text has one number for both curves. With sharp gaps, which the paper most likely used, {number(sharp)}.",
    )


def flooded_separation(paper: Paper) -> float:
    """ū(p0), m: the film that fills the gap."""
    return float(mean_separation(paper.pressure, paper.surface, skin=paper.wet))


@computes("flooding-film")
def _flooding(paper: Paper) -> Found:
    return Found(
        flooded_separation(paper),
        "The film that floods the gap is its mean separation, which the text gives as 13 µm elsewhere. For the surface that "
        "the four printed parameters make it would be "
        f"{number(1e6 * float(mean_separation(paper.pressure, paper.printed_surface, skin=paper.wet)))} µm.",
    )


@computes("flooding-film-abstract")
def _flooding_abstract(paper: Paper) -> float:
    return flooded_separation(paper)


@computes("separation-without")
def _without(paper: Paper) -> float:
    return flooded_separation(paper)


@computes("separation-with")
def _with(paper: Paper) -> Found:
    sharp = paper.strongest(closure="sharp")
    printed = printed_value("separation-with")
    asked = float(pressure_at_separation(printed, paper.surface, skin=paper.wet)) / paper.pressure - 1
    return Found(
        float(paper.strongest_bridges.mean_separation),
        f"With sharp gaps {number(1e6 * float(sharp.mean_separation))} µm. 10 µm ask for p_a = {number(asked, 2)} p0.",
    )


@computes("film-at-strongest")
def _film(paper: Paper) -> Found:
    sharp = paper.strongest(closure="sharp")
    return Found(
        float(paper.strongest_bridges.film_thickness),
        f"With sharp gaps {number(1e6 * float(sharp.film_thickness))} µm, where the maximum is broad.",
    )


def cosines(paper: Paper, angle: str) -> float:
    """cos θ1 + cos θ2."""
    return float(np.cos(paper["angle-skin"]) + np.cos(paper[angle]))


@computes("cosines-glass")
def _glass(paper: Paper) -> float:
    gap = kelvin_gap(1.0, paper["angle-skin"], contact_angle_counterface=paper["angle-glass-red"])
    return float(gap)


@computes("cosines-polypropylene")
def _polypropylene(paper: Paper) -> float:
    return cosines(paper, "angle-polypropylene")


@computes("eq-5")
def _eq5(paper: Paper) -> Found:
    gap = kelvin_gap(KELVIN_RADIUS, paper["angle-skin"], contact_angle_counterface=paper["angle-glass-red"])
    radius = -KELVIN_RADIUS  # the paper counts it negative
    return Found(float(gap), formula=-radius * cosines(paper, "angle-glass-red"))


def _laplace(paper: Paper) -> float:
    """|p_K| of Eqs. 5 and 6 at the strongest bridges, Pa."""
    radius = float(paper.strongest_bridges.kelvin_gap) / cosines(paper, "angle-glass")
    return float(surface_tension_of_water(paper["room-temperature"])) / radius


@computes("eq-6")
def _eq6(paper: Paper) -> Found:
    state = paper.strongest_bridges
    return Found(float(state.capillary_pressure / state.wet_area), formula=_laplace(paper))


@computes("eq-7")
def _eq7(paper: Paper) -> Found:
    state = paper.strongest_bridges
    gaps = gap_distribution(float(state.total_pressure), paper.surface, skin=paper.wet)
    wet = float(gaps.cumulative(state.kelvin_gap) - gaps.contact_fraction)
    return Found(float(state.total_pressure), formula=paper.pressure + _laplace(paper) * wet)


@computes("area-with-bridges")
def _area(paper: Paper) -> float:
    return float(paper.strongest_bridges.relative_contact_area) / paper.wet_area


@computes("area-and-total-pressure")
def _proportional(paper: Paper) -> float:
    state = paper.strongest_bridges
    areas = float(state.relative_contact_area) / paper.wet_area
    return float(np.log(areas) / np.log(float(state.total_pressure) / paper.pressure))


@computes("separation-with-bridges")
def _approach(paper: Paper) -> float:
    return float(paper.strongest_bridges.mean_separation) / flooded_separation(paper)


@computes("wet-area-with-film")
def _wet_area(paper: Paper) -> float:
    films = FILMS[flooded_separation(paper) > FILMS]
    return growing(paper.bridges(films).wet_area)


@computes("flooded-is-wet")
def _flooded(paper: Paper) -> float:
    state = paper.bridges(2 * flooded_separation(paper))
    return float(state.wet_area + state.relative_contact_area)


@computes("polypropylene")
def _no_bridges(paper: Paper) -> float:
    states = paper.bridges(angle="angle-polypropylene")
    return largest_change(states.relative_contact_area / paper.wet_area)


@computes("smoother-surface")
def _smoother(paper: Paper) -> Found:
    height = float(paper.surface.rms_height) * SMOOTHER
    smooth = replace(paper.surface, rms_height=height)
    state = paper.bridges(FILMS[::4] * SMOOTHER, surface=smooth)
    alone = float(relative_contact_area(paper.pressure, paper.variance(paper.wet) * SMOOTHER**2))
    return Found(
        float(state.capillary_pressure.max()) / float(paper.strongest_bridges.capillary_pressure),
        f"Ten times is our choice; the wiper blade itself is not described. The area is "
        f"{number(float(state.relative_contact_area.max()) / alone, 2)} times what it is without.",
    )
