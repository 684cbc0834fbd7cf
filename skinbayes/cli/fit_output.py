"""What ``fit`` prints: the table, what was not learnt, where data and prior or model disagree, and where everything is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.cli.output import print_sentences, print_table, say

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit

MOST_ROWS = 4
"""Derived quantities that differ over more rows than this are left to the summary file."""


def print_fit(result: Fit | JointFit, directory: Path, page: Path | None) -> None:
    """Print a fit for people: the numbers, then the same sentences on model, priors and sampler as the page has."""
    from skinbayes.fit.joint_fit import JointFit
    from skinbayes.fit.manifest import SUMMARY
    from skinbayes.report import joint_remarks, remarks

    title = ("" if result.converged else "NOT CONVERGED – ") + result.provenance["title"]
    rows, crowded = _rows(result)
    headers = ("parameter", "median", "5 %", "95 %", *_convergence(result))
    print_table(headers, rows, title=title, right=tuple(range(1, len(headers))))
    print_sentences(
        joint_remarks(result, result.left_out()) if isinstance(result, JointFit) else remarks(result)
    )
    if crowded:
        say(f"row by row in {directory / SUMMARY}: {', '.join(sorted(crowded))}")
    say(f"run: {directory}" + (f"\nreport: {page}" if page else f"\nreport: skinbayes report {directory}"))


def _rows(result: Fit | JointFit) -> tuple[list[list[str]], set[str]]:
    """Rows of the table, and the derived quantities that are left to the file because they differ over many rows."""
    from skinbayes.units import format_quantity

    free, shown = result.summary(), _convergence(result)
    everything = result.summary(derived=True)
    counts = Counter(label.partition("[")[0] for label in everything.index)
    crowded = {name for name, count in counts.items() if count > MOST_ROWS}
    rows: list[list[str]] = []
    records: list[dict[Any, Any]] = everything.to_dict("records")
    for label, row in zip(everything.index.astype(str), records, strict=True):
        if label not in free.index and label.partition("[")[0] in crowded:
            continue
        values = [format_quantity(row[key], row["unit"]) for key in ("median", "q05", "q95")]
        found = [form(row[key]) if label in free.index else "" for key, form in shown.values()]
        rows.append([label, *values, *found])
    return rows, crowded


def _convergence(result: Fit | JointFit) -> dict[str, tuple[str, Callable[[float], str]]]:
    """Headers of the diagnostics of parameters that the engine has, with their name and how they are written."""
    from skinbayes.phrases import sample_size

    known = {"ESS": ("ess_bulk", sample_size), "R-hat": ("r_hat", "{:.3f}".format)}
    return {header: entry for header, entry in known.items() if entry[0] in result.provenance["sampling"]}
