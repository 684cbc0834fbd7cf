"""Skin in humid air (Appendix A, Fig. 16)."""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import relative_contact_area
from skinbayes.phrases import number
from skinbayes.reproduce.choices import DRY_AIR, HUMIDITIES, MOIST_AIR
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.rules import QUARTER
from skinbayes.reproduce.words import farthest_from_one, largest_change
from skinbayes.wetting import CapillaryState, capillary_state_in_humid_air

SOFT, STIFF = "young-modulus-layer-wet", "humid-stiff-modulus"
"""Moduli of the two curves of Fig. 16."""


def humid_skin(
    paper: Paper, modulus: str, humidity: FloatArray | float = HUMIDITIES, closure: str = "gaussian"
) -> CapillaryState:
    """Skin of a modulus, by its name, in equilibrium with air of the temperature of the room."""
    return capillary_state_in_humid_air(
        humidity,
        paper["room-temperature"],
        nominal_pressure=paper.pressure,
        spectrum=paper.surface,
        skin=paper.skin(paper[modulus]),
        contact_angle_skin=paper["angle-skin"],
        contact_angle_counterface=paper["angle-glass"],
        closure=closure,  # type: ignore[arg-type]
        count=False,
    )


@computes("kelvin-gap-at-half")
def _gap(paper: Paper) -> float:
    return float(humid_skin(paper, SOFT, paper["room-humidity"]).kelvin_gap)


@computes("film-at-half")
def _film(paper: Paper) -> float:
    return float(humid_skin(paper, SOFT, paper["room-humidity"]).film_thickness)


@computes("soft-in-dry-air")
def _soft(paper: Paper) -> Found:
    area = humid_skin(paper, SOFT, DRY_AIR).relative_contact_area
    sharp = humid_skin(paper, SOFT, DRY_AIR, "sharp").relative_contact_area
    return Found(
        float(area),
        f"log10 A/A0 = −{number(-float(np.log10(area)), 2)}, which is nearly 0 on the axis of Fig. 16; with sharp gaps "
        f"A/A0 = {number(float(sharp))}.",
    )


@computes("soft-changes")
def _changes(paper: Paper) -> Found:
    area = humid_skin(paper, SOFT).relative_contact_area
    half = HUMIDITIES[np.flatnonzero(area > 0.1)[-1]]
    return Found(
        float(area.max() / area.min()),
        f"Below a tenth of full contact above {number(100 * float(half), 2)} %; where depends on how the gaps are described.",
    )


@computes("stiff-in-all-air")
def _stiff(paper: Paper) -> Found:
    area = humid_skin(paper, STIFF).relative_contact_area
    logs = np.log10(area)
    return Found(
        farthest_from_one(area / np.exp(np.log(area).mean())),
        f"log10 A/A0 from −{number(-float(logs.min()))} to −{number(-float(logs.max()))}.",
    )


def _without_bridges(paper: Paper) -> float:
    return float(relative_contact_area(paper.pressure, paper.variance(paper.skin(paper[STIFF]))))


def _stiff_below(paper: Paper) -> FloatArray:
    """Area of the stiff layer up to the humidity below which the paper calls bridges negligible, over that without them."""
    humidity = np.append(HUMIDITIES[HUMIDITIES < MOIST_AIR], MOIST_AIR)
    return humid_skin(paper, STIFF, humidity).relative_contact_area / _without_bridges(paper)


@computes("stiff-is-load")
def _load(paper: Paper) -> Found:
    ratios = _stiff_below(paper)
    middle = HUMIDITIES[HUMIDITIES < MOIST_AIR][np.argmin(np.abs(ratios[:-1] - QUARTER))]
    return Found(
        farthest_from_one(ratios),
        f"Below 1.25 from {number(100 * float(middle), 2)} % on; above in drier air.",
    )


@computes("bridges-below-90")
def _below(paper: Paper) -> Found:
    ratios = _stiff_below(paper)
    return Found(
        largest_change(ratios),
        f"In dry air, where bridges span less than a molecule; {number(100 * float(ratios[-1] - 1), 2)} % at 90 %. On the "
        f"axis of Fig. 16, decades, it is {number(float(np.log10(ratios.max())), 2)}.",
    )
