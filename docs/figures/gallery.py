"""Draw the figures of docs/gallery.md, beside this file, by running the programs of the page.

Run with ``python docs/figures/gallery.py``. A program that is followed by a picture leaves it under the name ``figure``.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "gallery.md"
PROGRAM = re.compile(
    r"^```python\n(.*?)^```$(?:\n+!\[[^\]]+\]\(figures/([\w-]+\.svg)\))?", re.MULTILINE | re.DOTALL
)


def figures() -> Iterator[tuple[str, Figure]]:
    """The figures of the page by the names of their files."""
    names: dict[str, object] = {}
    for program, file in PROGRAM.findall(PAGE.read_text(encoding="utf-8")):
        exec(compile(program, PAGE.name, "exec"), names)
        if file:
            figure = names["figure"]
            assert isinstance(figure, Figure), f"{file}: its program leaves no figure"
            yield file, figure


def main(folder: Path) -> None:
    """Write all figures."""
    for file, figure in figures():
        with rc_context({"svg.hashsalt": "skinbayes", "svg.fonttype": "path"}):
            figure.savefig(folder / file, metadata={"Date": None, "Creator": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else HERE)
