"""A problem that is linear and normal in logarithms, so that evidence and posterior are known whatever the priors."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import multivariate_normal, norm

from skinbayes.fit import Fit
from skinbayes.forward import ForwardModel
from skinbayes.problem import Problem, build_problem

TIME = np.linspace(0.0, 2.0, 6)
FRICTION = np.exp([0.35, 0.1, 0.55, 0.42, 0.9, 0.6])
NAMES = ("typical_friction_coefficient", "velocity_shift_factor")


def growing(inputs, tables):
    """ln μ = ln a + t ln b."""
    first, second = (inputs[name] for name in NAMES)
    return {"friction_coefficient": first * second ** inputs["time"]}


MODEL = ForwardModel(
    name="growing", summary="test", observables=("friction_coefficient",), required=(*NAMES, "time"), evaluate=growing,
    uses_surface=False,
)  # fmt: skip


@dataclass(frozen=True)
class Known:
    """Priors of ln a and ln b are normal with these means and standard deviations, 0 is fixed; ln μ has a known noise."""

    means: tuple[float, ...] = (0.0, 0.0)
    widths: tuple[float, ...] = (0.5, 0.5)
    noise: float = 0.4
    name: str = "growing"

    def wider(self, *factors):
        return replace(self, widths=tuple(f * s for f, s in zip(factors, self.widths, strict=True)))

    def reaching(self, reach, *names):
        """With 90 % intervals whose ends are moved out by a factor."""
        ratios = [
            1 + np.log(reach) / (norm.ppf(0.95) * width) if name in names and width else 1.0
            for name, width in zip(NAMES, self.widths, strict=True)
        ]
        return self.wider(*ratios)

    @property
    def design(self):
        return np.stack([np.ones_like(TIME), TIME], axis=1)

    def log_evidence(self):
        covariance = self.noise**2 * np.eye(TIME.size)
        covariance += self.design @ np.diag(np.square(self.widths)) @ self.design.T
        away = np.log(FRICTION) - self.design @ self.means
        return multivariate_normal(np.zeros(TIME.size), covariance).logpdf(away) - np.log(FRICTION).sum()

    def moments(self, prior_power=1.0, likelihood_power=1.0):
        """Mean and covariance of those of ln a and ln b that are free, with prior and likelihood raised to powers."""
        free = np.flatnonzero(self.widths)
        design, means = self.design[:, free], np.array(self.means)
        data = np.log(FRICTION) - self.design @ np.where(self.widths, 0.0, means)
        precision = prior_power * np.diag(1 / np.square(self.widths)[free])
        gain = likelihood_power * design.T / self.noise**2
        covariance = np.linalg.inv(precision + gain @ design)
        return covariance @ (precision @ means[free] + gain @ data), covariance

    def problem(self) -> Problem:
        parameters = {
            name: {"lognormal": [float(np.exp(mean)), width]} if width else float(np.exp(mean))
            for name, mean, width in zip(NAMES, self.means, self.widths, strict=True)
        }
        return build_problem(
            MODEL, {"time [s]": TIME, "friction_coefficient": FRICTION}, parameters=parameters,
            noise={"family": "lognormal", "noise_scale": self.noise}, name=self.name,
        )  # fmt: skip

    def fit(self, count=4000) -> Fit:
        """Exact draws of the posterior, and its exact evidence."""
        draws = np.exp(np.random.default_rng(5).multivariate_normal(*self.moments(), size=count))
        fit = Fit.from_draws(self.problem(), draws)
        sampling = {**fit.provenance["sampling"], "log_evidence": [self.log_evidence(), 1e-3]}
        return replace(fit, provenance={**fit.provenance, "sampling": sampling})
