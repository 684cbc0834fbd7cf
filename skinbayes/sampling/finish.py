"""When ensembles have explored enough for importance sampling to be tried."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.sampling.convergence import rank_r_hat
from skinbayes.sampling.importance import Attempt, importance_draws
from skinbayes.sampling.options import SamplerOptions
from skinbayes.sampling.search import Search
from skinbayes.sampling.stopping import is_check
from skinbayes.sampling.target import Target, is_hierarchical
from skinbayes.sampling.weighted_draws import ImportanceDraws

FIRST_ATTEMPT = 25
"""Steps after which importance sampling is tried for the first time; then each time the run is 30 % longer."""

IN_ANY_CASE = 100
"""Steps after which a proposal is fitted although the ensembles disagree more: they may be in different modes for good, and only
weighted draws tell how much either counts."""

AFTER_REFUSAL = 3
"""Draws that were made and refused are not tried again before the run is so many times longer."""

FOUND = 1.3
"""Largest R-hat of the ensembles, over the later half of their steps, at which a proposal is fitted to them: where they disagree
a little more than they will, weighted draws tell who is right."""

DRAWS_FOR_EXPLORED, DRAWS_FOR_ESS = 1.5, 8.0
"""Draws that are made at least for each evaluation that exploration took: they cost little more, and are worth far more. But no
more than so many for each effective draw that was asked for."""


class Finish:
    """Tries importance sampling as the run grows.

    Parameters
    ----------
    target, options : of the run

    Attributes
    ----------
    refused : why draws were not accepted, the last time they were tried
    """

    def __init__(self, target: Target, options: SamplerOptions) -> None:
        self._target, self._options = target, options
        self._not_before = self._since = self._made = self._given_up = 0
        self._pending: Attempt | None = None
        self._search: Search | None = None
        self.refused = ""

    def attempt(
        self,
        steps: int,
        joined: Callable[[str], FloatArray],
        crew: Callable[[Sequence[Any]], list[Any]],
        discarded: int = 0,
        spent: int = 0,
    ) -> ImportanceDraws | None:
        """Draws if they are due and accepted; what comes out depends on the seed, ``steps`` and the positions alone.

        Parameters
        ----------
        steps : of each ensemble so far
        joined : gives ``"positions"``, ``(ensembles, steps, walkers, D)``, and ``"log_density"``
        crew : evaluates positions
        discarded : steps at the beginning after which walkers were taken along; fewer than ``steps``
        spent : evaluations of the run so far, without those of attempts
        """
        options = self._options
        # in the tens of dimensions of people a proposal resembles no posterior
        due = (
            options.importance
            and not is_hierarchical(self._target)
            and steps >= self._not_before
            and steps > 0
        )
        if not due or not is_check(steps, options.block_steps, FIRST_ATTEMPT):
            return None
        first = max(steps // 2, discarded)
        positions, log_density = (joined(name)[:, first:] for name in ("positions", "log_density"))
        ensembles, _, walkers, dimension = positions.shape
        chains = positions.reshape(ensembles, -1, dimension)
        apart = [rank_r_hat(chains[..., column]) for column in range(dimension)]
        worst = int(np.argmax(np.nan_to_num(apart, nan=np.inf)))
        agree = bool(apart[worst] <= FOUND)
        if not agree and steps < IN_ANY_CASE:
            self.refused = f"the ensembles do not agree yet about {self._target.names[worst]}"
            return None
        least = int(min(DRAWS_FOR_EXPLORED * spent, DRAWS_FOR_ESS * options.ess))
        flat = log_density.reshape(ensembles, -1)
        if self._pending is not None:
            found = self._pending.go_on(chains, flat, options.ess, least)
        else:
            self._search = Search(self._target, crew, walkers, options.search)
            found = importance_draws(
                chains,
                flat,
                self._search.evaluate,
                options.ess,
                np.random.default_rng([options.seed, 8, steps]),
                least,
                agree,
                self._search if options.search else None,
            )
            self._since = steps
        if isinstance(found, ImportanceDraws):
            self._made = 0
            return found
        self.refused = found.why
        self._made = found.tried + (0 if self._search is None else self._search.evaluations)
        if found.pending is not None and steps < AFTER_REFUSAL * self._since:
            self._pending = found.pending
            return None
        self._not_before = AFTER_REFUSAL * self._since if self._made > spent / 4 else 0
        self._given_up += self._made
        self._made, self._pending = 0, None
        return None

    @property
    def evaluations(self) -> int:
        """Of the target for draws that were not accepted."""
        return self._given_up + self._made
