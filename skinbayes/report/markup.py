"""From plain text to safe HTML: everything is escaped first, then subscripts, powers and DOIs are marked up."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from skinbayes.plot.symbols import SUBSCRIPT

if TYPE_CHECKING:
    from markupsafe import Markup

_DOI = re.compile(r"10\.[0-9]{4,9}/[^\s,;)&<>\"']*[^\s,;)&<>\"'.]")
_POWER = re.compile(r"\^(?:\(([^()<>]+)\)|(-?[0-9.]*[0-9]))")


def symbols(text: str) -> Markup:
    """Set subscripts and powers: ``σ_f / E0^(1/2)``.

    Examples
    --------
    >>> print(symbols("σ_f < E0^2"))
    σ<sub>f</sub> &lt; E<sub>0</sub><sup>2</sup>
    """
    from markupsafe import Markup, escape

    marked = SUBSCRIPT.sub(lambda m: f"{m.group(1)}<sub>{m.group(2) or m.group(3)}</sub>", str(escape(text)))
    return Markup(_POWER.sub(lambda m: f"<sup>{m.group(1) or m.group(2)}</sup>", marked))


def links(text: str) -> Markup:
    """Turn each DOI in a text into a link to its resolver.

    Examples
    --------
    >>> print(links("see 10.1007/s11249-012-0053-2."))
    see <a href="https://doi.org/10.1007/s11249-012-0053-2">10.1007/s11249-012-0053-2</a>.
    """
    from markupsafe import Markup, escape

    return Markup(
        _DOI.sub(lambda m: f'<a href="https://doi.org/{m.group()}">{m.group()}</a>', str(escape(text)))
    )
