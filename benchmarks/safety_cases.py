"""What states cost with safety functions and with FCL, and what they cost with more links."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob

from benchmarks import safety_loops
from benchmarks.safety_scenes import configurations, maze, scene, snake
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.kernels import articulated_validity, safety_table
from ellipsoid_planning.safety import SafetyReport, TabulatedSafety
from ellipsoid_planning.safety.exact import mean_time
from planners.fcl import FclValidityChecker
from planners.spaces import state_space, write_configuration

Array = NDArray[np.float64]

LINKS = (10, 20, 40, 80)
_STATES, _FCL_STATES = 20_000, 300
_GROWTH_STATES = 300


@dataclass(frozen=True)
class StateCosts:
    """Seconds for one state by method, on random states and on the valid ones among them."""

    name: str
    safe: float
    anywhere: dict[str, float]
    valid: dict[str, float]
    tables: SafetyReport
    answered_valid: float


def state_costs(name: str) -> StateCosts:
    """Costs of the states of a scene."""
    cspace = scene(name)
    safety = TabulatedSafety(cspace, keep=False)
    rows = configurations(cspace, _STATES)
    valid = rows[cspace.are_valid(rows)]
    return StateCosts(
        name,
        len(valid) / len(rows),
        _costs(cspace, safety, rows),
        _costs(cspace, safety, valid),
        safety.report(rows),
        safety.report(valid).answered,
    )


def _costs(cspace: CSpace, safety: TabulatedSafety, rows: Array) -> dict[str, float]:
    packed, out = cspace.poses(rows), np.empty(len(rows), dtype=np.bool_)
    arrays = (safety.book, safety.offsets, safety.intervals)
    answers = np.zeros((len(rows), len(safety_table.link_rows(safety.book))), dtype=np.bool_)
    exact = articulated_validity.are_articulated_free
    scene_, robot = cspace.scene, safety.kinematics
    return {
        "exact": _best(lambda: exact(scene_, robot, packed, out), len(rows)),
        "tabulated": _best(
            lambda: safety_table.are_tabulated_free(scene_, robot, *arrays, packed, out), len(rows)
        ),
        "its look-ups": _best(
            lambda: safety_table.table_answers(robot, *arrays, packed, answers), len(rows)
        ),
        "FCL": fcl_cost(cspace, rows[:_FCL_STATES]),
    }


def _best(run: Callable[[], object], count: int) -> float:
    run()
    return min(mean_time(run, count) for _ in range(3))


def fcl_cost(cspace: CSpace, rows: Array) -> float:
    """Seconds for one state with OMPL's FCL checker."""
    si = ob.SpaceInformation(state_space(cspace))
    checker, states = FclValidityChecker(si, cspace), []
    for row in rows:
        state = si.allocState()
        write_configuration(state, row, cspace)
        states.append(state)
    return _best(lambda: [checker.isValid(state) for state in states], len(states))


def growth(links: int) -> dict[str, float]:
    """Seconds for one state of a snake of ``links`` in a world that grows with it.

    The snakes bend gently, so that they do not meet themselves; every link is tested.
    """
    side = 4.0 * links
    world = maze(4 * links, side)
    cspace = CSpace(world, snake(links, bend=0.15))
    rows = configurations(cspace, _GROWTH_STATES)
    packed, out = cspace.poses(rows), np.empty(len(rows), dtype=np.bool_)
    arguments = (cspace.scene, cspace.kinematics, packed, out)
    bare = _best(lambda: safety_loops.placed_only(*arguments), len(rows))
    found = {
        "kinematics": bare,
        "environment": _best(lambda: safety_loops.environment(*arguments), len(rows)) - bare,
        "self-collision": _best(lambda: safety_loops.self_collision(*arguments), len(rows)) - bare,
        "FCL": fcl_cost(cspace, rows[:30]),
    }
    assert out.all()
    return found


def exponent(costs: dict[int, float]) -> float:
    """The slope of a line through logarithms: cost ∝ links ** exponent."""
    links = [math.log(count) for count in costs]
    values = [math.log(value) for value in costs.values()]
    return float(np.polyfit(links, values, 1)[0])
