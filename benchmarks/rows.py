"""How much memory and time do the commands take with many rows of data?

Each command runs as a process of its own on rows of a ball on dry and wet skin whose load differs from row to row, or on a table
of few distinct rows repeated. Printed are the peak of resident memory, CPU and wall seconds.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from common import ROOT

SIZES = (100, 1_000, 10_000)
COMMANDS = ("check", "prior", "predict", "fit", "report", "compare")


def write_table(path: Path, rows: int, distinct: int | None = None, seed: int = 1) -> Path:
    """Write rows of friction of a ball on skin, dry and wet in turn; ``distinct`` of them repeated if given.

    The numbers are drawn from a power law of the load with 20 % of scatter: a table to measure speed with, not data.
    """
    rng = np.random.default_rng(seed)
    kinds = min(rows, distinct or rows)
    force = np.resize(np.exp(rng.uniform(np.log(0.05), np.log(5.0), kinds)), rows)
    state = np.resize(["dry", "wet"], rows)
    level = np.where(state == "dry", 0.3, 1.4)
    friction = level * (force / 0.5) ** (-1 / 3) * np.exp(0.2 * rng.standard_normal(rows))
    lines = ["state,normal_force [N],sphere_radius [mm],friction_coefficient [1]"]
    lines += [f"{s},{f:.6g},8,{m:.6g}" for s, f, m in zip(state, force, friction, strict=True)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def measured(arguments: list[str], limit: int | None = None) -> dict[str, float]:
    """Run the command line with these arguments; peak memory in MB, CPU and wall seconds, and its exit status."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    started = time.perf_counter()
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            [sys.executable, "-c", "from skinbayes.cli import main; main()", *arguments],
            stdout=said, stderr=subprocess.STDOUT, env=environment, cwd=ROOT,
        )  # fmt: skip
        # waits for this process alone; its workers, which share the work, count on their own
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 3):
            said.seek(0)
            raise SystemExit(said.read().decode(errors="replace"))
    return {
        "megabytes": used.ru_maxrss / 1024, "cpu_seconds": used.ru_utime + used.ru_stime,
        "wall_seconds": time.perf_counter() - started, "status": process.returncode,
    }  # fmt: skip


def run(
    sizes: list[int], commands: list[str], model: str, distinct: int | None, cores: int
) -> list[dict[str, Any]]:
    """Measure each command at each size."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for rows in sizes:
            table = write_table(Path(folder) / f"{rows}.csv", rows, distinct)
            directory = str(Path(folder) / f"run{rows}")
            calls = {
                "check": ["check", model, "--data", str(table)],
                "prior": ["prior", model, "--data", str(table), "--json"],
                "predict": ["predict", model, "--conditions", str(table), "--json"],
                "fit": ["fit", model, "--data", str(table), "--cores", str(cores), "-o", directory],
                "report": ["report", directory],
                "compare": ["compare", directory, directory],
            }
            for command in commands:
                found.append({"command": command, "rows": rows} | measured(calls[command]))
                print(json.dumps(found[-1]), file=sys.stderr)
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--rows", type=int, nargs="+", default=list(SIZES))
    parser.add_argument("--commands", nargs="+", default=list(COMMANDS), choices=COMMANDS)
    parser.add_argument(
        "--model", default="forearm-glass", help="model whose data have the columns of the table"
    )
    parser.add_argument("--distinct", type=int, help="rows that differ; the others repeat them")
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--json", action="store_true", help="one JSON document on standard output")
    chosen = parser.parse_args()
    found = run(chosen.rows, chosen.commands, chosen.model, chosen.distinct, chosen.cores)
    if chosen.json:
        print(json.dumps(found, indent=2))
        return
    print(f"{'command':<10}{'rows':>8}{'peak, MB':>12}{'CPU s':>10}{'wall s':>10}")
    for entry in found:
        print(
            f"{entry['command']:<10}{entry['rows']:>8}{entry['megabytes']:>12.0f}"
            f"{entry['cpu_seconds']:>10.1f}{entry['wall_seconds']:>10.1f}"
        )


if __name__ == "__main__":
    main()
