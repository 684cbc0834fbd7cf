"""Small words of the page."""

from __future__ import annotations

from collections.abc import Sequence

_PLURALS = {"person": "people", "body_site": "body sites", "row_label": "rows"}


def plural(column: str) -> str:
    """The levels of a grouping column: ``"people"``, ``"liquids"``."""
    return _PLURALS.get(column, f"{column.replace('_', ' ')}s")


def and_list(parts: Sequence[str]) -> str:
    """``"a, b and c"``.

    Examples
    --------
    >>> and_list(["a", "b", "c"]), and_list(["a"])
    ('a, b and c', 'a')
    """
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} and {parts[-1]}"
