"""FreeIntervalRRTConnect beside OMPL's RRTConnect with the plug-in, in one run.

    python -m benchmarks.tree_planner                     # all bundled scenarios; some minutes
    python -m benchmarks.tree_planner --scenarios maze-2d --runs 3 --time-limit 5

Seed by seed, the planners in turns. Times are the planners' alone, without simplification; a run
without a path counts as the limit.
"""

from __future__ import annotations

import argparse
import sys

from benchmarks.markdown import duration
from benchmarks.plans import Series, one_run
from benchmarks.ratios import ratio
from ellipsoid_planning.scenario import Scenario, bundled_scenarios, load_scenario

OURS, PEER, ROADMAP = "FreeIntervalRRTConnect", "RRTConnect", "HighwayRoadmap"
PLANNERS = (OURS, PEER, ROADMAP)


def arguments() -> argparse.Namespace:
    known = list(bundled_scenarios())
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.tree_planner",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--scenarios", nargs="+", choices=known, default=known, metavar="NAME")
    parser.add_argument("--runs", type=int, default=15, help="seeds of each planner (15)")
    parser.add_argument("--time-limit", type=float, default=20.0, help="of one run [s] (20)")
    given = parser.parse_args()
    if given.runs < 1 or not given.time_limit > 0.0:
        parser.error("runs and time limit must be positive")
    return given


def measured(scenario: Scenario, runs: int, limit: float) -> dict[str, Series]:
    """All runs of every planner on one scenario."""
    found = {name: Series(scenario.name, name, "plugin", limit) for name in PLANNERS}
    for series in found.values():
        one_run(scenario, Series(series.scenario, series.planner, "plugin", 0.05), seed=1)
    for number in range(runs):
        for name, series in found.items():
            # Two failures at the limit say enough about a planner.
            if series.failures < 2 or series.failures < len(series.runs):
                sys.stderr.write(f"{scenario.name}, run {number + 1}, {name}\n")
                series.runs.append(one_run(scenario, series, seed=number + 1))
    return found


def cell(series: Series) -> str:
    failed = f", {series.failures}/{len(series.runs)} without a path" if series.failures else ""
    at_least = ">" if series.is_bound else ""
    return f"{at_least}{duration(series.median)}{failed}"


def main() -> None:
    """Measure and print a Markdown table."""
    given = arguments()
    print(f"| Scenario | {OURS} | {PEER} + plug-in | ratio | {ROADMAP} | ratio |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for name in given.scenarios:
        found = measured(load_scenario(name), given.runs, given.time_limit)
        ours, peer, roadmap = (found[planner] for planner in PLANNERS)
        assert not any(series.uncertified for series in found.values())
        cells = [cell(ours), cell(peer), str(ratio(peer, ours))]
        cells += [cell(roadmap), str(ratio(roadmap, ours))]
        print(f"| {name} | {' | '.join(cells)} |", flush=True)
    print(
        f"\nMedians of up to {given.runs} seeds; ratios to {OURS}'s median."
        f" Limit {given.time_limit:g} s."
    )


if __name__ == "__main__":
    main()
