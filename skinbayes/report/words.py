"""Small words of the page."""

from __future__ import annotations

from collections.abc import Sequence

_PLURALS = {"person": "people", "body_site": "body sites", "row_label": "rows"}


def plural(column: str) -> str:
    """The levels of a grouping column: ``"people"``, ``"liquids"``."""
    return _PLURALS.get(column, f"{column.replace('_', ' ')}s")


def sample_size(ess: float) -> str:
    """An effective sample size, or that it is unknown: the autocorrelation has not died out within the run.

    Examples
    --------
    >>> sample_size(512.3), sample_size(0.0), sample_size(float("nan"))
    ('512', 'unknown', 'unknown')
    """
    return f"{ess:.0f}" if ess > 0 else "unknown"


def and_list(parts: Sequence[str]) -> str:
    """``"a, b and c"``.

    Examples
    --------
    >>> and_list(["a", "b", "c"]), and_list(["a"])
    ('a, b and c', 'a')
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"
