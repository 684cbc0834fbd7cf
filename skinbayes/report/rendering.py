"""From a template and what it shows to a file, which appears whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from skinbayes.atomic import write_atomically
from skinbayes.errors import cannot_write
from skinbayes.report.markup import links, symbols


def write_whole(path: Path, page: str) -> Path:
    """Write a page; ``InputError`` if its folder cannot be written, ``MachineError`` if the disk is full."""
    try:
        write_atomically(path, page.encode())
    except OSError as error:
        raise cannot_write(path, error, begun=False) from None
    return path


def rendered(template: str, shown: Mapping[str, Any]) -> str:
    """The page as text; everything shown is escaped."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("skinbayes.report", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # both escape their text before they add markup
    safe = jinja2.filters.do_mark_safe
    environment.filters |= {
        "symbols": lambda text: safe(symbols(text)),
        "links": lambda text: safe(links(text)),
    }
    return environment.get_template(template).render(shown)
