"""From plain text to safe HTML: everything is escaped first; then subscripts, powers and DOIs are marked up."""

from __future__ import annotations

import re
from html import escape

from skinbayes.plot.symbols import SUBSCRIPT

_DOI = re.compile(r"(?:https://(?:dx\.)?doi\.org/)?(10\.[0-9]{4,9}/[^\s,;)&<>\"']*[^\s,;)&<>\"'.])")
_POWER = re.compile(r"\^(?:\(([^()<>&;]+)\)|(-?[0-9.]*[0-9]))")


_UNIT = re.compile(r"(?<=[0-9]) (%|[kMGTmµn]?(?:Pa|N|m|s)\b)")
"""A number and its unit stay in one line."""


def symbols(text: str) -> str:
    """Set subscripts and powers: ``σ_f / E0^(1/2)``.

    Examples
    --------
    >>> print(symbols("σ_f < E0^2"))
    σ<sub>f</sub> &lt; E<sub>0</sub><sup>2</sup>
    """
    kept = _UNIT.sub(lambda m: f"\u00a0{m.group(1)}", escape(text))
    marked = SUBSCRIPT.sub(lambda m: f"{m.group(1)}<sub>{m.group(2) or m.group(3)}</sub>", kept)
    return _POWER.sub(lambda m: f"<sup>{m.group(1) or m.group(2)}</sup>", marked)


def links(text: str) -> str:
    """Turn each DOI in a text into a link to its resolver.

    Examples
    --------
    >>> print(links("see 10.1007/s11249-012-0053-2."))
    see <a href="https://doi.org/10.1007/s11249-012-0053-2">10.1007/s11249-012-0053-2</a>.
    """
    return _DOI.sub(lambda m: f'<a href="https://doi.org/{m.group(1)}">{m.group(1)}</a>', escape(text))
