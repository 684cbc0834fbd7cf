"""The commands shown in docs/command-line.md, and what they really print.

``python tests/architecture/command_line_page.py`` runs them all and writes their output into the page.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import tempfile
from pathlib import Path

from source_tree import ROOT

PAGE = ROOT / "docs" / "command-line.md"
BLOCK = re.compile(r"^```\n((?:\$ skinbayes [^\n]*\n)+)(.*?)^```$", re.MULTILINE | re.DOTALL)
ABRIDGED = "…\n"


def blocks() -> list[tuple[list[str], str]]:
    """Commands of each block (without the prompt) and the output shown below them."""
    found = BLOCK.findall(PAGE.read_text(encoding="utf-8"))
    return [([line.removeprefix("$ ") for line in commands.splitlines()], shown) for commands, shown in found]


def numbers(text: str) -> dict[str, list[float]]:
    """The rows of tables: name to the numbers in them, in the units shown."""
    rows = [line.split() for line in text.splitlines() if re.match(r" [a-z]\S+  ", line)]
    found: dict[str, list[float]] = {row[0]: [] for row in rows}
    for name, *cells in rows:
        found[name] += [float(cell) for cell in cells if re.fullmatch(r"-?\d+(\.\d+)?(e-?\d+)?", cell)]
    return found


def run(command: str, folder: Path, width: int | None = None) -> str:
    """What ``command`` prints in ``folder``, ``width`` columns wide: standard output, or the message if it fails."""
    from skinbayes.cli import main

    arguments = [word for word in shlex.split(command)[1:] if not word.startswith(">")]
    out, err = io.StringIO(), io.StringIO()
    os.environ.pop("COLUMNS", None)  # the page is as wide as output that is no terminal
    if width is not None:
        os.environ["COLUMNS"] = str(width)
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main(arguments)
        except SystemExit as end:
            status = end.code
    if ">/dev/null" in command and status == 0:
        return ""
    text = out.getvalue() if status == 0 else err.getvalue()
    lines = [line.rstrip() for line in text.replace(f"{ROOT}/", "").splitlines()]
    return "\n".join(lines).strip("\n") + "\n"


def refresh() -> None:
    """Write what the commands print now into the page; abridged output is left as it is."""
    with tempfile.TemporaryDirectory() as folder:

        def now(match: re.Match[str]) -> str:
            if match[2].endswith(ABRIDGED) or ABRIDGED in match[2]:
                return match[0]
            commands = match[1].replace("$ ", "").splitlines()
            return f"```\n{match[1]}{''.join(run(command, Path(folder)) for command in commands)}```"

        PAGE.write_text(BLOCK.sub(now, PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    refresh()
