"""What the priors alone predict, beside the data."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.errors import InputError
from skinbayes.problem.possible import predicted_everywhere

if TYPE_CHECKING:
    from skinbayes.problem.problem import Problem

SURPRISING = 0.005
"""A datum with a smaller fraction of prior predictive draws on one side of it contradicts the priors."""


MOST_NUMBERS = 10_000_000
"""Draws times data that are made at most (80 MB): with more than 2,500 data fewer than 4,000 draws."""

PROBES = 200
"""Draws of which one must give a finite prediction at all rows before the others are evaluated."""

FEWEST_DRAWS = 1_000
"""Draws that are made with any number of data: fewer could not tell what contradicts the priors."""

NUMBERS_AT_A_TIME = 1_000_000


@dataclass(frozen=True)
class PredictedRow:
    """One datum and the prior predictive distribution at its conditions, SI; ``fraction_below`` of the draws lie below it."""

    label: str
    observable: str
    observed: float
    q05: float
    median: float
    q95: float
    fraction_below: float


@dataclass(frozen=True)
class PriorPredictive:
    """Prior predictive comparison of a problem.

    Attributes
    ----------
    model : name
    observables : what was observed
    rows : one entry for each datum
    draws : number of prior draws
    failed : draws for which the forward model gave no finite prediction
    """

    model: str
    observables: tuple[str, ...]
    rows: tuple[PredictedRow, ...]
    draws: int
    failed: int

    def sentences(self) -> list[str]:
        """What the comparison says, in words."""
        said = []
        outside = [
            row.label for row in self.rows if min(row.fraction_below, 1 - row.fraction_below) < SURPRISING
        ]
        within = sum(row.q05 <= row.observed <= row.q95 for row in self.rows)
        said.append(
            f"{within} of {len(self.rows)} data lie inside the 5-95 % range of what the priors predict."
        )
        if outside:
            said.append(
                f"Row {', '.join(outside[:5])} lies where almost no prior draw predicts anything: the priors (or the model) "
                "contradict the data before any fit."
            )
        if self.failed:
            said.append(
                f"{self.failed} of {self.draws} prior draws give no finite prediction and count as impossible."
            )
        return said

    def most_surprising(self, count: int) -> tuple[PredictedRow, ...]:
        """The data, or the ``count`` of them furthest out in what the priors predict, in their order."""
        far = sorted(
            range(len(self.rows)),
            key=lambda i: min(self.rows[i].fraction_below, 1 - self.rows[i].fraction_below),
        )
        return tuple(self.rows[i] for i in sorted(far[:count]))

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        return asdict(self) | {"sentences": self.sentences()}


def _unusable(problem: Problem, missing: str) -> InputError:
    names = " or ".join(problem.observables)
    return InputError(
        f"{problem.spec.path}: no prior draw gives a finite {names}{f'; {missing}' if missing else ''}"
    )


def prior_predictive(problem: Problem, seed: int = 1, draws: int = 4000) -> PriorPredictive:
    """Draw data from the priors and compare them with the observed ones.

    Parameters
    ----------
    problem : a problem with data
    seed : seed of the draws
    draws : number of prior draws; with very many data fewer are made, and the result says how many

    Raises
    ------
    InputError
        The model has no data, or no prior draw gives a finite prediction.
    """
    observables = problem.observables
    rng = np.random.default_rng([seed, 2])
    observed = np.asarray(problem.observed)
    draws = min(draws, max(FEWEST_DRAWS, MOST_NUMBERS // len(observed)))
    theta = problem.draw_prior(rng, draws)
    first, missing = predicted_everywhere(problem, theta[:PROBES])
    if not first.any():  # more of them would take their time for nothing
        raise _unusable(problem, missing)
    step = max(1, NUMBERS_AT_A_TIME // len(observed))
    simulated = np.concatenate(
        [problem.simulate(theta[i : i + step], rng) for i in range(0, len(theta), step)]
    )
    finite = np.isfinite(simulated).all(axis=1)
    usable = simulated if finite.all() else simulated[finite]
    if len(usable) == 0:
        raise _unusable(problem, missing)
    quantiles, below = np.empty((3, len(observed))), np.empty(len(observed))
    width = max(1, NUMBERS_AT_A_TIME // len(usable))
    for start in range(0, len(observed), width):
        part = slice(start, start + width)
        quantiles[:, part] = np.quantile(usable[:, part], [0.05, 0.5, 0.95], axis=0)
        below[part] = (usable[:, part] < observed[part]).mean(axis=0)
    names = np.repeat(observables, problem.conditions.n_rows).tolist()
    rows = tuple(
        PredictedRow(label, name, *(float(v) for v in (observed[i], *quantiles[:, i], below[i])))
        for i, (label, name) in enumerate(zip(problem.datum_labels(), names, strict=True))
    )
    return PriorPredictive(problem.name, observables, rows, draws, draws - len(usable))
