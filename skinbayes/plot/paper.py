"""The figures of the paper, drawn again in one style."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from skinbayes.atomic import write_atomically
from skinbayes.errors import InputError, cannot_write
from skinbayes.plot.paper_axes import PaperFigure
from skinbayes.plot.paper_contact import CONTACT
from skinbayes.plot.paper_sliding import SLIDING
from skinbayes.plot.paper_water import WATER
from skinbayes.plot.style import look

if TYPE_CHECKING:
    from skinbayes.reproduce import Paper

FIGURES: tuple[PaperFigure, ...] = tuple(sorted((*CONTACT, *WATER, *SLIDING), key=lambda figure: figure.key))
"""All of them in the order of the paper. Figs. 1, 2 and 18 are pictures."""

COLUMN = "84 mm"
"""Width of a figure in its file: that of a column of the journal; those with two panels have two."""

TWO_COLUMNS = ("fig05", "fig14", "fig15", "fig20", "fig21")

CAPTIONS = "captions.md"


def save_figures(
    paper: Paper, folder: Path, progress: Callable[[int, int], None] | None = None
) -> list[Path]:
    """Write every figure as PDF and PNG, and their captions.

    Parameters
    ----------
    paper : the cases of the paper
    folder : where; made if it does not exist
    progress : called with the number of figures done and their total

    Returns
    -------
    list of Path
        The files

    Raises
    ------
    InputError
        The folder cannot be written.
    MachineError
        The disk is full.
    """
    import io

    if folder.is_file():
        raise InputError(f"{folder}: a file; expected a folder for the figures")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(folder, error, begun=False) from None
    written = []
    for done, one in enumerate(FIGURES):
        if progress is not None:
            progress(done, len(FIGURES))
        width = "174 mm" if one.key in TWO_COLUMNS else COLUMN
        figure = one.draw(paper, width=width)
        for kind, options in (("pdf", {"metadata": {"CreationDate": None}}), ("png", {"dpi": 300})):
            buffer = io.BytesIO()
            with look():
                figure.savefig(buffer, format=kind, **options)
            written.append(_write(folder / f"{one.key}.{kind}", buffer.getvalue()))
    captions = [f"**Fig. {int(one.key[3:])}. {one.heading}.** {one.caption}" for one in FIGURES]
    written.append(_write(folder / CAPTIONS, ("\n\n".join(captions) + "\n").encode()))
    return written


def _write(path: Path, content: bytes) -> Path:
    try:
        write_atomically(path, content)
    except OSError as error:
        raise cannot_write(path, error, begun=False) from None
    return path
