"""What a misprint or gap is shown by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Demonstration:
    """One misprint or gap.

    Attributes
    ----------
    id : name
    title : what is wrong, in a line
    where : place in the paper
    text : what follows from the numbers
    headers : of the table
    rows : cells as text, the first names the row
    """

    id: str
    title: str
    where: str
    text: str
    headers: Sequence[str]
    rows: Sequence[tuple[str, ...]]
