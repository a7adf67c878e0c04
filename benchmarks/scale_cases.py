"""What one world of many ellipsoids costs: seconds and bytes of everything a planner does in it."""

from __future__ import annotations

import math
import statistics
import time
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.scale_scenes import SIZES, scale_scenario, side
from ellipsoid_planning.cspace.local import LocalCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import broad_phase, layout, lines, motion, validity
from ellipsoid_planning.roadmap.highway import SOLVED, HighwayRoadmap
from ellipsoid_planning.scenario import Scenario

Array = NDArray[np.float64]

STATES, MOTIONS, LINES = 2_000, 500, 60
ROUNDS = 5
TIME_LIMIT = 20.0
"""Of one plan [s]; a plan that takes longer counts as infinitely long."""

TIMES = (
    "state check, in the middle",
    "state check, anywhere",
    "clearance of a state",
    "certified motion",
    "sweep line, around start and goal",
    "sweep line, across the whole world",
    "building a CSpace",
    "whole plan",
)
BYTES = ("packed scene", "roadmap after the plan")
COUNTS = ("obstacles that such a line passes",)


def measure(count: int, dimension: int, seed: int) -> dict[str, float]:
    """Seconds of each of TIMES, bytes of each of BYTES, and each of COUNTS."""
    scenario = scale_scenario(count, dimension, seed)
    cspace, random = scenario.cspace(), np.random.default_rng([seed, dimension])
    half = 0.5 * side(SIZES[0], dimension)
    middle = configurations(random, scenario, half, STATES)
    anywhere = configurations(random, scenario, 0.5 * side(count, dimension), STATES)
    nearby = LocalCSpace(cspace, np.full(dimension, -2.0 * half), np.full(dimension, 2.0 * half))
    found = {
        "state check, in the middle": _states(cspace, middle),
        "state check, anywhere": _states(cspace, anywhere),
        "clearance of a state": _clearances(cspace, middle[: STATES // 10]),
        "certified motion": _motions(cspace, middle),
        "sweep line, around start and goal": _lines(nearby, middle),
        "sweep line, across the whole world": _lines(cspace, middle),
        "building a CSpace": _best(scenario.cspace, 3),
    }
    found["packed scene"] = cspace.scene.nbytes
    found["obstacles that such a line passes"] = _passed(cspace, middle)
    found |= _plan(scenario, cspace)
    return found


def configurations(
    random: np.random.Generator, scenario: Scenario, half: float, count: int
) -> Array:
    """Configurations (count, d), the base within ``half`` of the origin along every axis."""
    n = scenario.dimension
    places = random.uniform(-half, half, size=(count, n))
    if n == 2:
        return np.column_stack([places, random.uniform(-math.pi, math.pi, size=count)])
    turns = random.normal(size=(count, 4))
    return np.hstack([places, turns / np.linalg.norm(turns, axis=1, keepdims=True)])


def _best(run: Callable[[], Any], rounds: int = ROUNDS) -> float:
    """The least wall time [s] of a few calls, after one that may compile."""
    run()
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        run()
        times.append(time.perf_counter() - began)
    return min(times)


def _states(cspace: CSpace, rows: Array) -> float:
    poses, out = cspace.poses(rows), np.empty(len(rows), dtype=np.bool_)
    return _best(lambda: validity.are_free(cspace.scene, poses, out)) / len(rows)


def _clearances(cspace: CSpace, rows: Array) -> float:
    poses = cspace.poses(rows)
    return _best(lambda: [validity.clearance_of(cspace.scene, *p) for p in poses]) / len(rows)


def _motions(cspace: CSpace, rows: Array) -> float:
    """Motions of a third of the way to another state."""
    n, first = cspace.dimension, cspace.poses(rows[:MOTIONS])
    last = cspace.poses(rows[MOTIONS : 2 * MOTIONS])
    last[:, :n] = first[:, :n] + (last[:, :n] - first[:, :n]) / 3.0
    out = np.empty(MOTIONS, dtype=np.int64)
    return _best(lambda: motion.motions_are_free(cspace.scene, first, last, out)) / MOTIONS


def _lines(cspace: CSpace, rows: Array) -> float:
    """Lines of one layer; what it remembers of pairs of bodies is there after the first round."""
    layer, out = cspace.layer(rows[0]), np.empty((lines.CAPACITY, 2))
    places = np.zeros((LINES, 3))
    places[:, : cspace.dimension] = rows[:LINES, : cspace.dimension]
    cache = (layer._table, layer._keys, layer._scratch)  # noqa: SLF001 (kernels are timed bare)
    axis, placed = cspace.dimension - 1, layer._placed  # noqa: SLF001

    def run() -> None:
        for place in places:
            lines.free_intervals(cspace.scene, placed, 0, *cache, axis, *place, out)

    return _best(run) / LINES


def _passed(cspace: CSpace, rows: Array) -> float:
    """Mean number of obstacles whose boxes meet that of the robot's first part on a whole line."""
    layer, tree = cspace.layer(rows[0]), layout.tree_rows(cspace.scene)
    placed, out = layer._placed[0], np.empty(len(tree), dtype=np.int64)  # noqa: SLF001
    extent, total = placed[layout.PLACED_EXTENT :], 0
    for row in rows[:LINES]:
        place = np.zeros(3)
        place[: cspace.dimension - 1] = row[: cspace.dimension - 1]
        low, high = (place + placed[:3] + sign * extent for sign in (-1.0, 1.0))
        low[cspace.dimension - 1], high[cspace.dimension - 1] = -math.inf, math.inf
        nodes = out[: broad_phase.overlapping_nodes(tree, *low, *high, out)]
        total += int(np.count_nonzero(tree[nodes, layout.NODE_OBSTACLE] >= 0.0))
    return total / LINES


def _plan(scenario: Scenario, cspace: CSpace) -> dict[str, float]:
    """The median time of plans by fresh planners, and the bytes that one of them holds then."""
    times = [_one_plan(scenario, cspace)[0] for _ in range(ROUNDS)]
    tracemalloc.start()
    try:
        planner = _one_plan(scenario, cspace)[1]
        held = tracemalloc.get_traced_memory()[0]
    finally:
        tracemalloc.stop()
    assert planner.cspace is cspace
    return {"whole plan": statistics.median(times), "roadmap after the plan": float(held)}


def _one_plan(scenario: Scenario, cspace: CSpace) -> tuple[float, HighwayRoadmap]:
    began = time.perf_counter()
    planner = HighwayRoadmap(cspace)
    outcome = planner.solve(
        scenario.start[None],
        scenario.goal[None],
        lambda: time.perf_counter() - began > TIME_LIMIT,
    )
    seconds = time.perf_counter() - began
    return (seconds if outcome.status == SOLVED else math.inf), planner
