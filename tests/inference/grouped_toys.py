"""Small models of grouped data without physics, whose predictive densities have a closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np

TOY = """
{top}
title = "People and liquids"
forward = "constant"

[data]
file = "{data}"
observable = "friction_coefficient"

[parameters]
typical_friction_coefficient = {{ lognormal = [0.5, 1.0] }}

[noise]
family = "lognormal"
noise_scale = {noise}

[groups.person]
scale = {person}

[groups.liquid]
scale = 0.3
"""


class Design:
    """Persons crossed with liquids, one row each: labels, and ln of friction drawn from the toy."""

    def __init__(
        self, seed: int, persons: int = 6, liquids: int = 4, noise: float = 0.2, person: float = 0.4
    ) -> None:
        rng = np.random.default_rng(seed)
        self.person, self.liquid = (place.ravel() for place in np.indices((persons, liquids)))
        self.values = (
            np.log(0.4)
            + person * rng.normal(size=persons)[self.person]
            + 0.3 * rng.normal(size=liquids)[self.liquid]
            + noise * rng.normal(size=persons * liquids)
        )

    def covariance(self, noise: float, person: float) -> np.ndarray:
        """Of ln of friction, effects integrated out and ln of the typical value too: it has variance 1 about ln 0.5."""
        same_person, same_liquid = (x[:, None] == x for x in (self.person, self.liquid))
        return noise**2 * np.eye(len(self.values)) + person**2 * same_person + 0.09 * same_liquid + 1.0

    def log_evidence(self, noise: float, person: float, rows: np.ndarray) -> float:
        """ln p of the data of some rows, of friction itself."""
        if not rows.any():
            return 0.0
        y = self.values[rows]
        covariance = self.covariance(noise, person)[np.ix_(rows, rows)]
        residual = y - np.log(0.5)
        square = residual @ np.linalg.solve(covariance, residual)
        log_determinant = np.linalg.slogdet(covariance)[1]
        return float(-0.5 * (square + log_determinant + len(y) * np.log(2 * np.pi)) - y.sum())

    def write(self, folder: Path, noise: str, person: str, name: str = "toy", top: str = "") -> Path:
        """Write data and model; returns the model file."""
        lines = ["person,liquid,friction_coefficient [1]"]
        for who, what, value in zip(self.person, self.liquid, self.values, strict=True):
            lines.append(f"p{who},l{what},{float(np.exp(value))!r}")
        (folder / "toy.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
        path = folder / f"{name}.toml"
        path.write_text(TOY.format(data="toy.csv", noise=noise, person=person, top=top), encoding="utf-8")
        return path
