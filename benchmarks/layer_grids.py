"""Layers from grids of rotations against as many random rotations: layers used, and time to a path.

    python -m benchmarks.layer_grids                  # the bundled scenes in space, 10 seeds
    python -m benchmarks.layer_grids --seeds 3 --scenarios rabbit-3d-cluttered

Every grid is turned by a random rotation for each seed, as a single placement is luck. Passages are
found without layers, which hides differences: they are not looked for here.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.groups.catalogue import grid_by_name
from ellipsoid_planning.outcome import SOLVED
from ellipsoid_planning.roadmap import highway, passages
from ellipsoid_planning.roadmap.orientations import random_turn
from ellipsoid_planning.roadmap.parameters import RoadmapParameters
from ellipsoid_planning.scenario import load_scenario

SCENARIOS = ("rabbit-3d-cluttered", "rabbit-3d-narrow", "window-3d", "rabbit-3d-open")
GRIDS = ("600-cell", "icosahedral-bcc", "super-fibonacci", "random")
LIMIT = 20.0


def quaternions(name: str, count: int, seed: int) -> NDArray[np.float64]:
    """About ``count`` rotations of a grid, turned at random."""
    if name == "random":
        return grid_by_name(name, count=count, seed=seed).quaternions()
    size = {"count": count} if name == "super-fibonacci" else _resolution(count)
    return random_turn(grid_by_name(name, **size).quaternions(), 3, np.random.default_rng(seed))


def _resolution(count: int) -> dict[str, float]:
    return {"resolution_deg": float(np.degrees((8.0 * np.pi**2 / count) ** (1.0 / 3.0)))}


def run(scenario_name: str, grid: str, count: int, seed: int) -> tuple[float, int, int]:
    """Seconds, layers looked at, and layers in all of one query; nan if there was no path."""
    scenario = load_scenario(scenario_name)
    rows = quaternions(grid, count, seed)
    parameters = RoadmapParameters(layers=len(rows), refine=0)
    original = highway.spread_orientations
    highway.spread_orientations = lambda *_: rows
    try:
        planner = highway.HighwayRoadmap(scenario.cspace(), parameters)
        began = time.perf_counter()
        outcome = planner.solve(
            scenario.start[None],
            scenario.goal[None],
            lambda: time.perf_counter() - began > LIMIT,
        )
        taken = time.perf_counter() - began
    finally:
        highway.spread_orientations = original
    solved = outcome.status == SOLVED
    return (taken if solved else np.nan), planner.statistics.get("layers", 0), len(rows)


def main() -> None:
    """Measure and print a Markdown table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.layer_grids", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--count", type=int, default=420)
    parser.add_argument("--scenarios", nargs="+", default=list(SCENARIOS))
    given = parser.parse_args()
    passages.seeds_of_query = lambda *_: iter(())
    highway.HighwayRoadmap(load_scenario(SCENARIOS[0]).cspace()).compile_kernels()
    print("| scenario | grid | layers | solved | layers looked at | mean time |")
    print("| --- | --- | ---: | ---: | ---: | ---: |")
    for name in given.scenarios:
        for grid in GRIDS:
            found = [run(name, grid, given.count, seed) for seed in range(given.seeds)]
            times = np.array([row[0] for row in found])
            solved = np.count_nonzero(~np.isnan(times))
            layers = np.mean([row[1] for row in found])
            mean = 1e3 * np.nanmean(times) if solved else np.nan
            total = found[0][2]
            line = f"| {name} | {grid} | {total} | {solved}/{given.seeds} |"
            print(f"{line} {layers:.0f} | {mean:.1f} ms |", flush=True)


if __name__ == "__main__":
    main()
