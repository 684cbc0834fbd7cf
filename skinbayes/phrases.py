"""Lists, counts and names of groups as people write them."""

from __future__ import annotations

from collections.abc import Sequence

_PLURALS = {"person": "people", "body_site": "body sites", "row_label": "rows"}


def and_list(parts: Sequence[str]) -> str:
    """``"a, b and c"``.

    Examples
    --------
    >>> and_list(["a", "b", "c"]), and_list(["a"])
    ('a, b and c', 'a')
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"


def singular(column: str) -> str:
    """A level of a grouping column: ``"body site"``."""
    return column.replace("_", " ") if column != "row_label" else "row"


def plural(column: str) -> str:
    """The levels of a grouping column: ``"people"``, ``"body sites"``."""
    return _PLURALS.get(column, f"{singular(column)}s")


def row_count(count: int) -> str:
    """``"1 row"``, ``"11 rows"``."""
    return f"{count} row{'' if count == 1 else 's'}"


def sample_size(ess: float) -> str:
    """An effective sample size, or that it is unknown: the autocorrelation has not died out within the run.

    Examples
    --------
    >>> sample_size(512.3), sample_size(0.0), sample_size(float("nan"))
    ('512', 'unknown', 'unknown')
    """
    return f"{ess:.0f}" if ess > 0 else "unknown"
