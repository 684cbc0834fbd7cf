"""The numbers of a comparison as the tables that terminal and page show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from skinbayes.comparison.models import Comparison
from skinbayes.comparison.verdicts import one, plus_minus

EXPLAINED = (
    "elpd: expected log predictive density of the data, each left out in turn, ± standard error; more is better. p_loo: "
    "effective number of parameters. weight: fraction in the mixture of the models that predicts best. refits: data without "
    "which the model was sampled anew. unreliable: data whose number cannot be trusted."
)
"""What the headers mean."""


class Table(NamedTuple):
    """A table of text, the model of each row first."""

    title: str
    headers: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]


def comparison_tables(comparison: Comparison) -> list[Table]:
    """Predictive densities of single data, the evidence if it is known, and a table for each column that was left out."""
    rows = [
        (m.name, plus_minus(m.elpd_loo, m.elpd_loo_se), plus_minus(m.elpd_difference, m.elpd_difference_se),
         f"{m.p_loo:.1f}", "–" if m.weight is None else f"{m.weight:.2f}", str(m.refitted_rows), str(m.unreliable_rows))
        for m in comparison.models
    ]  # fmt: skip
    headers = ("model", "elpd", "difference", "p_loo", "weight", "refits", "unreliable")
    found = [Table("", headers, rows)]
    if comparison.has_evidence:
        evidence = [
            (m.name, plus_minus(m.log_evidence or 0.0, m.log_evidence_se), f"{m.probability:.3f}")
            for m in comparison.by_evidence
        ]
        found.append(Table("", ("model", "ln evidence", "probability"), evidence))
    return found + [_levels(comparison, column) for column in comparison.columns]


def _levels(comparison: Comparison, column: str) -> Table:
    rows = []
    for model in sorted(comparison.models, key=lambda model: -model.left_out[column].elpd):
        entry = model.left_out[column]
        pairs = ((entry.elpd, entry.elpd_se), (entry.difference, entry.difference_se))
        said = (plus_minus(value, error) for value, error in pairs)
        rows.append((model.name, *said, str(len(entry.refitted)), str(len(entry.unreliable))))
    return Table(
        f"one {one(column)} left out at a time",
        ("model", "elpd", "difference", "refits", "unreliable"),
        rows,
    )
