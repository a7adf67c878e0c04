"""The length of a path as OMPL measures it, in plain numpy.

The distance of two configurations is that of the translations, plus 0.5 times the shortest
turn [rad] in the plane (SE2StateSpace), or plus the quaternions' arc length [rad], half the
turn, in space (SE3StateSpace).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ellipsoid_planning.robots.rigid import RigidRobot

HEADING_WEIGHT = 0.5
# SO3StateSpace takes quaternions for equal whose product is this close to 1.
SAME_QUATERNION = 1e-9


def path_length(robot: RigidRobot, configurations: ArrayLike) -> float:
    """Return the sum of OMPL's distances along a path of configurations (m, d)."""
    path = np.asarray(configurations, dtype=float)
    return float(np.sum(_steps(robot, path) + _turns(robot, path)))


def base_travel(robot: RigidRobot, configurations: ArrayLike) -> float:
    """Return how far the robot's base travels along a path of configurations (m, d)."""
    return float(np.sum(_steps(robot, np.asarray(configurations, dtype=float))))


def _steps(robot: RigidRobot, path: NDArray[np.float64]) -> NDArray[np.float64]:
    moves = np.diff(path[:, : robot.dimension], axis=0)
    return np.asarray(np.linalg.norm(moves, axis=1))


def _turns(robot: RigidRobot, path: NDArray[np.float64]) -> NDArray[np.float64]:
    if not robot.rotates:
        return np.zeros(len(path) - 1)
    if robot.dimension == 2:
        turns = np.abs(np.diff(path[:, 2]))
        return HEADING_WEIGHT * np.minimum(turns, np.abs(2.0 * np.pi - turns))
    products = np.abs(np.sum(path[:-1, 3:] * path[1:, 3:], axis=1))
    apart = products <= 1.0 - SAME_QUATERNION
    return np.where(apart, np.arccos(np.minimum(products, 1.0)), 0.0)


def turn_length(robot: RigidRobot) -> float:
    """The length that planners let a turn of one radian count for by default.

    Half the robot's reach, which is how far its points move at most in such a turn.
    """
    return 0.5 * max(
        float(np.linalg.norm(part.centre) + part.semi_axes.max()) for part in robot.parts
    )
