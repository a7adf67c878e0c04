"""One run of OMPL's RRT around an arrangement, with FCF as distance to the goal."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from ompl import base as ob
from ompl import geometric as og

from ellipsoid_planning.crystal.diffraction.fourier_cost import FourierCost
from ellipsoid_planning.crystal.phasing.trace import Trace
from planners import bindings

from .goal import Box, Budget, FreeArrangements, LowCost

Array = NDArray[np.float64]

# A tree's longest edge as a share of the box's diagonal, and how densely edges are checked.
EDGE = 0.1
SPACING = 0.05
# No run of a few thousand steps takes this long [s]; steps end it, so that it can be repeated.
NEVER = 1e6


def grow_tree(
    cost: FourierCost, start: Array, reach: Array, steps: int, threshold: float, seed: int
) -> tuple[Array, float, Trace]:
    """Grow a tree of free arrangements from ``start`` (K,), itself free.

    Args:
        cost: the Fourier cost.
        start: the root.
        reach: (K,), the box around it; coordinates with a reach of 0 do not move.
        steps: how many arrangements join the tree.
        threshold: FCF that ends the search.
        seed: of OMPL's random numbers.

    Returns:
        The arrangement with the lowest cost, that cost, and what was looked at.

    Raises:
        KeyboardInterrupt: SIGINT arrived; the tree is given up.
    """
    moving = reach > 0.0
    trace = Trace()
    trace.add(start, cost.value(start))
    if not np.any(moving) or steps < 1:
        return start, float(trace.costs[0]), trace
    # Fixed coordinates get a box so thin that they stay what they are.
    box = Box(start, np.where(moving, reach, 0.0))
    condition = bindings.stop_after(NEVER)
    budget = Budget(steps, condition)
    bindings.set_seed(seed)
    with bindings.ompl_output("silent"):
        si = _space_information(cost, box, budget)
        goal = LowCost(si, cost, box, threshold, budget)
        planner = _planner(si, box, goal)
        with bindings.interruptible(condition) as interruption:
            planner.solve(condition)
        if interruption.requested:
            raise KeyboardInterrupt
        found = _nearest(planner, box)
    trace.extend(goal.trace)
    if found is None:
        return start, float(trace.costs[0]), trace
    value = cost.value(found)
    best = (found, value) if value < trace.costs[0] else (start, float(trace.costs[0]))
    return (*best, trace)


def _space_information(cost: FourierCost, box: Box, budget: Budget) -> ob.SpaceInformation:
    si = ob.SpaceInformation(box.space())
    si.setStateValidityChecker(FreeArrangements(si, cost.model, box, budget))
    si.setStateValidityCheckingResolution(SPACING)
    si.setup()
    return si


def _planner(si: ob.SpaceInformation, box: Box, goal: LowCost) -> og.RRT:
    problem = ob.ProblemDefinition(si)
    root = si.allocState()
    box.access.write(root, [0.0] * len(box.centre))
    problem.addStartState(root)
    problem.setGoal(goal)
    planner = og.RRT(si)
    planner.setRange(EDGE * 2.0 * math.sqrt(len(box.centre)))
    planner.setProblemDefinition(problem)
    planner.setup()
    return planner


def _nearest(planner: og.RRT, box: Box) -> Array | None:
    """The tree's arrangement nearest to the goal: the end of OMPL's approximate path."""
    path = planner.getProblemDefinition().getSolutionPath()
    if path is None:
        return None
    last = bindings.configurations_of_path(path, box.access)[-1]
    return np.asarray(box.centre + box.reach * last)
