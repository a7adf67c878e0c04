"""Distances along a path, of what moves; an arm's resting base would hide them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.articulated import FIXED_BASE, ArticulatedRobot
from ellipsoid_planning.robots.joint import FIXED
from ellipsoid_planning.robots.tree import joints_in_order

if TYPE_CHECKING:
    from ellipsoid_planning.scenario import Scenario
    from planners.view.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Distances:
    """Along a path.

    Attributes:
        travelled: (m,), the length travelled in OMPL's metric.
        moving: (m,), from what moves to obstacles and arena boundaries.
        resting: the same of what never moves; infinite if everything does.
    """

    travelled: NDArray[np.float64]
    moving: NDArray[np.float64]
    resting: float = float("inf")


def distances_along(scenario: Scenario, trajectory: Trajectory) -> Distances:
    """Measure distances at the samples of a trajectory."""
    from ellipsoid_planning.cspace import CSpace

    space, resting = scenario.cspace(), np.inf
    robot = scenario.robot
    if isinstance(robot, ArticulatedRobot) and robot.base == FIXED_BASE:
        still = _resting_links(robot)
        if {link in still for link in robot.part_links} == {True, False}:
            base, arm = _with_parts_of(robot, still), _without_parts_of(robot, still)
            space = CSpace(scenario.world, arm, scenario.clearance)
            alone = CSpace(scenario.world, base, scenario.clearance)
            resting = alone.clearance(trajectory.configurations[0])
    moving = np.array([space.clearance(q) for q in trajectory.configurations])
    return Distances(trajectory.travelled, moving, float(resting))


def _resting_links(robot: ArticulatedRobot) -> set[str]:
    """The root of a fixed base and the links that hang on it by fixed joints only."""
    still = {robot.root}
    for joint in joints_in_order(robot.joints, robot.root):
        if joint.type == FIXED and joint.parent in still:
            still.add(joint.child)
    return still


def _with_parts_of(robot: ArticulatedRobot, names: set[str]) -> ArticulatedRobot:
    links = (link if link.name in names else replace(link, parts=()) for link in robot.links)
    return replace(robot, links=tuple(links))


def _without_parts_of(robot: ArticulatedRobot, names: set[str]) -> ArticulatedRobot:
    return _with_parts_of(robot, {link.name for link in robot.links} - names)
