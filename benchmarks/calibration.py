"""Are the shipped models calibrated? The table of docs/calibration.md.

Each model is simulated and fitted many times; a folder keeps what is done, so that the program goes on where it was, also
with more simulations. ``--only`` chooses models; two of the same data are written MODEL+OTHER.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import skinbayes as sb
from skinbayes.calibration import Calibration, OddsCalibration
from skinbayes.phrases import number

ESS = 400
"""Effective sample size of each fit: fits stop early, which is the harder test of the rule by which they stop."""

MODELS = (
    "finger-water",
    "forearm-glass",
    "forearm-glass-separate",
    "forearm-glass+forearm-glass-separate",
)


def row(result: Calibration | OddsCalibration) -> str:
    """A row of the table, as Markdown."""
    seconds = sum(one.seconds for one in result.simulations) / len(result.simulations)
    start = f"{len(result.simulations)} | {result.failed}"
    if isinstance(result, OddsCalibration):
        p = result.p_values()
        name = min(p, key=lambda key: p[key])
        found = f"| {' or '.join(result.models)} | {start} | {number(p[name], 2)} ({name}) of {len(p)} | | |"
    else:
        name, p_value, tests = result.worst()
        held = [[result.coverage(one, level)[:2] for one in result.names] for level in (0.5, 0.9)]
        covered = " | ".join(
            f"{100 * sum(hits for hits, _ in each) / sum(count for _, count in each):.1f} %" for each in held
        )
        found = f"| {result.name} | {start} | {number(p_value, 2)} ({name}) of {tests} | {covered} |"
    return f"{found} {'yes' if result.passed() else 'NO'} | {seconds:.1f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", default=MODELS, metavar="MODEL")
    parser.add_argument("--simulations", type=int, default=200)
    parser.add_argument("--cores", type=int, default=1)
    parser.add_argument("--scheduler", metavar="ADDRESS")
    parser.add_argument("--folder", type=Path, default=Path("runs/calibration"))
    arguments = parser.parse_args()
    print(
        "| model | simulations | failed | smallest p, of how many tests | in 50 % | in 90 % | passes | CPU s each |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for name in arguments.only:
        result = sb.calibrate(
            *map(sb.load_problem, name.split("+")),
            simulations=arguments.simulations,
            ess=ESS,
            cores=arguments.cores,
            scheduler=arguments.scheduler,
            directory=arguments.folder / name,
        )
        print(row(result), flush=True)


if __name__ == "__main__":
    main()
