"""Contact area over the water film, 24 films for each of 64 parameter vectors: skinbayes against plain vectorised NumPy.

Run with ``python benchmarks/capillary.py [--json]``. The baseline is what one writes from Eqs. 5 to 7 of the paper with arrays:
a list of Kelvin lengths for every vector, ``p ← p0 + p_K F(d_K; p)`` iterated for all of them at once with the gap distribution
at each pressure (the package's own, vectorised), films and areas at the solution, and interpolation to the films wanted. The
number of Kelvin lengths and the tolerance are the smallest that keep its error of the area below 0.1 % (`BASELINE_GAPS`,
`BASELINE_TOLERANCE`). Errors are against the solution refined at every film.
"""

from __future__ import annotations

import numpy as np
from common import best_time, report

from skinbayes.contact import (
    LayeredSkin,
    gap_distribution,
    mean_separation,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.roughness import SelfAffineSpectrum
from skinbayes.wetting import capillary_state

COUNT, FILMS = 64, 24
TENSION, SKIN_ANGLE = 0.0727, np.radians(80.0)
BASELINE_GAPS, BASELINE_TOLERANCE = 52, 1e-3


class Case:
    """64 skins about the paper's, with their films from 2 to 105 % of the flooded one."""

    def __init__(self, seed: int = 1) -> None:
        rng = np.random.default_rng(seed)

        def scale(middle: float, width: float) -> np.ndarray:
            return middle * np.exp(rng.normal(0.0, width, COUNT))

        self.surface = SelfAffineSpectrum(
            rms_height=scale(22.4e-6, 0.1),
            hurst_exponent=rng.uniform(0.74, 0.82, COUNT),
            wavevector_min=scale(1e3, 0.05),
            wavevector_rolloff=scale(6.3e3, 0.05),
            wavevector_max=1e9,
        )
        self.skin = LayeredSkin(
            young_modulus_layer=scale(7e6, 0.25),
            young_modulus_bulk=scale(20e3, 0.15),
            layer_thickness=scale(20e-6, 0.15),
        )
        self.load, self.glass = scale(6830.0, 0.1), rng.uniform(0.0, 0.5, COUNT)
        self.flooded = mean_separation(self.load[:, None], self.surface, skin=self.skin)
        self.films = self.flooded * np.linspace(0.02, 1.05, FILMS)

    def skinbayes(self, refine: bool = False) -> np.ndarray:
        """A/A0 from the package, shape ``(64, 24)``."""
        state = capillary_state(
            self.films,
            self.load,
            spectrum=self.surface,
            skin=self.skin,
            surface_tension=TENSION,
            contact_angle_skin=SKIN_ANGLE,
            contact_angle_counterface=self.glass,
            refine=refine,
        )
        return state.relative_contact_area

    def baseline(self) -> np.ndarray:
        """A/A0 by fixed-point iteration over Kelvin lengths and interpolation, shape ``(64, 24)``."""
        wetting_tension = TENSION * (np.cos(SKIN_ANGLE) + np.cos(self.glass))[:, None]
        # equal steps of ln(1 + d0/d), from the flooded gap downwards
        gap = 3 * self.flooded / np.expm1(np.linspace(1e-3, np.log(1 + 3 / 0.2), BASELINE_GAPS))
        load = self.load[:, None]
        pressure = np.broadcast_to(load, gap.shape)
        while True:
            gaps = gap_distribution(pressure, self.surface, skin=self.skin)
            wet = gaps.cumulative(gap[..., None])[..., 0] - gaps.contact_fraction
            following = load + wetting_tension / gap * wet
            done = np.max(np.abs(following / pressure - 1)) < BASELINE_TOLERANCE
            pressure = following
            if done:
                break
        film = gap_distribution(pressure, self.surface, skin=self.skin).film(gap[..., None])[..., 0]
        film = np.concatenate([self.flooded, film], axis=1)[:, ::-1]
        pressure = np.concatenate([load, pressure], axis=1)[:, ::-1]
        found = np.array([np.interp(*row) for row in zip(self.films, film, pressure, strict=True)])
        return relative_contact_area(found, twice_stress_variance(self.surface, self.skin)[:, None])


def run() -> dict[str, float]:
    """Time both sides and compare their results with the refined solution."""
    case = Case()
    exact = case.skinbayes(refine=True)
    plain_error, error = (float(np.max(np.abs(x / exact - 1))) for x in (case.baseline(), case.skinbayes()))
    plain, ours = best_time(case.baseline, 3), best_time(case.skinbayes, 10)
    return {
        "vectors": COUNT,
        "films": FILMS,
        "baseline_ms_per_vector": plain / COUNT * 1e3,
        "skinbayes_ms_per_vector": ours / COUNT * 1e3,
        "ratio": plain / ours,
        "baseline_largest_relative_error": plain_error,
        "skinbayes_largest_relative_error": error,
    }


LINES = (
    ("plain vectorised NumPy, ms per vector", "baseline_ms_per_vector", ".2f"),
    ("skinbayes, ms per vector", "skinbayes_ms_per_vector", ".2f"),
    ("times faster", "ratio", ".1f"),
    ("largest relative error of plain NumPy", "baseline_largest_relative_error", ".1e"),
    ("largest relative error of skinbayes", "skinbayes_largest_relative_error", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, f"A/A0 at {FILMS} films for each of {COUNT} parameter vectors", run, LINES)
