"""Lengths of HighwayRoadmap's simplified paths beside those of planners that optimise them.

    python -m benchmarks.path_quality                     # every bundled scenario; 20 minutes
    python -m benchmarks.path_quality --time-limit 20 --scenarios maze-2d window-3d

HighwayRoadmap's length is the median over its seeds, after the default simplification; the time
behind it is that of search and simplification. RRTstar and BITstar have the plug-in's checker and
improve their path until the time limit; it is taken as they leave it.

Aim: at most AIM times the shorter of the two.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
from dataclasses import dataclass

from benchmarks.markdown import duration
from ellipsoid_planning.result import PlanResult
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario
from planners.solve import plan

OURS = "HighwayRoadmap"
PEERS = ("RRTstar", "BITstar")
AIM = 1.10
OWN_LIMIT = 10.0
"""For HighwayRoadmap [s]; it needs a small part of it."""


@dataclass(frozen=True)
class Quality:
    """Path lengths in one scenario, infinite where no path was found.

    Attributes:
        scenario: its name.
        lengths: of HighwayRoadmap, seed by seed.
        seconds: of HighwayRoadmap with its simplification, seed by seed.
        peers: the lengths of PEERS.
    """

    scenario: str
    lengths: tuple[float, ...]
    seconds: tuple[float, ...]
    peers: tuple[float, ...]

    @property
    def length(self) -> float:
        """HighwayRoadmap's median."""
        return statistics.median(self.lengths)

    @property
    def ratio(self) -> float:
        """To the best of the others; NaN if none of them found a path."""
        best = min(self.peers)
        return self.length / best if math.isfinite(best) else math.nan


def arguments() -> argparse.Namespace:
    known = list(bundled_scenarios())
    parser = argparse.ArgumentParser(prog="python -m benchmarks.path_quality", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--scenarios", nargs="+", choices=known, default=known, metavar="NAME")
    parser.add_argument("--seeds", type=int, default=5, help="of HighwayRoadmap (5)")
    parser.add_argument("--time-limit", type=float, default=60.0, help="of the others [s] (60)")
    given = parser.parse_args()
    if given.seeds < 1 or not given.time_limit > 0.0:
        parser.error("seeds and time limit must be positive")
    return given


def measured(scenario: Scenario, seeds: int, time_limit: float) -> Quality:
    """The lengths that all planners reach in one scenario."""
    sys.stderr.write(f"{scenario.name}\n")
    own = [plan(scenario, OURS, time_limit=OWN_LIMIT, seed=n + 1) for n in range(seeds)]
    peers = [
        plan(scenario, name, time_limit=time_limit, seed=1, simplify=False, anytime=True)
        for name in PEERS
    ]
    assert all(one.path is None or one.path.certified for one in (*own, *peers))
    return Quality(
        scenario.name,
        tuple(map(length, own)),
        tuple(map(seconds, own)),
        tuple(map(length, peers)),
    )


def length(result: PlanResult) -> float:
    return math.inf if result.path is None else result.path.length


def seconds(result: PlanResult) -> float:
    return float(result.time["total"] or 0.0)


def shown(value: float) -> str:
    return f"{value:.3f}" if math.isfinite(value) else "no path"


def row(found: Quality) -> str:
    spread = f"{shown(found.length)} ({shown(min(found.lengths))} to {shown(max(found.lengths))})"
    cells = [found.scenario, spread, duration(statistics.median(found.seconds))]
    cells += [*map(shown, found.peers), f"{found.ratio:.2f}" if found.ratio > 0.0 else "none"]
    return "| " + " | ".join(cells) + " |"


def check(found: Quality) -> str:
    if math.isnan(found.ratio):
        return f"undecided: {found.scenario}: neither {' nor '.join(PEERS)} found a path"
    verdict = "reached" if found.ratio <= AIM else "MISSED "
    return f"{verdict}: {found.scenario}: {found.ratio:.3f} times the best, aim {AIM:g}"


def main() -> None:
    """Measure and print a Markdown table and the checks."""
    given = arguments()
    heads = [f"{OURS} (range)", "its time", *(f"{one}, {given.time_limit:g} s" for one in PEERS)]
    print("| Scenario | " + " | ".join([*heads, "ratio to the best"]) + " |")
    print("| --- |" + " ---: |" * (len(heads) + 1), flush=True)
    qualities = []
    for name in given.scenarios:
        found = measured(load_scenario(name), given.seeds, given.time_limit)
        qualities.append(found)
        print(row(found), flush=True)
    print("\n```", *map(check, qualities), "```", sep="\n")


if __name__ == "__main__":
    main()
