"""The C-space that fits a robot."""

from __future__ import annotations

from ellipsoid_planning.cspace.articulated import ArticulatedCSpace
from ellipsoid_planning.cspace.space import CSpace
from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.rigid import RigidRobot
from ellipsoid_planning.world import World


def cspace_of(world: World, robot: RigidRobot | ArticulatedRobot, clearance: float = 0.0) -> CSpace:
    """The configuration space of ``robot`` in ``world``; every motion keeps ``clearance``.

    Raises:
        GeometryError: if the dimensions differ, or the clearance does not fit.
    """
    if isinstance(robot, ArticulatedRobot):
        return ArticulatedCSpace(world, robot, clearance)
    return CSpace(world, robot, clearance)
