"""What rows measured under the same conditions say about the misfit of a model, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skinbayes.fit.predicted import is_logarithmic
from skinbayes.phrases import percent
from skinbayes.plot.numbers import quantity_of
from skinbayes.plot.symbols import spoken_name
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.statistics.repeats import LackOfFit


def repeat_sentences(fit: Fit) -> tuple[list[str], list[str]]:
    """A sentence for each observable with repeats: how they scatter, and whether that allows the misfit.

    Those that speak against the model, and the others.
    """
    against: list[str] = []
    others: list[str] = []
    for name, one in fit.repeats.items():
        (against if one.found else others).append(_said(fit, name, one))
    return against, others


def _said(fit: Fit, observable: str, found: LackOfFit) -> str:
    known = lookup(observable)
    what = known.symbol if known else spoken_name(observable)
    logarithmic = is_logarithmic(fit, observable)

    def size(value: float) -> str:
        return percent(value) if logarithmic else quantity_of(observable, value)

    chance = f"simulated data of the model miss them as far in {percent(found.probability)} of cases"
    return (
        f"Rows of the same conditions scatter by {size(found.scatter)}{f' of {what}' if logarithmic else ''} "
        f"({found.degrees_of_freedom} degrees of freedom). The model misses the means of the {found.conditions} conditions by "
        f"{size(found.misfit)}, where such a scatter alone makes {size(found.allowed)}: "
        + ("MORE than repeats allow" if found.found else "no more than repeats allow")
        + f" ({chance})."
    )
