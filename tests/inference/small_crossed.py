"""Small crossed designs of people and sites with simulated friction, and their posteriors without the package's sampler."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from skinbayes.problem import Problem, load_problem

SITES = ("volar forearm", "dorsal forearm", "palm", "fingertip", "cheek", "thigh")
WEAK = 'loguniform = ["0.5 MPa", "500 MPa"]'
MODEL = """
format = 1
title = "Small crossed design"
forward = "friction"
[data]
file = "{name}.csv"
observable = "friction_coefficient"
[surface]
name = "paper_reference"
[parameters]
young_modulus_layer = "750 MPa"
young_modulus_bulk = {{ lognormal = ["20 kPa", 0.35] }}
layer_thickness = "20 um"
yield_stress = {{ lognormal = ["50 MPa", 0.5] }}
{stress}
{groups}
[noise]
family = "{family}"
noise_scale = {{ half_normal = 0.3 }}
"""


@dataclass(frozen=True)
class Crossed:
    """A design, how its data are made, and its priors.

    Attributes
    ----------
    people, sites : numbers of levels
    by : column by which the shear stress differs, or None
    groups : columns with effects to the prior of their scale
    stress : prior of the shear stress
    loads : of each person at each site, in mN
    noise : scatter of ln of friction, or of friction
    family : of the noise; effects are added to friction if it is gaussian, else to its ln
    """

    people: int
    sites: int
    by: str | None = "body_site"
    groups: dict[str, str] = field(default_factory=lambda: {"person": "half_normal = 0.5"})
    stress: str = WEAK
    loads: tuple[int, ...] = (200, 500, 1000, 2000)
    noise: float = 0.08
    family: str = "lognormal"

    def problem(self, folder: Path, seed: int) -> Problem:
        """The design with data made from ``seed``."""
        rng = np.random.default_rng(seed)
        person, site = rng.normal(0.0, 0.3, self.people), rng.normal(0.0, 0.3, self.sites)
        lines = ["person,body_site,normal_force [mN],sphere_radius [mm],friction_coefficient [1]"]
        for i in range(self.people):
            for j in range(self.sites):
                for load in self.loads:
                    scatter = self.noise * rng.normal()
                    friction = 0.6 * np.exp(person[i] + site[j] + scatter)
                    if self.family == "gaussian":
                        friction = 0.6 * np.exp(site[j]) + 0.5 * person[i] + scatter
                    lines.append(f"P{i},{SITES[j]},{load},8,{friction:.4f}")
        levels = {"person": [f"P{i}" for i in range(self.people)], "body_site": SITES[: self.sites]}
        if self.by is None:
            stress = f"frictional_shear_stress = {{ {self.stress} }}"
        else:
            table = "".join(f'"{level}" = {{ {self.stress} }}\n' for level in levels[self.by])
            stress = f'[parameters.frictional_shear_stress]\nby = "{self.by}"\n{table}'
        groups = "".join(f"[groups.{c}]\nscale = {{ {prior} }}\n" for c, prior in self.groups.items())
        (folder / "crossed.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
        path = folder / "crossed.toml"
        path.write_text(
            MODEL.format(name="crossed", stress=stress, groups=groups, family=self.family), encoding="utf-8"
        )
        return load_problem(path)


@dataclass(frozen=True)
class Weighted:
    """Weighted draws ``(n, D)`` of the posterior, SI."""

    draws: np.ndarray
    weights: np.ndarray

    @property
    def effective_size(self) -> float:
        """1 / Σ w²."""
        return float(1.0 / np.square(self.weights).sum())


def by_regression(problem: Problem, rng: np.random.Generator, count: int = 40_000) -> Weighted:
    """Posterior by importance sampling in which all shear stresses are exact given the other parameters.

    ln of friction is ln of shear stress + ln g(other parameters) + effects + scatter. The other parameters are drawn: the
    scales and the skin from their priors, the scatter about the residuals of a regression on all levels. Given them, logarithms
    of shear stresses are those of a linear regression with known covariance: normal, but for their prior. Under gaussian noise
    friction is shear stress times g plus effects and scatter, and the same holds for shear stresses themselves. Nothing is shared
    with the coordinates, the starts and the moves of the sampler, nor the algebra of the groups; only predictions and priors are.
    """
    names = problem.names
    stress = [i for i, name in enumerate(names) if name.startswith("frictional_shear_stress")]
    noise = names.index("noise_scale")
    theta = problem.draw_prior(rng, count)
    labels = problem.conditions.labels
    additive = not problem.noise_is_logarithmic.all()
    y = problem.observed if additive else np.log(problem.observed)
    told = {p.by for p in problem.free if p.by} | set(problem.groups.columns)
    columns = [labels[c][:, None] == np.unique(labels[c]) for c in sorted(told & set(labels))]
    dummies = np.concatenate(columns, axis=1).astype(float)
    within = y - dummies @ np.linalg.lstsq(dummies, y, rcond=None)[0]
    freedom = y.size - np.linalg.matrix_rank(dummies)
    middle, width = 0.5 * np.log(within @ within / freedom), 1.5 / np.sqrt(2.0 * freedom)
    log_noise = middle + width * rng.standard_t(5, size=count)
    theta[:, noise] = np.exp(log_noise)
    prior = {p.label: p.prior for p in problem.free}
    weight = prior["noise_scale"].log_density(theta[:, noise]) + log_noise
    weight += 3.0 * np.log1p(np.square((log_noise - middle) / width) / 5.0)

    known = theta.copy()
    known[:, stress] = 10e6
    predicted = problem.predict(known)["friction_coefficient"]
    data = np.tile(y, (count, 1)) if additive else y - np.log(predicted) + np.log(10e6)
    levels = [name.partition("[")[2].rstrip("]") for name in (names[i] for i in stress)]
    column = next((labels[c] for c in labels if set(levels) <= set(labels[c].tolist())), None)
    design = (
        np.ones((y.size, 1))
        if column is None
        else np.stack([column == v for v in levels], axis=1).astype(float)
    )
    drawn = np.empty((count, len(stress)))
    flat = prior[names[stress[0]]].family == "uniform"
    tilt = np.full(len(stress), 1.0 if flat and not additive else 0.0)
    for some in np.array_split(np.arange(count), max(1, count // 2000)):
        covariance = theta[some, noise, None, None] ** 2 * np.eye(y.size)
        for name in (n for n in names if n.startswith("group_scale")):
            member = labels[name.partition("[")[2].rstrip("]")]
            covariance += theta[some, names.index(name), None, None] ** 2 * (member[:, None] == member)
        precision = np.linalg.inv(covariance)
        acting = predicted[some, :, None] * design if additive else np.tile(design, (len(some), 1, 1))
        carried = np.swapaxes(acting, 1, 2) @ precision
        normal = carried @ acting
        projected = np.einsum("bkm,bm->bk", carried, data[some])
        best = np.linalg.solve(normal, projected[..., None])[..., 0]
        left = data[some] - np.einsum("bnk,bk->bn", acting, best)
        weight[some] -= 0.5 * np.einsum("bn,bnm,bm->b", left, precision, left)
        weight[some] -= 0.5 * (np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(normal)[1])
        spread = np.linalg.inv(normal)
        # a prior flat in the shear stress itself tilts the normal distribution of its logarithm, which moves its mean
        moved = spread @ tilt
        weight[some] += best @ tilt + 0.5 * moved @ tilt
        root = np.linalg.cholesky(spread)
        drawn[some] = best + moved + np.einsum("bkl,bl->bk", root, rng.standard_normal(best.shape))
    theta[:, stress] = 10e6 * drawn if additive else np.exp(drawn)
    for i in stress:
        jacobian = 0.0 if additive else (1.0 - tilt[0]) * np.log(theta[:, i])
        weight += prior[names[i]].log_density(theta[:, i]) + jacobian
    fractions = np.exp(weight - weight.max())
    return Weighted(theta, fractions / fractions.sum())
