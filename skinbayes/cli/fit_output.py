"""What ``fit`` prints: the table, what was not learnt, where data and prior or model disagree, and where everything is."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.cli.output import print_sentences, print_table, say

if TYPE_CHECKING:
    from skinbayes.fit import Fit

MOST_ROWS = 4
"""Derived quantities that differ over more rows than this are left to the summary file."""


def print_fit(result: Fit, directory: Path, page: Path | None) -> None:
    """Print a fit for people: the numbers, then the same sentences on model, priors and sampler as the page has."""
    from skinbayes.fit.manifest import SUMMARY
    from skinbayes.report import remarks

    title = ("" if result.converged else "NOT CONVERGED – ") + result.provenance["title"]
    rows, crowded = _rows(result)
    print_table(
        ("parameter", "median", "5 %", "95 %", "ESS", "R-hat"), rows, title=title, right=(1, 2, 3, 4, 5)
    )
    print_sentences(remarks(result))
    if crowded:
        say(f"row by row in {directory / SUMMARY}: {', '.join(sorted(crowded))}")
    say(f"run: {directory}" + (f"\nreport: {page}" if page else f"\nreport: skinbayes report {directory}"))


def _rows(result: Fit) -> tuple[list[list[str]], set[str]]:
    """Rows of the table, and the derived quantities that are left to the file because they differ over many rows."""
    from skinbayes.report.words import sample_size
    from skinbayes.units import format_quantity

    free = result.summary()
    everything = result.summary(derived=True)
    counts = Counter(label.partition("[")[0] for label in everything.index)
    crowded = {name for name, count in counts.items() if count > MOST_ROWS}
    rows: list[list[str]] = []
    records: list[dict[Any, Any]] = everything.to_dict("records")
    for label, row in zip(everything.index.astype(str), records, strict=True):
        if label not in free.index and label.partition("[")[0] in crowded:
            continue
        values = [format_quantity(row[key], row["unit"]) for key in ("median", "q05", "q95")]
        known = label in free.index
        convergence = [sample_size(row["ess_bulk"]), f"{row['r_hat']:.3f}"] if known else ["", ""]
        rows.append([label, *values, *convergence])
    return rows, crowded
