"""ln of the evidence by another method: nested sampling, which shares nothing with walkers and importance sampling."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING, Any

from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit

OPTIONS: dict[str, Any] = {"max_runs": 1}
"""Of nested sampling: one run knows ln Z to about a tenth, each further one may cost minutes."""

AGREEMENT = 3.0
"""The two agree if they differ by at most so many combined standard errors."""

CrossCheckProgress = Callable[[str, Any], None]
"""Called with the name of a model and the sampler's progress."""


@dataclass(frozen=True)
class CrossCheck:
    """ln Z of one model by two methods.

    Attributes
    ----------
    name : the model
    log_evidence, log_evidence_se : of the fit; None if its engine did not give it
    nested, nested_se : by nested sampling
    """

    name: str
    log_evidence: float | None
    log_evidence_se: float | None
    nested: float
    nested_se: float

    @property
    def agrees(self) -> bool | None:
        """Whether the two differ by at most three combined standard errors; None if the fit has none."""
        if self.log_evidence is None or self.log_evidence_se is None:
            return None
        return abs(self.log_evidence - self.nested) <= AGREEMENT * hypot(self.log_evidence_se, self.nested_se)

    def sentence(self) -> str:
        """Both numbers and whether they agree, in words."""
        by_nested = f"nested sampling gives ln Z = {self.nested:.2f} ± {self.nested_se:.2f}"
        if self.agrees is None:
            return f"'{self.name}': {by_nested}; the fit has no evidence of its own to compare with."
        gap = self.nested - (self.log_evidence or 0.0)
        both = hypot(self.log_evidence_se or 0.0, self.nested_se)
        verdict = (
            f"they agree (difference {gap:.2f}, {AGREEMENT:.0f} combined standard errors are {AGREEMENT * both:.2f})"
            if self.agrees
            else f"they DISAGREE, by {abs(gap) / both:.1f} combined standard errors: do not use either before it is clear why"
        )
        return f"'{self.name}': {by_nested}, the fit {self.log_evidence:.2f} ± {self.log_evidence_se:.2f}; {verdict}."


def cross_check(fit: Fit | JointFit, progress: CrossCheckProgress | None = None) -> CrossCheck:
    """Compute ln Z of a fit by nested sampling with dynesty, an independent check.

    Parameters
    ----------
    fit : a fit whose model and data are at hand
    progress : called with the name of the model and the sampler's progress

    Raises
    ------
    InputError
        The model or the data are not at hand, or dynesty is not installed; the message says how to install it.
    """
    from skinbayes.fit import sample

    if fit.problem is None:
        raise InputError(f"'{fit.name}' cannot be checked: its model or its data are not at hand")
    told = None if progress is None else (lambda state: progress(fit.name, state))
    run = fit.provenance["sampling"]
    found = sample(fit.problem, int(run["seed"]), engine="nested", progress=told, **OPTIONS)
    own = run.get("log_evidence") or (None, None)
    return CrossCheck(fit.name, *own, *found.provenance["sampling"]["log_evidence"])
