"""What the paper says in words about the contact area (Sects. 1, 4, 5 and 7)."""

from __future__ import annotations

import numpy as np

from skinbayes.contact import relative_contact_area, twice_stress_variance
from skinbayes.friction import friction_coefficient
from skinbayes.phrases import number
from skinbayes.reproduce.choices import DECADE, LOADS, MAGNIFICATIONS, TISSUES
from skinbayes.reproduce.contact import wet_area_at, yielded_fraction
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.words import falling, farthest_from_one, largest_change


@computes("dry-yields")
def _dry_yields(paper: Paper) -> float:
    return yielded_fraction(paper, paper["wavevector-max"])


@computes("yield-decides")
def _yield_decides(paper: Paper) -> Found:
    elastic = float(relative_contact_area(paper.pressure, paper.variance(paper.dry)))
    return Found(paper.dry_area / elastic, f"Without yielding A/A0 would be {number(elastic)}.")


@computes("area-against-magnification")
def _magnification(paper: Paper) -> float:
    areas = relative_contact_area(
        paper.pressure, paper.variance(paper.wet, MAGNIFICATIONS[1:] * paper["wavevector-min"])
    )
    return falling(areas)


@computes("area-is-small")
def _small(paper: Paper) -> float:
    return paper.wet_area


@computes("area-is-not-nominal")
def _not_nominal(paper: Paper) -> float:
    return paper.wet_area


@computes("strain-is-small")
def _strain(paper: Paper) -> float:
    return paper.pressure / paper.dry_area / paper["young-modulus-layer-dry"]


@computes("one-shear-stress")
def _one_shear_stress(paper: Paper) -> float:
    wet = paper["friction-measured-wet"] / paper.wet_area
    return wet / (paper["friction-measured-dry"] / paper.dry_area)


@computes("area-with-load")
def _exponent(paper: Paper) -> float:
    low, high = (wet_area_at(paper, float(factor) * paper.pressure) for factor in DECADE)
    return float(np.log(high / low) / np.log(DECADE[1] / DECADE[0]))


@computes("friction-with-load")
def _friction_with_load(paper: Paper) -> float:
    def friction(load: float) -> float:
        pressure = paper.pressure_under(load)
        area = wet_area_at(paper, pressure)
        return float(friction_coefficient(paper["shear-stress-used"], area, nominal_pressure=pressure))

    return farthest_from_one(
        np.array([friction(float(load)) for load in LOADS]) / friction(paper["ball-load"])
    )


@computes("area-and-tissue")
def _tissue(paper: Paper) -> float:
    areas = [
        float(
            relative_contact_area(
                paper.pressure,
                twice_stress_variance(paper.surface, paper.skin(paper["young-modulus-layer-wet"], bulk)),
            )
        )
        for bulk in TISSUES
    ]
    return largest_change(np.array(areas) / paper.wet_area)


@computes("water-and-area")
def _water(paper: Paper) -> float:
    return paper.wet_area / paper.dry_area


@computes("water-and-friction")
def _water_friction(paper: Paper) -> Found:
    return Found(
        paper.wet_area / paper.dry_area,
        "At one shear stress and one nominal pressure friction goes as the area.",
    )
