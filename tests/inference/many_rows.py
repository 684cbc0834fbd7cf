"""Tables with many rows, and commands run on them as processes of their own whose memory is measured."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np


def write_loads(
    path: Path, rows: int, distinct: int | None = None, columns: dict[str, list[str]] | None = None
) -> Path:
    """Write friction of a ball on skin, dry and wet in turn, at loads that all differ or of which ``distinct`` are repeated."""
    rng = np.random.default_rng(1)
    kinds = min(rows, distinct or rows)
    force = np.resize(np.exp(rng.uniform(np.log(0.05), np.log(5.0), kinds)), rows)
    state = np.resize(["dry", "wet"], rows)
    level = np.where(state == "dry", 0.3, 1.4)
    friction = level * (force / 0.5) ** (-1 / 3) * np.exp(0.2 * rng.standard_normal(rows))
    further = columns or {}
    header = ["state", *further, "normal_force [N]", "sphere_radius [mm]", "friction_coefficient [1]"]
    cells = zip(state, *further.values(), force, friction, strict=True)
    lines = [",".join([*map(str, labels), f"{f:.6g}", "8", f"{m:.6g}"]) for *labels, f, m in cells]
    path.write_text("\n".join([",".join(header), *lines]) + "\n", encoding="utf-8")
    return path


MEASURED = """
import atexit, sys
from skinbayes.cli import main
status = open("/proc/self/status")
atexit.register(lambda: sys.stderr.write(next(line for line in status if line.startswith("VmHWM"))))
main()
"""
"""Not what the system counts for a child: that begins with the memory of the process that started it."""


def run(*arguments: str | Path) -> tuple[int, str, float]:
    """Run the command line; exit status, what it said, and the peak of its resident memory, MB."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-c", MEASURED, *map(str, arguments)]
    process = subprocess.run(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
    )
    said, _, peak = process.stdout.rpartition("VmHWM:")
    return process.returncode, said, float(peak.split()[0]) / 1024
