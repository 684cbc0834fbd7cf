"""Rows of the tables of a page, as text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.phrases import sample_size
from skinbayes.plot.numbers import interval, number, quantity
from skinbayes.plot.symbols import spoken_name
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit

MOST_LISTED = 4
"""Derived quantities with more rows than this are summarised, and listed in full behind a fold."""

MOST_UNFOLDED = 400
"""Longest list behind a fold."""


@dataclass(frozen=True)
class ParameterRow:
    """One free parameter; ``ess`` and ``r_hat`` are empty if the engine has none."""

    label: str
    symbol: str
    name: str
    prior: str
    source: str
    median: str
    interval: str
    ess: str
    r_hat: str


@dataclass(frozen=True)
class DerivedRow:
    """One derived quantity, at one row of data or at all of them."""

    symbol: str
    name: str
    median: str
    interval: str


@dataclass(frozen=True)
class FixedRow:
    """One input with a fixed value."""

    symbol: str
    name: str
    value: str
    source: str


def parameter_rows(fit: Fit) -> list[ParameterRow]:
    """The free parameters with prior, posterior and convergence."""
    rows = []
    for label, row in fit.summary().iterrows():
        name = str(label)
        prior = fit.provenance["priors"][name]
        median, unit = float(row["median"]), str(row["unit"])
        rows.append(
            ParameterRow(
                label=name,
                symbol=fit.symbol(name),
                name=spoken_name(name),
                prior=str(prior["text"]),
                source=str(prior["source"]),
                median=quantity(median, unit),
                interval=interval(float(row["q05"]), float(row["q95"]), unit, typical=median),
                ess=sample_size(row["ess_bulk"]) if "ess_bulk" in row else "",
                r_hat=f"{row['r_hat']:.3f}" if "r_hat" in row else "",
            )
        )
    return rows


def derived_rows(fit: Fit) -> tuple[list[DerivedRow], list[DerivedRow]]:
    """Derived quantities: those to show, with one line for many rows of data, and the many lines behind a fold."""
    by_name: dict[str, list[str]] = {}
    for label in fit.derived_labels():
        by_name.setdefault(label.partition("[")[0], []).append(label)
    shown: list[DerivedRow] = []
    folded: list[DerivedRow] = []
    for name, labels in by_name.items():
        rows = [_derived_row(fit, label) for label in labels[:MOST_UNFOLDED]]
        if len(labels) <= MOST_LISTED:
            shown += rows
            continue
        folded += rows
        found = np.array([fit.quantiles(label) for label in labels])
        low, high = float(found[:, 1].min()), float(found[:, 1].max())
        ends = float(found[:, 0].min()), float(found[:, 2].max())
        unit = fit.unit(name)
        same = high - low <= 1e-9 * abs(high)
        differ = bool((np.ptp(found, axis=0) > 1e-9 * abs(high)).any())
        shown.append(
            DerivedRow(
                symbol=fit.symbol(name),
                name=f"{spoken_name(name)}, {len(labels)} rows",
                median=f"{quantity(high, unit)} in all rows"
                if same
                else f"{interval(low, high, unit)}, by row",
                interval=_interval(*ends, unit, high) + (", over all rows" if differ else ""),
            )
        )
    return shown, folded


def _derived_row(fit: Fit, label: str) -> DerivedRow:
    low, median, high = (float(q) for q in fit.quantiles(label))
    unit = fit.unit(label)
    return DerivedRow(
        symbol=fit.symbol(label),
        name=spoken_name(label),
        median=quantity(median, unit),
        interval=_interval(low, high, unit, median),
    )


def _interval(low: float, high: float, unit: str, typical: float) -> str:
    """An interval; one whose ends are the same to six digits is said to be no interval."""
    if not high - low > 1e-6 * max(abs(low), abs(high)):
        return "hardly varies"
    return interval(low, high, unit, typical=typical)


def fixed_rows(fit: Fit) -> list[FixedRow]:
    """Inputs that were not inferred, or that follow one that was."""
    rows = []
    for label, entry in (fit.provenance["fixed"] | fit.provenance.get("tied", {})).items():
        name, _, level = label.partition("[")
        known = lookup(name)
        symbol = (known.symbol if known else name) + (f" ({level.removesuffix(']')})" if level else "")
        unit = known.unit if known else "1"
        value = str(entry["text"]) if "text" in entry else quantity(float(entry["value"]), unit, 6)
        rows.append(FixedRow(symbol, spoken_name(label), value, str(entry["source"])))
    return rows


def settings(fit: Fit) -> list[tuple[str, str]]:
    """Versions, seed and settings of the run."""
    run, seconds = fit.provenance["sampling"], fit.provenance.get("seconds", {})
    entries = [
        ("Model", str(fit.provenance["model"])),
        ("Created", str(fit.provenance["created"])),
    ]
    # of the run, every number and word that is no sentence, by name: engines differ
    entries += [
        (str(name).replace("_", " ").capitalize(), str(value))
        for name, value in run.items()
        if isinstance(value, int | float | str) and not isinstance(value, bool) and name != "verdict"
    ]
    if seconds:
        entries.append(("Time", f"{number(float(seconds['total']))} s"))
    entries.append(
        ("Versions", ", ".join(f"{name} {found}" for name, found in fit.provenance["versions"].items()))
    )
    entries.append(("Fingerprint of model, data and priors", str(fit.provenance["fingerprint"])))
    return entries
