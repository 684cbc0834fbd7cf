"""What the benchmarks share: timing a call, and printing the result as a table or as JSON."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Sequence


def best_time(
    function: Callable[[], object],
    repeats: int,
    calls: int = 1,
    clock: Callable[[], float] = time.process_time,
) -> float:
    """Seconds a call, the best of ``repeats`` rounds; CPU seconds unless another clock is given."""
    times = []
    for _ in range(repeats):
        start = clock()
        for _ in range(calls):
            function()
        times.append((clock() - start) / calls)
    return min(times)


def report(
    description: str | None,
    title: str,
    run: Callable[[], dict[str, float]],
    lines: Sequence[tuple[str, str, str]],
) -> None:
    """Run a benchmark and print it.

    Parameters
    ----------
    description : docstring of the benchmark, whose first line is the help text
    title : first line of the table
    run : makes the measurement
    lines : label, key of the result and number format of each line
    """
    parser = argparse.ArgumentParser(description=(description or "").splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one JSON document on standard output")
    as_json = parser.parse_args().json
    result = run()
    if as_json:
        print(json.dumps(result, indent=2))
        return
    print(title)
    for label, key, style in lines:
        print(f"  {label:<52}{result[key]:>10{style}}")
