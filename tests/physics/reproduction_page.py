"""The tables of docs/reproduction.md, from what is computed.

``python tests/physics/reproduction_page.py`` computes everything and writes them into the page.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from skinbayes.reproduce import Compared, Demonstration, Paper, demonstrations, reproduction
from skinbayes.reproduce.shown import computed_text, count_sentence, difference_text, paper_text

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reproduction.md"
BLOCK = re.compile(r"(<!-- (\w[\w-]*) -->\n).*?(<!-- end -->\n)", re.DOTALL)


def table(headers: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [headers, ["---"] * len(headers), *rows]
    return "".join(f"| {' | '.join(cell.replace('|', '/') for cell in line)} |\n" for line in lines)


def blocks(rows: Sequence[Compared], shown: Sequence[Demonstration]) -> dict[str, str]:
    """What stands between the marks of the page, by their names."""
    missed = [
        (f"{row.statement.description} ({row.statement.where})", paper_text(row), computed_text(row),
         difference_text(row), row.note)
        for row in rows if not row.agrees
    ]  # fmt: skip
    found = {
        "counts": count_sentence(list(rows)) + "\n",
        "missed": table(("what and where", "paper", "skinbayes", "off by", "why"), missed),
    }
    return found | {one.id: f"{one.text}\n\n{table(one.headers, one.rows)}" for one in shown}


def filled(page: str, found: dict[str, str]) -> str:
    """The page with its blocks as they are computed."""
    return BLOCK.sub(lambda match: f"{match[1]}{found[match[2]]}{match[3]}", page)


if __name__ == "__main__":
    case = Paper()
    now = blocks(reproduction(case), demonstrations(case))
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), now), encoding="utf-8")
