"""The beginning of a page: the question, and the answer in a sentence or two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.files.noise_block import NOISE_PARAMETERS
from skinbayes.files.scatter_block import SCATTER_PARAMETERS
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.phrases import and_list
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.rows import varying
from skinbayes.plot.symbols import spoken_name
from skinbayes.plot.updates import fit_updates
from skinbayes.report.people import contrast_values
from skinbayes.vocabulary import QUANTITIES, lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit

MOST_ASKED = 2
"""Quantities named in the question."""

MOST_TREATMENTS = 2
"""Contrasts named in the answer."""


def data_name(fit: Fit) -> str:
    """File or data set that was fitted, without its folder."""
    data = fit.provenance.get("data", {})
    return str(data.get("name") or data.get("key", ""))


def is_scatter(label: str) -> bool:
    """Whether a parameter describes scatter or effects of groups, not the skin."""
    return label.partition("[")[0] in (*NOISE_PARAMETERS, *SCATTER_PARAMETERS)


def question(fit: Fit) -> str:
    """What was asked of which data."""
    count = len(observed_values(fit))
    listed = and_list([f"{spoken_name(name)}{_symbol(name)}" for name in observables(fit)])
    values = f"{'one value' if count == 1 else f'{count} values'} of {listed}"
    where = ""
    if found := varying(fit):
        condition, along = found
        known = QUANTITIES.get(condition)
        ends = interval(
            float(along.min()),
            float(along.max()),
            known.unit if known else "1",
            typical=float(np.median(along)),
        )
        where = f", {spoken_name(condition)} {ends},"
    asked = list(dict.fromkeys(label.partition("[")[0] for label in fit.shown_names if not is_scatter(label)))
    names = [f"{spoken_name(name)} {_plain_symbol(fit, name)}".strip() for name in asked[:MOST_ASKED]]
    if len(asked) > MOST_ASKED:
        names.append(f"{len(asked) - MOST_ASKED} more")
    about = and_list(names) if names else "their scatter"
    return f"What {'does' if count == 1 else 'do'} {values}{where} say about {about}?"


def answer(fit: Fit) -> str:
    """What is known: the parameter that the data inform most, and the best known combination that the model names.

    Treatments come before both.
    """
    physical = [update for label, update in fit_updates(fit).items() if not is_scatter(label)]
    learnt = sorted(
        (u for u in physical if u.verdict in ("updated", "contradicted")), key=lambda u: -u.contraction
    )
    products = sorted(single_products(fit), key=lambda label: _relative_width(fit, label))
    if treatments := contrast_values(fit):  # what was asked, as a ratio and not as its logarithm
        learnt = [update for update in learnt if update.name.partition("[")[0] != "contrast"]
        rest = len(learnt) + len(products) + len(treatments[MOST_TREATMENTS:])
        return _with_rest(treatments[:MOST_TREATMENTS], rest)
    values = [_value(fit, update.name) for update in learnt[:1]] + [
        _value(fit, label) for label in products[:1]
    ]
    if not values:
        return "These data tell next to nothing about any single parameter." if physical else ""
    return _with_rest(values, len(learnt) + len(products) - len(values))


def _with_rest(values: list[str], rest: int) -> str:
    return f"{'; '.join(values)}{f'; {rest} more below' if rest else ''}."


def unanswered(fit: Fit) -> list[str]:
    """What the data leave as it was, and what they pull away from it."""
    physical = [update for label, update in fit_updates(fit).items() if not is_scatter(label)]
    silent = [fit.symbol(u.name) for u in physical if u.verdict == "not updated"]
    pulled = [fit.symbol(u.name) for u in physical if u.verdict in ("moved", "contradicted")]
    said = [f"About {and_list(silent)} only the prior speaks."] if silent else []
    if pulled:
        said.append(f"Data and prior pull against each other in {and_list(pulled)}.")
    return said


def single_products(fit: Fit) -> list[str]:
    """Derived quantities that the model file names itself and that have one value for all rows."""
    return [
        label
        for label in fit.derived_labels()
        if label.partition("[")[0] not in QUANTITIES and "[" not in label
    ]


def _plain_symbol(fit: Fit, name: str) -> str:
    """Symbol of a parameter without its level; empty if it has none but its name."""
    label = next(label for label in fit.names if label.partition("[")[0] == name)
    symbol = fit.symbol(label).partition(" (")[0]
    return "" if symbol in (name, spoken_name(name)) else symbol


def _value(fit: Fit, label: str) -> str:
    low, middle, high = (float(q) for q in fit.quantiles(label))
    unit, symbol = fit.unit(label), fit.symbol(label)
    name = (
        ""
        if label not in fit.names or spoken_name(label) == symbol
        else f"{spoken_name(label).partition(' (')[0]} "
    )
    value = f"{name}{symbol} = {quantity(middle, unit)} (90 %: {interval(low, high, unit, typical=middle)})"
    return f"{value[:1].upper()}{value[1:]}" if name else value


def _relative_width(fit: Fit, label: str) -> float:
    low, middle, high = (float(q) for q in fit.quantiles(label))
    return (high - low) / abs(middle) if middle else np.inf


def _symbol(name: str) -> str:
    known = lookup(name)
    return f" {known.symbol}" if known else ""
