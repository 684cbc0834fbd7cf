"""Log-posterior of `forearm-glass`: skinbayes against the same numbers from the documented functions, each with its checks.

Run with ``python benchmarks/log_posterior.py [--json]``. The baseline is what a user would write for one vector or a batch: the
public functions of the physics for layered skin and its spectrum, the normal density of ln of the data, and ``scipy.stats``
for each prior. Both sides take turns in one process, so that other work on the machine meets both; a time is the shortest of
all turns.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from common import COUNT, report
from scipy.stats import lognorm, loguniform, norm

from skinbayes import load_problem
from skinbayes.contact import (
    LayeredSkin,
    elastoplastic_contact_area,
    reduced_modulus,
    sphere_contact,
    twice_stress_variance,
)
from skinbayes.friction import friction_coefficient
from skinbayes.roughness import SelfAffineSpectrum

TURNS = 1000


class Case:
    """The shipped model, and its numbers written out."""

    def __init__(self) -> None:
        self.problem = load_problem("forearm-glass")
        self.batch = self.problem.draw_prior(np.random.default_rng(1), COUNT)
        values, prior = self.problem.conditions.values, {p.label: p.prior for p in self.problem.free}
        self.force, self.radius = values["normal_force"], values["sphere_radius"]
        self.log_observed = np.log(self.problem.observed)
        self.wet = self.problem.conditions.labels["state"] == "wet"
        self.surface = {
            p.name: p.value for p in self.problem.fixed if p.name.startswith(("hurst", "wavevector"))
        }
        self.priors = [
            loguniform(*p.arguments)
            if p.family == "loguniform"
            else lognorm(p.arguments[1], scale=p.arguments[0])
            for p in prior.values()
        ]
        self.names = list(prior)

    def plain(self, theta: np.ndarray) -> np.ndarray:
        """Log-posterior from public functions, shape ``(B,)``."""
        theta = np.atleast_2d(theta)
        given = {name: theta[:, [i]] for i, name in enumerate(self.names)}
        skin = LayeredSkin(
            young_modulus_layer=np.where(
                self.wet, given["young_modulus_layer[wet]"], given["young_modulus_layer[dry]"]
            ),
            young_modulus_bulk=given["young_modulus_bulk"],
            layer_thickness=given["layer_thickness"],
        )
        spectrum = SelfAffineSpectrum(rms_height=given["rms_height"], **self.surface)
        modulus = reduced_modulus(given["young_modulus_bulk"], 0.5)
        pressure = sphere_contact(self.force, self.radius, reduced_modulus=modulus).mean_pressure
        area = elastoplastic_contact_area(
            pressure,
            twice_stress_variance(spectrum, skin),
            yield_stress=np.where(self.wet, np.inf, given["yield_stress[dry]"]),
        ).total
        friction = friction_coefficient(given["frictional_shear_stress"], area, nominal_pressure=pressure)
        likelihood = norm.logpdf(self.log_observed, np.log(friction), 0.1) - self.log_observed
        prior = sum(density.logpdf(theta[:, i]) for i, density in enumerate(self.priors))
        return np.asarray(prior + likelihood.sum(axis=-1))


def in_turns(first: Callable[[], object], second: Callable[[], object]) -> tuple[float, float]:
    """Fewest microseconds of both, measured in turns."""
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(TURNS):
        for function, found in zip((first, second), times, strict=True):
            start = time.perf_counter()
            function()
            found.append((time.perf_counter() - start) * 1e6)
    return min(times[0]), min(times[1])


def run() -> dict[str, float]:
    """Time both sides and compare their results."""
    case = Case()
    ours, plain = case.problem.log_posterior(case.batch), case.plain(case.batch)
    one = case.batch[0]
    single = in_turns(lambda: case.plain(one), lambda: case.problem.log_posterior(one))
    many = in_turns(lambda: case.plain(case.batch), lambda: case.problem.log_posterior(case.batch))
    return {
        "plain_one_us": single[0],
        "skinbayes_one_us": single[1],
        "ratio_one": single[0] / single[1],
        "plain_batch_us": many[0],
        "skinbayes_batch_us": many[1],
        "ratio_batch": many[0] / many[1],
        "largest_difference": float(np.max(np.abs(ours - plain))),
    }


LINES = (
    ("public functions and scipy.stats, one vector, us", "plain_one_us", ".0f"),
    ("skinbayes, one vector, us", "skinbayes_one_us", ".0f"),
    ("times faster", "ratio_one", ".1f"),
    (f"public functions and scipy.stats, {COUNT} vectors, us", "plain_batch_us", ".0f"),
    (f"skinbayes, {COUNT} vectors, us", "skinbayes_batch_us", ".0f"),
    ("times faster ", "ratio_batch", ".1f"),
    ("largest difference of the log-posterior", "largest_difference", ".1e"),
)

if __name__ == "__main__":
    report(__doc__, "Log-posterior of forearm-glass", run, LINES)
