"""Pages that a reader follows from top to bottom: files to write, commands to type, programs to run, and what they print.

In a page ``<!-- file: NAME -->`` above a fence makes it a file; a fence that begins with ``$ skinbayes`` is typed in a
terminal of 100 columns; a ``python`` fence runs, and the ``text`` fence right below it is what it prints. A line ``…`` stands
for lines that are left out. ``python tests/architecture/walked_pages.py [NAME ...]`` writes what is printed now into the pages.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
import tempfile
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from command_line_page import numbers, run
from source_tree import ROOT

FENCE = re.compile(r"(?:<!-- file: (\S+) -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LEFT_OUT = "…"
WIDTH = 100


@dataclass(frozen=True)
class Step:
    """Something to do with what is shown of it, and where in the page that stands."""

    kind: str
    text: str
    name: str = ""
    shown: str | None = None
    span: tuple[int, int] = (0, 0)


def pages() -> list[Path]:
    """Pages with a file to write or a program whose output is shown, those of a test of their own apart."""
    return [
        path
        for path in sorted((ROOT / "docs").glob("*.md"))
        if "<!-- walked -->" in path.read_text(encoding="utf-8")
    ]


def steps(page: str) -> Iterator[Step]:
    """What there is to do, in order."""
    fences = list(FENCE.finditer(page))
    for fence, after in zip(fences, [*fences[1:], None], strict=True):
        name, language, text = fence.groups()
        if name:
            yield Step("file", text, name)
        elif text.startswith("$ skinbayes"):
            commands = re.match(r"(?:\$ skinbayes [^\n]*\n)+", text)
            assert commands is not None
            end = commands.end()
            yield Step("commands", commands[0], shown=text[end:], span=(fence.start(3) + end, fence.end(3)))
        elif language == "python":
            if after is not None and after[2] == "text" and not page[fence.end() : after.start()].strip():
                yield Step("program", text, shown=after[3], span=after.span(3))
            else:
                yield Step("program", text)


def walk(page: str, folder: Path) -> Iterator[tuple[Step, str]]:
    """Do it in ``folder``; each step with what it printed."""
    names: dict[str, object] = {}
    for step in steps(page):
        printed = ""
        if step.kind == "file":
            (folder / step.name).write_text(step.text, encoding="utf-8")
        elif step.kind == "commands":
            commands = step.text.replace("$ ", "").splitlines()
            printed = "".join(run(command, folder, WIDTH) for command in commands)
        else:
            out = io.StringIO()
            with contextlib.chdir(folder), contextlib.redirect_stdout(out), np.printoptions(legacy=False):
                exec(compile(step.text, "the page", "exec"), names)
            printed = out.getvalue()
        yield step, printed


def words(text: str) -> list[str]:
    """Lines without their numbers, blanks and rules: draws may differ in a last bit from one library to the next."""
    bare = [re.sub(r"[\d.,−+-]+|[─\s]+", " ", line) for line in text.splitlines()]
    lines = [" ".join(line.split()).removesuffix(" e") for line in bare]
    return [line for line in lines if line]


def missing(shown: str, printed: str) -> list[str]:
    """Lines of the page that are not printed, in order, and rows of tables with other numbers."""
    wanted, there = [line for line in words(shown) if line != LEFT_OUT], iter(words(printed))
    wrong = [line for line in wanted if line not in there]
    found = numbers(printed)
    for name, row in numbers(shown).items():
        if name in found and not np.allclose(found[name], row, rtol=0.1, atol=0.1):
            wrong.append(f"{name}: {found[name]} is printed, {row} is shown")
    return wrong


def refreshed(page: str, folder: Path) -> str:
    """The page with what is printed now; what is shown in part only is left as it is."""
    text = page
    for step, printed in reversed(list(walk(page, folder))):
        if step.shown is not None and LEFT_OUT not in step.shown.splitlines():
            text = text[: step.span[0]] + printed + text[step.span[1] :]
    return text


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for path in pages():
        if not sys.argv[1:] or path.stem in sys.argv[1:]:
            with tempfile.TemporaryDirectory() as made:
                path.write_text(refreshed(path.read_text(encoding="utf-8"), Path(made)), encoding="utf-8")
