"""The examples of docs/engines.md, run as a user would: as scripts of their own, in a folder of their own."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from source_tree import ROOT

EXAMPLES = re.findall(
    r"^```python\n(.*?)^```$",
    (ROOT / "docs" / "engines.md").read_text(encoding="utf-8"),
    re.MULTILINE | re.DOTALL,
)


@pytest.mark.parametrize("number", [0, 1], ids=["own engine", "draws of another sampler"])
def test_examples_run_outside_the_package(number: int, tmp_path: Path) -> None:
    assert len(EXAMPLES) == 2
    assert len(EXAMPLES[number].strip().splitlines()) <= 30
    script = tmp_path / "mine.py"
    script.write_text(EXAMPLES[number] + "print(fit.summary().to_csv(), fit.converged)\n", encoding="utf-8")
    command = [sys.executable, "-W", "error", "-W", "ignore::FutureWarning:arviz", str(script)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=500)
    assert done.returncode == 0, done.stderr
    # by ensembles 8.36 MPa; both ways know it to better than a fifth
    row = re.search(r"^frictional_shear_stress,Pa,([\d.e+-]+)", done.stdout, re.MULTILINE)
    assert row is not None
    assert float(row[1]) == pytest.approx(8.36e6, rel=0.2), done.stdout
    assert (tmp_path / "page.html").exists() == (number == 1)
