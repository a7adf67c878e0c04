"""A roadmap that is kept for all queries against an empty one for each; prints a Markdown table.

    python -m benchmarks.kept_roadmap                      # 100 random queries a bundled scenario
    python -m benchmarks.kept_roadmap maze-2d --queries 20 --limit 5

Every query is asked of both in turn. Times are the process' own CPU time.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.articulated_sampling import ArticulatedSampling
from ellipsoid_planning.cspace.sampling import FreeIntervalSampling
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap.highway import HighwayRoadmap
from ellipsoid_planning.scenario import bundled_scenarios, load_scenario

Array = NDArray[np.float64]
Query = tuple[Array, Array]

MARGIN = 1.05
"""By how much the kept roadmap's median and sum may exceed the fresh one's: noise."""


@dataclass
class Asked:
    """What the queries took of one kind of roadmap: seconds, expansions, and how many it solved."""

    seconds: list[float] = field(default_factory=list)
    expansions: int = 0
    solved: int = 0

    def ask(self, roadmap: HighwayRoadmap, query: Query, limit: float) -> None:
        """Ask one query."""
        before, began = roadmap.statistics.get("expansions", 0), time.process_time()
        outcome = roadmap.solve(*query, lambda: time.process_time() - began > limit)
        self.seconds.append(time.process_time() - began)
        self.expansions += roadmap.statistics.get("expansions", 0) - before
        self.solved += outcome.status == SOLVED


def valid_configurations(cspace: CSpace, seed: int) -> Iterator[Array]:
    """Random free configurations (1, d)."""
    draw: Callable[[Array], bool]
    if isinstance(cspace, ArticulatedCSpace):
        draw = ArticulatedSampling(cspace, seed).sample
    else:
        draw = FreeIntervalSampling(cspace, seed).sample
    out = np.empty(cspace.robot.configuration_size)
    while True:
        if draw(out) and cspace.is_valid(out):
            yield out[None].copy()


def compared(name: str, queries: int, limit: float, seed: int) -> tuple[Asked, Asked]:
    """Random queries of a scenario's scene: (fresh, kept)."""
    cspace = load_scenario(name).cspace()
    HighwayRoadmap(cspace).compile_kernels()
    drawn = valid_configurations(cspace, seed)
    kept, fresh, again = HighwayRoadmap(cspace), Asked(), Asked()
    for number in range(queries):
        query = next(drawn), next(drawn)
        fresh.ask(HighwayRoadmap(cspace), query, limit)
        again.ask(kept, query, limit)
        sys.stderr.write(f"\r{name}: {number + 1} of {queries}")
    sys.stderr.write("\n")
    return fresh, again


def row(name: str, fresh: Asked, kept: Asked) -> str:
    """A line of the table."""
    cells = [name]
    for value in (lambda a: f"{a.solved}", lambda a: f"{a.expansions}"):
        cells += [value(fresh), value(kept)]
    for number in (np.median, np.sum):
        times = [1e3 * float(number(asked.seconds)) for asked in (fresh, kept)]
        cells += [*(f"{t:.3g}" for t in times), f"{times[1] / max(times[0], 1e-9):.2f}"]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Ask, and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.kept_roadmap", description=__doc__)
    parser.add_argument("scenarios", nargs="*", default=list(bundled_scenarios()))
    parser.add_argument("--queries", type=int, default=100)
    parser.add_argument("--limit", type=float, default=12.0, help="for one query [s of CPU]")
    parser.add_argument("--seed", type=int, default=7)
    given = parser.parse_args()
    heads = ["solved", "", "expansions", "", "median ms", "", "ratio", "sum ms", "", "ratio"]
    print("| scene | " + " | ".join(heads) + " |")
    print("|---|" + "---:|" * len(heads))
    print("| fresh, kept" + " |" * (len(heads) + 1))
    slower = []
    for name in given.scenarios:
        fresh, kept = compared(name, given.queries, given.limit, given.seed)
        print(row(name, fresh, kept), flush=True)
        if kept.solved < fresh.solved or sum(kept.seconds) > MARGIN * sum(fresh.seconds):
            slower.append(name)
    print(f"\n{'MISSED' if slower else 'reached'}: never slower than fresh {', '.join(slower)}")


if __name__ == "__main__":
    main()
