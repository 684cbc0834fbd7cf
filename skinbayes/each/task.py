"""One of many fits: its task, and what comes of it."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from time import process_time
from typing import Any

import numpy as np

from skinbayes.defaults import MOST_DRAWS
from skinbayes.each.result import OneFit
from skinbayes.errors import MachineError
from skinbayes.fit.result import PosteriorResult
from skinbayes.fit.run import sample
from skinbayes.fit.run_contents import run_contents
from skinbayes.forward import ForwardModel
from skinbayes.problem.problem import Problem


@dataclass(frozen=True)
class Task:
    """One data set that is to be fitted: all that its result depends on.

    Attributes
    ----------
    name : of the data
    problem : without what its forward model has prepared
    model : number of the prepared forward model among those that all workers have
    seed : of this fit
    """

    name: str
    problem: Problem
    model: int
    seed: int


@dataclass(frozen=True)
class Fitted:
    """What a worker returns.

    Attributes
    ----------
    one : what became of the fit
    draws : content of the file of its draws, empty if none are kept
    run : path inside its run directory to content, empty if none is kept
    """

    one: OneFit
    draws: bytes = b""
    run: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class FitTask:
    """Does task after task; workers get it once.

    Attributes
    ----------
    models : prepared forward models, such as those with tables of films
    options : of :func:`skinbayes.sample`
    draws : how many are kept of each fit
    runs : whether the files of a run directory are made too
    """

    models: tuple[ForwardModel, ...]
    options: Mapping[str, Any]
    draws: int = MOST_DRAWS
    runs: bool = False

    def __call__(self, task: Task) -> Fitted:
        """Fit, and gather what is kept."""
        started = process_time()
        problem = task.problem
        problem.__dict__["model"] = self.models[task.model]
        one = OneFit(task.name, problem.fingerprint, problem.conditions.n_rows, task.seed)
        try:
            fit = sample(problem, seed=task.seed, **self.options)
        except (MachineError, MemoryError):
            raise  # says nothing about these data
        except Exception as error:  # whatever it is: it is counted, and said
            return Fitted(
                replace(
                    one, failure=f"{type(error).__name__}: {error}"[:500], seconds=process_time() - started
                )
            )
        one = _described(one, fit)
        run = run_contents(fit, problem) if self.runs else {}
        return Fitted(replace(one, seconds=process_time() - started), draws_image(fit, self.draws), run)


def seed_of(seed: int, name: str) -> int:
    """Seed of one of many fits: that of the others, and which there are, does not matter.

    Examples
    --------
    >>> seed_of(1, "P1") == seed_of(1, "P1"), seed_of(1, "P1") == seed_of(1, "P2")
    (True, False)
    """
    of_name = int.from_bytes(hashlib.sha256(name.encode()).digest()[:8], "little")
    return int(np.random.SeedSequence([seed, of_name]).generate_state(1)[0])


def _described(one: OneFit, fit: PosteriorResult) -> OneFit:
    table = fit.summary(derived=True)
    posterior = fit.groups["posterior"]
    # rows of one data set are not those of another
    by_row = [
        label
        for label in table.index
        if "row" in getattr(posterior.get(label.partition("[")[0]), "dims", ()) and "[" in label
    ]
    table = table.drop(index=by_row)
    sampling = fit.provenance["sampling"]
    evidence = sampling["log_evidence"]
    sizes, spreads = (np.asarray(sampling.get(key, []), dtype=float) for key in ("ess_bulk", "r_hat"))
    return replace(
        one,
        converged=fit.converged,
        verdict=sampling.get("verdict", ""),
        quantities={
            str(label): [float(line[key]) for key in ("q05", "median", "q95")]
            for label, line in table.iterrows()
        },
        units={str(label): str(unit) for label, unit in table["unit"].items()},
        log_evidence=None if evidence is None else [float(value) for value in evidence],
        ess_bulk=float(sizes.min()) if np.isfinite(sizes).any() else None,
        r_hat=float(spreads.max()) if np.isfinite(spreads).any() else None,
        evaluations=sampling.get("evaluations"),
    )


def draws_image(fit: PosteriorResult, most: int) -> bytes:
    """A NumPy archive with an array for each parameter: draws evenly spaced among those of the fit, ``most`` at most."""
    if not most:
        return b""
    theta = fit.theta()
    chosen = theta[np.linspace(0, len(theta) - 1, min(most, len(theta))).round().astype(int)]
    image = io.BytesIO()
    np.savez(image, **dict(zip(fit.names, chosen.T, strict=True)))
    return image.getvalue()
