"""Rows of the tables of a page, as text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from skinbayes.phrases import number, sample_size
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.symbols import spoken_name
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit

Row: TypeAlias = dict[str, str]
"""One line of a table: its texts by name."""

MOST_LISTED = 4
"""Derived quantities with more rows than this are summarised, and listed in full behind a fold."""

MOST_UNFOLDED = 400
"""Longest list behind a fold."""


def parameter_rows(fit: Fit) -> list[Row]:
    """The free parameters with prior, posterior and convergence, which are empty if the engine has none."""
    rows = []
    for label, row in fit.summary().iterrows():
        name = str(label)
        prior = fit.provenance["priors"][name]
        found = (float(row[key]) for key in ("q05", "median", "q95"))
        rows.append(
            _values(fit.symbol(name), spoken_name(name), str(row["unit"]), *found)
            | {
                "prior": str(prior["text"]),
                "source": str(prior["source"]),
                "ess": sample_size(row["ess_bulk"]) if "ess_bulk" in row else "",
                "r_hat": f"{row['r_hat']:.3f}" if "r_hat" in row else "",
            }
        )
    return rows


def derived_rows(fit: Fit) -> tuple[list[Row], list[Row]]:
    """Derived quantities: those to show, with one line for many rows of data, and the many lines behind a fold."""
    shown: list[Row] = []
    folded: list[Row] = []
    for name, labels in labels_by_name(fit.derived_labels()).items():
        found = np.array([fit.quantiles(label) for label in labels])
        unit = fit.unit(name)
        rows = [
            _values(fit.symbol(label), spoken_name(label), unit, *(float(q) for q in quantiles))
            for label, quantiles in zip(labels[:MOST_UNFOLDED], found, strict=False)
        ]
        if len(labels) <= MOST_LISTED:
            shown += rows
            continue
        folded += rows
        low, high = float(found[:, 1].min()), float(found[:, 1].max())
        ends = float(found[:, 0].min()), float(found[:, 2].max())
        same = high - low <= 1e-9 * abs(high)
        differ = bool((np.ptp(found, axis=0) > 1e-9 * abs(high)).any())
        shown.append(
            {
                "symbol": fit.symbol(name),
                "name": f"{spoken_name(name)}, {len(labels)} rows",
                "median": f"{quantity(high, unit)} in all rows"
                if same
                else f"{interval(low, high, unit)}, by row",
                "interval": _interval(*ends, unit, high) + (", over all rows" if differ else ""),
            }
        )
    return shown, folded


def labels_by_name(labels: Iterable[str]) -> dict[str, list[str]]:
    """Labels of each quantity: itself, or one for each level or row where it differs by these."""
    found: dict[str, list[str]] = {}
    for label in labels:
        found.setdefault(label.partition("[")[0], []).append(label)
    return found


def _values(symbol: str, name: str, unit: str, low: float, median: float, high: float) -> Row:
    return {
        "symbol": symbol,
        "name": name,
        "median": quantity(median, unit),
        "interval": _interval(low, high, unit, median),
    }


def _interval(low: float, high: float, unit: str, typical: float) -> str:
    """An interval; one whose ends are the same to six digits is said to be no interval."""
    if not high - low > 1e-6 * max(abs(low), abs(high)):
        return "hardly varies"
    return interval(low, high, unit, typical=typical)


def fixed_rows(fit: Fit) -> list[Row]:
    """Inputs that were not inferred, or that follow one that was."""
    rows = []
    for label, entry in (fit.provenance["fixed"] | fit.provenance.get("tied", {})).items():
        name, _, level = label.partition("[")
        known = lookup(name)
        symbol = (known.symbol if known else name) + (f" ({level.removesuffix(']')})" if level else "")
        unit = known.unit if known else "1"
        value = str(entry["text"]) if "text" in entry else quantity(float(entry["value"]), unit, 6)
        rows.append(
            {"symbol": symbol, "name": spoken_name(label), "value": value, "source": str(entry["source"])}
        )
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
