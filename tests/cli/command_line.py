"""Running the command line inside the test process and as a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from skinbayes.cli import main

ROOT = Path(__file__).resolve().parents[2]


class Outcome(NamedTuple):
    """What a command did."""

    status: int
    output: str
    errors: str

    def document(self) -> Any:
        """Standard output as one strict JSON document."""

        def refuse(text: str) -> None:
            raise AssertionError(f"{text} is not JSON")

        return json.loads(self.output, parse_constant=refuse)


def run(capsys: pytest.CaptureFixture[str], *arguments: str | Path) -> Outcome:
    """Run ``skinbayes`` in this process."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main([str(argument) for argument in arguments])
    captured = capsys.readouterr()
    return Outcome(int(ended.value.code or 0), captured.out, captured.err)


def environment() -> dict[str, str]:
    """Environment in which a new interpreter finds this package, wherever it is imported from."""
    path = os.environ.get("PYTHONPATH", "")
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, [str(ROOT), path]))}


def command(*arguments: str | Path) -> list[str]:
    """The command line as a process."""
    start = "import sys; from skinbayes.cli import main; main()"
    return [sys.executable, "-c", start, *(str(argument) for argument in arguments)]


def run_process(*arguments: str | Path, cwd: Path | None = None, timeout: float = 120) -> Outcome:
    """Run ``skinbayes`` as a process of its own."""
    done = subprocess.run(
        command(*arguments), capture_output=True, text=True, encoding="utf-8", timeout=timeout, cwd=cwd,
        env=environment(), stdin=subprocess.DEVNULL,
    )  # fmt: skip
    return Outcome(done.returncode, done.stdout, done.stderr)
