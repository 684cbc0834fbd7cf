"""The beginning of a page: the question, and the answer in a sentence or two."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.files.noise_block import NOISE_PARAMETERS
from skinbayes.plot.data import varying
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.predictive import observables, observed_values
from skinbayes.plot.symbols import spoken_name
from skinbayes.plot.updates import fit_updates
from skinbayes.report.words import and_list
from skinbayes.vocabulary import QUANTITIES, lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit

MOST_ASKED = 4
"""Parameters named in the question."""

MOST_ANSWERED = 3
"""Values in the answer."""


def data_name(fit: Fit) -> str:
    """File or key of the data, without its folder."""
    key = str(fit.provenance.get("data", {}).get("key", ""))
    return PurePath(key.replace("\\", "/")).name


def is_scatter(label: str) -> bool:
    """Whether a parameter describes scatter or effects of groups, not the skin."""
    return label.partition("[")[0] in (*NOISE_PARAMETERS, "group_scale")


def question(fit: Fit) -> str:
    """What was asked of which data."""
    count = len(observed_values(fit))
    listed = and_list([f"{spoken_name(name)}{_symbol(name)}" for name in observables(fit)])
    values = f"{'one value' if count == 1 else f'{count} values'} of the {listed}"
    where = [name] if (name := data_name(fit)) else []
    if found := varying(fit):
        condition, along = found
        known = QUANTITIES.get(condition)
        unit = known.unit if known else "1"
        where.append(
            f"{spoken_name(condition)} {interval(float(along.min()), float(along.max()), unit, typical=float(np.median(along)))}"
        )
    asked = [label for label in fit.names if not is_scatter(label)]
    names = [_named(fit, label) for label in asked[:MOST_ASKED]]
    if len(asked) > MOST_ASKED:
        names.append(f"{len(asked) - MOST_ASKED} more")
    about = and_list(names) if names else "the scatter of the data"
    verb = "does" if count == 1 else "do"
    source = f" ({', '.join(where)})" if where else ""
    return f"What {verb} {values}{source} say about the {about}?"


def answer(fit: Fit) -> list[str]:
    """What is known best, and what the data leave as it was: one or two sentences."""
    updates = fit_updates(fit)
    physical = [update for label, update in updates.items() if not is_scatter(label)]
    learnt = sorted(
        (u for u in physical if u.verdict in ("updated", "contradicted")), key=lambda u: -u.contraction
    )
    found = [_value(fit, name) for name in single_products(fit)] + [_value(fit, u.name) for u in learnt]
    said = []
    if found:
        said.append(f"{'; '.join(found[:MOST_ANSWERED])}.")
        if len(found) > MOST_ANSWERED:
            said[0] = f"{said[0][:-1]}; and {len(found) - MOST_ANSWERED} more below."
    elif physical:
        said.append("These data tell next to nothing about any single one of them.")
    silent = [fit.symbol(u.name) for u in physical if u.verdict == "not updated"]
    if silent and found:
        said.append(f"About {and_list(silent)} these data say nothing: there only the prior speaks.")
    moved = [fit.symbol(u.name) for u in physical if u.verdict in ("moved", "contradicted")]
    if moved:
        said.append(f"The data pull {and_list(moved)} away from what was assumed before.")
    return said


def single_products(fit: Fit) -> list[str]:
    """Derived quantities that the model file names itself and that have one value for all rows."""
    return [
        label
        for label in fit.derived_labels()
        if label.partition("[")[0] not in QUANTITIES and "[" not in label
    ]


def _named(fit: Fit, label: str) -> str:
    spoken, symbol = spoken_name(label), fit.symbol(label)
    plain = symbol.partition(" (")[0]
    return (
        spoken if symbol in (label, spoken) else f"{spoken.partition(' (')[0]} {symbol}" if plain else spoken
    )


def _value(fit: Fit, label: str) -> str:
    low, middle, high = (float(q) for q in np.quantile(fit.draws(label), [0.05, 0.5, 0.95]))
    unit = fit.unit(label)
    name = _named(fit, label)
    return (
        f"{name[:1].upper()}{name[1:]} is {quantity(middle, unit)} "
        f"(90 %: {interval(low, high, unit, typical=middle)})"
    )


def _symbol(name: str) -> str:
    known = lookup(name)
    return f" {known.symbol}" if known else ""
