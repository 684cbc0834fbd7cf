"""The page about the paper: what it states beside what is computed, its misprints shown, its figures drawn again."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.files import load_reference
from skinbayes.plot.paper import FIGURES
from skinbayes.plot.paper_overview import OVERVIEW, plot_overview
from skinbayes.report.figures import NARROW, placed
from skinbayes.report.rendering import rendered, write_whole
from skinbayes.reproduce import RULES, statements
from skinbayes.reproduce.choices import CHOICES
from skinbayes.reproduce.shown import (
    computed_text,
    count_sentence,
    difference_text,
    paper_text,
    printed_text,
)
from skinbayes.reproduce.statements import SOURCE

if TYPE_CHECKING:
    from skinbayes.reproduce import Compared, Demonstration, Paper


def write_reproduction(
    rows: Sequence[Compared],
    demonstrations: Sequence[Demonstration],
    paper: Paper,
    path: Path,
    progress: Callable[[int, int], None] | None = None,
) -> Path:
    """Write one self-contained HTML page about the reproduction.

    Parameters
    ----------
    rows : everything that is compared
    demonstrations : misprints and gaps
    paper : the cases of the paper, of which the figures are drawn
    path : the file to write
    progress : called with the number of figures drawn and their total

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written.
    MachineError
        The disk is full.
    """
    pictures = list(_pictures(paper, progress))
    return write_whole(Path(path), rendered("reproduction.html", _context(rows, demonstrations, pictures)))


def _pictures(paper: Paper, progress: Callable[[int, int], None] | None) -> Iterator[dict[str, Any]]:
    for done, one in enumerate(FIGURES):
        if progress is not None:
            progress(done, len(FIGURES))
        numbered = vars(one) | {"heading": f"Fig. {int(one.key[3:])}. {one.heading}"}
        yield placed(numbered, one.draw(paper, width=None), one.draw(paper, width=NARROW))


def _context(
    rows: Sequence[Compared], demonstrations: Sequence[Demonstration], pictures: list[dict[str, Any]]
) -> dict[str, Any]:
    provenance = load_reference(SOURCE).provenance
    shown = [_row(row) for row in rows]
    stated = [vars(one) | {"words": printed_text(one.words)} for one in statements().values()]
    return {
        "title": "Contact mechanics and friction on dry and wet human skin, computed again",
        "converged": True,
        "total": len(rows),
        "summary": count_sentence(list(rows)),
        "source": f"{', '.join(provenance.authors)}: {provenance.title.partition(': ')[0]}. Tribology Letters 50 (2013) 17, "
        f"{provenance.doi[0]}.",
        "missed": [row for row in shown if not row["agrees"]],
        "demonstrations": demonstrations,
        "groups": [
            {"name": name, "rows": [row for row in shown if row["group"] == name]}
            for name in dict.fromkeys(row["group"] for row in shown)
        ],
        "overview": placed(OVERVIEW, plot_overview(rows), plot_overview(rows, NARROW)),
        "pictures": pictures,
        "rules": [rule.sentence for rule in RULES.values()],
        "inputs": [one for one in stated if one["role"] == "input"],
        "choices": CHOICES,
        "left": [one for one in stated if one["role"] == "not computed"],
    }


def _row(row: Compared) -> dict[str, Any]:
    stated = row.statement
    words = {"number": "printed ", "claim": "the paper: "}.get(stated.role, "")
    return {
        "stated": words + paper_text(row),
        "id": stated.id,
        "group": stated.group,
        "description": stated.description,
        "where": stated.where,
        "paper": paper_text(row),
        "computed": computed_text(row),
        "difference": difference_text(row),
        "agrees": row.agrees,
        "note": row.note,
    }
