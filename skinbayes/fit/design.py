"""Which further rows would tell most: expected information of measurements that were not made yet."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError
from skinbayes.files.dataset import Data, Dataset, as_dataset
from skinbayes.files.dataset_rows import positive_column
from skinbayes.files.find_dataset import suggestions
from skinbayes.fit.new_measurements import NewMeasurements
from skinbayes.fit.prediction import new_conditions_of
from skinbayes.statistics.expected_information import information, information_on, information_on_model

if TYPE_CHECKING:
    import pandas

    from skinbayes.fit.result import FitResult

DRAWS = 1500
"""Posterior draws that stand for what is known where each is held against every other."""

MOST_DRAWS = 6000
"""Posterior draws where neighbours are looked for."""

MOST_PARAMETERS = 3
"""Parameters that may be asked about together, apart from all."""

MOST_CANDIDATES = 1000
"""Candidates looked at: so many were run."""


@dataclass(frozen=True)
class Chosen:
    """One row of a design, with what all rows up to it would tell.

    Attributes
    ----------
    row : of the candidates, from 0
    information, error : expected from this row and those chosen before it together, nats, with its standard error
    """

    row: int
    information: float
    error: float


@dataclass(frozen=True)
class Design:
    """What each candidate row would tell, and which rows to measure.

    Attributes
    ----------
    name : of the fit
    converged : whether the fit, and the one it is held against, have converged
    columns : the candidates: quantity to SI values, label column to text, each ``(N,)``
    about : parameters asked about, all if empty; or the two models
    between_models : whether it is which of two models is right that is asked
    information, errors : expected information of each candidate alone, nats, ``(N,)``, with its standard error
    costs : of each candidate, ``(N,)``, or None
    chosen : the rows to measure, in the order of their choice: each the best (for its cost) beside those before it

    Examples
    --------
    >>> import numpy as np
    >>> import skinbayes as sb
    >>> problem = sb.load_problem("finger-null")
    >>> fit = sb.Fit.from_draws(problem, problem.draw_prior(np.random.default_rng(1), 500))
    >>> candidates = {"person": ["ID01", "new"], "liquid": ["water", "water"], "normal_force": [1.0, 1.0]}
    >>> design = fit.design(candidates, parameters=["typical_friction_coefficient"])
    >>> design.information.shape, design.chosen[0].row in (0, 1)
    ((2,), True)
    """

    name: str
    converged: bool
    columns: Mapping[str, np.ndarray]
    about: tuple[str, ...]
    between_models: bool
    information: FloatArray
    errors: FloatArray
    costs: FloatArray | None
    chosen: tuple[Chosen, ...]

    @property
    def order(self) -> list[int]:
        """Rows of the candidates, the best first: by information, or by information over cost."""
        return np.argsort(-self._per_cost(self.information), kind="stable").tolist()

    def _per_cost(self, values: FloatArray) -> FloatArray:
        return values if self.costs is None else values / self.costs

    def sentence(self) -> str:
        """What to measure, and what it would tell.

        Returns
        -------
        str
            One or two sentences.

        Examples
        --------
        >>> design.sentence().startswith("Row")
        True
        """
        rows = ", ".join(str(one.row + 1) for one in self.chosen)
        best = self.chosen[-1]
        if self.between_models:
            gained = (
                f"would tell {self.about[0]} from {self.about[1]} by {best.information:.2f} ± {best.error:.2f} nats at even "
                f"odds, of the {np.log(2.0):.2f} that certainty is worth"
            )
        else:
            what = " and ".join(self.about) or "all parameters together"
            gained = (
                f"would tell {best.information:.2f} ± {best.error:.2f} nats about {what}: as much as a width that becomes "
                f"{np.exp(max(best.information, 0.0)):.2g} times smaller"
            )
        several, first, last = len(self.chosen) > 1, self.order[0], self.order[-1]
        worth, errors = self._per_cost(self.information), self._per_cost(self.errors)
        alike = first != last and worth[first] - worth[last] < 2.0 * np.hypot(errors[first], errors[last])
        more = " All candidates tell about the same, within the error of this estimate."
        return f"Row{'s' if several else ''} {rows} {gained}.{more if alike and not several else ''}"

    def to_frame(self) -> pandas.DataFrame:
        """The candidates with what each would tell.

        Returns
        -------
        pandas.DataFrame
            The columns, ``information`` and ``information_se`` in nats, the best first; the index is the row, from 1.

        Examples
        --------
        >>> list(design.to_frame().columns)[-2:]
        ['information', 'information_se']
        """
        import pandas

        table = pandas.DataFrame(
            {**self.columns, "information": self.information, "information_se": self.errors},
            index=pandas.RangeIndex(1, len(self.information) + 1, name="row"),
        )
        return table.iloc[self.order]


def design(
    fit: FitResult,
    candidates: Data,
    parameters: Sequence[str] = (),
    against: FitResult | None = None,
    rows: int = 1,
    cost: str | None = None,
    seed: int = 1,
    progress: Callable[[int, int], None] | None = None,
) -> Design:
    """Expected information of candidate rows; see :meth:`skinbayes.Fit.design`."""
    dataset = as_dataset(candidates)
    if dataset.n_rows > MOST_CANDIDATES:
        raise InputError(
            f"{dataset.path}: {dataset.n_rows} candidates; expected at most {MOST_CANDIDATES}, with which time was measured"
        )
    if parameters and against is not None:
        raise InputError(
            "design: found parameters and another model; expected one of them, to say what is asked"
        )
    if not 1 <= rows <= dataset.n_rows:
        raise InputError(f"rows: found {rows}; expected 1 to {dataset.n_rows}, the number of candidates")
    for name in parameters:
        if name not in fit.names:
            raise InputError(
                f"'{name}' is no free parameter of '{fit.name}'; expected some of {', '.join(fit.names)}."
                f"{suggestions(name, list(fit.names))}"
            )
    if len(parameters) > MOST_PARAMETERS:
        raise InputError(
            f"{len(parameters)} parameters; expected at most {MOST_PARAMETERS} of them, or none for all together"
        )
    costs = None if cost is None else _costs(dataset, cost)
    rng = np.random.default_rng([seed])
    most = MOST_DRAWS if parameters else DRAWS
    asked = [
        _measurements(one, dataset, most, rng, progress) for one in (fit, *((against,) if against else ()))
    ]
    if against is not None and asked[0].observables != asked[1].observables:
        raise InputError(
            f"'{fit.name}' explains {', '.join(asked[0].observables)} and '{against.name}' "
            f"{', '.join(asked[1].observables)}; expected two models of the same quantities"
        )
    phi = asked[0].theta[:, [fit.names.index(name) for name in parameters]]

    def worth(wanted: list[int]) -> tuple[float, float]:
        if against is not None:
            first, second = asked
            of_first, of_second = (
                (first.log_predictive(made, wanted), second.log_predictive(made, wanted)) for made in asked
            )
            return information_on_model(of_first, of_second)
        if parameters:
            return information_on(phi, np.hstack([values[:, wanted] for values in asked[0].values]))
        return information(asked[0].log_density(asked[0], wanted))

    alone = np.array([worth([row]) for row in range(dataset.n_rows)])
    return Design(
        name=fit.name,
        converged=fit.converged and (against is None or against.converged),
        columns=dataset.columns,
        about=(fit.name, against.name) if against else tuple(parameters),
        between_models=against is not None,
        information=alone[:, 0],
        errors=alone[:, 1],
        costs=costs,
        chosen=_chosen(alone, costs, rows, worth),
    )


def _measurements(
    fit: FitResult,
    dataset: Dataset,
    most: int,
    rng: np.random.Generator,
    progress: Callable[[int, int], None] | None,
) -> NewMeasurements:
    theta = fit.theta()
    picked = theta if len(theta) <= most else theta[rng.choice(len(theta), most, replace=False)]
    return NewMeasurements.of(new_conditions_of(fit, dataset, progress), picked, rng)


def _costs(dataset: Dataset, cost: str) -> FloatArray:
    if cost not in dataset.units:
        raise InputError(f"{dataset.path}: no numeric column '{cost} [..]', which is to be the cost of a row")
    return positive_column(dataset, cost, "information is divided by it")


def _chosen(
    alone: FloatArray,
    costs: FloatArray | None,
    count: int,
    worth: Callable[[list[int]], tuple[float, float]],
) -> tuple[Chosen, ...]:
    """The best row, then the one that adds most to it, and so on."""
    price = np.ones(len(alone)) if costs is None else costs
    first = int(np.argmax(alone[:, 0] / price))
    found = [Chosen(first, float(alone[first, 0]), float(alone[first, 1]))]
    while len(found) < count:
        taken = [one.row for one in found]
        left = [row for row in range(len(alone)) if row not in taken]
        together = {row: worth([*taken, row]) for row in left}
        best = max(left, key=lambda row: (together[row][0] - found[-1].information) / price[row])
        found.append(Chosen(best, *together[best]))
    return tuple(found)
