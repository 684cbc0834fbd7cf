"""What heights, cut-off and correction the authors must have used for the outputs that they print."""

from __future__ import annotations

import numpy as np
from scipy.optimize import root

from skinbayes.arrays import FloatArray
from skinbayes.contact import (
    AREA_CORRECTION,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.phrases import number
from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.statements import printed_value, statements
from skinbayes.reproduce.surface import height_of_slope, with_other
from skinbayes.roughness import rms_slope


def used(paper: Paper, separation: float) -> tuple[float, float, float]:
    """Height, m, cut-off, 1/m, and correction with which slope and area are the printed ones and ū is given, m; no plateau."""
    wanted = np.log([printed_value("rms-slope-in-use"), separation, printed_value("wet-area")])

    def miss(unknown: FloatArray) -> FloatArray:
        surface = with_other(paper, rms_height=np.exp(unknown[0]), wavevector_max=np.exp(unknown[1]))
        gamma = float(unknown[2])
        found = (
            rms_slope(surface),
            mean_separation(paper.pressure, surface, skin=paper.wet, area_correction=gamma),
            relative_contact_area(paper.pressure, twice_stress_variance(surface, paper.wet), area_correction=gamma),
        )  # fmt: skip
        return np.log([float(value) for value in found]) - wanted

    start = [np.log(height_of_slope(paper)), np.log(paper["wavevector-max"]), AREA_CORRECTION]
    solution = root(miss, start, tol=1e-9)
    if not solution.success:
        return np.nan, np.nan, np.nan
    return float(np.exp(solution.x[0])), float(np.exp(solution.x[1])), float(solution.x[2])


def what_was_used(paper: Paper) -> Demonstration:
    """Three outputs, three unknowns."""
    printed = statements()["separation-without"].printed
    assert printed is not None
    separations = (printed.low - printed.step, printed.low, printed.low + printed.step)
    rows = []
    for separation in separations:
        height, cut_off, gamma = used(paper, separation)
        rows.append(
            (
                f"{number(1e6 * separation)} µm",
                f"{number(1e6 * height)} µm",
                f"{number(cut_off)} 1/m",
                number(gamma),
            )
        )
    return Demonstration(
        id="what-was-used",
        title="What the authors must have used",
        where="Sects. 3 to 5",
        text="Slope, mean separation and wet area are outputs; they determine heights, cut-off and correction, without a plateau "
        "and with H and q0 as printed. The three rows go through what ≈ 13 µm allows. The cut-off agrees with the printed "
        "one, the heights are about √10 times the printed ones, and the correction is near the usual 0.42, far from "
        "plain theory, 1.",
        headers=("ū(p0)", "h_rms", "q1", "γ"),
        rows=[
            *rows,
            (
                "printed: ≈ 13 µm",
                f"{number(1e6 * paper['rms-height-printed'])} µm",
                f"{number(paper['wavevector-max'])} 1/m",
                "not printed",
            ),
        ],
    )
