"""What do many fits cost beside their bare sampling, and do killed workers change them?

A made-up panel: friction of each person under six loads, fitted by ``load-series``. The baseline is the sampler alone, run
on the same problems with the same seeds in one process. Then ``fit_each`` on processes of this machine and, if
dask.distributed is installed, on a local cluster; in both a worker is killed twice meanwhile. Printed are processor seconds
a fit over those of the baseline, and whether all numbers are the same.

    python benchmarks/each.py --people 1000 --cores 2
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import signal
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import skinbayes as sb
from skinbayes.each import EachFit
from skinbayes.each.problems import share_preparation
from skinbayes.each.task import seed_of
from skinbayes.sampling.engines import find_engine, options_for


def panel(people: int) -> dict[str, Any]:
    """Problems of made-up people, a table to measure speed with, not data."""
    rng = np.random.default_rng(4)
    load = np.geomspace(0.05, 2, 6)
    names = np.repeat([f"P{i + 1}" for i in range(people)], load.size)
    own = np.repeat(0.5 * rng.lognormal(0, 0.3, people), load.size)
    force = np.tile(load, people)
    data = {
        "person": names, "normal_force [N]": force, "sphere_radius [mm]": np.full(names.size, 8.0),
        "friction_coefficient [1]": own * force**-0.2 * rng.lognormal(0, 0.06, names.size),
    }  # fmt: skip
    return sb.problems_of_each("load-series", data, column="person")


def bare(problems: dict[str, Any], seed: int, ess: int) -> float:
    """Processor seconds of the sampler alone."""
    share_preparation(problems.values())
    name, engine = find_engine("emcee")
    started = time.process_time()
    for person, problem in problems.items():
        engine.run(
            problem.target(), options_for(name, engine, seed=seed_of(seed, person), ess=ess), None, None
        )
    return time.process_time() - started


def killing(moments: set[int]) -> Callable[[int, int], None]:
    """Kills a worker process of this machine when so many fits are done."""

    def told(done: int, total: int) -> None:
        if done in moments:
            os.kill(multiprocessing.active_children()[0].pid or 0, signal.SIGKILL)

    return told


def same(first: EachFit, second: EachFit) -> bool:
    """Whether two sets of fits have the same numbers."""
    return bool(first.table().drop(columns="seconds").equals(second.table().drop(columns="seconds")))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=50)
    parser.add_argument("--baseline", type=int, default=20, help="people of whom the sampler alone is timed")
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--ess", type=int, default=400)
    arguments = parser.parse_args()
    few = list(panel(arguments.people))[: arguments.baseline]

    def some() -> dict[str, Any]:
        """Problems of the first few people, as fresh as all are."""
        everybody = panel(arguments.people)
        return {person: everybody[person] for person in few}

    bare(panel(2), 1, arguments.ess)  # imports
    base = bare(some(), 1, arguments.ess) / len(few)
    print(f"sampler alone: {base:.2f} processor seconds a fit ({len(few)} of them)")
    third = arguments.people // 3
    with tempfile.TemporaryDirectory() as folder:
        plain = sb.fit_each(some(), seed=1, ess=arguments.ess)
        mean = float(np.mean([one.seconds for one in plain.fits]))
        print(f"one after the other: {mean / base:.2f} times that in each of {len(few)}")
        begun = time.perf_counter()
        here = sb.fit_each(
            panel(arguments.people), seed=1, ess=arguments.ess, cores=arguments.cores, directory=Path(folder) / "here",
            progress=killing({third, 2 * third}),
        )  # fmt: skip
        wall = time.perf_counter() - begun
        mean = float(np.mean([one.seconds for one in here.fits]))
        print(
            f"{arguments.cores} processes, a worker killed twice: {here.sentence()} {mean / base:.2f} times in each; "
            f"{wall * arguments.cores / arguments.people / base:.2f} core seconds of the clock a fit over the baseline"
        )
        few = {one.name: one.quantities for one in plain.fits}
        print(
            f"the same numbers: {all(few[one.name] == one.quantities for one in here.fits if one.name in few)}"
        )
        try:
            import distributed
        except ImportError:
            return
        with distributed.LocalCluster(
            n_workers=arguments.cores, threads_per_worker=1, dashboard_address=":0", local_directory=folder
        ) as cluster:
            pids = list(cluster.scheduler_info["workers"].values())
            told = _killing_workers({third, 2 * third}, [worker["name"] for worker in pids], cluster)
            there = sb.fit_each(
                panel(arguments.people),
                seed=1,
                ess=arguments.ess,
                scheduler=cluster.scheduler_address,
                progress=told,
            )
        print(
            f"a dask cluster, a worker killed twice: {there.sentence()} The same numbers: {same(here, there)}"
        )


def _killing_workers(moments: set[int], names: list[Any], cluster: Any) -> Callable[[int, int], None]:
    """Kills a worker of a dask cluster when so many fits are done; its nanny starts another."""

    def told(done: int, total: int) -> None:
        if done in moments:
            os.kill(cluster.workers[names[0]].process.process.pid, signal.SIGKILL)

    return told


if __name__ == "__main__":
    main()
