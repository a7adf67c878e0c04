"""How far the points of an articulated robot can get from its joints, whatever their values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ellipsoid_planning.robots.joint import BALL, PRISMATIC, Joint
from ellipsoid_planning.robots.tree import joints_in_order

if TYPE_CHECKING:
    from ellipsoid_planning.robots.articulated import ArticulatedRobot

# What a joint that moves no part reaches, as a fraction of the whole robot's reach.
LEAST_REACH = 1e-3


def link_reaches(robot: ArticulatedRobot) -> dict[str, float]:
    """Upper bounds, by link, of the distance from the link's origin of it and all that hangs on it.

    They hold for all values of the joints within their limits.
    """
    reaches = dict.fromkeys((link.name for link in robot.links), 0.0)
    for link in robot.links:
        for part in link.parts:
            own = float(np.linalg.norm(part.centre) + part.semi_axes.max())
            reaches[link.name] = max(reaches[link.name], own)
    for joint in reversed(list(joints_in_order(robot.joints, robot.root))):
        arm = float(np.linalg.norm(joint.position)) + travel(joint)
        reaches[joint.parent] = max(reaches[joint.parent], arm + reaches[joint.child])
    return reaches


def travel(joint: Joint) -> float:
    """How far a prismatic joint takes its child from the joint's origin; 0 for the others."""
    return max(abs(joint.lower), abs(joint.upper)) if joint.type == PRISMATIC else 0.0


def joint_reaches(robot: ArticulatedRobot) -> dict[str, float]:
    """For each moving joint, how far points that it moves can get from the child's origin."""
    reaches = link_reaches(robot)
    return {joint.name: reaches[joint.child] for joint in robot.moving_joints}


def robot_reach(robot: ArticulatedRobot) -> float:
    """How far points of the robot can get from its base."""
    return link_reaches(robot)[robot.root]


def joint_weights(robot: ArticulatedRobot) -> NDArray[np.float64]:
    """Weights (J,) of the moving joints in the metric |Δ base| + Σ w |Δ joint| (thesis 6.3.1).

    Half of how far a turn by one radian moves points at most, as OMPL's SE(2) counts headings of a
    robot of reach 1; OMPL's distance of rotations in space is half the angle. Prismatic joints
    count as they are. Joints that move no part count a little, so that different configurations
    are never at distance 0.
    """
    reaches = joint_reaches(robot)
    least = LEAST_REACH * robot_reach(robot)
    weights = []
    for joint in robot.moving_joints:
        reach = max(reaches[joint.name], least)
        turn = (1.0 if joint.type == BALL else 0.5) * reach
        weights.append(1.0 if joint.type == PRISMATIC else turn)
    return np.array(weights)
