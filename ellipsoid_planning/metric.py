"""The length of a path as OMPL measures it, in plain numpy.

The distance of two configurations is that of the base's translations, plus 0.5 times the shortest
turn [rad] in the plane (SE2StateSpace), or plus the quaternions' arc length [rad], half the
turn, in space (SE3StateSpace); plus that of each joint times its weight (CompoundStateSpace): the
difference of a revolute [rad] or prismatic joint, the shortest turn [rad] of a continuous one,
the quaternions' arc length [rad] of a ball joint.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.robots.articulated import ArticulatedRobot
from ellipsoid_planning.robots.configurations import checked_configurations
from ellipsoid_planning.robots.joint import BALL, CONTINUOUS, Joint
from ellipsoid_planning.robots.reach import robot_reach
from ellipsoid_planning.robots.robot import Robot

Array = NDArray[np.float64]

HEADING_WEIGHT = 0.5
# SO3StateSpace takes quaternions for equal whose product is this close to 1.
SAME_QUATERNION = 1e-9


def path_length(robot: Robot, configurations: ArrayLike) -> float:
    """Return the sum of OMPL's distances along a path of configurations (m, d).

    Raises:
        GeometryError: if they are no configurations of finite numbers.
    """
    return float(np.sum(segment_lengths(robot, configurations)))


def segment_lengths(robot: Robot, configurations: ArrayLike) -> Array:
    """Return OMPL's distances (m − 1,) between neighbours of a path of configurations (m, d)."""
    path = checked_configurations(configurations, robot.configuration_size)
    distances = _steps(robot, path) + _turns(robot, path)
    if isinstance(robot, ArticulatedRobot):
        for joint, weight in zip(robot.moving_joints, robot.joint_weights, strict=True):
            distances += weight * _joint_moves(joint, path[:, robot.joint_slices[joint.name]])
    return np.asarray(distances)


def base_travel(robot: Robot, configurations: ArrayLike) -> float:
    """Return how far the robot's base travels along a path of configurations (m, d).

    Raises:
        GeometryError: if they are no configurations of finite numbers.
    """
    path = checked_configurations(configurations, robot.configuration_size)
    return float(np.sum(_steps(robot, path)))


def _steps(robot: Robot, path: Array) -> Array:
    if robot.base_size == 0:
        return np.zeros(len(path) - 1)
    moves = np.diff(path[:, : robot.dimension], axis=0)
    return np.asarray(np.linalg.norm(moves, axis=1))


def _turns(robot: Robot, path: Array) -> Array:
    if not robot.rotates:
        return np.zeros(len(path) - 1)
    if robot.dimension == 2:
        return HEADING_WEIGHT * _shortest_turns(path[:, 2])
    return _arcs(path[:, 3:7])


def _joint_moves(joint: Joint, values: Array) -> Array:
    """Distances (m - 1,) between the successive values (m, 1 or 4) of a joint."""
    if joint.type == BALL:
        return _arcs(values)
    if joint.type == CONTINUOUS:
        return _shortest_turns(values[:, 0])
    return np.abs(np.diff(values[:, 0]))


def _shortest_turns(headings: Array) -> Array:
    turns = np.abs(np.diff(headings))
    return np.asarray(np.minimum(turns, np.abs(2.0 * np.pi - turns)))


def _arcs(quaternions: Array) -> Array:
    products = np.abs(np.sum(quaternions[:-1] * quaternions[1:], axis=1))
    apart = products <= 1.0 - SAME_QUATERNION
    return np.where(apart, np.arccos(np.minimum(products, 1.0)), 0.0)


def turn_length(robot: Robot) -> float:
    """The length that planners let a turn of one radian count for by default.

    Half the robot's reach, which is how far its points move at most in such a turn.
    """
    if isinstance(robot, ArticulatedRobot):
        return 0.5 * robot_reach(robot)
    return 0.5 * max(
        float(np.linalg.norm(part.centre) + part.semi_axes.max()) for part in robot.parts
    )
